#pragma once

namespace bagnold {

constexpr double earth_gravity = 9.81;  // m/s^2

}  // namespace bagnold
