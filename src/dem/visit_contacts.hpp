// f(contact) for every contact of a state, through the same law that moves it, with nothing advanced.
#pragma once
#include "dem/contact_laws.hpp"

namespace bagnold::dem {

// A contact as the law sees it. j >= 0: grain; j < 0: wall -1 - j.
template <class Law>
struct ContactView {
  std::int64_t i, j;
  Law law;
  Motion motion;
  Size size;
  Geometry geometry;
  History history;
  Force force;
};

template <class Tables, class F>
void visit_contacts(const DemState& state, const Tables& tables, F&& f) {
  const Grains& g = state.grains;
  const auto visit = [&](std::int64_t i, std::int64_t j, const auto& law, const Motion& motion, const Size& size,
                         const Vec3& spring, const Vec3& roll) {
    ContactView<std::decay_t<decltype(law)>> c{
        i, j, law, motion, size, laws::pair_geometry(motion), {numbers(spring), numbers(roll)}, {}};
    c.force = laws::interact<false>(law, c.geometry, size, 0.0, c.history);
    f(c);
  };
  const auto shift = neighbours::image_shifts(state.box);
  const PairList& pairs = state.pairs;
  for (std::size_t p = 0; p < pairs.touching.size(); ++p) {
    if (!pairs.touching[p]) continue;
    const auto i = at(pairs.i[p]), j = at(pairs.j[p]);
    visit(pairs.i[p], pairs.j[p], tables.of(g.species[i], g.species[j]),
          pair_motion(g, i, j, g.x[i] - g.x[j] - shift[pairs.image[p]]), pair_size(g, i, j), pairs.spring[p],
          pairs.roll[p]);
  }
  const WallContacts& at_walls = state.wall_contacts;
  for (std::size_t k = 0; k < at_walls.touching.size(); ++k) {
    if (!at_walls.touching[k]) continue;
    const std::size_t w = k / at(g.flowing), i = k % at(g.flowing);
    visit(static_cast<std::int64_t>(i), -1 - static_cast<std::int64_t>(w),
          tables.of(g.species[i], state.walls[w].species), wall_motion(g, i, state.walls[w]), wall_size(g, i),
          at_walls.spring[k], at_walls.roll[k]);
  }
}

}  // namespace bagnold::dem
