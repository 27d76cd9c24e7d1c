// Random packings for tests: positions and forces are random numbers, because the identities of coarse-graining hold
// for any of them; contacts with the base go both up and down, and some are level.
#pragma once
#include <cmath>
#include <vector>

#include "cg/snapshot.hpp"
#include "core/random.hpp"

namespace bagnold::test {

inline double random_number(std::uint64_t seed, std::uint64_t item, std::uint32_t draw, double lo, double hi) {
  return lo + (hi - lo) * random::uniform(seed, random::Stream::test, item, draw);
}

inline cg::StoredSnapshot random_packing(std::uint64_t seed, int flowing = 120, int base = 30, int contacts = 300) {
  const auto u = [&](std::uint64_t item, std::uint32_t draw, double lo, double hi) {
    return random_number(seed, item, draw, lo, hi);
  };
  cg::StoredSnapshot s;
  s.box = {.origin = {0, 0, 0}, .length = {6, 5, 8}, .periodic = {true, true, false}};
  s.flowing = flowing;
  for (int i = 0; i < flowing + base; ++i) {
    const auto item = static_cast<std::uint64_t>(i);
    const bool flows = i < flowing;
    const double d = u(item, 0, 0.7, 1.2);
    s.x.push_back({u(item, 1, 0, 6), u(item, 2, 0, 5), flows ? u(item, 3, 0, 8) : u(item, 3, -1, 0.4)});
    s.v.push_back(flows ? Vec3{u(item, 4, -1, 2), u(item, 5, -1, 1), u(item, 6, -1, 1)} : Vec3{});
    s.omega.push_back(flows ? Vec3{u(item, 7, -1, 1), u(item, 8, -1, 3), u(item, 9, -1, 1)} : Vec3{});
    s.diameter.push_back(d);
    s.mass.push_back(d * d * d);
    s.inertia.push_back(0.1 * d * d * d * d * d);
  }
  for (int c = 0; c < contacts; ++c) {
    const auto item = static_cast<std::uint64_t>(100000 + c);
    const bool with_base = c % 4 == 0;
    dem::Contact contact;
    contact.i = static_cast<std::int32_t>(u(item, 0, 0, flowing));
    contact.j = with_base ? flowing + static_cast<std::int32_t>(u(item, 1, 0, base))
                          : static_cast<std::int32_t>(u(item, 1, 0, flowing));
    if (contact.j == contact.i) contact.j = (contact.i + 1) % flowing;
    if (c % 37 == 0) contact.j = -1;
    // A direction on the sphere; z of both signs, a few exactly or nearly level.
    double nz = u(item, 2, -1, 1);
    if (c % 11 == 0) nz = 0;
    if (c % 13 == 0) nz = 1e-5;
    const double phi = u(item, 3, 0, 6.283185307179586), s_xy = std::sqrt(1 - nz * nz);
    contact.normal = {s_xy * std::cos(phi), s_xy * std::sin(phi), nz};
    contact.overlap = u(item, 4, 0.001, 0.05);
    const double radii =
        contact.j < 0
            ? 0.5 * s.diameter[static_cast<std::size_t>(contact.i)]
            : 0.5 * (s.diameter[static_cast<std::size_t>(contact.i)] + s.diameter[static_cast<std::size_t>(contact.j)]);
    contact.branch = (radii - contact.overlap) * contact.normal;
    contact.force = {u(item, 5, -1, 1), u(item, 6, -1, 1), u(item, 7, -1, 3)};
    s.contacts.push_back(contact);
  }
  // The branch of a contact between flowing grains has to end at the partner: put the partner there for every contact
  // is impossible with random contacts, so flowing contacts use the true separation instead.
  for (dem::Contact& c : s.contacts) {
    if (c.j < 0 || c.j >= flowing) continue;
    c.branch = minimum_image(s.box, s.x[static_cast<std::size_t>(c.i)] - s.x[static_cast<std::size_t>(c.j)]);
    c.normal = c.branch / norm(c.branch);
  }
  return s;
}

}  // namespace bagnold::test
