// Depth profiles of long series at a cost of nanoseconds per grain: sums are gathered as powers about the centres of
// fine bins, and turned into fields once, at the end.
//
// Averaged over x and y every term of rho, p and of the stress is q g(z - z_i) or C Phi(z - z_i) with Phi' = g the
// integral of the kernel. For a grain at z_i = z_b + s h/2 in the bin of width h about z_b, -1 <= s <= 1, the integral is
// replaced by the polynomial in s that equals it at the Chebyshev nodes s_j of the bin,
//
//   Phi(z - z_i) = sum_k a_k(z) s^k,   a_k(z) = sum_j A_kj Phi(z - z_b - s_j h/2),   g(z - z_i) = sum_k a_k'(z) s^k,
//
// so a bin needs the sums of q s^k only. In other words: a grain is shared among the nodes of its bin with weights that add up to
// one. Nodes carry the exact kernel and its exact derivatives, so the balances of mass and momentum stay exact to
// round-off, whatever the polynomials neglect. The Gaussian keeps 9 powers in bins of w/2, which leaves 2e-11 of the peak;
// Lucy and Heaviside are polynomials between their knots, which lie on edges of bins, and are not approximated at all.
//
// Contact stress needs no special function per contact: -f_a r_b [Phi(z - z_j) - Phi(z - z_i)]/(z_i - z_j) is a
// tensor f_a r_b/r_z given to grain i and taken from grain j. Where the difference would cancel, in contacts that are nearly
// level (|r_z| < 2e-3 w), the differences of powers (s_i^k - s_j^k)/(s_i - s_j) are formed without cancellation.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cg/channels.hpp"
#include "cg/snapshot.hpp"
#include "core/arrays.hpp"
#include "dem/contact_model.hpp"
#include "dem/contacts.hpp"
#include "dem/fast/contact_pack.hpp"
#include "laws/registries.hpp"

namespace bagnold::cg {

// Moments sum q s^k of `width` channels in bins [first, first + count): data[bin][k < terms][channel].
struct BinMoments {
  std::int64_t first = 0, count = 0, width = 0, terms = 0;
  std::vector<double> data;
};

// Where a profile is evaluated: nodes n * spacing + origin. Bins begin at the origin as well; their width is a fraction or
// a multiple of the spacing.
struct Lattice {
  double origin = 0, spacing = 0;
  std::int64_t bins_per_node = 1, nodes_per_bin = 1;  // one of them is 1
  double bin() const { return spacing * static_cast<double>(nodes_per_bin) / static_cast<double>(bins_per_node); }
  double node(std::int64_t n) const { return origin + static_cast<double>(n) * spacing; }
};

// The lattice whose spacing is nearest to the one asked for and suits the kernel (exactly the one asked for with the
// Gaussian; a fraction of the cut-off with the others).
Lattice make_lattice(const laws::CgKernels::Any& kernel, double spacing, double origin = 0);

// Makes sure that bin b exists (where a grain at z needs it). Grows by some more than asked, so that it happens rarely.
void cover(BinMoments& moments, std::int64_t b, double z);
inline double* bin_data(BinMoments& m, std::int64_t b) { return m.data.data() + (b - m.first) * m.terms * m.width; }

struct ProfileMoments {
  laws::CgKernels::Any kernel;
  Lattice lattice;
  double area = 1;  // Lx Ly
  std::int64_t samples = 0;
  double contacts = 0;  // number of contacts, summed over the samples
  Vec3 base_force{};    // force of the flow on the base, summed over the samples
  BinMoments flow, base;
};

// Sums over the contacts of a grain, channels [16, 32): fabric (not yet times the volume), nothing, contact stress.
struct alignas(64) ContactShare {
  std::array<double, 16> channel{};
};

// Memory of the functions below, kept between calls so that nothing is allocated.
struct ProfileScratch {
  std::vector<ContactShare> shares;         // of each grain that touches; of others from an earlier sample
  std::vector<std::uint8_t> touches;        // whether it has contacts; 0 between calls,
  bool unfinished = false;                  // unless they were left by an exception
  std::vector<std::uint8_t> flows;          // whether it flows, of each row of the engine
  std::vector<std::int32_t> bin, count;     // of a grain; by range of grains and bin
  std::vector<std::int32_t> begin, order;   // by bin; grains in the order of their bins
  std::vector<double> place, sorted_place;  // s of a grain in its bin; the same in that order
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  std::vector<std::vector<dem::ContactForce>> special;  // by section: with the base, or nearly level
  std::vector<std::int64_t> contacts;                   // by section
};

ProfileMoments make_moments(const laws::CgKernels::Any& kernel, const Lattice& lattice, const Box& box);

// Throws NumericalError if a grain is so far away that it cannot be part of a profile (or its position is not finite).
void add_snapshot(ProfileMoments& moments, const Snapshot& snapshot, ProfileScratch& scratch);
// The same from a running engine, without the copies a Snapshot needs: from its state,
void add_state(ProfileMoments& moments, const dem::DemState& state, const dem::ContactLaws& laws,
               ProfileScratch& scratch);
// and from inside the fast one, in the three stages of dem::Watch: begin, the contacts of every section as they come, and the
// grains. The result does not depend on the number of threads.
void begin_rows(const dem::fast::Engine& engine, ProfileScratch& scratch);
void add_section(const ProfileMoments& moments, std::size_t section, dem::fast::ContactPacks packs,
                 ProfileScratch& scratch);
void add_rows(ProfileMoments& moments, const dem::fast::Engine& engine, ProfileScratch& scratch);
void clear(ProfileMoments& moments);                               // keeps the bins
void add_moments(ProfileMoments& to, const ProfileMoments& from);  // of the same kernel and lattice

// Sums at nodes [first, first + count) and their derivatives along z, per unit area; not divided by samples.
// `averaged`: means over intervals of one spacing about the nodes (mass and force are then exact per interval) instead of
// values at the nodes.
struct ProfileSums {
  std::int64_t first = 0;
  std::vector<Row> value, slope;
};
ProfileSums evaluate(const ProfileMoments& moments, std::int64_t first, std::int64_t count, bool averaged = false);

// Nodes outside of which every sum is constant.
struct NodeRange {
  std::int64_t first = 0, count = 0;
};
NodeRange reach(const ProfileMoments& moments);

}  // namespace bagnold::cg
