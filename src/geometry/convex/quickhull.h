#pragma once

#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// The convex hull of points on a grid. All coordinates are whole numbers, so small that the side of a plane
/// on which a point lies is exact in 64 bits. Nothing here can be led astray by rounding: the surface is
/// closed and convex whatever the points.

namespace hooke::geometry {

using GridPoint = Vector3<std::int64_t>;

/// Coordinates of grid points lie in [-kGridHalf, kGridHalf]: a height is below 3 * 2^61.
inline constexpr std::int64_t kGridHalf = std::int64_t{1} << 19;

/// A triangle of the hull.
struct HullTriangle {
  std::array<std::uint32_t, 3> vertex = {};  ///< Numbers of the points, counter-clockwise from outside.
  std::array<std::uint32_t, 3> neighbor =
      {};                     ///< Neighboring triangles: number k is across the edge from vertex k to k + 1.
  GridPoint normal = {};      ///< Outward normal, of twice the area in length.
  double inverse_length = 0;  ///< 1 / |normal|.
};

/// Height of `p` over the triangle's plane, times the length of its normal: exact.
inline std::int64_t scaled_height(const HullTriangle& t, std::span<const GridPoint> points, GridPoint p) {
  return dot(t.normal, p - points[t.vertex[0]]);
}
/// Height of `p` over the triangle's plane in grid units.
inline double height_over(const HullTriangle& t, std::span<const GridPoint> points, GridPoint p) {
  return static_cast<double>(scaled_height(t, points, p)) * t.inverse_length;
}

/// Triangles around the points, by quickhull (Barber, Dobkin, Huhdanpaa 1996, The quickhull algorithm for
/// convex hulls): the point that is farthest outside is added until none is farther outside than `tolerance`
/// [grid units], or `vertex_limit` points are on the hull. The hull is exactly convex; points may lie on it
/// that are not needed for its shape. Empty if all points lie in one plane.
///
/// Precondition: points are in ascending order of (x, y, z), each once; vertex_limit >= 4.
[[nodiscard]] std::vector<HullTriangle> triangulate_hull(std::span<const GridPoint> points, double tolerance,
                                                         int vertex_limit);

/// Faces of the hull, each as a loop of points, counter-clockwise from outside. Triangles with all corners at
/// most `tolerance` [grid units] below the plane of a larger one are joined to it: all that are connected, or
/// only as long as the face stays convex. The loop of a face begins with its lowest point.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> join_triangles(std::span<const HullTriangle> triangles,
                                                                     std::span<const GridPoint> points,
                                                                     double tolerance, bool stay_convex);

}  // namespace hooke::geometry
