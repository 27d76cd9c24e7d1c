#include "io/provenance.hpp"

#include <utility>

#include "core/version.hpp"
#include "io/hdf5.hpp"

namespace bagnold::io {

Provenance provenance(std::int64_t seed, std::string input) {
  return {std::string(version()), std::string(git_hash()), std::string(compiler()), seed, std::move(input)};
}

void write_provenance(H5File& file, const Provenance& provenance) {
  file.attribute("/", "version", provenance.version);
  file.attribute("/", "git_hash", provenance.git_hash);
  file.attribute("/", "compiler", provenance.compiler);
  file.attribute("/", "seed", provenance.seed);
  file.attribute("/", "input", provenance.input);
}

Provenance read_provenance(const H5File& file) {
  return {file.string_attribute("/", "version"), file.string_attribute("/", "git_hash"),
          file.string_attribute("/", "compiler"), file.int_attribute("/", "seed"), file.string_attribute("/", "input")};
}

}  // namespace bagnold::io
