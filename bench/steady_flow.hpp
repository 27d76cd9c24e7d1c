// The reference flow of the paper, where it is steady.
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "app/dem_input.hpp"
#include "chute_flow.hpp"
#include "config/case.hpp"

namespace bagnold::bench {

// cases/chute.toml at t = 200, when it is steady: the bed is a slice of a packing, as in the paper.
inline std::vector<Grain> steady_flow() {
  const std::string file = "bench-steady.state";
  if (read(file).empty()) {
    fmt::print("running cases/chute.toml to t = 200, once ...\n");
    config::Case input = config::Case::from_file(BAGNOLD_CASES "/chute.toml");
    app::DemInput chute = app::build_dem(app::read_dem(input));
    advance(chute.state, chute.laws, 2'000'000);
    write(file, grains_of(chute.state));
  }
  return read(file);
}

}  // namespace bagnold::bench
