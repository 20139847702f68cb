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

/// By what a mesh is asked.
enum class MeshTree : std::uint8_t {
  kBoxes,   ///< Its triangles in a tree of boxes: any mesh, a surface that rays meet from both sides.
  kPlanes,  ///< Also a BSP tree (hooke/bsp.h), of a closed mesh: a solid. Points of ropes, cloths and
            ///< particles are pushed out from any depth; what begins inside a ray meets at once, and closest
            ///< points know their depth. Rays take two to five times as long. Bodies meet its triangles.
};

enum class ShapeKind : std::uint8_t {
  kHalfSpace,  ///< Solid below the plane y = 0 of its frame.
  kSphere,
  kBox,
  kMesh,  ///< Triangles, solid on the inner side of each. Of a dynamic body: a closed surface, which has the
          ///< mass of its inside and collides by its convex parts (decompose_convex). One that crosses itself
          ///< so that it bounds no matter has the mass of these parts.
  kCapsule,   ///< A cylinder along y between two half spheres.
  kCylinder,  ///< Along y, its center at the origin.
  kCone,      ///< Along y, the tip up; the origin is halfway up, not the center of mass.
  kHull,      ///< The convex hull of a mesh's points.
  kCompound,  ///< The shapes in BodyDesc::parts. Not of a part.
};

struct Shape {
  ShapeKind kind = ShapeKind::kHalfSpace;
  Real radius = Real(0.5);       ///< Sphere, capsule, cylinder, base of a cone [m], positive.
  Real half_height = Real(0.5);  ///< Cylinder, cone; of a capsule without its half spheres [m], positive.
  Vec3 half_extents = {Real(0.5), Real(0.5), Real(0.5)};  ///< Box [m], each positive.
  MeshId mesh = {};                                       ///< Mesh, hull.

  static constexpr Shape half_space() { return {.kind = ShapeKind::kHalfSpace}; }
  static constexpr Shape sphere(Real radius) { return {.kind = ShapeKind::kSphere, .radius = radius}; }
  static constexpr Shape box(Vec3 half_extents) {
    return {.kind = ShapeKind::kBox, .half_extents = half_extents};
  }
  static constexpr Shape capsule(Real radius, Real half_height) {
    return {.kind = ShapeKind::kCapsule, .radius = radius, .half_height = half_height};
  }
  static constexpr Shape cylinder(Real radius, Real half_height) {
    return {.kind = ShapeKind::kCylinder, .radius = radius, .half_height = half_height};
  }
  static constexpr Shape cone(Real radius, Real half_height) {
    return {.kind = ShapeKind::kCone, .radius = radius, .half_height = half_height};
  }
  static constexpr Shape of_mesh(MeshId mesh) { return {.kind = ShapeKind::kMesh, .mesh = mesh}; }
  static constexpr Shape compound() { return {.kind = ShapeKind::kCompound}; }
  static constexpr Shape hull_of(MeshId mesh) { return {.kind = ShapeKind::kHull, .mesh = mesh}; }
};

}  // namespace hooke
