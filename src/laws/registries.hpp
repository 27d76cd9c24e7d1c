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

namespace bagnold::laws {

// Normal contact forces.
using NormalLaws = Registry<
    Linear,
    Hertz>;

// Tangential contact forces.
using TangentialLaws = Registry<
    LinearHistory,
    Mindlin>;

// Resistance to rolling.
using RollingLaws = Registry<
    NoRollingResistance,
    SpringSlider>;

// Coarse-graining functions.
using CgKernels = Registry<
    CgGaussian,
    CgLucy,
    CgHeaviside>;

// Basal friction of the depth-averaged layer, mu(h, F).
using FrictionLaws = Registry<
    Coulomb,
    PouliquenForterre,
    ExponentialFriction,
    Jenkins,
    Voellmy,
    MuOfI>;

// Mean solid volume fraction of the layer as a function of the friction angle.
using DensityLaws = Registry<
    ConstantDensity,
    ExponentialAngleDensity>;

// Ratio of the normal stresses K = sigma_xx/sigma_zz.
using StressRatioLaws = Registry<
    ConstantStressRatio,
    LinearAngleStressRatio>;

// Shape factor alpha = mean(u^2)/mean(u)^2.
using ShapeFactorLaws = Registry<
    ConstantShapeFactor,
    StrainModelShapeFactor>;

}  // namespace bagnold::laws
