#include "sph/implicit.hpp"

#include <fmt/core.h>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "sph/forces.hpp"
#include "sph/small_tensor.hpp"
#include "sph/yield.hpp"

namespace bagnold::sph {
namespace {

// Replaces each stored block D by (m + dt D)^-1, upper triangle.
template <int D>
void invert_blocks(Work& w, const Particles& p, double dt) {
  parallel_for(p.size(), [&](std::int64_t k) {
    double* block = w.preconditioner.data() + k * (D * (D + 1) / 2);
    Matrix<D> m = from_upper<D>(block);
    for (double& c : m) c *= dt;
    for (int d = 0; d < D; ++d) m[d * D + d] += p.mass[static_cast<std::size_t>(k)];
    m = inverse(m);
    for (int a = 0, q = 0; a < D; ++a)
      for (int b = a; b < D; ++b, ++q) block[q] = m[a * D + b];
  });
}

// r.P^-1 r, and the squared size of what is left of the momentum balance, r.m^-1 r.
struct Products {
  double preconditioned = 0, balance = 0;
  Products& operator+=(const Products& other) {
    preconditioned += other.preconditioned, balance += other.balance;
    return *this;
  }
};

// z = P^-1 r
template <int D>
Products precondition(Work& w, const Particles& p, const Field& r, Field& z) {
  return parallel_sum<Products>(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const Matrix<D> m = from_upper<D>(w.preconditioner.data() + k * (D * (D + 1) / 2));
    Products product;
    for (std::size_t a = 0; a < D; ++a) {
      double sum = 0;
      for (std::size_t b = 0; b < D; ++b) sum += m[a * D + b] * r[b][i];
      z[a][i] = sum;
      product.preconditioned += sum * r[a][i];
      product.balance += r[a][i] * r[a][i] / p.mass[i];
    }
    return product;
  });
}

template <int D>
int solve(Work& w, State& state, const Model& model, double dt) {
  Particles& p = state.particles;
  const std::int64_t n = p.size();
  Field &v = w.cg_p, &q = w.cg_q, &r = w.cg_r, &z = w.cg_z, &x = p.v;
  const auto each = [&](auto&& f) {
    parallel_for(n, [&](std::int64_t k) {
      for (std::size_t d = 0; d < D; ++d) f(d, static_cast<std::size_t>(k));
    });
  };
  invert_blocks<D>(w, p, dt);
  // The unknown lives in p.v; v(n) is kept in `rate` until the end, the right-hand side in r.
  each([&](std::size_t d, std::size_t i) {
    const double old = p.v[d][i], guess = old + dt * p.rate[d][i];
    r[d][i] = p.mass[i] * (old + dt * w.acceleration[d][i] - guess);
    p.rate[d][i] = old;
    x[d][i] = guess;
  });
  viscous_force(w, p, model, x, q);
  each([&](std::size_t d, std::size_t i) { r[d][i] += dt * q[d][i]; });
  Products products = precondition<D>(w, p, r, z);
  each([&](std::size_t d, std::size_t i) { v[d][i] = z[d][i]; });
  const double mass = parallel_sum<double>(n, [&](std::int64_t i) { return p.mass[static_cast<std::size_t>(i)]; });
  const double g_dt = model.numerics.cg_tolerance * std::max(model.gravity_norm(), 1e-12) * dt,
               limit = mass * g_dt * g_dt;
  int iterations = 0;
  while (!(products.balance <= limit)) {  // also for NaN
    viscous_force(w, p, model, v, q);
    const double curvature = parallel_sum<double>(n, [&](std::int64_t k) {
      const auto i = static_cast<std::size_t>(k);
      double sum = 0;
      for (std::size_t d = 0; d < D; ++d) {
        q[d][i] = p.mass[i] * v[d][i] - dt * q[d][i];
        sum += v[d][i] * q[d][i];
      }
      return sum;
    });
    if (++iterations > model.numerics.cg_max_iterations || !(curvature > 0))
      throw NumericalError(
          fmt::format("sph: implicit viscosity: no convergence at t = {:g} s, step {}, after {} iterations "
                      "(residual {:g}, wanted {:g}, curvature {:g})",
                      state.time, state.step, iterations, std::sqrt(products.balance), std::sqrt(limit), curvature));
    const double alpha = products.preconditioned / curvature;
    each([&](std::size_t d, std::size_t i) {
      x[d][i] += alpha * v[d][i];
      r[d][i] -= alpha * q[d][i];
    });
    const double before = products.preconditioned;
    products = precondition<D>(w, p, r, z);
    const double beta = products.preconditioned / before;
    each([&](std::size_t d, std::size_t i) { v[d][i] = z[d][i] + beta * v[d][i]; });
  }
  each([&](std::size_t d, std::size_t i) { p.rate[d][i] = (x[d][i] - p.rate[d][i]) / dt; });
  return iterations;
}

}  // namespace

void viscous_force(Work& w, const Particles& p, const Model& model, const Field& v, Field& force) {
  ++w.applications;
  if (model.corrected())
    corrected_viscous_force(w, p, model, v, force);
  else
    pair_viscous_force(w, p, model, v, force);
}

void predict_viscosity(Work& w, const State& state, const Model& model, double dt) {
  const Particles& p = state.particles;
  Field& v = w.cg_z;
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) v[d][i] = p.v[d][i] + dt * p.rate[d][i];
  });
  lower_viscosity(w, p, model, v);
}

int solve_viscous(Work& w, State& state, const Model& model, double dt) {
  return model.dim == 2 ? solve<2>(w, state, model, dt) : solve<3>(w, state, model, dt);
}

}  // namespace bagnold::sph
