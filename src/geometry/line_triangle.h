#pragma once

#include "hooke/math.h"

#include <array>
#include <limits>

namespace hooke::geometry {

/// Where a line meets a triangle.
struct LineHit {
  double fraction = std::numeric_limits<double>::infinity();  ///< At origin + fraction direction.
  std::array<double, 3> weights = {};                         ///< Weights of the corners, with the sum 1.
};

/// Where the line meets the triangle; at infinity if it does not, or sees it edge-on. The three volumes have
/// opposite signs in the triangles on both sides of an edge, to the last bit: no line slips through.
inline LineHit line_hits_triangle(DVec3 origin, DVec3 direction, const std::array<DVec3, 3>& corners) {
  const DVec3 a = corners[0] - origin;
  const DVec3 b = corners[1] - origin;
  const DVec3 c = corners[2] - origin;
  const double of_a = dot(direction, cross(b, c));
  const double of_b = dot(direction, cross(c, a));
  const double of_c = dot(direction, cross(a, b));
  const bool has_negative = of_a < 0.0 || of_b < 0.0 || of_c < 0.0;
  const bool has_positive = of_a > 0.0 || of_b > 0.0 || of_c > 0.0;
  if (has_negative == has_positive) return {};
  const double whole = of_a + of_b + of_c;
  const DVec3 hit = (of_a / whole) * a + (of_b / whole) * b + (of_c / whole) * c;
  return {dot(hit, direction) / dot(direction, direction), {of_a / whole, of_b / whole, of_c / whole}};
}

}  // namespace hooke::geometry
