#pragma once

#include "hooke/math.h"

#include "math/trig.h"

#include <array>
#include <numbers>

namespace hooke::elements {

/// The angle between two triangles that share the edge from x0 to x1, and its gradient.
///
///     theta = atan2((n_a x n_b) . e / |e|, n_a . n_b),   e = x1 - x0
///     n_a = (x0 - x2) x (x1 - x2),   n_b = (x1 - x3) x (x0 - x3)
///
/// theta is 0 if flat. A positive angle folds the wings x2 and x3 to the side away from the normals. The
/// gradient follows Bridson, Marino and Fedkiw 2003, "Simulation of clothing with folds and wrinkles".
/// `valid` is false if a triangle or the edge has no extent: then there is no angle, and no force.
template <class T>
struct Dihedral {
  T angle = T(0);
  std::array<Vector3<T>, 4> gradient = {};
  bool valid = false;
};

/// Returns the same angle in (-pi, pi]. `angle` is in (-3 pi, 3 pi].
template <class T>
constexpr T wrapped(T angle) {
  constexpr T kPi = std::numbers::pi_v<T>;
  if (angle > kPi) angle = angle - T(2) * kPi;
  if (angle <= -kPi) angle = angle + T(2) * kPi;
  return angle;
}

template <class T>
Dihedral<T> dihedral(Vector3<T> x0, Vector3<T> x1, Vector3<T> x2, Vector3<T> x3) {
  const Vector3<T> e = x1 - x0;
  const Vector3<T> na = cross(x0 - x2, x1 - x2);
  const Vector3<T> nb = cross(x1 - x3, x0 - x3);
  const T le = length(e);
  const T aa = dot(na, na);
  const T bb = dot(nb, nb);
  if (!(le > T(0)) || !(aa > T(0)) || !(bb > T(0))) return Dihedral<T>();

  Dihedral<T> d;
  d.valid = true;
  using math::atan2;  // The laboratory's power series bring their own atan2.
  d.angle = atan2(dot(cross(na, nb), e) / le, dot(na, nb));
  const Vector3<T> ua = (T(1) / aa) * na;
  const Vector3<T> ub = (T(1) / bb) * nb;
  d.gradient[2] = -le * ua;
  d.gradient[3] = -le * ub;
  d.gradient[0] = (-dot(x2 - x1, e) / le) * ua + (-dot(x3 - x1, e) / le) * ub;
  d.gradient[1] = (dot(x2 - x0, e) / le) * ua + (dot(x3 - x0, e) / le) * ub;
  return d;
}

}  // namespace hooke::elements
