#pragma once

#include "hooke/math.h"
#include "hooke/world.h"

#include "collision/broad_phase/broad_phase.h"
#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// What is where: rays, swept shapes and points against all colliders. A collider is found where its body is
/// now, as far as the box that `broad_phase` has of it reaches. Equally near colliders stand in the order
/// in which their bodies were created.

namespace hooke::collision {

/// Who can be found: what collides, as far as the filters agree.
struct QueryScene {
  static constexpr std::uint32_t kNobody = 0xFFFFFFFF;

  const BroadPhase& broad_phase;
  const state::Bodies& bodies;
  const state::Colliders& colliders;
  FilterDesc filter = {};
  std::uint32_t skip = kNobody;  ///< A body that is not found.
  bool sensors = false;          ///< Sensors too.
};

[[nodiscard]] bool can_be_found(const QueryScene& scene, std::uint32_t collider);

/// Sorts colliders by the creation of their bodies, then by part.
void sort_by_creation(const QueryScene& scene, std::vector<std::uint32_t>& colliders);

struct RayHit {
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;  ///< Of a mesh.
  double fraction = 0;         ///< Of the motion, in [0, 1].
  DVec3 point = {};            ///< [m]
  Vec3 normal = {};            ///< Outward, unit; degenerate cases as in cast_ray_on_shape.
};

/// The first collider on the way from `origin` over `motion` [m] (finite).
[[nodiscard]] std::optional<RayHit> cast_ray(const QueryScene& scene, DVec3 origin, DVec3 motion);

/// Whether there is any.
[[nodiscard]] bool is_ray_blocked(const QueryScene& scene, DVec3 origin, DVec3 motion);

/// Replaces `hits` by the first hit of every collider on the way, in order of fraction.
void cast_ray_through(const QueryScene& scene, DVec3 origin, DVec3 motion, std::vector<RayHit>& hits);

struct ClosestHit {
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;  ///< Of a mesh.
  Real distance = Real(0);     ///< Negative inside [m].
  DVec3 point = {};            ///< On the surface [m].
  Vec3 normal = {};            ///< Outward, unit.
};

/// Replaces `hits` by the nearest surface point of every collider that is at most `reach` (not negative, may
/// be infinite) from `point` or holds it, in order of distance. A mesh without MeshTree::kPlanes is its
/// surface and holds nothing; its normal leads to the side on which the point is.
void find_near(const QueryScene& scene, DVec3 point, Real reach, std::vector<ClosestHit>& hits);

/// The first of those.
[[nodiscard]] std::optional<ClosestHit> find_closest(const QueryScene& scene, DVec3 point, Real reach);

/// The first collider that a convex shape meets on the way of its frame from `start` over `motion` (finite),
/// without turning: conservative advancement (Mirtich, 1996), each time by the way that closes the present
/// gap along its normal. It ends `sweep_tolerance` apart at most. Both sides of a mesh are met.
[[nodiscard]] std::optional<RayHit> cast_shape(const QueryScene& scene, const state::ColliderShape& shape,
                                               const Pose& start, DVec3 motion);

/// Replaces `found` by the colliders that a convex shape overlaps, in order of creation.
void find_overlaps(const QueryScene& scene, const state::ColliderShape& shape, const Pose& pose,
                   std::vector<std::uint32_t>& found);

/// Whether two shapes overlap, of which one is convex; false if none is. A mesh is its surface.
[[nodiscard]] bool shapes_overlap(const state::ColliderShape& a, const Pose& pose_a,
                                  const state::ColliderShape& b, const Pose& pose_b);

}  // namespace hooke::collision
