#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "elements/dipoles.h"

#include <cmath>

namespace hooke::elements {

/// Acceleration [m/s^2] towards a center, at the offset d from it: -strength d / |d|^3; zero at the center
/// itself.
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

/// (1 - r / reach)^falloff; it is zero from `reach` on.
inline double falloff(const FieldDesc& field, double r) {
  if (!(r < field.reach)) return 0;
  double share = 1;
  for (int i = 0; i < field.falloff; ++i) share *= 1 - r / field.reach;
  return share;
}

/// Value of a radial field at d from its center, directed away from it; zero at the center. The unit is that
/// of `strength`.
inline DVec3 radial(const FieldDesc& field, DVec3 d) {
  const double r = length(d);
  return r > 0 ? (field.strength * falloff(field, r) / r) * d : DVec3{};
}

/// Value of a vortex at d from its center, counter-clockwise about its axis; zero on the axis.
inline DVec3 swirl(const FieldDesc& field, DVec3 d) {
  const DVec3 axis = normalize(vector_cast<double>(field.vector));
  const DVec3 across = cross(axis, d);
  const double r = length(across);
  return r > 0 ? (field.strength * falloff(field, r) / r) * across : DVec3{};
}

/// Acceleration [m/s^2] that a field gives at x to whatever is there. It is zero for fields whose effect
/// depends on more than the position.
inline DVec3 acceleration(const FieldDesc& field, DVec3 x) {
  switch (field.kind) {
    case FieldDesc::Kind::kUniform:
      return vector_cast<double>(field.vector);
    case FieldDesc::Kind::kInverseSquare:
      return attraction(x - field.center, field.strength);
    case FieldDesc::Kind::kSuction:
      return -radial(field, x - field.center);
    case FieldDesc::Kind::kVortex:
      return swirl(field, x - field.center);
    case FieldDesc::Kind::kMagnetic:
    case FieldDesc::Kind::kLiquid:
    case FieldDesc::Kind::kExplosion:
    case FieldDesc::Kind::kDipole:
      break;
  }
  return {};
}

/// The gradient of a magnetic field times d. For an offset d [m] it is the change of the flux density [T],
/// for a moment d [A m^2] the force [N]. The gradient is symmetric and without trace, because there are no
/// currents.
inline DVec3 times_gradient(const FieldDesc& field, DVec3 d) {
  const DVec3 axis = normalize(vector_cast<double>(field.vector));
  return (0.5 * field.strength) * (3 * dot(axis, d) * axis - d);
}

/// Flux density at x [T]; it is zero for a field that is not magnetic.
inline DVec3 flux_density(const FieldDesc& field, DVec3 x) {
  if (field.kind == FieldDesc::Kind::kMagnetic)
    return vector_cast<double>(field.vector) + times_gradient(field, x - field.center);
  if (field.kind == FieldDesc::Kind::kDipole)
    return dipole_field(vector_cast<double>(field.vector), x - field.center);
  return {};
}

}  // namespace hooke::elements
