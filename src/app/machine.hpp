// What the program knows of the machine it runs on: written into records, never into results.
#pragma once
#include <string_view>

namespace bagnold::app {

// The instructions that the hot loops use: "avx512", "avx2" or "baseline". Two variants may differ in the last bits.
std::string_view simd_variant();

double cpu_seconds();  // that all threads of this process have taken so far

}  // namespace bagnold::app
