// The flow that the particle benchmarks run: a chute of 20 x 10 diameters, H = 20, theta = 24 deg, lambda = 1 (Weinhart
// et al. 2012, section 3), developed once and kept in a file of the working directory; larger flows are copies of it
// side by side, so that all have the same contacts per grain.
#pragma once
#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "dem/algorithm.hpp"
#include "dem/contacts.hpp"

namespace bagnold::bench {

inline constexpr double length = 20, width = 10, angle = 24 * std::numbers::pi / 180, kn = 2e5, gamma_n = 25;

inline dem::ContactLaws linear_laws() {
  laws::Linear normal;
  normal.stiffness = kn;
  normal.damping = gamma_n;
  return dem::compile(dem::uniform_model({"grain"}, {normal, laws::LinearHistory{}, laws::NoRollingResistance{}}), 0.5);
}

// About as stiff as the linear law at the overlaps of this flow.
inline dem::ContactLaws hertz_laws() {
  laws::Hertz normal;
  normal.young_modulus = 3.6e7;
  normal.restitution = 0.88;
  return dem::compile(dem::uniform_model({"grain"}, {normal, laws::Mindlin{}, laws::NoRollingResistance{}}), 0.5);
}

struct Grain {
  int type = 1;  // 1 flows, 2 is fixed
  Vec3 x, v, omega;
  double diameter = 1;
};

// nx times ny copies; mean diameter and mass of a grain of that diameter are 1.
inline dem::DemState make_state(const std::vector<Grain>& grains, int nx, int ny) {
  dem::DemState s;
  dem::Grains& g = s.grains;
  for (const int type : {1, 2})
    for (const Grain& p : grains)
      for (int k = 0; k < nx * ny && p.type == type; ++k) {
        const double mass = p.diameter * p.diameter * p.diameter;
        g.x.push_back(p.x + Vec3{k / ny * length, k % ny * width, 0});
        g.v.push_back(p.v);
        g.omega.push_back(p.omega);
        g.diameter.push_back(p.diameter);
        g.mass.push_back(mass);
        g.inertia.push_back(0.1 * mass * p.diameter * p.diameter);
        g.flowing += type == 1;
      }
  g.species.assign(g.x.size(), 0);
  for (std::size_t i = 0; i < g.x.size(); ++i) g.id.push_back(static_cast<std::int64_t>(i));
  s.box = {{0, 0, 0}, {nx * length, ny * width, 1}, {true, true, false}};
  s.gravity = {std::sin(angle), 0, -std::cos(angle)};
  s.dt = 1e-4;
  return s;
}

// A state as grains, with full-step velocities.
inline std::vector<Grain> grains_of(const dem::DemState& s) {
  std::vector<Grain> grains;
  for (std::int64_t i = 0; i < s.grains.size(); ++i)
    grains.push_back({i < s.grains.flowing ? 1 : 2, wrap(s.box, s.grains.x[static_cast<std::size_t>(i)]),
                      dem::full_step_velocity(s, i), dem::full_step_omega(s, i),
                      s.grains.diameter[static_cast<std::size_t>(i)]});
  return grains;
}

// A lattice of twenty layers with Bagnold's profile over a rough bed, left to flow. Diameters are uniform in
// 1 - spread .. 1 + spread.
inline std::vector<Grain> develop(const dem::ContactLaws& laws, double spread, double time) {
  std::vector<Grain> start;
  std::uint64_t item = 0;
  const auto u = [&](std::uint32_t draw) { return random::uniform(1, random::Stream::perturbation, item, draw) - 0.5; };
  const double pitch = 1 + spread;  // no overlaps
  const int nx = static_cast<int>(length / pitch), ny = static_cast<int>(width / pitch);
  for (int k = 0; k < 4000; ++k, ++item) {
    const double z = k / (nx * ny) * pitch, depth = 1 - z / (pitch * (4000.0 / (nx * ny) + 1));
    start.push_back(
        {1,
         {k % nx * length / nx + 0.04 * u(0), k / nx % ny * width / ny + 0.04 * u(1), z + pitch + 0.04 * u(2)},
         {5 * (1 - std::pow(depth, 1.5)) + 0.5 * u(3), 0.5 * u(4), 0.5 * u(5)},
         {},
         1 + 2 * spread * u(6)});
  }
  for (int k = 0; k < 288; ++k, ++item)
    start.push_back({2, {k % 24 / 1.2 + 0.2 * u(0), k / 24 / 1.2 + 0.2 * u(1), 0.6 * u(2) - 0.3}, {}, {}, 1});
  dem::DemState s = make_state(start, 1, 1);
  prepare(s, laws);
  advance(s, laws, std::llround(time / s.dt));
  return grains_of(s);
}

// Lines `type x y z vx vy vz wx wy wz [diameter]`, of a box of 20 x 10.
inline std::vector<Grain> read(const std::string& name) {
  std::vector<Grain> grains;
  std::ifstream file(name);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Grain g;
    if (!(words >> g.type >> g.x.x >> g.x.y >> g.x.z >> g.v.x >> g.v.y >> g.v.z >> g.omega.x >> g.omega.y >> g.omega.z))
      continue;
    if (!(words >> g.diameter)) g.diameter = 1;
    g.x = wrap({{0, 0, 0}, {length, width, 1}, {true, true, false}}, g.x);
    grains.push_back(g);
  }
  return grains;
}

inline void write(const std::string& name, const std::vector<Grain>& grains) {
  std::ofstream file(name);
  for (const Grain& g : grains)
    file << fmt::format("{} {} {} {} {} {} {} {} {} {} {}\n", g.type, g.x.x, g.x.y, g.x.z, g.v.x, g.v.y, g.v.z,
                        g.omega.x, g.omega.y, g.omega.z, g.diameter);
}

// The flow kept as bench-<name>.state, made now if it is not there.
template <class Make>
std::vector<Grain> flow(const std::string& name, Make&& make) {
  const std::string file = "bench-" + name + ".state";
  if (read(file).empty()) {
    fmt::print("developing the {} flow, once ...\n", name);
    write(file, make());
  }
  return read(file);  // the same bits whether it was there or not
}

inline std::vector<Grain> developed_flow() {
  return flow("developed", [] { return develop(linear_laws(), 0, 20); });
}

inline std::vector<Grain> unequal_flow() {
  return flow("unequal", [] { return develop(linear_laws(), 0.2, 20); });
}

// The developed flow one time unit later, under these laws.
inline std::vector<Grain> later_flow(const std::string& name, const dem::ContactLaws& laws) {
  return flow(name, [&] {
    dem::DemState s = make_state(developed_flow(), 1, 1);
    prepare(s, laws);
    advance(s, laws, std::llround(1 / s.dt));
    return grains_of(s);
  });
}

}  // namespace bagnold::bench
