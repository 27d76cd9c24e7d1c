#include "app/bed_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <span>

#include "app/cost.hpp"
#include "app/progress.hpp"
#include "app/signals.hpp"
#include "core/error.hpp"
#include "io/hdf5.hpp"
#include "io/sha256.hpp"

namespace bagnold::app {

namespace {

namespace fs = std::filesystem;
using scenario::BedRecipe;

constexpr std::int64_t bed_format = 1;  // of the group

fs::path file_of(const BedRecipe& recipe) {
  std::string name = "bed";
  for_each_field<BedRecipe>([&](const auto& f) { name += fmt::format("_{}", recipe.*(f.member)); });
  return cache_folder() / (name + ".h5");
}

StoredBed read_bed(const io::H5File& file, const std::string& group) {
  const auto damaged = [&](const std::string& what) {
    return IoError(fmt::format("{}: {}: {}", file.path().string(), group, what));
  };
  if (const auto format = file.int_attribute(group, "format"); format != bed_format)
    throw damaged(fmt::format("a bed of format {}, this program reads {}", format, bed_format));
  StoredBed stored;
  for_each_field<BedRecipe>([&](const auto& f) {
    auto& value = stored.recipe.*(f.member);
    if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>)
      value = file.int_attribute(group, std::string(f.name));
    else
      value = file.double_attribute(group, std::string(f.name));
  });
  stored.path = file.string_attribute(group, "path");
  stored.hash = file.string_attribute(group, "hash");
  stored.bed = {file.read<Vec3>(group + "/x"), file.read<double>(group + "/diameter")};
  if (stored.bed.x.size() != stored.bed.diameter.size()) throw damaged("x and diameter differ in length");
  if (const std::string found = bed_hash(stored.bed); found != stored.hash)
    throw damaged(fmt::format("its arrays have the hash {}, it says {}", found, stored.hash));
  return stored;
}

// Why a bed is not the one wanted; empty if it is.
std::string mismatch(const StoredBed& stored, const BedRecipe& recipe) {
  std::string what;
  for_each_field<BedRecipe>([&](const auto& f) {
    if (what.empty() && stored.recipe.*(f.member) != recipe.*(f.member))
      what = fmt::format("it was made with {} = {}, wanted {}", f.name, stored.recipe.*(f.member), recipe.*(f.member));
  });
  if (what.empty() && stored.path != scenario::bed_path())
    what = fmt::format("it was made by \"{}\", this program makes it by \"{}\"", stored.path, scenario::bed_path());
  return what;
}

void store(const StoredBed& stored) {
  const fs::path folder = cache_folder(), path = file_of(stored.recipe);
  std::error_code failed;
  if (folder.empty() || !(fs::create_directories(folder, failed), fs::is_directory(folder, failed))) return;
  const fs::path part = path.string() + fmt::format(".{}.part", ::getpid());  // of this process alone
  try {
    auto file = io::H5File::create(part);
    write_bed(file, "bed", stored);
    file.close();
    fs::rename(part, path);
  } catch (const std::exception&) {  // a full or read-only cache costs time, not the run
    fs::remove(part, failed);
  }
}

}  // namespace

std::string bed_hash(const scenario::Bed& bed) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return io::sha256({std::as_bytes(std::span(bed.x)), std::as_bytes(std::span(bed.diameter))});
}

void write_bed(io::H5File& file, const std::string& name, const StoredBed& stored) {
  const std::string group = "beds/" + name;
  file.write(group + "/x", stored.bed.x);
  file.write(group + "/diameter", stored.bed.diameter);
  file.attribute(group, "format", bed_format);
  for_each_field<BedRecipe>(
      [&](const auto& f) { file.attribute(group, std::string(f.name), stored.recipe.*(f.member)); });
  file.attribute(group, "path", stored.path);
  file.attribute(group, "hash", stored.hash);
}

std::vector<StoredBed> read_beds(const fs::path& path) {
  const auto file = io::H5File::read_only(path);
  std::vector<StoredBed> beds;
  if (!file.exists("beds")) return beds;
  for (const std::string& name : file.children("beds")) beds.push_back(read_bed(file, "beds/" + name));
  return beds;
}

fs::path cache_folder() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != 0) return fs::path(xdg) / "bagnold";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0)
    return fs::path(home) / ".cache" / "bagnold";
  return {};
}

std::optional<StoredBed> cached_bed(const BedRecipe& recipe) {
  const fs::path path = file_of(recipe);
  std::error_code failed;
  if (cache_folder().empty() || !fs::exists(path, failed)) return {};
  std::string why = "it holds no bed";
  try {
    for (StoredBed& stored : read_beds(path))
      if (why = mismatch(stored, recipe); why.empty()) return std::move(stored);
  } catch (const IoError& error) {
    why = error.what();
  }
  fmt::print(stderr, "warning: {}: not used: {}\n", path.string(), why);
  return {};
}

Cost bed_cost(const BedRecipe& recipe) {
  const auto grains = static_cast<double>(scenario::bed_grains(recipe));
  return {.elements = "grain",
          .engine = std::string(scenario::bed_path()),
          .count = grains,
          .element_steps = grains * scenario::bed_steps(recipe),
          .usual_speed = 4e6};
}

StoredBed settle_and_store(const BedRecipe& recipe, bool quiet) {
  const auto grains = scenario::bed_grains(recipe);
  if (!quiet)
    fmt::print(stderr, "note: settling a bed of {} grains to cut from, {}{}\n", grains,
               time_text(bed_cost(recipe), "bed"),
               cache_folder().empty() ? "" : "; kept in " + cache_folder().string() + " for other runs");
  const auto start = std::chrono::steady_clock::now();
  double steps = 0;
  std::optional<scenario::Bed> bed;
  {
    std::optional<Progress> progress;
    bed = scenario::settle_bed(recipe, [&](const scenario::Settling& now) {
      if (!progress) progress.emplace(0, now.latest, quiet, fmt::format("bed of {} grains", grains));
      if (progress->due()) progress->show(now.time, fmt::format("E_kin/E_ela {:.2g}, at rest 1e-5", now.energy_ratio));
      steps = static_cast<double>(now.step);
      return !stop_requested();
    });
  }
  if (!bed) throw Interrupted("interrupted while a bed was being settled: no run was begun");
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  remember_speed(bed_cost(recipe), "bed", steps * static_cast<double>(grains), took);
  StoredBed stored{recipe, std::string(scenario::bed_path()), bed_hash(*bed), std::move(*bed)};
  store(stored);
  return stored;
}

}  // namespace bagnold::app
