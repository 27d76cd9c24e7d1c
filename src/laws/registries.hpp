// THE list of laws: one registry per family, one line per law.
#pragma once
#include "core/registry.hpp"
// coarse-graining
#include "laws/cg_kernel/gaussian.hpp"
#include "laws/cg_kernel/heaviside.hpp"
#include "laws/cg_kernel/lucy.hpp"
// contact
#include "laws/contact/hertz.hpp"
#include "laws/contact/linear.hpp"
#include "laws/rolling/none.hpp"
#include "laws/rolling/spring_slider.hpp"
#include "laws/tangential/linear_history.hpp"
#include "laws/tangential/mindlin.hpp"
// depth-averaged layer
#include "laws/density/constant.hpp"
#include "laws/density/exponential_angle.hpp"
#include "laws/friction/coulomb.hpp"
#include "laws/friction/exponential.hpp"
#include "laws/friction/jenkins.hpp"
#include "laws/friction/mu_of_i.hpp"
#include "laws/friction/pouliquen_forterre.hpp"
#include "laws/friction/static_branch.hpp"
#include "laws/friction/voellmy.hpp"
#include "laws/shape_factor/constant.hpp"
#include "laws/shape_factor/strain_model.hpp"
#include "laws/stress_ratio/constant.hpp"
#include "laws/stress_ratio/linear_angle.hpp"

// continuum (sph)
#include "laws/dilatancy/linear.hpp"
#include "laws/dilatancy/rational.hpp"
#include "laws/eos/compressible_grains.hpp"
#include "laws/kernel/wendland_c2.hpp"
#include "laws/kernel/wendland_c4.hpp"
#include "laws/mean/arithmetic.hpp"
#include "laws/mean/geometric.hpp"
#include "laws/mean/harmonic.hpp"
#include "laws/regularisation/minatti2015.hpp"
#include "laws/regularisation/papanastasiou.hpp"
#include "laws/regularisation/simple.hpp"
#include "laws/rheology/mu_i.hpp"
#include "laws/rheology/mu_i_collisional.hpp"
#include "laws/viscous/cleary.hpp"
#include "laws/viscous/variational.hpp"
#include "laws/yield_surface/drucker_prager.hpp"
#include "laws/yield_surface/lade_duncan.hpp"
#include "laws/yield_surface/matsuoka_nakai.hpp"
#include "laws/yield_surface/mohr_coulomb.hpp"
#include "laws/yield_surface/triaxial_ratio.hpp"

namespace bagnold::laws {

// Normal contact forces.
using NormalLaws = Registry<Linear, Hertz>;

// Tangential contact forces.
using TangentialLaws = Registry<LinearHistory, Mindlin>;

// Resistance to rolling.
using RollingLaws = Registry<NoRollingResistance, SpringSlider>;

// Coarse-graining functions.
using CgKernels = Registry<CgGaussian, CgLucy, CgHeaviside>;

// Basal friction of the depth-averaged layer, mu(h, F).
using FrictionLaws = Registry<Coulomb, PouliquenForterre, ExponentialFriction, Jenkins, Voellmy, MuOfI>;

// Mean solid volume fraction of the layer as a function of the friction angle.
using DensityLaws = Registry<ConstantDensity, ExponentialAngleDensity>;

// Ratio of the normal stresses K = sigma_xx/sigma_zz.
using StressRatioLaws = Registry<ConstantStressRatio, LinearAngleStressRatio>;

// Shape factor alpha = mean(u^2)/mean(u)^2.
using ShapeFactorLaws = Registry<ConstantShapeFactor, StrainModelShapeFactor>;

// Friction of continua, mu(i).
using Rheologies = Registry<rheology::MuI, rheology::MuICollisional>;

// Friction of continua at other Lode angles than that of plane strain.
using YieldSurfaces = Registry<yield_surface::DruckerPrager, yield_surface::MatsuokaNakai, yield_surface::LadeDuncan,
                               yield_surface::MohrCoulomb, yield_surface::TriaxialRatio>;

// Volume fraction of continua, phi(i).
using Dilatancies = Registry<dilatancy::Linear, dilatancy::Rational>;

// Pressure of grains.
using GrainEos = Registry<eos::CompressibleGrains>;

// Viscosity at rest.
using Regularisations = Registry<regularisation::Minatti2015, regularisation::Papanastasiou, regularisation::Simple>;

// Smoothing kernels.
using SphKernels = Registry<kernel::WendlandC2, kernel::WendlandC4>;

// Mean viscosity of two particles.
using ViscosityMeans = Registry<mean::Harmonic, mean::Arithmetic, mean::Geometric>;

// Discrete pressure and viscous forces.
using ViscousOperators = Registry<viscous::Cleary, viscous::Variational>;

}  // namespace bagnold::laws
