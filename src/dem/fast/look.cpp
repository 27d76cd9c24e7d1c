#include "dem/fast/look.hpp"

#include "dem/fast/engine.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

void put(const Vec3Of<Lanes>& a, ContactPack::Vector& to) {
  a.x.store(to[0].data());
  a.y.store(to[1].data());
  a.z.store(to[2].data());
}

// As Kernel::act, with nothing advanced and nothing added.
template <class Tables, bool EqualRadii, bool OneKind>
[[gnu::flatten]] std::size_t look(const Engine& engine, const Section& section, const Tables& tables, std::size_t& from,
                                  std::span<ContactPack> out) {
  using K = Kernel<Tables, EqualRadii, OneKind>;
  const double *position = engine.rows.position.data(), *velocity = engine.rows.velocity.data();
  const Lanes zero = 0.0;
  const Vec3Of<Lanes> nothing{zero, zero, zero};
  auto law = pack_laws(tables, [&](std::size_t c) { return Lanes(engine.constants[c]); });
  std::size_t count = 0, p = from;
  for (; p < section.inner.count && count < out.size(); p += batch) {
    const Offset *i = section.inner.i.data() + p, *j = section.inner.j.data() + p;
    const Separation apart = separation(position, i, j);
    const RelativeMotion moving = relative_motion(velocity, i, j);
    typename K::Motion m{fold(engine.images, apart.r), moving.v, moving.spin_sum, nothing, apart.reach,
                         moving.size_difference,       1.0};
    Lanes mass_difference = zero;
    if constexpr (!K::symmetric) {
      const RowDifference d = difference(velocity, i, j, 4);
      m.spin_difference = d.xyz;
      mass_difference = d.fourth;
    }
    if constexpr (!OneKind)
      law = pack_laws(tables, [&](std::size_t c) { return gather(engine.constants.data() + c, &section.kind[p]); });
    const auto geometry = laws::pair_geometry(m);
    const std::uint32_t touching = to_integer(geometry.overlap > zero);
    if (touching == 0) continue;
    typename K::History history{K::load(&section.history[p * K::history_numbers]), nothing};
    if constexpr (K::rolls) history.roll = K::load(&section.history[p * K::history_numbers + 24]);
    const auto force =
        laws::interact<false>(law, geometry, K::sizes(m, moving.inverse_mass, mass_difference), zero, history);
    ContactPack& pack = out[count++];
    put(m.r, pack.branch);
    put(geometry.n, pack.normal);
    put(force.force, pack.force);
    geometry.overlap.store(pack.overlap.data());
    for (std::size_t k = 0; k < batch; ++k) {
      pack.i[k] = static_cast<std::uint32_t>(row_of(i[k]));
      pack.j[k] = static_cast<std::uint32_t>(row_of(j[k]));
    }
    pack.touching = touching;
  }
  from = p;
  return count;
}

}  // namespace

std::size_t look_at_contacts(const Engine& engine, std::size_t s, std::size_t& from, std::span<ContactPack> out) {
  const Section& section = engine.sections[s];
  return with_laws(engine.laws, [&](const auto& tables) {
    using T = std::decay_t<decltype(tables)>;
    if (!engine.one_kind) return look<T, false, false>(engine, section, tables, from, out);
    if (!engine.equal_radii) return look<T, false, true>(engine, section, tables, from, out);
    return look<T, true, true>(engine, section, tables, from, out);
  });
}

}  // namespace bagnold::dem::fast
