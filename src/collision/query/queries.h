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
/// Finds colliders with rays, swept shapes and points. A collider is found where its body is now, as far as
/// its box in `broad_phase` reaches. Equally near colliders stand in the order in which their bodies were
/// created.

namespace hooke::collision {

/// The bodies that can be found: those that collide, if the filters agree.
struct QueryScene {
  static constexpr std::uint32_t kNobody = 0xFFFFFFFF;

  const BroadPhase& broad_phase;
  const state::Bodies& bodies;
  const state::Colliders& colliders;
  FilterDesc filter = {};
  std::uint32_t skip = kNobody;  ///< Body that is not found.
  bool sensors = false;          ///< Whether sensors are found too.
};

[[nodiscard]] bool can_be_found(const QueryScene& scene, std::uint32_t collider);

/// Sorts colliders by the creation of their bodies, then by part.
void sort_by_creation(const QueryScene& scene, std::vector<std::uint32_t>& colliders);

struct RayHit {
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;  ///< Triangle of a mesh.
  double fraction = 0;         ///< Fraction of the motion, in [0, 1].
  DVec3 point = {};            ///< Point of the hit [m].
  Vec3 normal = {};            ///< Outward unit normal; degenerate cases as in cast_ray_on_shape.
};

/// The first collider in the path from `origin` over `motion` [m] (finite).
[[nodiscard]] std::optional<RayHit> cast_ray(const QueryScene& scene, DVec3 origin, DVec3 motion);

/// Whether any collider is in that path.
[[nodiscard]] bool is_ray_blocked(const QueryScene& scene, DVec3 origin, DVec3 motion);

/// Replaces `hits` by the first hit of every collider in that path, in order of fraction.
void cast_ray_through(const QueryScene& scene, DVec3 origin, DVec3 motion, std::vector<RayHit>& hits);

struct ClosestHit {
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;  ///< Triangle of a mesh.
  Real distance = Real(0);     ///< Distance, negative inside [m].
  DVec3 point = {};            ///< Point on the surface [m].
  Vec3 normal = {};            ///< Outward unit normal.
};

/// Replaces `hits` by the nearest surface point of every collider that is at most `reach` (not negative, may
/// be infinite) from `point` or holds it, in order of distance. A mesh without MeshTree::kPlanes is its
/// surface and holds nothing; its normal leads to the side of the point.
void find_near(const QueryScene& scene, DVec3 point, Real reach, std::vector<ClosestHit>& hits);

/// The first of the hits of find_near.
[[nodiscard]] std::optional<ClosestHit> find_closest(const QueryScene& scene, DVec3 point, Real reach);

/// The first collider that a convex shape meets when its frame moves from `start` over `motion` (finite),
/// without rotation. Uses conservative advancement (Mirtich, 1996); each step is the displacement that closes
/// the present gap along its normal. It ends at most `sweep_tolerance` apart. A mesh is met from both sides.
[[nodiscard]] std::optional<RayHit> cast_shape(const QueryScene& scene, const state::ColliderShape& shape,
                                               const Pose& start, DVec3 motion);

/// Replaces `found` by the colliders that a convex shape overlaps, in order of creation.
void find_overlaps(const QueryScene& scene, const state::ColliderShape& shape, const Pose& pose,
                   std::vector<std::uint32_t>& found);

/// Whether two shapes overlap, of which at least one is convex; false if none is. A mesh is its surface.
[[nodiscard]] bool shapes_overlap(const state::ColliderShape& a, const Pose& pose_a,
                                  const state::ColliderShape& b, const Pose& pose_b);

}  // namespace hooke::collision
