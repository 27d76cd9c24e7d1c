#include "core/variant.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>

#include "core/error.hpp"

extern "C" {
// An entry of cmake/merge_variants.sh; the linker knows where they begin and end, if there are any.
struct BagnoldVariantEntry {
  void* in_use;
  void* of[3];
};
extern BagnoldVariantEntry __start_bagnold_variants[] __attribute__((weak, visibility("hidden")));
extern BagnoldVariantEntry __stop_bagnold_variants[] __attribute__((weak, visibility("hidden")));
}

namespace bagnold {

namespace {

constexpr std::array built = {BAGNOLD_VARIANTS_BUILT};
constexpr std::array<std::string_view, 3> names = {"baseline", "avx2", "avx512"};

bool has_instructions(Variant variant) {
#if defined(__x86_64__)
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                  __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd");
  return variant == Variant::baseline || (variant == Variant::avx2 ? v3 : v4);
#else
  return variant == Variant::baseline;
#endif
}

Variant in_use = built[0];

void choose(Variant variant) {
  in_use = variant;
  for (BagnoldVariantEntry* entry = __start_bagnold_variants; entry != __stop_bagnold_variants; ++entry)
    entry->in_use = entry->of[static_cast<std::size_t>(variant)];
}

// Before main, so that tests, benchmarks and programs that use the engines as a library run at full speed; what the
// environment says wrong is reported by use_variant_of_environment().
[[maybe_unused]] const bool chosen = [] {
  for (const Variant variant : built)
    if (has_instructions(variant)) choose(variant);
  if (const char* wanted = std::getenv("BAGNOLD_SIMD"))
    for (const Variant variant : built)
      if (name(variant) == wanted && has_instructions(variant)) choose(variant);
  return true;
}();

}  // namespace

std::string_view name(Variant variant) { return names[static_cast<std::size_t>(variant)]; }
std::span<const Variant> built_variants() { return built; }

bool executable(Variant variant) {
  for (const Variant v : built)
    if (v == variant) return has_instructions(v);
  return false;
}

Variant variant() { return in_use; }

void use_variant(Variant variant) {
  if (!executable(variant)) {
    std::string known;
    for (const Variant v : built)
      if (executable(v)) known += fmt::format("{}{}", known.empty() ? "" : ", ", name(v));
    throw InputError(fmt::format("BAGNOLD_SIMD: error: this processor or build cannot execute {}, expected one of {}",
                                 name(variant), known));
  }
  choose(variant);
}

void use_variant_of_environment() {
  const char* wanted = std::getenv("BAGNOLD_SIMD");
  if (wanted == nullptr || *wanted == 0) return;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == wanted) return use_variant(static_cast<Variant>(k));
  throw InputError(fmt::format("BAGNOLD_SIMD: error: \"{}\" is no variant, expected baseline, avx2 or avx512", wanted));
}

}  // namespace bagnold
