// Exact states on disk. DIR/checkpoint.h5 is the newest, DIR/checkpoint.prev.h5 the one before; at every
// moment, power cuts included, at least one of them is whole once the first has been written.
#pragma once
#include <filesystem>
#include <vector>

#include "core/arrays.hpp"
#include "io/provenance.hpp"

namespace bagnold::io {

// Writes the arrays with a checksum each, then makes the file the newest checkpoint of `directory`. Throws
// IoError.
void write_checkpoint(const std::filesystem::path& directory, const std::vector<NamedArray>& state,
                      const Provenance& provenance);

struct RestoredFrom {
  std::filesystem::path file;
  Provenance provenance;
  bool previous = false;  // the newest was missing or damaged
  std::string damage;     // why it was not used
};

// Overwrites the arrays of `state`, all of them or, on an error, none. A file that cannot be read or whose
// checksums do not match is passed over for the previous one; IoError when neither is whole. InputError when
// a whole file holds other arrays than `state` (it belongs to another model or version); the text names the
// array.
RestoredFrom read_checkpoint(const std::filesystem::path& directory, const std::vector<NamedArray>& state);

// The provenance of the checkpoint that read_checkpoint would use: resuming starts from the input stored in
// it.
Provenance checkpoint_provenance(const std::filesystem::path& directory);

}  // namespace bagnold::io
