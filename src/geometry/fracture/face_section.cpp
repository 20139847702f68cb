#include "geometry/fracture/face_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace hooke::geometry {

namespace {

/// Second moments of area about the center: of y, of x, and mixed [m^4].
struct AreaMoments {
  double xx = 0;  ///< Integral of y^2: about the x axis.
  double yy = 0;  ///< Integral of x^2: about the y axis.
  double xy = 0;  ///< Integral of x y.
};

/// The direction of the longest edge that only one triangle has: of sections that are as stiff about all
/// axes, such as squares, axes along the edges count.
DVec3 longest_rim(std::span<const DVec3> points, std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  }
  std::vector<Edge> sorted = edges;
  std::sort(sorted.begin(), sorted.end());
  DVec3 longest = {};
  for (const Edge& edge : edges) {
    if (std::binary_search(sorted.begin(), sorted.end(), Edge{edge[1], edge[0]})) continue;
    const DVec3 along = points[edge[1]] - points[edge[0]];
    if (length_squared(along) > length_squared(longest)) longest = along;
  }
  return longest;
}

AreaMoments moments_of(std::span<const DVec3> points, std::span<const Triangle> triangles,
                       const FaceSection& section, DVec3 x, DVec3 y) {
  AreaMoments sum;
  for (const Triangle& t : triangles) {
    std::array<double, 4> u = {};
    std::array<double, 4> v = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const DVec3 arm = points[t[k]] - section.center;
      u[k] = dot(arm, x);
      v[k] = dot(arm, y);
      u[3] += u[k];
      v[3] += v[k];
    }
    const double area = 0.5 * ((u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]));
    // The integral of x_i x_j over a triangle is A / 12 times the sum over its corners and their sum.
    for (std::size_t k = 0; k < 4; ++k) {
      sum.xx += area / 12 * v[k] * v[k];
      sum.yy += area / 12 * u[k] * u[k];
      sum.xy += area / 12 * u[k] * v[k];
    }
  }
  return sum;
}

}  // namespace

FaceSection measure_section(std::span<const DVec3> points, std::span<const Triangle> triangles) {
  FaceSection section;
  DVec3 sum = {};
  DVec3 first = {};
  for (const Triangle& t : triangles)
    sum += 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
  section.area = length(sum);
  section.normal = normalize(sum);
  if (!(section.area > 0)) return section;
  for (const Triangle& t : triangles) {
    const DVec3 origin = points[triangles[0][0]];
    const DVec3 area = 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    first += dot(area, section.normal) / 3 *
             ((points[t[0]] - origin) + (points[t[1]] - origin) + (points[t[2]] - origin));
  }
  section.center = points[triangles[0][0]] + 1 / section.area * first;
  const DVec3 x = normalize(longest_rim(points, triangles));
  const DVec3 y = cross(section.normal, x);
  const AreaMoments moments = moments_of(points, triangles, section, x, y);
  // One Jacobi rotation, by at most 45 degrees, takes the mixed moment out.
  double cosine = 1;
  double sine = 0;
  if (std::abs(moments.xy) > 1e-9 * (moments.xx + moments.yy)) {
    const double ratio = (moments.xx - moments.yy) / (2 * moments.xy);
    const double tangent = (ratio < 0 ? 1 : -1) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1));
    cosine = 1 / std::sqrt(tangent * tangent + 1);
    sine = tangent * cosine;
  }
  const auto modulus = [&](DVec3 axis, DVec3 across) {
    const AreaMoments turned = moments_of(points, triangles, section, axis, across);
    double farthest = 0;
    for (const Triangle& t : triangles) {
      for (const std::uint32_t v : t)
        farthest = std::max(farthest, std::abs(dot(points[v] - section.center, across)));
    }
    return farthest > 0 ? std::max(0.0, turned.xx) / farthest : 0.0;
  };
  const DVec3 axis = cosine * x + sine * y;
  const DVec3 across = cosine * y - sine * x;
  section.modulus = std::min(modulus(axis, across), modulus(across, -axis));
  return section;
}

}  // namespace hooke::geometry
