#pragma once

#include "render/draw_list.h"

#include <cstddef>
#include <cstdint>
#include <span>

/// \file
/// Makes triangles for common shapes, with outward normals, counter-clockwise, with texture coordinates.

namespace hooke::render {

/// Sides of a turned shape.
inline constexpr int kRoundSides = 32;

/// Makes a box of `half_size` about the origin; every side shows the whole texture.
MeshGeometry make_box(Vec3 half_size);

/// Makes a sphere of radius 1 about the origin: an icosahedron, each triangle split in four `splits` times (0
/// to 6).
MeshGeometry make_sphere(int splits);

/// Makes a cylinder of `radius` along y from -half_height to half_height, with a half sphere on both ends.
/// `half_height` 0 gives a sphere. It has `sides` around, at least 3.
MeshGeometry make_capsule(float radius, float half_height, int sides = kRoundSides);

/// Makes a cylinder of `radius` along y from -half_height to half_height, with flat ends.
MeshGeometry make_cylinder(float radius, float half_height);

/// Makes a cone along y: a disk of `radius` at -half_height, the tip at half_height.
MeshGeometry make_cone(float radius, float half_height);

/// Computes smooth normals from the triangles, weighted by area. Vertices of no triangle keep theirs. It
/// raises the vertex revision.
void update_normals(MeshGeometry& geometry);

/// Adds the smooth tube of a rope to `geometry`: round cross sections along a Catmull-Rom curve, half spheres
/// at the ends. Repeated points and points that are not finite are left out; fewer than two others add
/// nothing.
/// Texture coordinate u goes around once, v along it in circumferences.
void add_tube(std::span<const Vec3> points, float radius, MeshGeometry& geometry);

/// The hairs that are drawn for one that was simulated.
struct Tuft {
  float radius = 0;          ///< Of the hair that was simulated [m].
  float spread = 0;          ///< Distance of the outermost hairs from it [m].
  std::uint32_t number = 0;  ///< Tells a tuft from others, whose hairs lie otherwise.
  bool few = false;          ///< Whether a quarter of the hairs stands for all, each twice as wide.
};

/// Adds a tuft of hairs that follow the points: strips that face the eye, with the direction along the hair
/// in place of the normal, u a number of the hair's own and v from 0 at the root to 1 at the tip. Points are
/// left out as for a tube.
void add_tuft(std::span<const Vec3> points, const Tuft& tuft, Vec3 eye, MeshGeometry& geometry);

/// Returns the spread of the tuft of one of these roots, which leaves no gap to the next root.
[[nodiscard]] float tuft_spread(std::span<const Vec3> roots, std::size_t one, float radius);

}  // namespace hooke::render
