#pragma once

#include "hooke/math.h"

#include "geometry/box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::geometry {

/// A ray prepared for tests against many boxes.
struct RaySlabs {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  DVec3 origin = {};
  DVec3 inverse = {};  ///< 1 / direction; infinite where the direction has no component.

  static RaySlabs of(DVec3 origin, DVec3 direction) {
    return {origin, {1.0 / direction.x, 1.0 / direction.y, 1.0 / direction.z}};
  }

  /// The fraction of the direction where the ray enters the box grown by `radius` on every side. It is 0 from
  /// within and kNever if the ray misses. A box inside another is never entered before it. The slack makes up
  /// for rounding, so that a hit on the rim of the box is never lost (after Ize, 2013, Robust BVH ray
  /// traversal).
  template <class T>
  [[nodiscard]] double enter(const Box3<T>& box, double radius = 0.0) const {
    const double lower[3] = {box.lower.x - radius, box.lower.y - radius, box.lower.z - radius};
    const double upper[3] = {box.upper.x + radius, box.upper.y + radius, box.upper.z + radius};
    const double from[3] = {origin.x, origin.y, origin.z};
    const double scale[3] = {inverse.x, inverse.y, inverse.z};
    double near = 0.0;
    double far = kNever;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isinf(scale[axis])) {
        if (from[axis] < lower[axis] || from[axis] > upper[axis]) return kNever;
        continue;
      }
      const double a = (lower[axis] - from[axis]) * scale[axis];
      const double b = (upper[axis] - from[axis]) * scale[axis];
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    return near <= far * (1.0 + 1e-14) ? near * (1.0 - 1e-14) : kNever;
  }
};

}  // namespace hooke::geometry
