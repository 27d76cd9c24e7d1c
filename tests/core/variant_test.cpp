// Which SIMD variant runs: the best one of this machine, the one asked for, and never one that it cannot execute.
#include "core/variant.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.hpp"

namespace bagnold {
namespace {

struct Environment {
  explicit Environment(const char* value) { setenv("BAGNOLD_SIMD", value, 1); }
  ~Environment() { unsetenv("BAGNOLD_SIMD"); }
};

TEST(VariantInUse, IsExecutable) { EXPECT_TRUE(executable(variant())); }

TEST(VariantInUse, EveryProcessorExecutesTheFirstThatWasBuilt) { EXPECT_TRUE(executable(built_variants().front())); }

TEST(VariantInUse, FollowsTheEnvironment) {
  const Variant before = variant();
  for (const Variant v : built_variants()) {
    const Environment wanted(std::string(name(v)).c_str());
    if (executable(v)) {
      use_variant_of_environment();
      EXPECT_EQ(variant(), v);
    } else {
      EXPECT_THROW(use_variant_of_environment(), InputError);
    }
  }
  use_variant(before);
}

TEST(VariantInUse, AnUnknownNameIsAnErrorThatListsTheKnown) {
  const Environment wanted("avx1024");
  try {
    use_variant_of_environment();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("avx512"), std::string::npos) << error.what();
  }
}

TEST(VariantInUse, AnotherForAWhile) {
  const Variant before = variant();
  {
    const WithVariant other(built_variants().front());
    EXPECT_EQ(variant(), built_variants().front());
  }
  EXPECT_EQ(variant(), before);
}

}  // namespace
}  // namespace bagnold
