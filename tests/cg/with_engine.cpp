// Coarse-graining of a running engine: the balance of momentum in time, and that looking changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cg/from_dem.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "dem/algorithm.hpp"
#include "dem/fast/engine.hpp"

using namespace bagnold;

namespace {

// Grains that slide, collide and hit the grains of a base, periodic in x and y.
dem::DemState small_chute(double dt, int copies = 1, bool alike = false) {
  dem::DemState s;
  s.box = {.origin = {0, 0, 0}, .length = {4.0 * copies, 4, 1}, .periodic = {true, true, false}};
  s.gravity = {0.4, 0, -0.9};
  s.dt = dt;
  const auto add = [&](const Vec3& x, const Vec3& v, double d) {
    dem::Grains& g = s.grains;
    g.x.push_back(x);
    g.v.push_back(v);
    g.omega.push_back({});
    g.diameter.push_back(d);
    g.mass.push_back(d * d * d);
    g.inertia.push_back(0.1 * d * d * d * d * d);
    g.species.push_back(0);
    g.id.push_back(static_cast<std::int64_t>(g.id.size()));
  };
  std::uint64_t item = 0;
  const auto u = [&](std::uint32_t k) { return 2 * random::uniform(3, random::Stream::test, item, k) - 1; };
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4 * copies; ++i, ++item)
        add({i + 0.5 + 0.01 * u(0), j + 0.5 + 0.01 * u(1), k + 0.45 + 0.01 * u(2)}, {1 + u(3), u(4), u(5)},
            alike ? 0.97 : 0.98 + 0.015 * u(6));
  s.grains.flowing = static_cast<std::int64_t>(item);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4 * copies; ++i, ++item)
      add({i + 0.4 + 0.1 * u(0), j + 0.6 + 0.1 * u(1), -0.45 + 0.1 * u(2)}, {}, 1);
  return s;
}

dem::ContactLaws soft_laws() {
  laws::Linear normal;
  normal.stiffness = 2000;
  normal.damping = 2;
  laws::LinearHistory tangential;
  tangential.friction = 0.5;
  return dem::compile(dem::uniform_model({"grain"}, {normal, tangential, laws::NoRollingResistance{}}), 0.5);
}

cg::ProfileSums sums_of(const dem::DemState& s, const dem::ContactLaws& laws) {
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.4};
  auto moments = cg::make_moments(kernel, cg::make_lattice(kernel, 0.25), s.box);
  cg::DemScratch scratch;
  cg::ProfileScratch profile_scratch;
  cg::add_snapshot(moments, cg::snapshot_of(s, laws, scratch), profile_scratch);
  return cg::evaluate(moments, -12, 50);
}

void expect_same(const cg::ProfileMoments& a, const cg::ProfileMoments& b, double tolerance) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.contacts, b.contacts);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.base_force[k], b.base_force[k], tolerance * norm(b.base_force));
  const auto one = cg::evaluate(a, -12, 50), other = cg::evaluate(b, -12, 50);
  for (std::size_t c = 0; c < cg::kChannels; ++c) {
    double peak = 0, worst = 0;
    for (std::size_t n = 0; n < one.value.size(); ++n) {
      peak = std::max(peak, std::abs(other.value[n][c]));
      worst = std::max(worst, std::abs(one.value[n][c] - other.value[n][c]));
    }
    EXPECT_GT(peak, 0) << "channel " << c;
    EXPECT_LE(worst, tolerance * peak) << "channel " << c;
  }
}

TEST(ProfileOfARunningEngine, IsThatOfItsSnapshotsSampleAfterSample) {
  const auto laws = soft_laws();
  dem::DemState s = small_chute(2e-3);
  s.walls = {{{0, 0, -0.6}, {0, 0, 1}, 0}};
  dem::prepare(s, laws);
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.4};
  auto direct = cg::make_moments(kernel, cg::make_lattice(kernel, 0.25), s.box), plain = direct;
  cg::ProfileScratch kept;
  for (int sample = 0; sample < 4; ++sample) {
    cg::DemScratch memory;
    cg::ProfileScratch fresh;
    cg::add_state(direct, s, laws, kept);
    cg::add_snapshot(plain, cg::snapshot_of(s, laws, memory), fresh);
    dem::advance(s, laws, 50);
  }
  EXPECT_GT(direct.contacts, 100);
  expect_same(direct, plain, 1e-13);
}

// Grains of several sizes and grains that are alike, contacts with the base and with a plane, level contacts, more than one
// slab and an odd number of them.
TEST(ProfileFromInsideTheFastEngine, IsThatOfItsSnapshotsWhateverTheThreads) {
  const auto laws = soft_laws();
  const int threads_before = threads();
  for (const auto& [copies, alike, plane] :
       {std::tuple{1, false, false}, {9, false, true}, {1, true, true}, {9, true, false}}) {
    std::vector<double> bits;
    for (const int count : {1, 2, 3}) {
      force_threads(count);
      dem::DemState s = small_chute(2e-3, copies, alike);
      if (plane) s.walls = {{{0, 0, -0.03}, {0, 0, 1}, 0}};
      dem::DemState twin = s;
      dem::prepare(s, laws);
      dem::prepare(twin, laws);
      const laws::CgKernels::Any kernel = laws::CgGaussian{0.4};
      auto inside = cg::make_moments(kernel, cg::make_lattice(kernel, 0.25), s.box), outside = inside;
      cg::ProfileScratch scratch, other;
      dem::Watch watch{.first = 50, .last = 200, .every = 50};
      watch.fast_before = [&](const dem::fast::Engine& engine) { cg::begin_rows(engine, scratch); };
      watch.fast_contacts = [&](const dem::fast::Engine&, std::size_t section, dem::fast::ContactPacks contacts) {
        cg::add_section(inside, section, contacts, scratch);
      };
      watch.fast = [&](const dem::fast::Engine& engine) {
        EXPECT_EQ(engine.alike, alike);
        cg::add_rows(inside, engine, scratch);
      };
      dem::advance(s, laws, 230, watch);
      int at_walls = 0;
      for (int sample = 0; sample < 4; ++sample) {
        dem::advance(twin, laws, 50);
        cg::DemScratch memory;
        cg::add_snapshot(outside, cg::snapshot_of(twin, laws, memory), other);
        for (const dem::Contact& c : memory.contacts) at_walls += c.j < 0 ? 1 : 0;
      }
      EXPECT_GT(inside.contacts, 100 * copies);
      EXPECT_EQ(plane, at_walls > 0);
      expect_same(inside, outside, 1e-12);
      if (count == 1) bits = inside.flow.data;
      EXPECT_TRUE(inside.flow.data == bits) << count << " threads";
    }
  }
  set_threads(threads_before);
}

TEST(ProfileFromInsideTheFastEngine, HasTheSameBitsAfterInterruptionsAndResumption) {
  const auto laws = soft_laws();
  dem::DemState whole = small_chute(2e-3, 2), cut = whole;
  dem::prepare(whole, laws);
  dem::prepare(cut, laws);
  const cg::StreamingOptions options{.kernel = laws::CgGaussian{0.4}, .first_step = 10, .last_step = 300, .every = 7};
  cg::ProfileObserver one(options, whole.box), other(options, cut.box);
  dem::advance(whole, laws, 320, one.watch(laws));
  for (const int steps : {3, 58, 101, 158}) {
    dem::advance(cut, laws, steps, other.watch(laws));
    cut = dem::DemState(cut);  // a copy carries the state and nothing else
  }
  const auto a = one.state(), b = other.state();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    if (const auto* numbers = std::get_if<std::vector<double>*>(&a[k].array)) {
      EXPECT_EQ(**numbers, *std::get<std::vector<double>*>(b[k].array)) << a[k].name;
    }
}

// Largest deviation of (p(t + dt) - p(t - dt))/2dt from div sigma + rho g - d(Pi)/dz at t, over the largest term.
double momentum_error(double dt) {
  const auto laws = soft_laws();
  dem::DemState s = small_chute(dt);
  dem::prepare(s, laws);
  dem::advance(s, laws, static_cast<std::int64_t>(std::llround(0.5 / dt)) - 1);
  const auto before = sums_of(s, laws);
  dem::advance(s, laws, 1);
  const auto now = sums_of(s, laws);
  dem::advance(s, laws, 1);
  const auto after = sums_of(s, laws);
  double peak = 0, worst = 0;
  for (std::size_t n = 0; n < now.value.size(); ++n)
    for (std::size_t a = 0; a < 3; ++a) {
      const double rate = (after.value[n][cg::kMomentum + a] - before.value[n][cg::kMomentum + a]) / (2 * dt);
      const double balance = now.slope[n][cg::kContact + 3 * a + 2] + now.slope[n][cg::kBase + 3 * a + 2] -
                             now.slope[n][cg::kFlux + cg::symmetric(a, 2)] +
                             now.value[n][cg::kMass] * s.gravity[static_cast<int>(a)];
      peak = std::max(peak, std::abs(balance));
      worst = std::max(worst, std::abs(rate - balance));
    }
  return worst / peak;
}

}  // namespace

// dp/dt = div sigma + rho g - d(rho V V)/dz at every height, base included; the rest is the finite difference in time.
TEST(WithEngine, MomentumBalanceInTimeConverges) {
  const double coarse = momentum_error(4e-4), fine = momentum_error(1e-4);
  EXPECT_LT(fine, 5e-3);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST(WithEngine, MassBalanceInTime) {
  const auto laws = soft_laws();
  const double dt = 1e-4;
  dem::DemState s = small_chute(dt);
  dem::prepare(s, laws);
  dem::advance(s, laws, 3000);
  const auto before = sums_of(s, laws);
  dem::advance(s, laws, 1);
  const auto now = sums_of(s, laws);
  dem::advance(s, laws, 1);
  const auto after = sums_of(s, laws);
  double peak = 0, worst = 0;
  for (std::size_t n = 0; n < now.value.size(); ++n) {
    const double rate = (after.value[n][cg::kMass] - before.value[n][cg::kMass]) / (2 * dt);
    peak = std::max(peak, std::abs(now.slope[n][cg::kMomentum + 2]));
    worst = std::max(worst, std::abs(rate + now.slope[n][cg::kMomentum + 2]));
  }
  EXPECT_LT(worst, 1e-4 * peak);
}

TEST(WithEngine, LookingChangesNothing) {
  const auto laws = soft_laws();
  dem::DemState alone = small_chute(2e-4), watched = small_chute(2e-4);
  dem::prepare(alone, laws);
  dem::prepare(watched, laws);
  cg::ProfileObserver observer({.kernel = laws::CgGaussian{}, .first_step = 100, .last_step = 900, .every = 25},
                               watched.box);
  dem::advance(alone, laws, 1000);
  for (int k = 0; k < 200; ++k) dem::advance(watched, laws, 5, observer.watch(laws));
  EXPECT_EQ(observer.profile().samples(), 33);
  ASSERT_EQ(alone.grains.x.size(), watched.grains.x.size());
  for (std::size_t i = 0; i < alone.grains.x.size(); ++i) {
    EXPECT_EQ(alone.grains.x[i], watched.grains.x[i]);
    EXPECT_EQ(alone.grains.v[i], watched.grains.v[i]);
    EXPECT_EQ(alone.grains.omega[i], watched.grains.omega[i]);
  }
  EXPECT_EQ(alone.pairs.spring, watched.pairs.spring);
}
