#include "core/version.hpp"

namespace bagnold {
std::string_view version() { return BAGNOLD_VERSION; }
std::string_view git_hash() { return BAGNOLD_GIT_HASH; }
std::string_view compiler() { return BAGNOLD_COMPILER; }
}  // namespace bagnold
