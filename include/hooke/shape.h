#pragma once

#include "hooke/id.h"
#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// What collides and what is drawn: shapes in their own frame, and the triangles they may refer to.

namespace hooke {

/// Triangles, counter-clockwise seen from outside. Copied by World::add_mesh.
struct MeshDesc {
  std::vector<Vec3> positions = {};  ///< [m], in the mesh's own frame. At most 2^24, all finite.
  std::vector<std::array<std::uint32_t, 3>> triangles = {};  ///< Indices into `positions`. At most 2^25.
};

enum class ShapeKind : std::uint8_t {
  kHalfSpace,  ///< Solid below the plane y = 0 of its frame.
  kSphere,
  kBox,
  kMesh,  ///< Triangles, solid on the inner side of each.
};

struct Shape {
  ShapeKind kind = ShapeKind::kHalfSpace;
  Real radius = Real(0.5);                                ///< Sphere [m], positive.
  Vec3 half_extents = {Real(0.5), Real(0.5), Real(0.5)};  ///< Box [m], each positive.
  MeshId mesh = {};                                       ///< Mesh.

  static constexpr Shape half_space() { return {.kind = ShapeKind::kHalfSpace}; }
  static constexpr Shape sphere(Real radius) { return {.kind = ShapeKind::kSphere, .radius = radius}; }
  static constexpr Shape box(Vec3 half_extents) {
    return {.kind = ShapeKind::kBox, .half_extents = half_extents};
  }
  static constexpr Shape of_mesh(MeshId mesh) { return {.kind = ShapeKind::kMesh, .mesh = mesh}; }
};

}  // namespace hooke
