#pragma once

#include "hooke/math.h"

#include "geometry/box.h"

#include <span>

/// \file
/// Volumes around points, in double: spheres, boxes along the axes, boxes that rotate with the object. Each
/// of them contains all its points, to rounding. Points must be finite and below 1e100; without any the
/// volume is empty.

namespace hooke::geometry {

/// The pose of an object: its points are rotated, then shifted [m].
struct RigidPose {
  DVec3 position = {};
  Quaternion<double> rotation = {};  ///< Unit rotation.
};

/// The point of the object's frame in the world.
[[nodiscard]] inline DVec3 to_world(const RigidPose& pose, DVec3 p) {
  return rotate(pose.rotation, p) + pose.position;
}
/// The point of the world in the object's frame.
[[nodiscard]] inline DVec3 to_local(const RigidPose& pose, DVec3 p) {
  return rotate(conjugate(pose.rotation), p - pose.position);
}
/// The pose of `object` in the frame of `seen_from`.
[[nodiscard]] inline RigidPose relative_pose(const RigidPose& object, const RigidPose& seen_from) {
  return {to_local(seen_from, object.position), normalize(conjugate(seen_from.rotation) * object.rotation)};
}

struct BoundingSphere {
  DVec3 center = {};
  double radius = -1;  ///< Radius [m]; negative: empty.
};

using DBox = Box3<double>;

/// A box with any rotation.
struct OrientedBox {
  DVec3 center = {};
  Matrix3<double> axes = {};          ///< The columns are the axes, of length one and at right angles.
  DVec3 half_extents = {-1, -1, -1};  ///< Half extents along the axes [m]; negative: empty.
};

/// The smallest sphere around the points. The point farthest outside joins the support. The smallest sphere
/// of at most five points is found among the spheres through two, three or four of them, and so on until no
/// point is outside by more than 1e-12 of the radius (Gaertner 1999, Fast and robust smallest enclosing
/// balls: its pivot rule). It takes a handful of passes over the points.
[[nodiscard]] BoundingSphere minimum_sphere(std::span<const DVec3> points);

/// The paper's sphere (4.3.1): it is about the mean of the vertices and reaches to the farthest. It is up to
/// twice too large.
[[nodiscard]] BoundingSphere vertex_sphere(std::span<const DVec3> points);

[[nodiscard]] DBox bounds_of(std::span<const DVec3> points);

/// The box with the given axes.
[[nodiscard]] OrientedBox box_along(const Matrix3<double>& axes, std::span<const DVec3> points);

/// A tight box. It is the smallest in volume of these: the boxes that lie with a side on a face of the convex
/// hull (and with another on an edge of it seen along that face's normal), the one along the principal axes
/// of the points, and the one along the coordinate axes. The smallest box of all may have its sides on edges
/// only (O'Rourke 1985, Finding minimal enclosing boxes): for a regular tetrahedron it is a cube, which this
/// does not find.
[[nodiscard]] OrientedBox tight_box(std::span<const DVec3> points);

/// Volume [m^3]; 0 for an empty one.
[[nodiscard]] double volume_of(const BoundingSphere& sphere);
[[nodiscard]] double volume_of(const DBox& box);
[[nodiscard]] double volume_of(const OrientedBox& box);

/// Whether volumes of two objects, the second one's at `b_in_a` in the frame of the first, may be within
/// `margin` [m] of each other. The answer no is certain, because rounding counts for yes. Boxes along the
/// axes are replaced by the box around the rotated one; oriented ones are compared by the 15 axes of
/// Gottschalk, Lin and Manocha (1996, OBBTree).
[[nodiscard]] bool may_overlap(const BoundingSphere& a, const BoundingSphere& b, const RigidPose& b_in_a,
                               double margin);
[[nodiscard]] bool may_overlap(const DBox& a, const DBox& b, const RigidPose& b_in_a, double margin);
[[nodiscard]] bool may_overlap(const OrientedBox& a, const OrientedBox& b, const RigidPose& b_in_a,
                               double margin);

/// Squared distance of a point, 0 inside [m^2].
[[nodiscard]] double distance_squared(const BoundingSphere& sphere, DVec3 p);
[[nodiscard]] double distance_squared(const OrientedBox& box, DVec3 p);

}  // namespace hooke::geometry
