#pragma once

#include "render/draw_list.h"

#include <span>

/// \file
/// Triangles for common things. All outward normals, counter-clockwise, with texture coordinates.

namespace hooke::render {

/// A box of `half_size` about the origin; every side shows the whole texture.
MeshGeometry make_box(Vec3 half_size);

/// A sphere of radius 1 about the origin: an icosahedron, each triangle split in four `splits` times (0 to
/// 6).
MeshGeometry make_sphere(int splits);

/// A cylinder of `radius` along y from -half_height to half_height, with a half sphere on both ends.
/// `half_height` 0 is a sphere.
MeshGeometry make_capsule(float radius, float half_height);

/// A cylinder of `radius` along y from -half_height to half_height, with flat ends.
MeshGeometry make_cylinder(float radius, float half_height);

/// A cone along y: a disk of `radius` at -half_height, the tip at half_height.
MeshGeometry make_cone(float radius, float half_height);

/// Smooth normals from the triangles, weighted by area. Vertices of no triangle keep theirs. Raises the
/// vertex revision.
void update_normals(MeshGeometry& geometry);

/// Adds the smooth tube of a rope to `geometry`: round cross sections along a Catmull-Rom curve, half spheres
/// at the ends. Repeated and not finite points are left out; fewer than two others add nothing.
void add_tube(std::span<const Vec3> points, float radius, MeshGeometry& geometry);

}  // namespace hooke::render
