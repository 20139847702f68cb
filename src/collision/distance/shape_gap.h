#pragma once

#include "hooke/shape.h"

#include "state/colliders.h"
#include "state/mesh.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// How far a point is from a shape, in the shape's frame.

namespace hooke::collision {

/// Signed distance to a shape, negative inside, and the unit normal that leads out.
struct Gap {
  Real distance = Real(0);
  Vec3 normal = {};
};

/// Shapes that are told by their sizes alone, all but hulls and meshes; degenerate places as in
/// geometry/closest.h.
[[nodiscard]] Gap gap_to_shape(const Shape& shape, Vec3 x);
/// Those and hulls.
[[nodiscard]] Gap gap_to_shape(const state::ColliderShape& shape, Vec3 x);

/// One triangle of a mesh that is solid behind its fronts. Over the face the distance is signed; beside it
/// the nearest point is on the rim, and the distance is positive in front of the triangle's plane.
struct TriangleGap {
  Gap gap;
  bool over_face = false;
  Real unsigned_distance = Real(0);
};

[[nodiscard]] TriangleGap gap_to_triangle(const state::Mesh& mesh, std::uint32_t triangle, Vec3 x);

/// Whether a mesh with MeshTree::kPlanes holds the point; nothing for others, which do not know.
[[nodiscard]] std::optional<bool> is_inside(const state::Mesh& mesh, Vec3 x);

/// The gap of a point of which is_inside says where it is: beside the face, the side is that and not the
/// plane's.
[[nodiscard]] Gap gap_on_side(const TriangleGap& gap, std::optional<bool> is_inside);

/// Triangles within `reach` of a point, in ascending order; and the nearest for a point
/// inside a mesh with MeshTree::kPlanes.
void find_triangles_near(const state::Mesh& mesh, Vec3 x, Real reach, std::vector<std::uint32_t>& found);

/// Signed distance to the nearest triangle, or `reach` if none is that near. With MeshTree::kPlanes also
/// deeper inside than `reach`.
[[nodiscard]] Real distance_to_mesh(const state::Mesh& mesh, Vec3 x, Real reach);

}  // namespace hooke::collision
