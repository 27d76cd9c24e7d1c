// Which of the SIMD variants of the hot functions is in use (cmake/variants.cmake): the best one that this processor executes,
// or the one that the environment asks for (BAGNOLD_SIMD=baseline|avx2|avx512). Results of different variants may differ in
// the last bits; each is reproducible in itself, and baseline gives the same bits on every processor.
#pragma once
#include <span>
#include <string_view>

namespace bagnold {

enum class Variant { baseline, avx2, avx512 };

std::string_view name(Variant variant);
std::span<const Variant> built_variants();
bool executable(Variant variant);  // built, and this processor has the instructions

Variant variant();  // in use

// Not while hot functions run. Throws InputError for a variant that is not executable.
void use_variant(Variant variant);
// Follows BAGNOLD_SIMD. Throws InputError for a name that does not exist or a variant that is not executable here.
void use_variant_of_environment();

// Another variant for a while.
class WithVariant {
 public:
  explicit WithVariant(Variant wanted) : before_(variant()) { use_variant(wanted); }
  ~WithVariant() { use_variant(before_); }
  WithVariant(const WithVariant&) = delete;
  WithVariant& operator=(const WithVariant&) = delete;

 private:
  Variant before_;
};

}  // namespace bagnold
