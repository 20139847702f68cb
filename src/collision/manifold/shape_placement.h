#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_mesh.h"
#include "state/colliders.h"

#include <cstdint>

/// \file
/// Shapes of bodies where they stand, for tests of one pair.

namespace hooke::collision {

/// The collider's shape seen from its body's center of mass, of a body turned by `rotation`.
[[nodiscard]] Convex place(const state::Colliders& colliders, std::uint32_t collider, Quat rotation);

/// The mesh of a shape placed by `place` on a body with its center of mass `from` the origin of the offsets
/// [m], which is taken in double: meshes may be wide.
[[nodiscard]] PlacedMesh place_mesh(const state::ColliderShape& shape, const Convex& place, DVec3 from);

/// How high the point `from` a body's center of mass is over a half-space placed by `place` on it [m].
[[nodiscard]] Real height_over(const Convex& half_space, DVec3 from);

}  // namespace hooke::collision
