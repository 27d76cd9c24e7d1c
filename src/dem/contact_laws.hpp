// The bridge between the state and the pair law: how a listed pair or a grain at a wall is handed to it.
#pragma once
#include <array>
#include <cstddef>
#include <utility>
#include <variant>

#include "dem/contact_model.hpp"
#include "dem/state.hpp"
#include "laws/contact/pair.hpp"

namespace bagnold::dem {

using Motion = laws::PairMotion<double>;
using Geometry = laws::PairGeometry<double>;
using Size = laws::PairSize<double>;
using History = laws::PairHistory<double>;
using Force = laws::PairForce<double>;

// Tables of constants of one choice of laws, as raw arrays for the loops.
template <class Normal, class Tangential, class Rolling>
struct LawTables {
  const Normal* normal;
  const Tangential* tangential;
  const Rolling* rolling;
  std::int32_t species;
  laws::PairLaw<Normal, Tangential, Rolling> of(std::int32_t a, std::int32_t b) const {
    const auto k = static_cast<std::size_t>(a * species + b);
    return {normal[k], tangential[k], rolling[k]};
  }
};

// f(LawTables) for the laws chosen: the one place where the choice is made.
template <class F>
auto with_laws(const ContactLaws& laws, F&& f) {
  return std::visit(
      [&](const auto& normal, const auto& tangential, const auto& rolling) {
        return f(LawTables{normal.data(), tangential.data(), rolling.data(), laws.species});
      },
      laws.normal, laws.tangential, laws.rolling);
}

inline std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

// Starting a team of threads costs as much as stepping some hundred grains.
inline bool worth_threads(const Grains& g) { return g.flowing >= 500; }

inline Motion pair_motion(const Grains& g, std::size_t i, std::size_t j, const Vec3& r) {
  return {numbers(r),
          numbers(g.v[i] - g.v[j]),
          numbers(g.omega[i] + g.omega[j]),
          numbers(g.omega[i] - g.omega[j]),
          0.5 * (g.diameter[i] + g.diameter[j]),
          0.5 * (g.diameter[i] - g.diameter[j]),
          1.0};
}

inline Size pair_size(const Grains& g, std::size_t i, std::size_t j) {
  const bool flows = static_cast<std::int64_t>(j) < g.flowing;
  return laws::sizes(2 / g.diameter[i], 2 / g.diameter[j], 1 / g.mass[i], flows ? 1 / g.mass[j] : 0.0);
}

// Distance of the centre of grain i from the wall, positive on the side of the grains.
inline double height_above(const Wall& wall, const Vec3& x) { return dot(x - wall.point, wall.normal); }

inline Motion wall_motion(const Grains& g, std::size_t i, const Wall& wall) {
  return {numbers(height_above(wall, g.x[i]) * wall.normal),
          numbers(g.v[i]),
          numbers(g.omega[i]),
          numbers(g.omega[i]),
          0.5 * g.diameter[i],
          0.5 * g.diameter[i],
          0.0};
}

inline Size wall_size(const Grains& g, std::size_t i) {
  return laws::sizes(2 / g.diameter[i], 0.0, 1 / g.mass[i], 0.0);
}

}  // namespace bagnold::dem
