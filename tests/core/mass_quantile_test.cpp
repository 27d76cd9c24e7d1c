#include <gtest/gtest.h>

#include "core/mass_quantile.hpp"

namespace bagnold {
namespace {

TEST(MassQuantiles, AreWhereTheShareIsReached) {
  const MassQuantiles q({{3, 1}, {1, 2}, {2, 1}});
  EXPECT_EQ(q.at(0), 1);
  EXPECT_EQ(q.at(0.5), 1);  // of mass 4, two lie at 1
  EXPECT_EQ(q.at(0.51), 2);
  EXPECT_EQ(q.at(0.75), 2);
  EXPECT_EQ(q.at(0.76), 3);
  EXPECT_EQ(q.at(1), 3);
}

}  // namespace
}  // namespace bagnold
