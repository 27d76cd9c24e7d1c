// Steps with the energy ledger kept.
#include "dem/fast/pass.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

void forces_with_ledger(Engine& engine) {
  with_kernel(engine, [&]<class K>(const auto& tables) { all_forces<K, true>(engine, tables); });
}

void pass_with_ledger(Engine& engine, int from, int to, const Watch* watch) {
  with_kernel(engine, [&]<class K>(const auto& tables) { pass<K, true>(engine, tables, from, to, watch); });
}

}  // namespace bagnold::dem::fast
