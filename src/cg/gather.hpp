// From the grains and contacts of one instant to the moments of cg/moments.hpp: what the gatherings from snapshots and
// states (deposit.cpp) and from the rows of the fast engine (deposit_rows.cpp) share.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "cg/moments.hpp"
#include "core/parallel.hpp"
#include "core/simd.hpp"

namespace bagnold::cg {

using Lanes = Pack;  // eight channels

struct Place {
  std::int64_t bin;
  double s;  // -1 at the lower edge of the bin, 1 at the upper one
};
Place place(const ProfileMoments& p, double z);

// Contacts with the base, and contacts so level that their stress cannot be given to the grains; `z` and `diameter` are
// those of grain i. A level contact of flowing grains has its f_a r_z/r_z shared with the others.
void add_base_contact(ProfileMoments& p, double z, double diameter, const dem::ContactForce& c);
void add_level_contact(ProfileMoments& p, double z, const dem::ContactForce& c);
double level(const ProfileMoments& p);  // |r_z| below which a contact is

// No grain has contacts yet.
void prepare_shares(ProfileScratch& w, std::size_t grains);

inline constexpr std::size_t flow_width = kFlowing;
inline constexpr std::size_t look_ahead = 16;  // grains: what they carry is asked for that much before it is needed

// Sorts the grains in w.ranges by bin. Their order inside a bin is that of the ranges.
template <class Grains>
void sort_by_bin(ProfileMoments& p, const Grains& grains, ProfileScratch& w) {
  const double per_bin = 1 / p.lattice.bin(), origin = p.lattice.origin;
  const auto ranges = static_cast<std::int64_t>(w.ranges.size());
  const std::size_t items = w.ranges.empty() ? 0 : w.ranges.back().second;
  w.bin.resize(items);
  w.place.resize(items);
  w.order.resize(items + look_ahead);
  w.sorted_place.resize(items + 8);
  w.count.resize(3 * w.ranges.size());
  const bool threads = items >= 500;
  parallel_for(
      ranges,
      [&](std::int64_t r) {
        std::int32_t lowest = std::numeric_limits<std::int32_t>::max(), highest = -lowest, odd = 0;
        for (std::size_t i = w.ranges[static_cast<std::size_t>(r)].first;
             i < w.ranges[static_cast<std::size_t>(r)].second; ++i) {
          const double s = (grains.z(i) - origin) * per_bin, b = std::floor(s);
          const bool fine = std::abs(s) < 1e9;
          odd |= fine ? 0 : 1;
          const auto bin = static_cast<std::int32_t>(fine ? b : 0.0);
          w.bin[i] = bin;
          w.place[i] = 2 * (s - b) - 1;
          lowest = std::min(lowest, bin);
          highest = std::max(highest, bin);
        }
        std::int32_t* found = &w.count[3 * static_cast<std::size_t>(r)];
        found[0] = lowest, found[1] = highest, found[2] = odd;
      },
      threads);
  for (std::size_t r = 0; r < w.ranges.size(); ++r) {
    const auto [begin, end] = w.ranges[r];
    for (std::size_t i = begin; w.count[3 * r + 2] != 0 && i < end; ++i) place(p, grains.z(i));  // throws
    for (std::size_t edge = 0; edge < 2 && begin < end; ++edge) {
      const std::int32_t bin = w.count[3 * r + edge];
      cover(p.flow, bin, p.lattice.origin + bin * p.lattice.bin());
    }
  }

  // Counting sort, with one row of counters a range so that the order does not depend on threads.
  const auto bins = static_cast<std::size_t>(p.flow.count);
  const auto first = static_cast<std::int32_t>(p.flow.first);
  w.count.assign(w.ranges.size() * bins, 0);
  w.begin.assign(bins + 1, 0);
  const auto in_range = [&](std::int64_t r, const auto& f) {
    const auto [begin, end] = w.ranges[static_cast<std::size_t>(r)];
    std::int32_t* count = w.count.data() + static_cast<std::size_t>(r) * bins;
    for (std::size_t i = begin; i < end; ++i) f(i, count[w.bin[i] - first]++);
  };
  parallel_for(
      ranges, [&](std::int64_t r) { in_range(r, [](std::size_t, std::int32_t) {}); }, threads);
  for (std::size_t r = 0; r < w.ranges.size(); ++r)
    for (std::size_t b = 0; b < bins; ++b) {
      std::int32_t& c = w.count[r * bins + b];
      const std::int32_t here = c;
      c = w.begin[b + 1];
      w.begin[b + 1] += here;
    }
  for (std::size_t b = 0; b < bins; ++b) w.begin[b + 1] += w.begin[b];
  parallel_for(
      ranges,
      [&](std::int64_t r) {
        in_range(r, [&](std::size_t i, std::int32_t before) {
          const auto to = static_cast<std::size_t>(w.begin[static_cast<std::size_t>(w.bin[i] - first)] + before);
          w.order[to] = static_cast<std::int32_t>(i);
          w.sorted_place[to] = w.place[i];
        });
      },
      threads);
}

// Brings the sums of a grain nearer: they are wherever its number puts them.
inline void ask_for_share(const ProfileScratch& w, std::size_t grain) {
  const double* sums = w.shares[grain].channel.data();
  __builtin_prefetch(sums, 1);
  __builtin_prefetch(sums + 8, 1);
}

// Adds to the sums over the contacts of a grain; they start again with the first contact of a sample.
inline void share(ProfileScratch& w, std::size_t grain, const Lanes& fabric, const Lanes& stress) {
  double* sums = w.shares[grain].channel.data();
  const double known = w.touches[grain];  // 0 or 1: no branch that nobody can foresee
  w.touches[grain] = 1;
  (known * Lanes::load_unaligned(sums) + fabric).store_unaligned(sums);
  (known * Lanes::load_unaligned(sums + 8) + stress).store_unaligned(sums + 8);
}

// Sum of each of eight registers.
[[gnu::always_inline]] inline Lanes sums_of(const Lanes (&row)[8]) {
  return Lanes(simd::halves(simd::lane_sums(row[0].v, row[1].v, row[2].v, row[3].v),
                            simd::lane_sums(row[4].v, row[5].v, row[6].v, row[7].v)));
}

// What sums are multiplied by: channels [0, 16), and [16, 24), of contacts.
struct Scales {
  Lanes low = 1.0, high = 1.0, contacts = 1.0;
};

// The grains of one bin, a few at a time: powers of their places first, then what they carry, then what the contacts of those
// that have any do, sixteen channels at a time so that the sums stay in registers. Grains that are alike carry motion only
// and 1 for the mass: their sums are scaled once a bin, and that for the mass is the number of grains.
template <int terms, class Grains>
class BinDeposit {
 public:
  BinDeposit(const Grains& grains, ProfileScratch& w) : grains_(grains), w_(w) {}

  void add(double* bin, std::size_t first, std::size_t last) {
    for (; first < last; first += most) {
      const std::size_t n = std::min(most, last - first);
      const std::int32_t* item = w_.order.data() + first;
      const Scales scales = grains_.scales();
      take_powers(bin, w_.sorted_place.data() + first, n);
      std::size_t touched = 0;  // grains with contacts
      std::uint8_t* const touches = w_.touches.data();
      const ContactShare* const shares = w_.shares.data();
      add_sums<Grains::alike>(bin, n, scales.low, scales.high, [&](std::size_t g, Lanes& a, Lanes& b) {
        const auto i = static_cast<std::size_t>(item[g]);
        if constexpr (requires { grains_.ask(i); }) grains_.ask(static_cast<std::size_t>(item[g + look_ahead]));
        grains_.carry(i, memo_, a, b);
        if constexpr (!Grains::alike) volume_[touched] = memo_.volume;
        grain_[touched] = g;
        share_[touched] = item[g];
        const std::size_t sums = touches[i] * i;  // of another grain if it has none
        touched += touches[i];
        touches[i] = 0;
        __builtin_prefetch(shares[sums].channel.data());
        __builtin_prefetch(shares[sums].channel.data() + 8);
        return g;
      });
      add_sums<false>(bin + kFabric, touched, scales.contacts, 1.0, [&](std::size_t t, Lanes& a, Lanes& b) {
        const double* share = shares[share_[t]].channel.data();
        a = Lanes::load_unaligned(share);
        if constexpr (!Grains::alike) {
          const double v = volume_[t];
          a *= Lanes(v, v, v, v, v, v, 0, 1);
        }
        b = Lanes::load_unaligned(share + 8);
        return grain_[t];
      });
    }
  }

 private:
  static constexpr std::size_t most = 64;

  // Their sums are the moments of the number of grains; that of power 0 is known.
  void take_powers(double* bin, const double* place, std::size_t n) {
    constexpr std::size_t rows = (terms - 1 + 7) / 8 * 8;
    Lanes number[rows]{};  // [k - 1]: of power k
    for (std::size_t g = 0; g < n; g += 8) {
      Lanes p = select(lanes_between(0, static_cast<int>(n - g)), Lanes(1.0), 0.0);
      const Lanes s = Lanes::load_unaligned(place + g);  // readable beyond the last grain
      p.store(&power_[0][g]);
#pragma GCC unroll 16
      for (std::size_t k = 1; k < terms; ++k) {
        p *= s;
        p.store(&power_[k][g]);
        if constexpr (!Grains::alike) number[k - 1] += p;
      }
    }
    if constexpr (Grains::alike) return;
    bin[kNumber] += static_cast<double>(n);
    for (std::size_t k = 1; k < terms; k += 8) {
      Lanes eight[8];
      std::copy_n(number + k - 1, 8, eight);
      const Lanes sums = sums_of(eight);
      for (std::size_t l = 0; l < 8 && k + l < terms; ++l)
        bin[(k + l) * flow_width + kNumber] += sums[static_cast<int>(l)];
    }
  }

  // Adds sixteen channels of n things times the scales: next(k, a, b) gives those of thing k and returns its grain.
  // `count`: channel kMass counts them.
  template <bool count, class Next>
  void add_sums(double* __restrict bin, std::size_t n, const Lanes& scale_low, const Lanes& scale_high,
                const Next& next) {
    Lanes low[terms]{}, high[terms]{};
    for (std::size_t t = 0; t < n; ++t) {
      Lanes a, b;
      const std::size_t g = next(t, a, b);
#pragma GCC unroll 16
      for (std::size_t k = 0; k < terms; ++k) {
        low[k] += power_[k][g] * a;
        high[k] += power_[k][g] * b;
      }
    }
#pragma GCC unroll 16
    for (std::size_t k = 0; k < terms; ++k) {
      double* to = bin + k * flow_width;
      (Lanes::load_unaligned(to) + scale_low * low[k]).store_unaligned(to);
      (Lanes::load_unaligned(to + 8) + scale_high * high[k]).store_unaligned(to + 8);
      if constexpr (count) to[kNumber] += low[k][static_cast<int>(kMass)];
    }
  }

  const Grains& grains_;
  ProfileScratch& w_;
  typename Grains::Memo memo_;
  alignas(64) double power_[terms][most];
  double volume_[most + 1];
  std::size_t grain_[most + 1];
  std::int32_t share_[most + 1];
};

// Adds the grains in w.ranges with the shares their contacts gave them.
template <class Grains>
void deposit_grains(ProfileMoments& p, const Grains& grains, ProfileScratch& w) {
  std::visit(
      [&](const auto& kernel) {
        constexpr int terms = std::decay_t<decltype(kernel)>::expansion_terms;
        constexpr std::int64_t block = 16;  // bins
        parallel_for((p.flow.count + block - 1) / block,
                     [&](std::int64_t k) {
                       BinDeposit<terms, Grains> deposit(grains, w);
                       for (std::int64_t b = k * block; b < std::min((k + 1) * block, p.flow.count); ++b) {
                         const auto n = static_cast<std::size_t>(b);
                         deposit.add(p.flow.data.data() + n * terms * flow_width, static_cast<std::size_t>(w.begin[n]),
                                     static_cast<std::size_t>(w.begin[n + 1]));
                       }
                     },
                     w.order.size() >= 500);
      },
      p.kernel);
  w.unfinished = false;
}

}  // namespace bagnold::cg
