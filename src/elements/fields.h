#pragma once

#include "hooke/math.h"

namespace hooke::elements {

/// Acceleration towards a center at offset `d` [m/s^2]: -strength d / |d|^3; none at the center itself.
template <class T>
Vector3<T> attraction(Vector3<T> d, double strength) {
  const T r2 = length_squared(d);
  if (!(r2 > T(0))) return {};
  using std::sqrt;
  return (-strength / (r2 * sqrt(r2))) * d;
}

/// Force on a charge [N]: q v x B.
template <class T>
Vector3<T> magnetic_force(Vector3<T> v, DVec3 field, double charge) {
  return charge * cross(v, Vector3<T>{T(field.x), T(field.y), T(field.z)});
}

}  // namespace hooke::elements
