#include "lab/shape/convex_solid.h"

#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hooke::geometry {

namespace {

constexpr double kBoundless = std::numeric_limits<double>::infinity();
constexpr double kParallel = 1e-12;  ///< Square of the sine below which directions count as the same.

/// A Shadow is the projection of the core onto n.
struct Shadow {
  double low = kBoundless, high = -kBoundless;
};

Shadow shadow_along(const ConvexSolid& solid, DVec3 n) {
  Shadow e;
  for (const DVec3 v : solid.vertices) {
    const double along = dot(n, v);
    e.low = std::min(e.low, along);
    e.high = std::max(e.high, along);
  }
  return e;
}

DVec3 direction_of(const ConvexSolid& solid, std::array<std::uint32_t, 2> edge) {
  return normalize(solid.vertices[edge[1]] - solid.vertices[edge[0]]);
}

void keep_directions(ConvexSolid& solid) {
  for (const auto edge : solid.edges) {
    const DVec3 d = direction_of(solid, edge);
    const bool known = std::any_of(solid.directions.begin(), solid.directions.end(), [&](const auto other) {
      return length_squared(cross(d, direction_of(solid, other))) < kParallel;
    });
    if (!known) solid.directions.push_back(edge);
  }
}

/// Returns the direction along which the cores are farthest apart, or overlap least.
std::optional<SolidGap> best_axis(const ConvexSolid& a, const ConvexSolid& b) {
  SolidGap best = {-kBoundless, {}};
  const auto ask = [&](DVec3 n) {
    const Shadow of_a = shadow_along(a, n);
    const Shadow of_b = shadow_along(b, n);
    if (of_b.low - of_a.high > best.distance) best = {of_b.low - of_a.high, n};
    if (of_a.low - of_b.high > best.distance) best = {of_a.low - of_b.high, -n};
  };
  for (const ConvexSolid::Face& face : a.faces) {
    const double gap = shadow_along(b, face.normal).low - face.offset;
    if (gap > best.distance) best = {gap, face.normal};
  }
  for (const ConvexSolid::Face& face : b.faces) {
    const double gap = shadow_along(a, face.normal).low - face.offset;
    if (gap > best.distance) best = {gap, -face.normal};
  }
  for (const auto edge_a : a.directions) {
    for (const auto edge_b : b.directions) {
      const DVec3 n = cross(direction_of(a, edge_a), direction_of(b, edge_b));
      if (length_squared(n) > kParallel) ask(normalize(n));
    }
  }
  if (best.distance == -kBoundless) return {};
  return best;
}

struct Nearest {
  double distance_squared = kBoundless;
  DVec3 on_a = {}, on_b = {};
};

/// Compares the corners of `solid` with the faces of `other`.
void ask_corners(const ConvexSolid& solid, const ConvexSolid& other, bool swapped, Nearest& nearest) {
  for (const DVec3 v : solid.vertices) {
    for (const ConvexSolid::Face& face : other.faces) {
      for (std::size_t i = 2; i < face.loop.size(); ++i) {
        const auto near = closest_on_triangle(v, other.vertices[face.loop[0]],
                                              other.vertices[face.loop[i - 1]], other.vertices[face.loop[i]]);
        if (!(near.distance_squared < nearest.distance_squared)) continue;
        nearest = {near.distance_squared, swapped ? near.point : v, swapped ? v : near.point};
      }
    }
  }
}

/// A single vertex counts as an edge of no length.
std::vector<std::array<std::uint32_t, 2>> edges_of(const ConvexSolid& solid) {
  if (solid.edges.empty()) return {{0, 0}};
  return solid.edges;
}

Nearest nearest_features(const ConvexSolid& a, const ConvexSolid& b) {
  Nearest nearest;
  ask_corners(a, b, false, nearest);
  ask_corners(b, a, true, nearest);
  for (const auto edge_a : edges_of(a)) {
    for (const auto edge_b : edges_of(b)) {
      const auto pair = closest_between_segments<double>({a.vertices[edge_a[0]], a.vertices[edge_a[1]]},
                                                         {b.vertices[edge_b[0]], b.vertices[edge_b[1]]});
      if (pair.distance_squared < nearest.distance_squared)
        nearest = {pair.distance_squared, pair.point_a, pair.point_b};
    }
  }
  return nearest;
}

/// Returns a direction for cores that share a point and have no faces: across their edges, or upward.
DVec3 direction_without_faces(const ConvexSolid& a, const ConvexSolid& b) {
  const DVec3 up = {0, 1, 0};
  for (const ConvexSolid* solid : {&a, &b}) {
    if (solid->edges.empty()) continue;
    const DVec3 along = direction_of(*solid, solid->edges[0]);
    const DVec3 across = cross(along, std::abs(along.x) < 0.5 ? DVec3{1, 0, 0} : DVec3{0, 0, 1});
    return direction_or(across, up);
  }
  return up;
}

}  // namespace

ConvexSolid solid_sphere(double radius) {
  return {.vertices = {{}}, .skin = radius};
}

ConvexSolid solid_capsule(double radius, double half_height) {
  return {.vertices = {{0, -half_height, 0}, {0, half_height, 0}},
          .edges = {{0, 1}},
          .directions = {{0, 1}},
          .skin = radius};
}

ConvexSolid solid_triangle(DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 n = direction_or(cross(b - a, c - a), {});
  if (n == DVec3{}) {
    const double ab = length_squared(b - a), bc = length_squared(c - b), ca = length_squared(a - c);
    if (!(ab > 0) && !(bc > 0)) return {.vertices = {a}};
    const bool long_ab = ab >= bc && ab >= ca;
    return {.vertices = {long_ab ? a : c, long_ab || bc >= ca ? b : a},
            .edges = {{0, 1}},
            .directions = {{0, 1}}};
  }
  ConvexSolid solid = {.vertices = {a, b, c}, .edges = {{0, 1}, {1, 2}, {2, 0}}};
  solid.faces = {{n, dot(n, a), {0, 1, 2}}, {-n, -dot(n, a), {0, 2, 1}}};
  for (const auto [from, to] : solid.edges) {
    const DVec3 side = normalize(cross(solid.vertices[to] - solid.vertices[from], n));
    solid.faces.push_back({side, std::max(dot(side, solid.vertices[from]), dot(side, solid.vertices[to]))});
  }
  solid.directions = solid.edges;
  return solid;
}

ConvexSolid solid_hull(const ConvexHull& hull) {
  ConvexSolid solid;
  for (const Vec3 v : hull.vertices) solid.vertices.push_back(vector_cast<double>(v));
  for (const ConvexHull::Face& face : hull.faces) {
    ConvexSolid::Face own;
    for (std::size_t i = 0; i < face.count; ++i) own.loop.push_back(hull.loop[face.first + i]);
    // Newell's normal uses all corners, which rounding to float moves off the plane.
    const DVec3 origin = solid.vertices[own.loop[0]];
    DVec3 normal = {};
    for (std::size_t i = 2; i < own.loop.size(); ++i)
      normal += cross(solid.vertices[own.loop[i - 1]] - origin, solid.vertices[own.loop[i]] - origin);
    own.normal = direction_or(normal, vector_cast<double>(face.normal));
    own.offset = shadow_along(solid, own.normal).high;
    solid.faces.push_back(std::move(own));
  }
  for (const ConvexHull::Edge& edge : hull.edges) solid.edges.push_back({edge.vertex_a, edge.vertex_b});
  keep_directions(solid);
  return solid;
}

ConvexSolid placed(const ConvexSolid& solid, Quaternion<double> rotation, DVec3 shift) {
  ConvexSolid result = solid;
  for (DVec3& v : result.vertices) v = rotate(rotation, v) + shift;
  for (ConvexSolid::Face& face : result.faces) {
    face.normal = rotate(rotation, face.normal);
    face.offset += dot(face.normal, shift);
  }
  return result;
}

double separation_along(const ConvexSolid& a, const ConvexSolid& b, DVec3 n) {
  return shadow_along(b, n).low - shadow_along(a, n).high - a.skin - b.skin;
}

SolidGap gap_between(const ConvexSolid& a, const ConvexSolid& b) {
  const double skins = a.skin + b.skin;
  const std::optional<SolidGap> axis = best_axis(a, b);
  if (axis && !(axis->distance > 0)) return {axis->distance - skins, axis->normal};
  const Nearest nearest = nearest_features(a, b);
  const double distance = std::sqrt(nearest.distance_squared);
  const DVec3 otherwise = axis ? axis->normal : direction_without_faces(a, b);
  // The planes give the distance of faces with less rounding than the difference of their points.
  if (axis && distance <= axis->distance * (1 + 1e-9)) return {axis->distance - skins, axis->normal};
  return {distance - skins, direction_or(nearest.on_b - nearest.on_a, otherwise)};
}

}  // namespace hooke::geometry
