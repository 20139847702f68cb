#include "geometry/convex/immersion.h"

#include "math/trig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace hooke::geometry {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSides = 24;
constexpr int kRings = 5;  ///< Rings of a half sphere, without its pole; the mesh stays within the vertices
                           ///< of a hull.

/// A vertex of a solid of revolution: round * radius + end * half_height.
struct RoundVertex {
  DVec3 round = {};
  double end = 0;
};

struct RoundMesh {
  std::vector<RoundVertex> vertices;
  std::vector<std::array<std::uint16_t, 3>> triangles;
};

/// A circle of vertices about y, or a single vertex on it. `y` counts in radii.
struct Ring {
  double radius = 0;
  double y = 0;
  double end = 0;
};

/// Makes the mesh through rings from below to above; it is flat where it ends in a circle.
RoundMesh mesh_through(std::span<const Ring> rings) {
  RoundMesh mesh;
  std::vector<std::uint16_t> first;
  const double angle = 2 * kPi / kSides;
  const double widen = std::sqrt(angle / math::sin_cos(angle).sin);  // the polygon has the circle's area
  for (const Ring& ring : rings) {
    first.push_back(static_cast<std::uint16_t>(mesh.vertices.size()));
    const int count = ring.radius > 0 ? kSides : 1;
    for (int i = 0; i < count; ++i) {
      const math::SinCos<double> turn = math::sin_cos(i * angle);
      const double r = widen * ring.radius;
      mesh.vertices.push_back({{r * turn.cos, ring.y, r * turn.sin}, ring.end});
    }
  }
  const auto vertex = [&](std::size_t ring, int i) {
    return static_cast<std::uint16_t>(first[ring] + (rings[ring].radius > 0 ? i % kSides : 0));
  };
  const std::size_t top = rings.size() - 1;
  for (int i = 0; i < kSides; ++i) {
    for (std::size_t k = 0; k < top; ++k) {
      mesh.triangles.push_back({vertex(k, i), vertex(k + 1, i), vertex(k, i + 1)});
      mesh.triangles.push_back({vertex(k, i + 1), vertex(k + 1, i), vertex(k + 1, i + 1)});
    }
    mesh.triangles.push_back({vertex(0, 0), vertex(0, i), vertex(0, i + 1)});
    mesh.triangles.push_back({vertex(top, 0), vertex(top, i + 1), vertex(top, i)});
  }
  return mesh;
}

RoundMesh make_capsule() {
  std::vector<Ring> upper;
  double volume = 0;  // volume of the half sphere between the rings, by frusta of cones
  for (int i = 0; i <= kRings; ++i) {
    const math::SinCos<double> at = math::sin_cos(0.5 * kPi * i / kRings);
    upper.push_back({i < kRings ? at.cos : 0.0, at.sin, 1});
    if (i == 0) continue;
    const Ring& a = upper[upper.size() - 2];
    const Ring& b = upper.back();
    volume += kPi / 3 * (b.y - a.y) * (a.radius * a.radius + a.radius * b.radius + b.radius * b.radius);
  }
  std::vector<Ring> rings;
  for (Ring& ring : upper) ring.y *= 2 * kPi / 3 / volume;
  for (std::size_t i = upper.size(); i-- > 0;) rings.push_back({upper[i].radius, -upper[i].y, -1});
  rings.insert(rings.end(), upper.begin(), upper.end());
  return mesh_through(rings);
}

const RoundMesh& round_mesh(ShapeKind kind) {
  static const RoundMesh cylinder = mesh_through(std::array<Ring, 2>{{{1, 0, -1}, {1, 0, 1}}});
  static const RoundMesh cone = mesh_through(std::array<Ring, 2>{{{1, 0, -1}, {0, 0, 1}}});
  static const RoundMesh capsule = make_capsule();
  if (kind == ShapeKind::kCylinder) return cylinder;
  return kind == ShapeKind::kCone ? cone : capsule;
}

/// Calls visit(a, b, c) for each triangle of the surface, counter-clockwise from outside.
template <class Visit>
void for_triangles(const PlacedShape& placed, Visit&& visit) {
  std::array<DVec3, ConvexHull::kMaxVertices> points;
  const auto place = [&](DVec3 own) { return placed.position + rotate(placed.rotation, own); };
  const Shape& shape = placed.shape;
  if (placed.hull != nullptr) {
    const ConvexHull& hull = *placed.hull;
    for (std::size_t i = 0; i < hull.vertices.size(); ++i)
      points[i] = place(vector_cast<double>(hull.vertices[i]));
    for (const ConvexHull::Face& face : hull.faces) {
      const std::span<const std::uint16_t> loop(hull.loop.data() + face.first, face.count);
      for (std::size_t i = 2; i < loop.size(); ++i)
        visit(points[loop[0]], points[loop[i - 1]], points[loop[i]]);
    }
    return;
  }
  const bool round = shape.kind == ShapeKind::kCapsule || shape.kind == ShapeKind::kCylinder ||
                     shape.kind == ShapeKind::kCone;
  if (!round) return;
  const RoundMesh& mesh = round_mesh(shape.kind);
  const auto radius = static_cast<double>(shape.radius);
  const auto half_height = static_cast<double>(shape.half_height);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const RoundVertex& v = mesh.vertices[i];
    points[i] = place(radius * v.round + DVec3{0, half_height * v.end, 0});
  }
  for (const auto& [a, b, c] : mesh.triangles) visit(points[a], points[b], points[c]);
}

/// The part of a triangle below the level: up to four corners. Returns their number.
int clip_below(const std::array<DVec3, 3>& triangle, double level, std::array<DVec3, 4>& kept) {
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const DVec3 a = triangle[i];
    const DVec3 b = triangle[(i + 1) % 3];
    const double depth_a = level - a.y;
    const double depth_b = level - b.y;
    if (depth_a >= 0) kept[static_cast<std::size_t>(count++)] = a;
    if ((depth_a >= 0) == (depth_b >= 0)) continue;
    kept[static_cast<std::size_t>(count++)] = a + (depth_a / (depth_a - depth_b)) * (b - a);
  }
  return count;
}

Immersion immersed_sphere(const PlacedShape& placed, double level) {
  const auto radius = static_cast<double>(placed.shape.radius);
  const double c = std::clamp(radius + (level - placed.position.y), 0.0, 2 * radius);
  const double volume = cap_volume(radius, c);
  const double below = 3 * (2 * radius - c) * (2 * radius - c) / (4 * (3 * radius - c));
  return {volume, volume * (placed.position - DVec3{0, below, 0})};
}

}  // namespace

double cap_volume(double radius, double c) {
  return kPi / 3 * c * c * (3 * radius - c);
}

Immersion immersion(const PlacedShape& placed, double level) {
  if (placed.shape.kind == ShapeKind::kSphere) return immersed_sphere(placed, level);
  Immersion sum;
  const DVec3 apex = {placed.position.x, level, placed.position.z};
  for_triangles(placed, [&](DVec3 a, DVec3 b, DVec3 c) {
    std::array<DVec3, 4> kept;
    const int count = clip_below({a, b, c}, level, kept);
    for (std::size_t i = 2; i < static_cast<std::size_t>(count); ++i) {
      const double volume = dot(kept[0] - apex, cross(kept[i - 1] - apex, kept[i] - apex)) / 6;
      sum.volume += volume;
      sum.moment += (0.25 * volume) * (apex + kept[0] + kept[i - 1] + kept[i]);
    }
  });
  if (!(sum.volume > 0)) return {};
  return sum;
}

double shadow_area(const PlacedShape& placed, DVec3 direction) {
  const auto radius = static_cast<double>(placed.shape.radius);
  if (placed.shape.kind == ShapeKind::kSphere) return kPi * radius * radius;
  double sum = 0;
  for_triangles(placed, [&](DVec3 a, DVec3 b, DVec3 c) {
    sum += 0.25 * std::abs(dot(direction, cross(b - a, c - a)));
  });
  return sum;
}

}  // namespace hooke::geometry
