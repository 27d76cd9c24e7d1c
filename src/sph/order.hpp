// Keeping particles evenly spread and their volumes honest.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Sum of W dp^D on the square or cubic lattice of the initial state: the concentration of an undisturbed interior.
double lattice_concentration(const Model& model);

// rho *= 1 + (C/C_lattice - 1) min(1/2, volume_correction gamma dt) in the interior: where material shears, density
// follows the volume the positions show. Elsewhere a particle diluted beyond phi_min whose volume overlaps others (C > C_lattice) is
// given the density its place leaves it, up to phi_min: tr L of loose particles is a guess, and dilution feeds on itself.
void correct_volumes(Work& work, Particles& particles, const Model& model, double dt);

// density_rate += 2 delta h c sum A_j f [rho_j - rho_i + (grad rho_i + grad rho_j).r_ij/2]     after Antuono et al. 2010
// Blind to linear fields, so a state of rest stays one; conserves sum V rho. Needs kinematics(corrected).
void diffuse_density(Work& work, const Particles& particles, const Model& model);

// x += shifting h^2 gamma dt imbalance, at most 0.02 dp, along the surface only near one, not at all for loose particles.
void shift_particles(const Work& work, Particles& particles, const Model& model, double dt);

}  // namespace bagnold::sph
