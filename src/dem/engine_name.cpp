#include "dem/engine_name.hpp"

#include "dem/fast/engine.hpp"

namespace bagnold::dem {

std::string_view engine_name(const DemState& state) { return fast::supports(state) ? "fast" : "plain"; }

}  // namespace bagnold::dem
