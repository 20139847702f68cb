#pragma once

#include <numbers>

namespace hooke::test {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kGravity = 9.81;  ///< The default of WorldDesc [m/s^2].

}  // namespace hooke::test
