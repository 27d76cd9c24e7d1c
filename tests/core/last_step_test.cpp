#include "core/last_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bagnold {
namespace {

// Ends of every size and place against steps of every size: met to the bit, no step above the limit, none below half of it.
TEST(LastStep, MeetsTheEndExactlyWithoutASliver) {
  for (int k = 0; k < 2000; ++k) {
    const double limit = std::pow(10.0, -3 + k % 7) * (1 + 0.37 * (k % 11)), begin = k % 3 == 0 ? 1e3 * k : 0,
                 end = begin + limit * (0.01 + 0.0173 * k);
    double time = begin, least = limit, most = 0;
    int steps = 0;
    for (; time < end; ++steps) {
      const StepLength step = step_towards(end, time, limit);
      ASSERT_EQ(step.shortened, step.dt < limit);
      least = std::min(least, step.dt);
      most = std::max(most, step.dt);
      time = step.last ? end : time + step.dt;
      ASSERT_LT(steps, 10000);
    }
    EXPECT_EQ(time, end);
    EXPECT_LE(most, limit);
    if (end - begin > limit) {
      EXPECT_GE(least, 0.5 * limit * (1 - 1e-9)) << k;
      EXPECT_LE(steps, std::ceil((end - begin) / limit) + 1);
    }
  }
}

TEST(LastStep, LeavesAStepAloneThatNoEndIsNearTo) {
  const double never = std::numeric_limits<double>::infinity();
  for (const double end : {never, 2.0, 5.0}) {
    const StepLength step = step_towards(end, 0, 1);
    EXPECT_EQ(step.dt, 1);
    EXPECT_FALSE(step.shortened);
    EXPECT_FALSE(step.last);
  }
  EXPECT_EQ(step_towards(3, 4, 0.5).dt, 0.5);  // behind the end
  EXPECT_EQ(step_towards(never, 4, 1e300).dt, 1e300);
}

}  // namespace
}  // namespace bagnold
