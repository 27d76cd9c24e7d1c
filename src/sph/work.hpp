// Everything derived from the state in the course of a step. Never part of a checkpoint.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sph/model.hpp"
#include "sph/pairs.hpp"
#include "sph/records.hpp"
#include "sph/state.hpp"

namespace bagnold::sph {

struct Work {
  Pairs pairs;
  // Per particle. `volume` m/rho weighs energies, `area` (= volume but for axisymmetric flow: m/(2 pi r rho)) weighs
  // gradients. Tensors have dim x dim numbers a particle, row by row.
  std::vector<double> volume, area;
  std::vector<double> density_rate;         // D rho/Dt
  std::vector<double> shear_rate;           // sqrt(2 e:e), 1/s
  std::vector<double> lode;                 // cos(3 theta) of the strain rate, where the law asks for it
  std::vector<double> pressure, viscosity;  // Pa, Pa s
  std::vector<double> bulk;                 // bulk viscosity, Pa s
  std::vector<double> coverage;             // smallest eigenvalue of M: 1 inside, 0.5 at a free surface, 0 alone
  std::vector<double> concentration;        // sum A_j W, 1 inside
  std::vector<double> moment;               // M
  std::vector<double> correction;           // B
  std::vector<double> gradient;             // L
  Field imbalance;                          // sum A_j f r, points where neighbours are missing
  Field acceleration;                       // gravity and pressure (and viscosity for the minatti2015 step)
  Field force;                              // scratch: viscous force
  // Per pair, as long as positions do not change: separation, f = -W'/r, k/r^2 of the residual viscosity.
  std::array<std::vector<Pack>, 3> r;
  std::vector<Pack> f, k;
  std::vector<double> wall;  // resistance of the ghosts below a particle, upper triangle (minatti2015 operator)
  Records<8> slim, slim2;
  Records<16> wide, wide2;
  std::int64_t applications = 0;  // of the viscous operator, in this process
  // Of the last implicit solve.
  Field cg_r, cg_z, cg_p, cg_q;
  std::vector<double> preconditioner;
  void resize(std::int64_t n, int dim);
};

// Signed record of an image: `from` and `to` are records of parent and image.
template <class Records, class F>
void fill_images(const Pairs& pairs, std::int64_t n, Records& records, F&& f) {
  for (std::int64_t k = 0; k < pairs.images.size(); ++k) {
    const auto image = static_cast<std::size_t>(k);
    f(image, records.at(pairs.images.parent[image]), records.at(n + k));
  }
}

}  // namespace bagnold::sph
