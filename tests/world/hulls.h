#pragma once

#include "hooke/hooke.h"

#include "validation/crossings.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// What the checker of crossings.h looks at in place of bodies: meshes and lines that lie within their
/// shapes. Those of boxes, balls and needles are a thousandth smaller, so that rounding of the pose does not
/// count.

namespace hooke::test {

/// Points and triangles within a shape, in its frame.
struct Hull {
  std::vector<DVec3> points = {};
  std::vector<std::array<std::uint32_t, 3>> triangles = {};
  std::vector<std::array<std::uint32_t, 2>> lines = {};
};

inline constexpr double kHullScale = 0.999;

inline Hull hull_of_box(Vec3 half) {
  const DVec3 h = kHullScale * vector_cast<double>(half);
  Hull hull;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) hull.points.push_back({x * h.x, y * h.y, z * h.z});
  hull.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return hull;
}

/// An octahedron whose corners lie on the sphere.
inline Hull hull_of_ball(Real radius) {
  const double r = kHullScale * static_cast<double>(radius);
  Hull hull;
  hull.points = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  hull.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return hull;
}

/// The axis of a capsule.
inline Hull hull_of_needle(Real half_height) {
  const double h = kHullScale * static_cast<double>(half_height);
  Hull hull;
  hull.points = {{0, -h, 0}, {0, h, 0}};
  hull.lines = {{0, 1}};
  return hull;
}

/// The triangles of a mesh.
inline Hull hull_of_mesh(const MeshDesc& mesh) {
  Hull hull;
  for (const Vec3 p : mesh.positions) hull.points.push_back(vector_cast<double>(p));
  hull.triangles = mesh.triangles;
  return hull;
}

/// Adds the hull of a body where it is.
inline void append(const Pose& pose, const Hull& hull, Surfaces& to) {
  const auto from = static_cast<std::uint32_t>(to.points.size());
  const Quaternion<double> turn = {static_cast<double>(pose.rotation.x), static_cast<double>(pose.rotation.y),
                                   static_cast<double>(pose.rotation.z),
                                   static_cast<double>(pose.rotation.w)};
  for (const DVec3 p : hull.points) to.points.push_back(pose.position + rotate(normalize(turn), p));
  for (const auto& [a, b, c] : hull.triangles) to.triangles.push_back({from + a, from + b, from + c});
  for (const auto& [a, b] : hull.lines) to.lines.push_back({from + a, from + b});
}

}  // namespace hooke::test
