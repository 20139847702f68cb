#pragma once

#include "hooke/math.h"

#include "collision/broad_phase.h"
#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

/// \file
/// What is where: rays and points against all colliders. A collider is found where it is at the start of the
/// step, as far as the box that `broad_phase` has of it reaches.

namespace hooke::collision {

/// Who can be found.
struct QueryScene {
  const BroadPhase& broad_phase;
  const state::Bodies& bodies;
  const state::Colliders& colliders;
  std::uint32_t mask = 0xFFFFFFFF;  ///< Bodies of these categories (FilterDesc).
  bool sensors = false;             ///< Sensors too.
};

struct RayHit {
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;  ///< Of a mesh.
  double fraction = 0;         ///< Of the motion, in [0, 1].
  DVec3 point = {};            ///< [m]
  Vec3 normal = {};            ///< Outward, unit; degenerate cases as in cast_ray_on_shape.
};

/// The first collider on the way from `origin` over `motion` [m] (finite); of equally near ones the lowest.
[[nodiscard]] std::optional<RayHit> cast_ray(const QueryScene& scene, DVec3 origin, DVec3 motion);

/// Replaces `hits` by the first hit of every collider on the way, in order of (fraction, collider).
void cast_ray_through(const QueryScene& scene, DVec3 origin, DVec3 motion, std::vector<RayHit>& hits);

struct ClosestHit {
  std::uint32_t collider = 0;
  Real distance = Real(0);  ///< Negative inside [m].
  DVec3 point = {};         ///< On the surface [m].
  Vec3 normal = {};         ///< Outward, unit.
};

/// Replaces `hits` by the nearest surface point of every collider that is at most `reach` (not negative, may
/// be infinite) from `point` or holds it, in order of (distance, collider). A mesh holds what is behind its
/// nearest triangle.
void find_near(const QueryScene& scene, DVec3 point, Real reach, std::vector<ClosestHit>& hits);

/// The first of those.
[[nodiscard]] std::optional<ClosestHit> find_closest(const QueryScene& scene, DVec3 point, Real reach);

}  // namespace hooke::collision
