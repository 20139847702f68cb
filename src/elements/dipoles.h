#pragma once

#include "hooke/math.h"

#include <cmath>

/// \file
/// Fields and forces of magnetic dipoles in SI units (Jackson, Classical Electrodynamics, 5.6 and 5.7; Yung,
/// Landecker and Villani 1998).

namespace hooke::elements {

/// mu_0 / 4 pi [T m / A]. The measured value is larger by 5e-10 of it (CODATA 2018).
inline constexpr double kMagneticConstant = 1e-7;

/// A dipole has no field nearer than this [m], because there is no direction there.
inline constexpr double kDipoleGap = 1e-6;

/// Flux density in the unit direction n from a dipole, at a distance of 1 / `inverse` [T]:
/// mu_0 / 4 pi (3 (m.n) n - m) inverse^3.
inline DVec3 dipole_field(DVec3 moment, DVec3 n, double inverse) {
  return (kMagneticConstant * (inverse * inverse * inverse)) * (3 * dot(moment, n) * n - moment);
}

/// Force [N] on dipole b, which lies in the unit direction n from dipole a at a distance of 1 / `inverse`: 3
/// mu_0 / 4 pi ((a.n) b + (b.n) a + (a.b) n - 5 (a.n) (b.n) n) inverse^4. With a and b exchanged and n
/// reversed, the result is opposite to the last bit.
inline DVec3 dipole_force(DVec3 a, DVec3 b, DVec3 n, double inverse) {
  const double along_a = dot(a, n);
  const double along_b = dot(b, n);
  const DVec3 sum = along_a * b + along_b * a + (dot(a, b) - 5 * (along_a * along_b)) * n;
  const double square = inverse * inverse;
  return (3 * kMagneticConstant * (square * square)) * sum;
}

/// Flux density at d from a dipole [T]; it is zero nearer than kDipoleGap.
inline DVec3 dipole_field(DVec3 moment, DVec3 d) {
  const double r = length(d);
  return r >= kDipoleGap ? dipole_field(moment, (1 / r) * d, 1 / r) : DVec3{};
}

}  // namespace hooke::elements
