#pragma once

#include "hooke/math.h"
#include "hooke/shape.h"

#include "geometry/convex/convex_hull.h"

/// \file
/// What liquid and air act on: the volume of a solid shape below a level, and its area across a flow.
///
/// Spheres, boxes and hulls are exact. Capsules, cylinders and cones are polyhedra of 24 sides with cross
/// sections of the same area, and half spheres of the same volume: the whole volume is exact, areas seen from
/// the side to 0.6 %. Half-spaces and meshes have none: they do not move.

namespace hooke::geometry {

struct PlacedShape {
  const Shape& shape;
  const ConvexHull* hull = nullptr;  ///< Set for a box and a hull.
  Quaternion<double> rotation = {};  ///< Unit rotation of the shape's frame.
  DVec3 position = {};               ///< Position of its origin [m].
};

struct Immersion {
  double volume = 0;  ///< [m^3]
  DVec3 moment = {};  ///< Integral of x over the volume: volume times its center [m^4].
};

/// Finds the part of the shape below y = level. For a polyhedron it sums signed tetrahedra under what is left
/// of its triangles, with the apex in the plane, so that the cut itself adds nothing (the divergence
/// theorem). For a sphere it takes the cap of height c: pi c^2 (3 r - c) / 3, with its center 3 (2 r - c)^2 /
/// (4 (3 r - c)) off that of the sphere (Harris and Stocker 1998, "Handbook of Mathematics and Computational
/// Science").
[[nodiscard]] Immersion immersion(const PlacedShape& placed, double level);

/// Volume of the cap of height c, 0 to 2 r, of a sphere [m^3].
[[nodiscard]] double cap_volume(double radius, double c);

/// Area of the shadow of the shape along the unit `direction` [m^2]. For a convex polyhedron it is half the
/// sum of the shadows of its faces (Cauchy).
[[nodiscard]] double shadow_area(const PlacedShape& placed, DVec3 direction);

}  // namespace hooke::geometry
