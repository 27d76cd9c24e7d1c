#include "sph/images.hpp"

namespace bagnold::sph {
namespace {

constexpr std::array<double, 3> ones{1, 1, 1};

double position(const Particles& p, const Images& images, std::int64_t n, std::int64_t who, std::size_t k) {
  if (who < n) return p.x[k][static_cast<std::size_t>(who)];
  const auto image = static_cast<std::size_t>(who - n);
  return images.R[image][k] * p.x[k][static_cast<std::size_t>(images.parent[image])] + images.shift[image][k];
}

// Appends the image of `who` (particle or image) under position -> r position + shift, velocity -> s velocity.
void append(Images& images, std::int64_t n, std::int64_t who, const std::array<double, 3>& r,
            const std::array<double, 3>& s, const std::array<double, 3>& shift) {
  std::array<double, 3> R = r, S = s, total = shift;
  auto parent = static_cast<std::int32_t>(who);
  if (who >= n) {
    const auto image = static_cast<std::size_t>(who - n);
    parent = images.parent[image];
    for (std::size_t k = 0; k < 3; ++k) {
      total[k] += r[k] * images.shift[image][k];
      R[k] *= images.R[image][k];
      S[k] *= images.S[image][k];
    }
  }
  images.parent.push_back(parent);
  images.R.push_back(R);
  images.S.push_back(S);
  images.shift.push_back(total);
}

}  // namespace

Images make_images(const Model& model, const Particles& p, double reach) {
  Images images;
  const std::int64_t n = p.size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(model.dim); ++k) {
    const double length = model.period[k];
    if (!(length > 0)) continue;
    const std::int64_t so_far = n + images.size();
    for (std::int64_t i = 0; i < so_far; ++i) {
      const double x = position(p, images, n, i, k);
      std::array<double, 3> shift{0, 0, 0};
      shift[k] = length;
      if (x < reach) append(images, n, i, ones, ones, shift);
      shift[k] = -length;
      if (x > length - reach) append(images, n, i, ones, ones, shift);
    }
  }
  const auto mirror = [&](std::size_t k, const std::array<double, 3>& S) {
    std::array<double, 3> R = ones;
    R[k] = -1;
    const std::int64_t so_far = n + images.size();
    for (std::int64_t i = 0; i < so_far; ++i)
      if (position(p, images, n, i, k) < reach) append(images, n, i, R, S, {0, 0, 0});
  };
  if (model.axisymmetric) mirror(0, {-1, 1, 1});
  if (model.floor && model.corrected()) mirror(static_cast<std::size_t>(model.vertical()), {-1, -1, -1});
  return images;
}

}  // namespace bagnold::sph
