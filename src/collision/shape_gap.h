#pragma once

#include "hooke/shape.h"

#include "state/mesh.h"

#include <cstdint>
#include <vector>

/// \file
/// How far a point is from a static shape, in the shape's frame.

namespace hooke::collision {

/// Signed distance to a shape, negative inside, and the unit normal that leads out.
struct Gap {
  Real distance = Real(0);
  Vec3 normal = {};
};

/// Half-space, sphere or box. The center of a sphere leads up; a point in the middle of a box leaves by its
/// nearest face, the first of x, y, z among equals.
[[nodiscard]] Gap gap_to_shape(const Shape& shape, Vec3 x);

/// One triangle, solid behind its front: over its face the distance is signed, beside it that to the nearest
/// edge.
[[nodiscard]] Gap gap_to_triangle(const state::Mesh& mesh, std::uint32_t triangle, Vec3 x);

/// Triangles within `reach` of a point, in ascending order.
[[nodiscard]] std::vector<std::uint32_t> triangles_near(const state::Mesh& mesh, Vec3 x, Real reach);

/// Signed distance to the nearest triangle within `reach`, or `reach` if there is none.
[[nodiscard]] Real distance_to_mesh(const state::Mesh& mesh, Vec3 x, Real reach);

}  // namespace hooke::collision
