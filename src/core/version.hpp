// What every result says about the program that made it.
#pragma once
#include <string_view>

namespace bagnold {
std::string_view version();   // "0.1.0"
std::string_view git_hash();  // with "-dirty" when the tree had changes
std::string_view compiler();  // name, version, build type
}  // namespace bagnold
