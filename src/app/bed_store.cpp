#include "app/bed_store.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "core/error.hpp"
#include "io/hdf5.hpp"

namespace bagnold::app {

namespace {

namespace fs = std::filesystem;

// Raise when settle_bed gives other beds for the same recipe, so that old ones are not used.
constexpr int bed_version = 2;

fs::path cache_folder() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != 0) return fs::path(xdg) / "bagnold";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0)
    return fs::path(home) / ".cache" / "bagnold";
  return {};
}

std::string name_of(const scenario::BedRecipe& recipe) {
  std::string name = fmt::format("bed-v{}", bed_version);
  for_each_field<scenario::BedRecipe>([&](const auto& f) { name += fmt::format("_{}", recipe.*(f.member)); });
  return name + ".h5";
}

}  // namespace

scenario::Bed stored_bed(const scenario::BedRecipe& recipe) {
  const fs::path folder = cache_folder();
  const fs::path path = folder / name_of(recipe);
  std::error_code failed;
  if (!folder.empty() && fs::exists(path, failed)) {
    try {
      const auto file = io::H5File::read_only(path);
      return {file.read<Vec3>("x"), file.read<double>("diameter")};
    } catch (const IoError&) {  // damaged: make it anew
    }
  }
  fmt::print(stderr, "note: settling a bed of {:.0f} grains to cut from{}\n",
             recipe.length * recipe.width * scenario::filling_height(recipe),
             folder.empty() ? "" : ", kept in " + folder.string() + " for other runs");
  scenario::Bed bed = scenario::settle_bed(recipe);
  if (folder.empty() || !(fs::create_directories(folder, failed), fs::is_directory(folder, failed))) return bed;
  try {
    const fs::path part =
        path.string() + fmt::format(".{}", static_cast<unsigned>(std::hash<std::string>{}(path.string())));
    auto file = io::H5File::create(part);
    file.write("x", bed.x);
    file.write("diameter", bed.diameter);
    file.close();
    fs::rename(part, path);
  } catch (const std::exception&) {  // a full or read-only cache costs time, not the run
  }
  return bed;
}

}  // namespace bagnold::app
