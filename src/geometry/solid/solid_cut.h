#pragma once

#include "hooke/geometry.h"

#include "geometry/triangle_mesh.h"

#include <array>
#include <span>
#include <vector>

/// \file
/// Cuts solids by planes, without lids on the cuts.

namespace hooke::geometry {

using Corners = std::array<Vec3, 3>;  ///< Corners of a triangle, counter-clockwise seen from outside.

/// Unit normal; zero for a triangle of no area.
DVec3 normal_of(const Corners& triangle);

/// The part of a solid that is left between planes. Its convex hull is that of the surface and the corners.
struct SolidPiece {
  std::vector<Corners> surface;  ///< The pieces of the solid's own surface.
  std::vector<Plane> planes;     ///< The piece is below them.
  std::vector<Vec3> corners;     ///< Points in the solid where three of the planes meet.
};

struct SolidHalves {
  SolidPiece below, above;
  double cut_length = 0;  ///< Length of the curve in which the plane meets the surface [m].
};

/// Whether the point is inside the closed surface: how often that winds about a line along x from there on.
/// Either answer on the surface.
[[nodiscard]] bool contains(std::span<const Corners> surface, DVec3 p);

/// The two sides of a plane of a piece of `solid`. Points at most `on_plane` [m] away from the plane count as
/// on it; triangles that lie in it belong to the solid on their inner side.
[[nodiscard]] SolidHalves cut(const SolidPiece& piece, std::span<const Corners> solid, const Plane& plane,
                              double on_plane);

}  // namespace hooke::geometry
