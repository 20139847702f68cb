#pragma once

#include "hooke/math.h"

namespace hooke::elements {

/// Length of a vector; 0 if the vector is zero, where the square root of a power series in time is not
/// finite.
template <class T>
T length_or_zero(Vector3<T> a) {
  return length_squared(a) > T(0) ? length(a) : T(0);
}

/// Force [N] of air of density rho on a triangle. `flow` u is the velocity of the air relative to the
/// triangle, and `normal` is the cross product of two of its edges, of length 2 A:
///
///     F = rho A |u| cos(a) (C_d u + C_l |u| e) / 2,   cos(a) = |n.u| / |u|,   e = n - (n.u) u / |u|^2
///
/// n is turned to the side on which the air comes out. The force is zero on a triangle without area and in
/// still air.
template <class T>
Vector3<T> triangle_air_force(Vector3<T> flow, Vector3<T> normal, double density, double drag, double lift) {
  const T area2 = length_or_zero(normal);
  const T speed = length_or_zero(flow);
  if (!(area2 > T(0)) || !(speed > T(0))) return {};
  const T along = dot(normal, flow) / area2;
  const Vector3<T> n = (T(along < T(0) ? -1 : 1) / area2) * normal;
  const T across = along < T(0) ? -along : along;  // |u| cos(a)
  const Vector3<T> e = n - (across / (speed * speed)) * flow;
  return (0.25 * density * area2 * across) * (drag * flow + (lift * speed) * e);
}

/// Force [N] of the air on a strand along `axis`, which may have any length: F = rho C_d D L |u_t| u_t / 2.
/// u_t is the part of the flow across the strand, and `half_rho_area` is rho C_d D L / 2.
template <class T>
Vector3<T> strand_air_force(Vector3<T> flow, Vector3<T> axis, double half_rho_area) {
  const T l2 = length_squared(axis);
  const Vector3<T> across = l2 > T(0) ? flow - (dot(flow, axis) / l2) * axis : flow;
  return (half_rho_area * length_or_zero(across)) * across;
}

/// Drag [N] on a point: F = (c + rho (C_d A / 2) |u|) u. `half_rho_area` is rho C_d A / 2.
template <class T>
Vector3<T> point_air_force(Vector3<T> flow, double viscous, double half_rho_area) {
  return (viscous + half_rho_area * length_or_zero(flow)) * flow;
}

}  // namespace hooke::elements
