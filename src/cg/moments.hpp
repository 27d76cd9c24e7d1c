// Depth profiles of long series at a cost of nanoseconds per grain: sums are gathered as local expansions about the
// centres of fine bins, and turned into fields once, at the end.
//
// Averaged over x and y every term of rho, p and of the stress is q g(z - z_i) or C Phi(z - z_i) with Phi' = g the
// integral of the kernel. For a grain at z_i = z_b + delta in the bin about z_b,
//
//   g(z - z_i) = sum_k (-delta)^k/k! g^(k)(z - z_b),   Phi(z - z_i) = sum_k (-delta)^k/k! Phi^(k)(z - z_b),
//
// so a bin needs the moments M_k = sum q (-delta)^k/k! only. Both series stop at the same k: the truncated g is
// the derivative of the truncated Phi, and the balances of mass and momentum stay exact to round-off. The Gaussian
// keeps 8 terms with bins of w/8, which leaves 6e-13 of the peak; Lucy and Heaviside are polynomials between their knots, which
// lie on edges of bins, so their expansions are complete.
//
// Contact stress needs no special function per contact: -f_a r_b [Phi(z - z_j) - Phi(z - z_i)]/(z_i - z_j) is a
// tensor f_a r_b/r_z given to grain i and taken from grain j. Contacts that are nearly level (|r_z| < 2e-3 w) would
// cancel; they enter as -f_a r_b (g + r_z^2/24 g'') at their middle, which is a shift of their moments by one.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cg/channels.hpp"
#include "cg/snapshot.hpp"
#include "core/arrays.hpp"
#include "dem/contact_model.hpp"
#include "laws/registries.hpp"

namespace bagnold::cg {

// Moments of `width` channels about the centres of bins [first, first + count): data[bin][term][channel].
struct BinMoments {
  std::int64_t first = 0, count = 0, width = 0, terms = 0;
  std::vector<double> data;
};

// Where a profile is evaluated: nodes n * spacing + origin, which are edges of bins.
struct Lattice {
  double origin = 0, spacing = 0;
  std::int64_t bins_per_node = 2;  // even, so that the edges of averaging intervals are edges of bins as well
  double bin() const { return spacing / static_cast<double>(bins_per_node); }
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

// Scratch of add_snapshot and add_state, kept between calls so that nothing is allocated.
struct ProfileScratch {
  std::vector<double>
      of_contacts;  // per flowing grain: 9 of the contact stress, 6 of the fabric, 1 unused; 0 between calls
  std::vector<std::int32_t> bin, order, begin;  // grains sorted by bin
  std::vector<double> delta;                    // of a grain, from the centre of its bin
};

ProfileMoments make_moments(const laws::CgKernels::Any& kernel, const Lattice& lattice, const Box& box);

// Throws NumericalError if a grain is so far away that it cannot be part of a profile (or its position is not finite).
void add_snapshot(ProfileMoments& moments, const Snapshot& snapshot, ProfileScratch& scratch);
// The same from a running engine, without the copies a Snapshot needs.
void add_state(ProfileMoments& moments, const dem::DemState& state, const dem::ContactLaws& laws,
               ProfileScratch& scratch);
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
