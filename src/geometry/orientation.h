#pragma once

#include "hooke/math.h"

/// \file
/// Finds exactly on which side points lie, by signs of determinants that no rounding can change. A quick
/// value with a bound on its error decides nearly always. Where it cannot, the sum is formed without rounding
/// (Shewchuk, 1997, Adaptive precision floating-point arithmetic and fast robust geometric predicates).
///
/// Exact for coordinates that are zero or between 1e-80 and 1e80 in size. Total: the answer is 0 where a
/// number is not finite.

namespace hooke::geometry {

/// A point of a plane.
struct Point2 {
  double x = 0;
  double y = 0;
};

/// The sign of dot(cross(b - a, c - a), d - a): 1 where a, b, c run counter-clockwise seen from `d`, -1 where
/// clockwise, 0 where the four points lie in one plane.
[[nodiscard]] int orientation(DVec3 a, DVec3 b, DVec3 c, DVec3 d);

/// 1 where a, b, c run counter-clockwise, -1 where clockwise, 0 where they lie on one line.
[[nodiscard]] int orientation(Point2 a, Point2 b, Point2 c);

/// The point seen along axis 0 (x), 1 (y) or 2 (z). Counter-clockwise around the axis stays
/// counter-clockwise.
[[nodiscard]] constexpr Point2 seen_along(int axis, DVec3 p) {
  return axis == 0 ? Point2{p.y, p.z} : axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

}  // namespace hooke::geometry
