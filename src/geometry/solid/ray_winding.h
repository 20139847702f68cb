#pragma once

#include "hooke/math.h"

#include "geometry/box.h"

#include <algorithm>
#include <array>
#include <utility>

/// \file
/// How often a closed surface winds about a point, by the triangles that a line along x meets beyond it.

namespace hooke::geometry {

/// Number of times that the triangle, seen along x, winds about (y, z). It is counted by its edges, each of
/// them in one direction whichever triangle asks. So neighbors agree to the bit, and no line slips between
/// them.
[[nodiscard]] inline int winding_about(const std::array<DVec3, 3>& t, double y, double z) {
  int winding = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    DVec3 a = t[k], b = t[(k + 1) % 3];
    int sign = 1;
    if (b.z < a.z || (b.z == a.z && b.y < a.y)) {
      std::swap(a, b);
      sign = -1;
    }
    if (!(a.z <= z) || b.z <= z) continue;
    if (a.y + (z - a.z) / (b.z - a.z) * (b.y - a.y) > y) winding += sign;
  }
  return winding;
}

/// The x at which the line through (y, z) meets the triangle; within the triangle, however steep it is.
[[nodiscard]] inline double crossing_of(const std::array<DVec3, 3>& t, double y, double z) {
  const DVec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double x = t[0].x - (n.y * (y - t[0].y) + n.z * (z - t[0].z)) / n.x;
  const Box3<double> box = box_of(t[0], t[1], t[2]);
  return x >= box.lower.x ? std::min(x, box.upper.x) : box.lower.x;
}

}  // namespace hooke::geometry
