#pragma once
#include <string_view>

#include "dem/state.hpp"

namespace bagnold::dem {

// What advance() steps this state with: "fast" or "plain".
std::string_view engine_name(const DemState& state);

}  // namespace bagnold::dem
