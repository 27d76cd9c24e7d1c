// Problems 10, 12, 13, 14: oblique jump, roll waves, contraction, the inverse steady state.
#include <gtest/gtest.h>

#include <complex>

#include "shallow/support.hpp"

using namespace shallow_test;

// 10. A wall that turns the stream by 15 degrees: here the stream meets the straight bottom wall at that angle.
TEST(Problem10, ObliqueJump) {
  struct Case {
    double alpha, K, beta_deg;
  };
  for (const Case& c : {Case{1, 1, 28.59997}, Case{1.2, 1.03, 27.41878}}) {
    const double F1 = 4, turn = rad(15);
    const double sb = std::sin(rad(c.beta_deg)), r = 0.5 * (-1 + std::sqrt(1 + 8 * c.alpha * F1 * F1 * sb * sb / c.K));
    EXPECT_NEAR(std::tan(rad(c.beta_deg) - turn), std::tan(rad(c.beta_deg)) / r, 1e-6);
    Definition s = square(80, 0.5, 0, coulomb(0, c.alpha, c.K));
    s.grid.x0 = s.grid.y0 = 0;
    s.boundary[2].kind = BoundaryKind::wall;
    Flow run(s);
    run.fill([](double, double) { return 1; }, [&](double, double) { return F1 * std::cos(turn); },
             [&](double, double) { return -F1 * std::sin(turn); });
    const Solver& solver = run.solver;
    // the undisturbed stream enters on the left and at the top: hold those cells
    for (double t = 0; t < 1.0; t = run.state.time) {
      advance_one_step(run.solver, run.state);
      for (int k = 0; k < 80; ++k)
        for (int m = 0; m < 2; ++m) {
          if (k >= 0) set_cell(solver, run.state, m, k, 1, F1 * std::cos(turn), -F1 * std::sin(turn));
          set_cell(solver, run.state, k, 79 - m, 1, F1 * std::cos(turn), -F1 * std::sin(turn));
        }
    }
    // thickness behind the jump, and the angle of the jump to the wall, beta - turn, between two columns
    const auto position = [&](int i) {
      double y = 0;
      for (int j = 0; j < 80; ++j) y += (view_cell(solver, run.state, i, j).h - 1) / (r - 1) * solver.setup.grid.dy;
      return y;
    };
    EXPECT_NEAR(view_cell(solver, run.state, 60, 3).h / r, 1, 0.03) << c.alpha;
    const double angle = std::atan((position(70) - position(35)) / (35 * solver.setup.grid.dx));
    EXPECT_NEAR(angle * 180 / std::numbers::pi, c.beta_deg - 15, 0.6) << c.alpha;
    tabulate("10 oblique jump", "angle - exact (deg)", angle * 180 / std::numbers::pi - (c.beta_deg - 15), "< 0.6");
  }
}

namespace {

// Growth rate of a small sine of wavenumber k on uniform flow: linear theory of eq. 34 with constant alpha, K.
double theory(const laws::PouliquenForterre& law, double theta, double h, double alpha, double k) {
  const double gc = std::cos(rad(theta)), F = law.beta * h / laws::stopping_height(law, theta) - law.gamma,
               u = F * std::sqrt(gc * h);
  const auto p = law.prepared(1);
  const auto force = [&](double hh, double m) {  // h gc (T - mu) as a function of h and m = h u
    return hh * gc * (tan_d(theta) - p.mu(hh, m / hh / std::sqrt(gc * hh)));
  };
  const double e = 1e-6, m = h * u, Sh = (force(h + e, m) - force(h - e, m)) / (2 * e),
               Sm = (force(h, m + e) - force(h, m - e)) / (2 * e);
  using C = std::complex<double>;
  const C ik(0, k);
  // s h' = -ik m', s m' = -ik (A h' + B m') + Sh h' + Sm m'
  const double A = -alpha * u * u + gc * h, B = 2 * alpha * u;
  const C b = ik * B - Sm;
  const C s1 = 0.5 * (-b + std::sqrt(b * b + 4.0 * (-ik) * (-(ik * A) + Sh))),
          s2 = 0.5 * (-b - std::sqrt(b * b + 4.0 * (-ik) * (-(ik * A) + Sh)));
  return std::max(s1.real(), s2.real());
}

double measured(const laws::PouliquenForterre& law, double theta, double h, double alpha, double wavelength,
                double time) {
  const double gc = std::cos(rad(theta)), F = law.beta * h / laws::stopping_height(law, theta) - law.gamma,
               u = F * std::sqrt(gc * h);
  closure::ClosureSet set = coulomb(0, alpha);
  set.friction = law;
  Definition s = line(200, 0, wavelength, theta, set);
  s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
  Flow run(s);
  const double k = 2 * std::numbers::pi / wavelength;
  run.fill([&](double x, double) { return h * (1 + 1e-4 * std::sin(k * x)); }, [&](double, double) { return u; });
  const auto amplitude = [&] {
    const Profile p = run.profile();
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < p.x.size(); ++i) sum += p.h[i] * std::exp(std::complex<double>(0, -k * p.x[i]));
    return std::abs(sum);
  };
  run.to(0.5 * time);  // let the decaying mode go
  const double a1 = amplitude(), t1 = run.state.time;
  run.to(time);
  return std::log(amplitude() / a1) / (run.state.time - t1);
}

}  // namespace

// 12. Growth of roll waves on both sides of (25/4 - 4 alpha) F^2 + (5 - 2 alpha) gamma F + gamma^2 - K = 0.
TEST(Problem12, RollWavesGrowAndDecayAsTheyShould) {
  const laws::PouliquenForterre law;
  for (double alpha : {1.0, 1.25})
    for (double theta : {24.0, 28.0}) {
      const double h = 12, F = law.beta * h / laws::stopping_height(law, theta) - law.gamma;
      const double threshold =
          (25.0 / 4 - 4 * alpha) * F * F + (5 - 2 * alpha) * law.gamma * F + law.gamma * law.gamma - 1;
      const double wavelength = 300, expected = theory(law, theta, h, alpha, 2 * std::numbers::pi / wavelength);
      EXPECT_EQ(expected > 0, threshold > 0) << alpha << ' ' << theta;
      const double rate = measured(law, theta, h, alpha, wavelength, 400);
      EXPECT_NEAR(rate, expected, 0.03 * std::abs(expected) + 2e-5) << alpha << ' ' << theta;
      tabulate("12 roll waves", "growth rate / theory", rate / expected, "1 +- 0.03");
    }
}

// 13. Inviscid choking of a stream by a contraction, alpha = K = 1: Wc/W0 = F0 (3/(2 + F0^2))^(3/2).
TEST(Problem13, ContractionChokes) {
  const double F0 = 2.5, critical = F0 * std::pow(3 / (2 + F0 * F0), 1.5);
  for (double ratio : {critical + 0.05, critical - 0.08}) {
    Definition s = line(400, -20, 20, 0, coulomb(0));
    s.boundary[0] = {BoundaryKind::inflow, {{0}, {1}, {F0}}};
    for (int f = 0; f <= 400; ++f) {
      const double x = std::min(1.0, std::max(0.0, (-20 + f * 0.1) / 10));
      s.width.push_back(1 - (1 - ratio) * x * x * (3 - 2 * x));
    }
    Flow run(s);
    run.fill([](double, double) { return 1; }, [&](double, double) { return F0; });
    run.to(60);
    const Profile p = run.profile();
    const double upstream = p.h[195];  // just before the contraction
    if (ratio > critical)
      EXPECT_NEAR(upstream, 1, 1e-6);
    else
      EXPECT_GT(upstream, 1.5);
    if (ratio > critical) {  // energy and mass give the thickness in the throat
      double lo = 1, hi = std::pow(F0, 2.0 / 3) / std::pow(ratio, 2.0 / 3);
      const double E = 0.5 * F0 * F0 + 1;
      for (int k = 0; k < 100; ++k) {
        const double h = 0.5 * (lo + hi), u = F0 / (ratio * h);
        (0.5 * u * u + h > E ? lo : hi) = h;
      }
      EXPECT_NEAR(p.h[390] / lo, 1, 2e-3);
      tabulate("13 contraction", "throat thickness / exact", p.h[390] / lo, "1 +- 2e-3");
    }
  }
}

namespace {

// 14. Steady state with every closure on: choose h(x) and M, solve rho(h, u) h u = M, and let the bed carry it.
double inverse_error(int n, double theta, double h0, double u0) {
  auto set = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  set.static_branch = {};
  const double length = 400, gc = std::cos(rad(theta)), T = tan_d(theta);
  Definition s = line(n, 0, length, theta, set);
  const PreparedClosure p = prepare(s);
  const auto h_of = [&](double x) { return h0 * (1 + 0.08 * std::sin(2 * std::numbers::pi * x / length)); };
  const CarriedByItsBed flow{p, h_of, closure_at(p, h0, u0).rho * h0 * u0, T, gc};
  const int fine = 40 * n;  // Simpson-like midpoint sums of b_x
  std::vector<double> b(static_cast<std::size_t>(fine) + 1, 0.0);
  for (int k = 0; k < fine; ++k)
    b[static_cast<std::size_t>(k) + 1] =
        b[static_cast<std::size_t>(k)] + flow.bed_slope((k + 0.5) * length / fine) * length / fine;
  const double drop = b.back();
  s.bed = padded_bed(s.grid, [&](double x, double) {
    const double turns = std::floor(x / length), at = (x / length - turns) * fine;
    const auto k = static_cast<std::size_t>(at);
    return b[k] + (at - static_cast<double>(k)) * (b[std::min(k + 1, static_cast<std::size_t>(fine))] - b[k]) +
           turns * drop;
  });
  // periodic: the mean bed slope is given to the plane instead
  for (int i = -halo; i < n + halo; ++i)
    for (int j = -halo; j < 1 + halo; ++j) s.bed[s.grid.at(i, j)] -= drop * s.grid.x(i) / length;
  s.gravity.slope_x -= drop / length;
  s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
  Flow run(s);
  run.fill([&](double x, double) { return h_of(x); }, [&](double x, double) { return flow.u_of(h_of(x)); });
  run.to(150);
  const Profile q = run.profile();
  std::vector<double> exact;
  for (double x : q.x) exact.push_back(h_of(x));
  return relative_l1(q.h, exact);
}

}  // namespace

TEST(Problem14, InverseSteadyStateWithEveryClosure) {
  struct Case {
    const char* name;
    double theta, h, u;
  };
  for (const Case& c : {Case{"subcritical", 24, 10, 1.0}, Case{"supercritical", 28, 8, 4.0}}) {
    const double e1 = inverse_error(50, c.theta, c.h, c.u), e2 = inverse_error(100, c.theta, c.h, c.u);
    tabulate(std::string("14 inverse ") + c.name, "L1(h) at 100 cells", e2, "< 2e-3");
    tabulate(std::string("14 inverse ") + c.name, "order", order(e1, e2), ">= 1.9");
    EXPECT_LT(e2, 2e-3) << c.name;
    EXPECT_GE(order(e1, e2), 1.9) << c.name << ' ' << e1 << ' ' << e2;
  }
}
