#include "sph/order.hpp"

#include "core/parallel.hpp"
#include "sph/dispatch.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph {
namespace {

constexpr double interior = 0.9;        // coverage above which the concentration measures volume
constexpr double near_surface = 0.85;   // coverage below which only tangential shifts are made
constexpr double loose = 0.4;           // coverage below which nothing is shifted
constexpr double largest_shift = 0.02;  // over dp

// Unit eigenvector of the symmetric `m` for its eigenvalue `value`.
std::array<double, 2> eigenvector(const Matrix<2>& m, double value) {
  double x = m[1], y = value - m[0];
  const double a = value - m[3], b = m[1];
  if (a * a + b * b > x * x + y * y) x = a, y = b;
  const double length = std::sqrt(x * x + y * y);
  if (!(length > 0)) return {0, 1};
  return {x / length, y / length};
}
std::array<double, 3> eigenvector(const Matrix<3>& m, double value) {
  Matrix<3> s = m;
  for (std::size_t d = 0; d < 3; ++d) s[4 * d] -= value;
  std::array<double, 3> best{0, 0, 1};
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) {  // the rows span the other two directions
    const double *u = &s[3 * a], *v = &s[3 * ((a + 1) % 3)];
    const std::array<double, 3> c{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    if (length > longest) longest = length, best = {c[0] / length, c[1] / length, c[2] / length};
  }
  return best;
}

template <int D>
void shift(const Work& w, Particles& p, const Model& model, double dt) {
  const double h = model.h(), most = largest_shift * model.spacing;
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    if (w.coverage[i] < loose) return;
    const double amount = model.numerics.shifting * h * h * w.shear_rate[i] * dt;
    std::array<double, D> s;
    for (std::size_t d = 0; d < D; ++d) s[d] = amount * w.imbalance[d][i];
    if (w.coverage[i] < near_surface) {
      Matrix<D> minus_B;
      for (std::size_t m = 0; m < D * D; ++m) minus_B[m] = -w.correction[i * D * D + m];
      const auto normal = eigenvector(minus_B, smallest_eigenvalue(minus_B));
      double along = 0;
      for (std::size_t d = 0; d < D; ++d) along += s[d] * normal[d];
      for (std::size_t d = 0; d < D; ++d) s[d] -= along * normal[d];
    }
    double length = 0;
    for (const double c : s) length += c * c;
    length = std::sqrt(length);
    const double factor = length > most ? most / length : 1;
    for (std::size_t d = 0; d < D; ++d) p.x[d][i] += factor * s[d];
  });
}

// The hydrostatic slope is taken out first: it is the part that is not even about the floor.
template <int D>
void diffuse(Work& w, const Particles& p, const Model& model) {
  constexpr int area = 0, rho = 1, slope = 2;
  const std::int64_t n = p.size();
  const double rest = model.phi_max() * model.grains().grain_density,
               hydrostatic = rest * rest * model.grains().compressibility * model.gravity[D - 1],
               strength = 2 * model.numerics.density_diffusion * model.h() * model.sound_speed();
  w.slim.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    w.slim.at(k)[area] = w.area[i];
    w.slim.at(k)[rho] = p.rho[i] - hydrostatic * p.x[D - 1][i];
  });
  fill_images(w.pairs, n, w.slim, [](std::size_t, const double* from, double* to) { std::copy_n(from, slope, to); });
  std::fill_n(w.slim.at(w.pairs.elements(n) - 1), 8, 0.0);
  parallel_for(n, [&](std::int64_t k) {
    const double own = w.slim.at(k)[rho];
    Pack sum[D]{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[2];
      gather(w.slim, j, other);
      const Pack t = other[area] * w.f[q] * (own - other[rho]);
      for (std::size_t d = 0; d < D; ++d) sum[d] += t * w.r[d][q];
    });
    for (int a = 0; a < D; ++a) {
      double g = 0;
      for (int b = 0; b < D; ++b) g += w.correction[static_cast<std::size_t>(k * D * D + a * D + b)] * lane_sum(sum[b]);
      w.slim.at(k)[slope + a] = g;
    }
  });
  fill_images(w.pairs, n, w.slim, [&](std::size_t image, const double* from, double* to) {
    for (std::size_t d = 0; d < D; ++d) to[slope + d] = w.pairs.images.R[image][d] * from[slope + d];
  });
  parallel_for(n, [&](std::int64_t k) {
    const double* self = w.slim.at(k);
    Pack sum{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[slope + D];
      gather(w.slim, j, other);
      Pack jump = other[rho] - self[rho];
      for (std::size_t d = 0; d < D; ++d) jump += 0.5 * (self[slope + d] + other[slope + d]) * w.r[d][q];
      sum += other[area] * w.f[q] * jump;
    });
    w.density_rate[static_cast<std::size_t>(k)] += strength * lane_sum(sum);
  });
}

}  // namespace

void diffuse_density(Work& w, const Particles& p, const Model& model) {
  if (model.dim == 2)
    diffuse<2>(w, p, model);
  else
    diffuse<3>(w, p, model);
}

double lattice_concentration(const Model& model) {
  double sum = 0;
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    const PairShape<D, std::decay_t<decltype(kernel)>> shape(model.h());
    const int reach = static_cast<int>(2 * model.h() / model.spacing) + 1;
    double cell = 1;
    for (int d = 0; d < D; ++d) cell *= model.spacing;
    for (int a = -reach; a <= reach; ++a)
      for (int b = -reach; b <= reach; ++b)
        for (int c = D == 3 ? -reach : 0; c <= (D == 3 ? reach : 0); ++c)
          sum += cell * shape.w(shape.ratio(shape.tiny + model.spacing * model.spacing * (a * a + b * b + c * c)));
  });
  return sum;
}

void correct_volumes(Work& w, Particles& p, const Model& model, double dt) {
  const double undisturbed = lattice_concentration(model), loosest = model.phi_min() * model.grains().grain_density;
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double excess = w.concentration[i] / undisturbed - 1;
    if (w.coverage[i] > interior)
      p.rho[i] *= 1 + excess * std::min(0.5, model.numerics.volume_correction * w.shear_rate[i] * dt);
    else if (excess > 0 && p.rho[i] < loosest)
      p.rho[i] = std::min(p.rho[i] * (1 + excess), loosest);
  });
}

void shift_particles(const Work& w, Particles& p, const Model& model, double dt) {
  if (model.dim == 2)
    shift<2>(w, p, model, dt);
  else
    shift<3>(w, p, model, dt);
}

}  // namespace bagnold::sph
