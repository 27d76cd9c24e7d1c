// The additive quantities behind all fields. Each is a sum over grains (carried with the kernel W) or over contacts
// (spread along a line with the integral of W), hence linear in time: averages are taken of these, never of ratios.
//
// Contacts between flowing grains spread along the branch r_ij (Weinhart et al. 2012, eq. 32). The force of what does not
// flow is spread from r_i to the contact point and from there straight down (-z): momentum balance is the same
// exact identity as with the ray of (32), and in a depth profile sigma_az is the same as (32) wherever the base
// grain is below the grain that touches it; but nothing is left at z = +infinity when it is not, and sigma_ax,
// sigma_ay stay finite when both are level.
//
// Signs here are those of the paper's balance, tension positive; cg/fields.hpp turns them to compression positive.
#pragma once
#include <array>
#include <cstddef>

namespace bagnold::cg {

// The order is that of the registers of eight numbers in which sums are taken (cg/gather.hpp).
enum Channel : std::size_t {
  kMomentum = 0,     // m v_a
  kMass = 3,         // m
  kSpin = 4,         // I omega_a
  kInertia = 7,      // I
  kFlux = 8,         // m v_a v_b: xx xy xz yy yz zz
  kVolume = 14,      // pi d^3/6
  kVolumeSize = 15,  // pi d^3/6 times d, for the mean diameter
  kFabric = 16,      // pi d^3/6 times n_a n_b of its contacts: xx xy xz yy yz zz
  kNumber = 22,      // 1
  kContact = 23,     // contact stress, row-major a, b
  kBase = 32,        // stress of the base contacts, row-major a, b
  kChannels = 41,
  kCarried = kContact,  // channels before this one are carried by grains
  kFlowing = kBase,     // channels before this one come from flowing grains and their mutual contacts
};

using Row = std::array<double, kChannels>;

// Place of component (a, b) in a symmetric tensor stored as xx xy xz yy yz zz.
constexpr std::size_t symmetric(std::size_t a, std::size_t b) {
  constexpr std::size_t place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  return place[a][b];
}

}  // namespace bagnold::cg
