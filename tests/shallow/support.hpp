// Small helpers of the shallow-layer tests: set-ups in one line, error norms, observed orders.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "shallow/solver.hpp"

namespace shallow_test {
using namespace bagnold;
using namespace bagnold::shallow;

inline double rad(double deg) { return deg * std::numbers::pi / 180; }
inline double tan_d(double deg) { return std::tan(rad(deg)); }

inline closure::ClosureSet coulomb(double delta_deg, double alpha = 1, double K = 1) {
  closure::ClosureSet set;
  set.friction = laws::Coulomb{delta_deg};
  set.density = laws::ConstantDensity{1};
  set.stress_ratio = laws::ConstantStressRatio{K};
  set.shape_factor = laws::ConstantShapeFactor{alpha};
  return set;
}

// n cells on [x0, x1], gravity 1 on a plane inclined by theta.
inline Definition line(int n, double x0, double x1, double theta_deg, closure::ClosureSet set) {
  Definition s;
  s.grid = {.nx = n, .ny = 1, .x0 = x0, .dx = (x1 - x0) / n, .dy = 1};
  s.gravity = {.normal = std::cos(rad(theta_deg)), .slope_x = std::tan(rad(theta_deg)), .g = 1};
  s.closure = std::move(set);
  return s;
}
inline Definition square(int n, double half, double theta_deg, closure::ClosureSet set, double direction_deg = 0) {
  Definition s = line(n, -half, half, theta_deg, std::move(set));
  s.grid.ny = n;
  s.grid.y0 = -half;
  s.grid.dy = s.grid.dx;
  s.gravity.slope_y = s.gravity.slope_x * std::sin(rad(direction_deg));
  s.gravity.slope_x *= std::cos(rad(direction_deg));
  return s;
}

struct Profile {
  std::vector<double> x, h, u;
};

struct Flow {
  Solver solver;
  State state;
  explicit Flow(Definition s) : solver(make_solver(std::move(s))), state(empty_state(solver)) {}
  // h and u as functions of (x, y), by the mean over the cell of h (Gauss, two points a direction) and the u of its centre
  void fill(const std::function<double(double, double)>& h, const std::function<double(double, double)>& u = {},
            const std::function<double(double, double)>& v = {}) {
    const Grid& g = solver.setup.grid;
    const double q = 0.5 / std::sqrt(3.0);
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const double x = g.x(i), y = g.y(j), dx = q * g.dx, dy = g.two_d() ? q * g.dy : 0;
        const double mean = 0.25 * ((h(x - dx, y - dy) + h(x + dx, y + dy)) + (h(x + dx, y - dy) + h(x - dx, y + dy)));
        set_cell(solver, state, i, j, mean, u ? u(x, y) : 0, v ? v(x, y) : 0);
      }
    refresh(solver, state);
  }
  void to(double t) { advance(solver, state, t); }
  // Ends at t exactly, for comparing with exact solutions.
  void exactly(double t) { advance(solver, state, t, t); }
  Profile profile(int j = 0) const {
    Profile p;
    std::vector<double> v;
    view_row(solver, state, j, p.h, p.u, v);
    for (int i = 0; i < solver.setup.grid.nx; ++i) p.x.push_back(solver.setup.grid.x(i));
    return p;
  }
};

inline std::vector<double> padded_bed(const Grid& g, const std::function<double(double, double)>& b) {
  std::vector<double> bed(static_cast<std::size_t>(g.padded()), 0.0);
  for (int j = -halo; j < g.ny + halo; ++j)
    for (int i = -halo; i < g.nx + halo; ++i) bed[g.at(i, j)] = b(g.x(i), g.y(j));
  return bed;
}

// L1 norm relative to the exact solution.
inline double relative_l1(const std::vector<double>& a, const std::vector<double>& exact) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error += std::abs(a[i] - exact[i]);
    size += std::abs(exact[i]);
  }
  return error / size;
}
inline double order(double coarse, double fine, double ratio = 2) { return std::log(coarse / fine) / std::log(ratio); }

// One line of the verification table (validation/shallow/): printed when BAGNOLD_TABLE names a file.
inline void tabulate(const std::string& problem, const std::string& quantity, double value,
                     const std::string& criterion) {
  EXPECT_EQ((problem + quantity + criterion).find(','), std::string::npos) << "a comma ends a column";
  if (const char* name = std::getenv("BAGNOLD_TABLE"))
    if (std::FILE* f = std::fopen(name, "a")) {
      std::fprintf(f, "%s,%s,%.4g,%s\n", problem.c_str(), quantity.c_str(), value, criterion.c_str());
      std::fclose(f);
    }
}

// The bed of problem 14 under a steady flow of given thickness and mass flux, with every closure on.
struct CarriedByItsBed {
  PreparedClosure p;
  std::function<double(double)> h_of;
  double M, T, gc;               // mass flux, tan(theta), g cos(theta)
  double u_of(double h) const {  // rho(h, u) h u = M
    double lo = 0, hi = 20;
    for (int k = 0; k < 100; ++k) {
      const double u = 0.5 * (lo + hi);
      (closure_at(p, h, u).rho * h * u < M ? lo : hi) = u;
    }
    return 0.5 * (lo + hi);
  }
  double momentum_flux(double x) const {
    const double h = h_of(x), u = u_of(h);
    const CellClosure c = closure_at(p, h, u);
    return c.alpha * M * u + 0.5 * c.K * gc * c.rho * h * h;
  }
  double bed_slope(double x) const {
    const double h = h_of(x), e = 1e-3;
    const CellClosure c = closure_at(p, h, u_of(h));
    return T - c.mu - (momentum_flux(x + e) - momentum_flux(x - e)) / (2 * e) / (gc * c.rho * h);
  }
};

}  // namespace shallow_test
