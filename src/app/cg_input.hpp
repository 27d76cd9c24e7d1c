// Stored instants for `bagnold cg`: its own run.h5, LAMMPS dumps, MercuryDPM files.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cg/snapshot.hpp"

namespace bagnold::app {

// What foreign files do not say.
struct ForeignOptions {
  std::vector<std::int64_t> base_types;  // LAMMPS types or MercuryDPM species (column info) that do not flow
  double density = 0;                    // of the grains, where masses are not in the file
  double timestep = 0;                   // of LAMMPS, where times are not in the file
  // What the columns of a local dump are, in order: id1 id2 fx fy fz [tx ty tz], "-" to skip one. Forces are on id1.
  std::vector<std::string> contact_columns{"id1", "id2", "fx", "fy", "fz"};
};

struct SourceInfo {
  std::optional<Vec3> gravity;  // known for own runs only
};

// Calls `each` with every instant of the files, in order of time within each run. `inputs`: run directories or run.h5;
// LAMMPS dumps (an atom dump followed by its contact dump); MercuryDPM .data files (the .fstat beside is found).
// Throws InputError for files that are none of these or do not fit together.
SourceInfo read_instants(const std::vector<std::filesystem::path>& inputs, const ForeignOptions& options,
                         const std::function<void(const cg::StoredSnapshot&)>& each);

}  // namespace bagnold::app
