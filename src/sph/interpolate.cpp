#include "sph/interpolate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "sph/constitutive.hpp"
#include "sph/dispatch.hpp"
#include "sph/images.hpp"

namespace bagnold::sph {
namespace {

constexpr double surface = 0.5;  // sum A_j W where half of the surroundings is empty

// Direction of the grid that direction d of the model is drawn along: (x, z) of two dimensions are 0 and 2.
std::size_t axis_of(const Model& model, std::size_t d) { return model.dim == 2 && d == 1 ? 2 : d; }

void place_grid(GridFields& g, const Particles& p, const Model& model, std::int64_t most_cells) {
  g.spacing = model.spacing;
  double total = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) {
    double low = 0, high = model.period[d];
    if (!(high > 0)) {
      const auto [least, most] = std::minmax_element(p.x[d].begin(), p.x[d].end());
      low = *least - model.spacing, high = *most + model.spacing;
      if ((model.floor && static_cast<int>(d) == model.vertical()) || (model.axisymmetric && d == 0)) low = 0;
    }
    const double first = std::floor(low / model.spacing + 1e-9),
                 count = std::max(1.0, std::ceil(high / model.spacing - 1e-9) - first);
    total *= count;
    if (!(total <= static_cast<double>(most_cells)))
      throw NumericalError(
          fmt::format("sph: interpolation needs more than {} cells: particles have flown apart", most_cells));
    const std::size_t axis = axis_of(model, d);
    g.origin[axis] = first * model.spacing;
    g.cells[axis] = static_cast<std::int64_t>(count);
  }
}

// Calls add(cell, W) for the cells whose middle is within 2h of x.
template <int D, class Kernel, class F>
void scatter(const GridFields& g, const Model& model, const PairShape<D, Kernel>& shape, const std::array<double, 3>& x,
             F&& add) {
  const double reach = 2 * model.h(), dp = g.spacing;
  std::array<std::int64_t, 3> first{0, 0, 0}, last{0, 0, 0};
  for (std::size_t d = 0; d < D; ++d) {
    const std::size_t axis = axis_of(model, d);
    const double at = (x[d] - g.origin[axis]) / dp - 0.5;
    first[axis] = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(at - reach / dp)));
    last[axis] = std::min(g.cells[axis] - 1, static_cast<std::int64_t>(std::floor(at + reach / dp)));
  }
  for (std::int64_t c = first[2]; c <= last[2]; ++c)
    for (std::int64_t b = first[1]; b <= last[1]; ++b)
      for (std::int64_t a = first[0]; a <= last[0]; ++a) {
        const std::array<std::int64_t, 3> cell{a, b, c};
        double r2 = 0;
        for (std::size_t d = 0; d < D; ++d) {
          const std::size_t axis = axis_of(model, d);
          const double r = x[d] - (g.origin[axis] + (static_cast<double>(cell[axis]) + 0.5) * dp);
          r2 += r * r;
        }
        const double w = shape.w(shape.ratio(r2 + shape.tiny));
        if (w > 0) add(static_cast<std::size_t>((c * g.cells[1] + b) * g.cells[0] + a), w);
      }
}

}  // namespace

GridFields interpolate(const State& state, const Work& work, const Model& model, std::int64_t most_cells) {
  const Particles& p = state.particles;
  GridFields g;
  place_grid(g, p, model, most_cells);
  const auto size = static_cast<std::size_t>(g.cells[0] * g.cells[1] * g.cells[2]), n = p.mass.size();
  std::vector<double> shear(size, 0.0);
  for (auto* f : {&g.filled, &g.pressure, &g.density, &g.viscosity, &g.inertial_number, &g.speed}) f->assign(size, 0.0);
  for (auto& f : g.velocity) f.assign(size, 0.0);

  Model walls = model;  // mirror images under the floor belong to the interpolation, whatever the forces use
  walls.viscous = laws::viscous::Variational{};
  const Images images = make_images(walls, p, 2 * model.h());
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    const PairShape<D, std::decay_t<decltype(kernel)>> shape(model.h());
    const auto spread = [&](std::size_t i, const std::array<double, 3>& x, const std::array<double, 3>& sign) {
      scatter<D>(g, model, shape, x, [&](std::size_t cell, double w) {
        const double weight = work.area[i] * w;
        g.filled[cell] += weight;
        g.pressure[cell] += weight * work.pressure[i];
        g.density[cell] += weight * p.rho[i];
        g.viscosity[cell] += weight * work.viscosity[i];
        shear[cell] += weight * work.shear_rate[i];
        for (std::size_t d = 0; d < D; ++d) g.velocity[d][cell] += weight * sign[d] * p.v[d][i];
      });
    };
    std::array<double, 3> x{};
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t d = 0; d < D; ++d) x[d] = p.x[d][i];
      spread(i, x, {1, 1, 1});
    }
    for (std::size_t k = 0; k < images.parent.size(); ++k) {
      const auto i = static_cast<std::size_t>(images.parent[k]);
      for (std::size_t d = 0; d < D; ++d) x[d] = images.R[k][d] * p.x[d][i] + images.shift[k][d];
      spread(i, x, images.S[k]);
    }
  });

  const double nan = std::numeric_limits<double>::quiet_NaN(), Kt = model.grains().compressibility;
  for (std::size_t c = 0; c < size; ++c) {
    const double scale = g.filled[c] < surface ? nan : 1 / g.filled[c];
    double v2 = 0;
    for (auto& f : g.velocity) f[c] *= scale, v2 += f[c] * f[c];
    for (auto* f : {&g.pressure, &g.density, &g.viscosity}) (*f)[c] *= scale;
    g.speed[c] = std::sqrt(v2);
    const double number = inertial_number(model, shear[c] * scale, std::sqrt(Kt * g.pressure[c]));
    g.inertial_number[c] = std::isfinite(scale) && std::isfinite(number) ? number : nan;
  }
  return g;
}

}  // namespace bagnold::sph
