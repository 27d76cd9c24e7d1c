// Settled beds take longest to prepare and depend on a few numbers only. They are kept in the user's cache folder
// ($XDG_CACHE_HOME/bagnold, else ~/.cache/bagnold) and, so that a run can be repeated elsewhere, in run.h5.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/model.hpp"
#include "scenario/settled_bed.hpp"

namespace bagnold::io {
class H5File;
}

namespace bagnold::app {

struct StoredBed {
  scenario::BedRecipe recipe;
  std::string path;  // what computed it (scenario::bed_path)
  std::string hash;  // of the arrays (bed_hash)
  scenario::Bed bed;
};

// SHA-256 of the bytes of x, then of diameter, little-endian doubles: the name of what is in a bed.
std::string bed_hash(const scenario::Bed& bed);

// A group of a file: x, diameter; attributes recipe, path, hash. Both files of the cache and run.h5 hold beds/<name>.
void write_bed(io::H5File& file, const std::string& name, const StoredBed& stored);
// Throws IoError for a bed that is damaged: whose hash is not that of its arrays.
std::vector<StoredBed> read_beds(const std::filesystem::path& path);

// The user's cache folder of this program; empty when there is none.
std::filesystem::path cache_folder();

// The bed of this recipe from the cache. A file that holds anything but a bed of this recipe, made on this path and
// undamaged, is refused with a warning on stderr.
std::optional<StoredBed> cached_bed(const scenario::BedRecipe& recipe);

Cost bed_cost(const scenario::BedRecipe& recipe);  // of settling it

// Settles a bed, showing progress unless `quiet`, and puts it into the cache, whole or not at all: other processes may be
// doing the same. A cache that cannot be used is not an error. Throws Interrupted (app/signals.hpp).
StoredBed settle_and_store(const scenario::BedRecipe& recipe, bool quiet);

}  // namespace bagnold::app
