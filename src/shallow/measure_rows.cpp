// Measured closures of a row of cells, instantiated for every law. Nothing here knows of directions, so sums of products
// may be fused (see module.cmake).
#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

// h from rho(h, u) h = D by the secant method on rho h - D. |d ln rho/d ln h| < 0.2 for every closure in use, so that
// three steps after the first leave a relative error below 1e-11 (see the twin in tests/).
constexpr int density_iterations = 3;

struct Guess {
  Pack h, e, mu;  // thickness, rho h - D, friction
};

// Friction, density, stress ratio and shape factor of `n` cells that hold D > 0 and run at speeds s = F sqrt(h). The last
// step is so short that friction follows it along the secant.
template <class Law>
void measure(const PreparedClosure& p, int n, const double* D, const double* s, CellRow& row) {
  const typename Law::Prepared law = prepared_law<Law>(p).dynamic;
  const Polynomial rho_of_mu = p.rho_of_mu, K_of_mu = p.K_of_mu;
  const double inverse_rho = 1 / p.typical_rho;
  alignas(64) Row h_before, e_before, mu_before;
  const auto guess = [&](const Pack& h, int k) __attribute__((always_inline)) {
    const Pack mu = law.mu(h, Pack::load(s + k) * rsqrt(h));
    return Guess{h, rho_of_mu(mu) * h - Pack::load(D + k), mu};
  };
  const auto keep = [&](int k, const Guess& g) __attribute__((always_inline)) {
    g.h.store(h_before + k);
    g.e.store(e_before + k);
    g.mu.store(mu_before + k);
  };
  const auto part_of_last_step = [&](int k, const Guess& g) __attribute__((always_inline)) {
    const Pack change = g.e - Pack::load(e_before + k);
    return g.e * change / (change * change + 1e-200);  // 0 once converged
  };
  abreast(
      n, [&](int k) __attribute__((always_inline)) { return guess(Pack::load(D + k) * inverse_rho, k); },
      [&](int k, const Guess& g) __attribute__((always_inline)) {
        keep(k, g);
        (g.h - g.e * inverse_rho).store(row.h + k);
      });
  struct Step {
    Guess now;
    Pack next;
  };
  for (int iteration = 1; iteration < density_iterations; ++iteration)
    abreast(
        n,
        [&](int k) __attribute__((always_inline)) {
          const Guess g = guess(Pack::load(row.h + k), k);
          return Step{g, g.h - part_of_last_step(k, g) * (g.h - Pack::load(h_before + k))};
        },
        [&](int k, const Step& step) __attribute__((always_inline)) {
          keep(k, step.now);
          step.next.store(row.h + k);
        });
  abreast(
      n,
      [&](int k) __attribute__((always_inline)) {
        const Guess g = guess(Pack::load(row.h + k), k);
        const Pack part = part_of_last_step(k, g);
        return Guess{g.h - part * (g.h - Pack::load(h_before + k)), g.e,
                     g.mu - part * (g.mu - Pack::load(mu_before + k))};
      },
      [&](int k, const Guess& g) __attribute__((always_inline)) {
        g.h.store(row.h + k);
        g.mu.store(mu_before + k);
      });
  struct Closures {
    Pack rho, K, alpha;
  };
  abreast(
      n,
      [&](int k) __attribute__((always_inline)) {
        const Pack h = Pack::load(row.h + k), mu = Pack::load(mu_before + k);
        return Closures{Pack::load(D + k) / h, K_of_mu(mu),
                        p.alpha_varies
                            ? p.strain.prepared_factor(h, max(min(mu, p.mu_hi), p.mu_lo), p.strain_mu1, p.strain_mu2)
                            : Pack(p.alpha)};
      },
      [&](int k, const Closures& c) __attribute__((always_inline)) {
        c.rho.store(row.rho + k);
        c.K.store(row.K + k);
        c.alpha.store(row.alpha + k);
      });
}

}  // namespace

MeasureKernel choose_measure(const closure::ClosureSet& set) {
  return std::visit([](const auto& law) -> MeasureKernel { return measure<std::decay_t<decltype(law)>>; },
                    set.friction);
}

}  // namespace bagnold::shallow
