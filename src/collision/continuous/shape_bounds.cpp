#include "collision/continuous/shape_bounds.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

using geometry::Box;

Vec3 absolute(Vec3 v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// Half sizes of the world box around a box of `half_extents` rotated by `rotation`.
Vec3 rotated_extents(Quat rotation, Vec3 half_extents) {
  const Mat3 r = matrix_of(rotation);
  return half_extents.x * absolute(r.x) + half_extents.y * absolute(r.y) + half_extents.z * absolute(r.z);
}

/// Half sizes of the box around a disc of radius r across the unit vector `axis`: r sqrt(1 - axis_i^2).
Vec3 disc_extents(Vec3 axis, Real radius) {
  const auto side = [&](Real a) { return radius * std::sqrt(std::max(Real(0), Real(1) - a * a)); };
  return {side(axis.x), side(axis.y), side(axis.z)};
}

Box around(Vec3 center, Vec3 half) {
  return {center - half, center + half};
}

/// The bounds in axes parallel to the world's, about the origin of the shape's frame.
Box local_bounds(const state::ColliderShape& s, Quat rotation) {
  const Vec3 axis = rotate(rotation, Vec3{Real(0), Real(1), Real(0)});
  const Real r = s.shape.radius;
  switch (s.shape.kind) {
    case ShapeKind::kHalfSpace:
      return {{-Box::kFar, -Box::kFar, -Box::kFar}, {Box::kFar, Box::kFar, Box::kFar}};
    case ShapeKind::kSphere:
      return around({}, {r, r, r});
    case ShapeKind::kCapsule:
      return around({}, s.shape.half_height * absolute(axis) + Vec3{r, r, r});
    case ShapeKind::kBox:
      return around({}, rotated_extents(rotation, s.shape.half_extents));
    case ShapeKind::kCylinder:
      return around({}, s.shape.half_height * absolute(axis) + disc_extents(axis, r));
    case ShapeKind::kCone: {
      const Vec3 tip = s.shape.half_height * axis;
      return geometry::merge(around(-tip, disc_extents(axis, r)), tip);
    }
    case ShapeKind::kHull: {
      Box box;
      HOOKE_ASSERT(s.hull && !s.hull->vertices.empty());
      for (const Vec3 v : s.hull->vertices) {
        const Vec3 p = rotate(rotation, v);
        box = {geometry::min_of(box.lower, p), geometry::max_of(box.upper, p)};
      }
      return box;
    }
    case ShapeKind::kMesh: {
      HOOKE_ASSERT(s.mesh && !s.mesh->bvh.nodes.empty());
      const geometry::BvhNode& root = s.mesh->bvh.nodes.front();
      const Vec3 center = rotate(rotation, Real(0.5) * (root.lower + root.upper));
      return around(center, rotated_extents(rotation, Real(0.5) * (root.upper - root.lower)));
    }
    case ShapeKind::kCompound:
      break;
  }
  return {};
}

/// The nearest float that is not above (below) a sum in double.
Real round_down(double value) {
  const auto near = static_cast<Real>(value);
  return static_cast<double>(near) > value ? std::nextafter(near, -Box::kFar) : near;
}

Real round_up(double value) {
  const auto near = static_cast<Real>(value);
  return static_cast<double>(near) < value ? std::nextafter(near, Box::kFar) : near;
}

}  // namespace

Box bounds_of(const state::ColliderShape& shape, const Pose& pose) {
  const Box local = local_bounds(shape, pose.rotation);
  const DVec3 lower = pose.position + vector_cast<double>(local.lower);
  const DVec3 upper = pose.position + vector_cast<double>(local.upper);
  return {{round_down(lower.x), round_down(lower.y), round_down(lower.z)},
          {round_up(upper.x), round_up(upper.y), round_up(upper.z)}};
}

Box reach_of(const state::Bodies& bodies, const state::Colliders& colliders, std::uint32_t collider,
             Real dt) {
  return reach_of(colliders, collider, path_ahead(bodies, colliders.body[collider], dt));
}

Box reach_of(const state::Colliders& colliders, std::uint32_t collider, const Path& path) {
  const Pose pose = {path.center + vector_cast<double>(rotate(path.rotation, colliders.position[collider])),
                     path.rotation * colliders.rotation[collider]};
  const Box now = bounds_of(colliders.shape[collider], pose);
  // No point of the body moves farther by rotation than its diameter.
  const Real turn = std::min(length(path.turn), Real(2)) * path.radius;
  const Vec3 pad = {kReachMargin + turn, kReachMargin + turn, kReachMargin + turn};
  return {geometry::min_of(now.lower, now.lower + path.displacement) - pad,
          geometry::max_of(now.upper, now.upper + path.displacement) + pad};
}

}  // namespace hooke::collision
