#pragma once

#include "hooke/math.h"

#include <array>
#include <limits>

namespace hooke::geometry {

/// Six times the volumes between a line's direction and the edges of a triangle, each by the corner across
/// from its edge. In the triangles on both sides of an edge they have opposite signs, to the last bit.
inline std::array<double, 3> line_volumes(DVec3 origin, DVec3 direction,
                                          const std::array<DVec3, 3>& corners) {
  const DVec3 a = corners[0] - origin;
  const DVec3 b = corners[1] - origin;
  const DVec3 c = corners[2] - origin;
  return {dot(direction, cross(b, c)), dot(direction, cross(c, a)), dot(direction, cross(a, b))};
}

/// Where a line meets a triangle.
struct LineHit {
  double fraction = std::numeric_limits<double>::infinity();  ///< At origin + fraction direction.
  std::array<double, 3> weights = {};                         ///< Weights of the corners, with the sum 1.
};

/// Where the line meets the triangle; at infinity if it does not, or sees it edge-on. No line slips through
/// between two triangles.
inline LineHit line_hits_triangle(DVec3 origin, DVec3 direction, const std::array<DVec3, 3>& corners) {
  const DVec3 a = corners[0] - origin;
  const DVec3 b = corners[1] - origin;
  const DVec3 c = corners[2] - origin;
  const auto [of_a, of_b, of_c] = line_volumes(origin, direction, corners);
  const bool has_negative = of_a < 0.0 || of_b < 0.0 || of_c < 0.0;
  const bool has_positive = of_a > 0.0 || of_b > 0.0 || of_c > 0.0;
  if (has_negative == has_positive) return {};
  const double whole = of_a + of_b + of_c;
  const DVec3 hit = (of_a / whole) * a + (of_b / whole) * b + (of_c / whole) * c;
  return {dot(hit, direction) / dot(direction, direction), {of_a / whole, of_b / whole, of_c / whole}};
}

}  // namespace hooke::geometry
