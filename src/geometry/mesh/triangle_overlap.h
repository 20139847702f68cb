#pragma once

#include "hooke/math.h"

#include <array>

/// \file
/// Whether segments and triangles have a point in common. All are closed sets: those that touch in a point,
/// along an edge or in a common plane overlap. The answers are exact for the given coordinates (see
/// geometry/orientation.h), also for triangles that are only a segment or a point. Anything that is not
/// finite overlaps nothing.

namespace hooke::geometry {

using DTriangle = std::array<DVec3, 3>;

/// Whether two segments meet. Either may be a point.
[[nodiscard]] bool segments_overlap(DVec3 a, DVec3 b, DVec3 c, DVec3 d);

/// Whether the segment from `from` to `to` meets the triangle.
[[nodiscard]] bool segment_meets_triangle(DVec3 from, DVec3 to, const DTriangle& triangle);

/// Whether two triangles have a point in common: whether an edge of either meets the other.
[[nodiscard]] bool triangles_overlap(const DTriangle& a, const DTriangle& b);

}  // namespace hooke::geometry
