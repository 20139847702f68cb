#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_mesh.h"
#include "state/colliders.h"

#include <cstdint>

/// \file
/// Shapes of bodies with their positions and rotations, for tests of one pair.

namespace hooke::collision {

/// The collider's shape relative to its body's center of mass, for a body rotated by `rotation`.
[[nodiscard]] Convex place(const state::Colliders& colliders, std::uint32_t collider, Quat rotation);

/// The mesh of a shape placed by `place`. `from` leads from the body's center of mass to the origin of the
/// offsets [m]. It is in double, because meshes may be wide.
[[nodiscard]] PlacedMesh place_mesh(const state::ColliderShape& shape, const Convex& place, DVec3 from);

/// Height over a half-space, placed by `place`, of the point at `from` relative to its body's center of mass
/// [m].
[[nodiscard]] Real height_over(const Convex& half_space, DVec3 from);

}  // namespace hooke::collision
