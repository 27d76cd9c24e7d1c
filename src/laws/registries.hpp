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

}  // namespace bagnold::laws
