#include "collision/deformable/element_sweep.h"

#include "collision/deformable/deformable_tuning.h"
#include "geometry/closest.h"
#include "math/rotation.h"

#include <algorithm>

namespace hooke::collision {

namespace {

std::array<Real, 3> weights_at(const Convex& element, std::uint32_t count, Vec3 place) {
  const auto& [a, b, c] = element.corners;
  if (count == 2) {
    const Real along = geometry::closest_on_segment(place, a, b).fraction;
    return {Real(1) - along, along, Real(0)};
  }
  const Vec3 w = geometry::closest_on_triangle(place, a, b, c).weights;
  return {w.x, w.y, w.z};
}

/// Upper bound of how much nearer the two come along `normal` in the whole motion [m].
Real closing_distance(const MovingElement& element, const MovingShape& shape, Vec3 normal) {
  Real closing = Real(0);
  for (const Vec3 displacement : element.displacement)
    closing = std::max(closing, dot(normal, shape.displacement - displacement));
  return closing + length(cross(shape.turn, normal)) * shape.reach;
}

}  // namespace

Convex MovingElement::at(Real share) const {
  Convex convex = {.shape = {.kind = ShapeKind::kMesh}};
  for (std::size_t i = 0; i < 3; ++i) convex.corners[i] = corner[i] + share * displacement[i];
  return convex;
}

Convex MovingShape::at(Real share) const {
  Convex moved = convex;
  if (share == Real(0)) return moved;
  const Vec3 shift = share * displacement;
  if (turn == Vec3{}) {
    moved.center += shift;
    return moved;
  }
  const Mat3 rotation = matrix_of(math::quaternion_of(share * turn));
  moved.center = pivot + shift + rotation * (convex.center - pivot);
  moved.axes = rotation * convex.axes;
  return moved;
}

Real relative_displacement(const MovingElement& element, const MovingShape& shape) {
  Real longest = Real(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 lever = element.corner[i] - shape.pivot;
    const Vec3 moved = element.displacement[i] - shape.displacement;
    Real reach = length(moved - cross(shape.turn, lever));
    if (shape.turn != Vec3{}) {
      const Real turn = length(shape.turn);
      reach += turn * (length(moved) + turn * length(lever));
    }
    longest = std::max(longest, reach);
  }
  return longest;
}

ElementMeeting meet(const MovingElement& element, const MovingShape& shape, Real near) {
  ElementMeeting meeting;
  const Real farthest = relative_displacement(element, shape);
  Real share = Real(0);
  for (int round = 0;; ++round) {
    const Convex face = element.at(share);
    const Distance found =
        distance_between(face, shape.at(share), std::max(near, Real(0)) + Real(1.01) * farthest);
    if (found.cores_overlap) {
      meeting.crossed = round == 0;
      meeting.met = round > 0;
      return meeting;
    }
    if (round == 0) meeting.distance = found.distance;
    if (found.normal == Vec3{}) return meeting;  // Too far apart to meet.
    const Vec3 normal = -found.normal;
    const Real left = found.distance - near;
    const Real closing = closing_distance(element, shape, normal);
    const bool nearest = left <= kElementTouchingShare * std::abs(near);
    if (!nearest && closing * (Real(1) - share) <= left) return meeting;
    meeting.share = share;
    meeting.normal = normal;
    meeting.place = found.point_a;
    meeting.weight = weights_at(face, element.count, found.point_a);
    if (nearest || round == kMostMeetingRounds) {
      meeting.met = true;
      meeting.distance = found.distance;
      return meeting;
    }
    share = std::min(share + left / closing, Real(1));
  }
}

}  // namespace hooke::collision
