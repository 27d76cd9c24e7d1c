// Where a result comes from: enough to make it again, nothing about the machine it was made on.
#pragma once
#include <cstdint>
#include <string>

namespace bagnold::io {

class H5File;

struct Provenance {
  std::string version, git_hash, compiler;  // of the program
  std::int64_t seed = 0;
  std::string input;  // the resolved case, as text: running it gives the same bits
};

// The provenance of what this program makes of `input`.
Provenance provenance(std::int64_t seed, std::string input);

// Attributes version, git_hash, compiler, seed and input of the root group.
void write_provenance(H5File& file, const Provenance& provenance);
Provenance read_provenance(const H5File& file);

}  // namespace bagnold::io
