// The number of threads a user asks for.
#pragma once
#include <fmt/core.h>

#include <string>

#include "core/parallel.hpp"

namespace bagnold::app {

// 0: no wish on the command line. A wish that has to be reduced is said once.
inline void use_threads(int wish) {
  if (const std::string note = set_threads(wish); !note.empty()) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace bagnold::app
