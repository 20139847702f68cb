#pragma once

#include "hooke/math.h"

#include "state/colliders.h"

#include <cstdint>
#include <optional>

namespace hooke::collision {

/// The first point at which a ray meets a shape.
struct ShapeHit {
  double fraction = 0;         ///< The hit is at origin + fraction motion, in [0, 1].
  DVec3 normal = {};           ///< Outward unit normal.
  std::uint32_t triangle = 0;  ///< Triangle of a mesh.
};

/// The first point of the path from `origin` over `motion` (finite, in the shape's frame) that is in a shape.
/// A path that begins in a solid meets it at 0, and the normal then leads back (zero without a motion). A
/// mesh without MeshTree::kPlanes is met from either side, with the normal of the triangle's front.
[[nodiscard]] std::optional<ShapeHit> cast_ray_on_shape(const state::ColliderShape& shape, DVec3 origin,
                                                        DVec3 motion);

}  // namespace hooke::collision
