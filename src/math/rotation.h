#pragma once

#include "hooke/math.h"

#include "math/trig.h"

#include <cmath>
#include <numbers>

namespace hooke::math {

/// Returns the same rotation in double, normalized anew, because what it rotates may be far from the origin.
template <class T>
Quaternion<double> in_double(Quaternion<T> q) {
  return normalize(Quaternion<double>{static_cast<double>(q.x), static_cast<double>(q.y),
                                      static_cast<double>(q.z), static_cast<double>(q.w)});
}

/// Returns the same rotation in Real, as tables hold it.
inline Quat in_real(Quaternion<double> q) {
  return {static_cast<Real>(q.x), static_cast<Real>(q.y), static_cast<Real>(q.z), static_cast<Real>(q.w)};
}

/// Returns the rotation by |phi| [rad] about phi, of unit length to rounding, from + - * / and sqrt only. Up
/// to a quarter of a radian it takes the first terms of the series of sine and cosine, which are exact there
/// to 3e-16.
template <class T>
Quaternion<T> quaternion_of(Vector3<T> phi) {
  const Vector3<T> half = T(0.5) * phi;
  const T x2 = length_squared(half);
  if (x2 < T(1) / T(64)) {
    const auto term = [x2](double divisor) { return static_cast<T>(1 / divisor) * x2; };
    const T sine = T(1) - term(6) * (T(1) - term(20) * (T(1) - term(42) * (T(1) - term(72))));
    const T cosine = T(1) - term(2) * (T(1) - term(12) * (T(1) - term(30) * (T(1) - term(56))));
    return {sine * half.x, sine * half.y, sine * half.z, cosine};
  }
  const T x = std::sqrt(x2);
  const SinCos<T> angle = sin_cos(x);
  const T s = angle.sin / x;
  return {s * half.x, s * half.y, s * half.z, angle.cos};
}

/// Returns the multiple of 2 pi nearest to an angle [rad].
inline double whole_turns(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return kTurn * std::floor(angle / kTurn + 0.5);
}

/// Returns the rotation vector [rad] that leads from `before` to `after`. There is one for each number of
/// whole turns; the result is the one nearest to `about`.
template <class T>
Vector3<T> turn_between(Quaternion<T> before, Quaternion<T> after, Vector3<T> about) {
  const Quaternion<T> q = after * conjugate(before);
  const Vector3<T> sine = {q.x, q.y, q.z};
  const T size = length(sine);
  if (size == T(0) && about == Vector3<T>{}) return {};
  const Vector3<T> axis = size > T(0) ? (T(1) / size) * sine : normalize(about);
  const T angle = T(2) * atan2(size, q.w);
  const T whole = T(2) * std::numbers::pi_v<T>;
  return (angle + whole * std::round((dot(axis, about) - angle) / whole)) * axis;
}

}  // namespace hooke::math
