#pragma once

#include "hooke/id.h"
#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// What collides and what is drawn: shapes in their own frame, and meshes of triangles that they refer to.

namespace hooke {

/// A mesh of triangles, counter-clockwise seen from outside. World::add_mesh copies it.
struct MeshDesc {
  std::vector<Vec3> positions = {};  ///< Vertices in the mesh's own frame [m]. At most 2^24, all finite.
  /// Three indices into `positions` for each triangle. At most 2^25 triangles.
  std::vector<std::array<std::uint32_t, 3>> triangles = {};
};

/// The structure in which queries and contacts look for the triangles of a mesh.
enum class MeshTree : std::uint8_t {
  /// A tree of boxes around the triangles. It takes any mesh, as a surface that rays meet from both sides.
  kBoxes,
  /// A BSP tree (hooke/bsp.h) besides, for a closed mesh, which then is a solid. Points of ropes, cloths and
  /// particles are pushed out from any depth. A ray that starts inside hits at once, and closest points know
  /// their depth. Rays take two to five times as long. Bodies still collide with the triangles.
  kPlanes,
};

/// The kinds of shape. Each has a frame of its own, whose y axis points up.
enum class ShapeKind : std::uint8_t {
  kHalfSpace,  ///< All that is below the plane y = 0. It has no mass, and no dynamic body may have it.
  kSphere,     ///< A ball about the origin.
  kBox,        ///< A box about the origin, with its edges along the axes.
  /// The triangles of a mesh, solid on the inner side of each. A dynamic body needs a closed surface: it has
  /// the mass of the inside and collides by convex parts (decompose_convex). If the surface crosses itself so
  /// that it encloses no volume, the body has the mass of these parts.
  kMesh,
  kCapsule,   ///< A cylinder along y between two half spheres, about the origin.
  kCylinder,  ///< A cylinder along y, about the origin.
  kCone,      ///< A cone along y, the tip up. The origin is halfway up, which is not the center of mass.
  kHull,      ///< The convex hull of a mesh's points.
  kCompound,  ///< The shapes in BodyDesc::parts. A part may not be a compound itself.
};

/// A shape with its sizes. Only the fields that belong to `kind` are read. Sizes are 1e-6 to 1e6 m.
struct Shape {
  ShapeKind kind = ShapeKind::kHalfSpace;  ///< Says which of the other fields count.
  Real radius = Real(0.5);  ///< Radius of a sphere, capsule or cylinder, or of the base of a cone [m].
  /// Half the height of a cylinder or cone, or of a capsule without its half spheres [m].
  Real half_height = Real(0.5);
  Vec3 half_extents = {Real(0.5), Real(0.5), Real(0.5)};  ///< Half the lengths of a box along x, y and z [m].
  MeshId mesh = {};                                       ///< The mesh of a mesh or hull.

  ///@{
  /// Makes a shape of that kind from its sizes [m]. Sizes are not checked before the shape is used.
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
  ///@}
};

}  // namespace hooke
