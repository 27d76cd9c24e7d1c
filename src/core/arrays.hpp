// The arrays that make up the exact state of an engine, by name. An engine lists them once,
//   template <class Visit> void visit_state(DemState& s, Visit&& visit) { visit("x", s.grains.x); ... }
// and checkpointing, resuming and bitwise comparison all go through that list.
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/vec3.hpp"

namespace bagnold {

// A named reference to one array or number of a state. Vec3 arrays are stored as n x 3 doubles.
using StateArray = std::variant<std::vector<double>*, std::vector<Vec3>*, std::vector<std::int32_t>*,
                                std::vector<std::int64_t>*, std::vector<std::uint8_t>*, double*, std::int64_t*>;

struct NamedArray {
  std::string name;
  StateArray array;
};

}  // namespace bagnold
