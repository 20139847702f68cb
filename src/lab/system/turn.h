#pragma once

#include "hooke/math.h"

#include <cmath>

/// \file
/// Represents the rotation of a body by three coordinates, so that every method moves it like a point.
///
/// p = 2 tan(angle / 2) axis is the rotation since the last chart was laid (twice the vector of Rodrigues),
/// in world axes. A chart is a rotation that serves as origin. With s = 1 + p.p / 4:
///
/// omega s = p' + p x p' / 2,    p' = omega - p x omega / 2 + (p.omega) p / 4
///
/// and p'' follows from omega' by one more derivative. This uses only + - * /, so that series and directional
/// derivatives go through it (series.h). p grows beyond all limits towards half a turn, so System::lay_chart
/// lays a new chart before. Shuster 1993, "A survey of attitude representations", J. Astronaut. Sci. 41.

namespace hooke::lab {

template <class T>
T rotation_scale(Vector3<T> p) {
  return T(1) + T(0.25) * dot(p, p);
}

/// Returns `v` rotated by p.
template <class T>
Vector3<T> turned(Vector3<T> p, Vector3<T> v) {
  const Vector3<T> across = cross(p, v);
  return v + (T(1) / rotation_scale(p)) * (across + T(0.5) * cross(p, across));
}

/// Returns omega for p and p'.
template <class T>
Vector3<T> spin_of(Vector3<T> p, Vector3<T> rate) {
  return (T(1) / rotation_scale(p)) * (rate + T(0.5) * cross(p, rate));
}

/// Returns p' for p and omega.
template <class T>
Vector3<T> rotation_rate(Vector3<T> p, Vector3<T> omega) {
  return omega - T(0.5) * cross(p, omega) + (T(0.25) * dot(p, omega)) * p;
}

/// Returns the quaternion of p.
inline Quaternion<double> rotation_of(DVec3 p) {
  const double w = 1 / std::sqrt(rotation_scale(p));
  return {0.5 * w * p.x, 0.5 * w * p.y, 0.5 * w * p.z, w};
}

}  // namespace hooke::lab
