#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_points.h"
#include "collision/manifold/manifold_tuning.h"

#include <array>
#include <cstdint>

namespace hooke::collision {

/// A feature that a shape presents along a direction: a point, an edge, a face or the flat end of a cylinder.
/// It belongs to the core: the skin is added when points are made.
struct Feature {
  enum class Kind : std::uint8_t { kPoint, kSegment, kPolygon, kDisc };
  /// Faces of more corners are reduced to this many of them.
  static constexpr int kMaxPoints = 16;

  Kind kind = Kind::kPoint;
  int count = 0;
  std::array<Vec3, kMaxPoints> point;  ///< Points of a polygon, counter-clockwise from outside, or points on
                                       ///< the rim of a disc.
  std::array<std::uint16_t, kMaxPoints> vertex;  ///< Numbers of the vertices, for keys.
  std::array<std::uint16_t, kMaxPoints> edge;    ///< Numbers of the edges from point i to the next, for keys.
  Vec3 normal = {};                              ///< Outward normal of the plane of a polygon or disc.
  Vec3 center = {};                              ///< Center of a disc.
  Real radius = Real(0);

  void add(Vec3 p, std::uint32_t vertex_id, std::uint32_t edge_id) {
    if (count == kMaxPoints) return;
    point[static_cast<std::size_t>(count)] = p;
    vertex[static_cast<std::size_t>(count)] = static_cast<std::uint16_t>(vertex_id);
    edge[static_cast<std::size_t>(count++)] = static_cast<std::uint16_t>(edge_id);
  }
};

/// The feature that is farthest along the unit vector `n`.
[[nodiscard]] Feature feature_along(const Convex& convex, Vec3 n, Real least_cosine = kFlatFaceCosine);

/// A corner of a box, 0..7: bits 0, 1, 2 say +x, +y, +z.
[[nodiscard]] Vec3 corner_of_box(const Convex& box, unsigned corner);
/// The face of a box, 0..5: +x, -x, +y, -y, +z, -z.
[[nodiscard]] Feature face_of_box(const Convex& box, int face);
[[nodiscard]] Feature face_of_hull(const Convex& hull, std::size_t face);
/// Does the same as feature_along for a shape with `hull` set, whatever its kind. Vertices and edges are
/// those of the hull.
[[nodiscard]] Feature feature_of_hull(const Convex& hull, Vec3 n, Real least_cosine);

/// Adds the points where the two features lie over each other as seen along result.normal, from A to B: the
/// corners of what their projections have in common. Adds none for points and edges that miss each other, and
/// none for a point with anything but a face. `skin_a`, `skin_b` [m].
void overlap_features(const Feature& a, const Feature& b, Real skin_a, Real skin_b, ContactResult& result);

}  // namespace hooke::collision
