#pragma once

#include "hooke/math.h"

#include <cmath>

/// \file
/// The rotation of a body as three coordinates, so that every method moves it like a point.
///
/// p = 2 tan(angle / 2) axis is the turn since a chart was laid (the vector of Rodrigues, doubled), in world
/// axes. With s = 1 + p.p / 4:
///
///     omega s = p' + p x p' / 2,    p' = omega - p x omega / 2 + (p.omega) p / 4
///
/// and p'' follows from omega' by one more derivative. Nothing but + - * /, so series and directions go
/// through it (series.h). p grows beyond all limits towards half a turn: charts are laid anew before
/// (System::lay_chart). Shuster 1993, "A survey of attitude representations", J. Astronaut. Sci. 41.

namespace hooke::lab {

template <class T>
T rotation_scale(Vector3<T> p) {
  return T(1) + T(0.25) * dot(p, p);
}

/// `v` turned by p.
template <class T>
Vector3<T> turned(Vector3<T> p, Vector3<T> v) {
  const Vector3<T> across = cross(p, v);
  return v + (T(1) / rotation_scale(p)) * (across + T(0.5) * cross(p, across));
}

/// omega of p and p'.
template <class T>
Vector3<T> spin_of(Vector3<T> p, Vector3<T> rate) {
  return (T(1) / rotation_scale(p)) * (rate + T(0.5) * cross(p, rate));
}

/// p' of p and omega.
template <class T>
Vector3<T> rotation_rate(Vector3<T> p, Vector3<T> omega) {
  return omega - T(0.5) * cross(p, omega) + (T(0.25) * dot(p, omega)) * p;
}

/// p as a rotation.
inline Quaternion<double> rotation_of(DVec3 p) {
  const double w = 1 / std::sqrt(rotation_scale(p));
  return {0.5 * w * p.x, 0.5 * w * p.y, 0.5 * w * p.z, w};
}

}  // namespace hooke::lab
