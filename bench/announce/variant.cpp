// Every benchmark says first which SIMD variant it measures (BAGNOLD_SIMD=baseline|avx2|avx512 for another).
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "core/variant.hpp"

namespace {

[[maybe_unused]] const bool announced = [] {
  try {
    bagnold::use_variant_of_environment();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    std::_Exit(2);
  }
  fmt::print("SIMD variant: {}\n", bagnold::name(bagnold::variant()));
  return true;
}();

}  // namespace
