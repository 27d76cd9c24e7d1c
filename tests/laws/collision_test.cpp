#include <gtest/gtest.h>

#include "laws/contact/collision.hpp"

namespace bagnold::laws {
namespace {

TEST(Collision, PaperConstantsGiveThePapersCollision) {
  const Collision c = collision_of({2e5, 25}, 0.5);
  EXPECT_NEAR(c.time, 0.005, 3e-5);
  EXPECT_NEAR(c.restitution, 0.8831, 5e-4);
}

TEST(Collision, InverseRecoversTheConstants) {
  for (const double m : {0.5, 1.0, 3e-7})
    for (const double eps : {1.0, 0.88, 0.1}) {
      const SpringDashpot s = spring_dashpot_of({0.003, eps}, m);
      const Collision c = collision_of(s, m);
      EXPECT_NEAR(c.time, 0.003, 1e-15);
      EXPECT_NEAR(c.restitution, eps, 1e-13);
    }
}

TEST(Collision, OverdampedPairDoesNotRebound) {
  const Collision c = collision_of({1, 1e3}, 1);
  EXPECT_EQ(c.restitution, 0);
  EXPECT_TRUE(std::isinf(c.time));
}

}  // namespace
}  // namespace bagnold::laws
