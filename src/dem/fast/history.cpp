// Contacts between lists: the pairs that touch with their springs, out of inner lists and into new ones.
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"
#include "dem/neighbours.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

// A pair of an inner list that touches, or whose spring says so: the kernel may have rounded a grazing contact the other way.
struct Touching {
  std::int32_t i, j;  // grains, i < j
  std::array<int, 3> image;
  Vec3 spring, roll;
};
template <class F>
void for_touching(const Engine& engine, const Section& section, F&& f) {
  for (std::size_t k = 0; k < section.inner.count; ++k) {
    const auto a = row_of(section.inner.i[k]), b = row_of(section.inner.j[k]);
    const double *xa = &engine.rows.position[position_doubles * a], *xb = &engine.rows.position[position_doubles * b];
    Vec3 r{xa[0] - xb[0], xa[1] - xb[1], xa[2] - xb[2]};
    Touching t{engine.grain[a], engine.grain[b], {}, {}, {}};
    for (int d = 0; d < 3; ++d) {
      t.image[at(d)] = static_cast<int>(std::nearbyint(engine.images.inverse[d] * r[d]));
      r[d] -= engine.images.length[d] * t.image[at(d)];
    }
    const double* h = &section.history[k / 8 * 8 * engine.history_numbers + k % 8];
    t.spring = {h[0], h[8], h[16]};
    if (engine.history_numbers > 3) t.roll = {h[24], h[32], h[40]};
    const double reach = xa[3] + xb[3];
    if (norm2(r) >= reach * reach && t.spring == Vec3{} && t.roll == Vec3{}) continue;
    if (t.i > t.j) {
      std::swap(t.i, t.j);
      for (int& n : t.image) n = -n;
      t.spring = -t.spring;
      t.roll = -t.roll;
    }
    f(t);
  }
}

}  // namespace

// Counted first, then each section writes its own.
PairList touching_pairs(const Engine& engine) {
  const auto sections = static_cast<std::int64_t>(engine.sections.size());
  const bool threads = engine.grain.size() >= 500;
  std::vector<std::size_t> begin(engine.sections.size() + 1, 0);
  parallel_for(
      sections,
      [&](std::int64_t s) {
        for_touching(engine, engine.sections[at(s)], [&](const Touching&) { ++begin[at(s) + 1]; });
      },
      threads);
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  PairList pairs;
  for (auto* numbers : {&pairs.i, &pairs.j}) numbers->resize(begin.back());
  for (auto* vectors : {&pairs.spring, &pairs.roll}) vectors->resize(begin.back());
  pairs.image.resize(begin.back());
  parallel_for(
      sections,
      [&](std::int64_t s) {
        std::size_t p = begin[at(s)];
        for_touching(engine, engine.sections[at(s)], [&](const Touching& t) {
          pairs.i[p] = t.i;
          pairs.j[p] = t.j;
          pairs.image[p] = neighbours::image_code(t.image[0], t.image[1], t.image[2]);
          pairs.spring[p] = t.spring;
          pairs.roll[p++] = t.roll;
        });
      },
      threads);
  pairs.touching.assign(pairs.i.size(), 1);
  pairs.slab_begin = {0, static_cast<std::int64_t>(pairs.i.size())};
  return pairs;
}

void list_inner(Engine& engine, const PairList& remembered) {
  std::vector<std::uint32_t> begin(engine.grain.size() + 1, 0);
  const auto rows_of = [&](std::size_t p) {
    const std::size_t a = engine.row[at(remembered.i[p])], b = engine.row[at(remembered.j[p])];
    return std::pair{std::min(a, b), std::max(a, b)};
  };
  for (std::size_t p = 0; p < remembered.i.size(); ++p)
    if (remembered.touching[p]) ++begin[rows_of(p).first + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> contact(begin.back()), next(begin.begin(), begin.end() - 1);
  for (std::size_t p = 0; p < remembered.i.size(); ++p)
    if (remembered.touching[p]) contact[next[rows_of(p).first]++] = static_cast<std::uint32_t>(p);

  parallel_for(static_cast<std::int64_t>(engine.sections.size()), [&](std::int64_t s) {
    Section& section = engine.sections[at(s)];
    section.inner.count = 0;
    section.history.assign(8 * engine.history_numbers, 0);
    section.mid_valid = section.inner_valid = {};
    refresh(engine, at(s), engine.scratch[at(thread_index())]);
    for (std::size_t k = 0; k < section.inner.count; ++k) {
      const std::size_t i = row_of(section.inner.i[k]), j = row_of(section.inner.j[k]);
      for (std::uint32_t c = begin[std::min(i, j)]; c < begin[std::min(i, j) + 1]; ++c) {
        const std::size_t p = contact[c];
        if (rows_of(p).second != std::max(i, j)) continue;
        const double sign = engine.row[at(remembered.i[p])] == i ? 1 : -1;
        double* h = &section.history[k / 8 * 8 * engine.history_numbers + k % 8];
        for (int d = 0; d < 3; ++d) {
          h[8 * d] = sign * remembered.spring[p][d];
          if (engine.history_numbers > 3) h[24 + 8 * d] = sign * remembered.roll[p][d];
        }
      }
    }
  });
}

}  // namespace bagnold::dem::fast
