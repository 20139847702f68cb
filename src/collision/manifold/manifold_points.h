#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"

#include <array>
#include <cstdint>
#include <span>

/// \file
/// The contact of two convex shapes before it becomes a state::Manifold: a normal, and points in the order in
/// which they were found. Each family of pairs has its file, manifold_*.cpp.

namespace hooke::collision {

/// Points where features of A and B meet, as offsets like those of Convex.
struct ContactResultPoint {
  Vec3 on_a = {};
  Vec3 on_b = {};
  Real separation = Real(0);  ///< Separation along the normal [m].
  std::uint32_t key = 0;      ///< Names the features that meet; it stays the same from step to step.
};

struct ContactResult {
  static constexpr int kMaxPoints = 32;

  Vec3 normal = {};           ///< Unit vector from A to B.
  Real separation = Real(0);  ///< Separation along the normal [m]: the shapes are not nearer to each other,
                              ///< except by overlapping.
  std::uint32_t axis = 0;     ///< Code of what gave the normal, for the next step; each family has its own
                              ///< codes.
  int count = 0;              ///< 0 if they are farther apart than the margin.
  std::array<ContactResultPoint, kMaxPoints> point;

  /// Adds a point. Points for which there is no room are dropped.
  void add(const ContactResultPoint& p) {
    if (count < kMaxPoints) point[static_cast<std::size_t>(count++)] = p;
  }
};

/// The data that a family of pairs needs beyond the shapes.
struct ContactQuery {
  Real margin = Real(0);        ///< Points farther apart than this are not wanted [m].
  std::uint32_t last_axis = 0;  ///< ContactResult::axis of the last step; 0 if there was none.
};

// A key contains the kind of the point, and the vertices or edges of A and B.
inline constexpr std::uint32_t kVertexOfA = 0u << 30;
inline constexpr std::uint32_t kVertexOfB = 1u << 30;
inline constexpr std::uint32_t kCrossing = 2u << 30;
inline constexpr std::uint32_t kNearest = 3u << 30;

/// Keeps at most four points: the deepest, and those that span the largest area with it. Points whose keys
/// are among `old_keys` are preferred a little, so that the choice lasts from step to step. Points farther
/// apart than `margin` are removed.
void reduce_points(ContactResult& result, Real margin, std::span<const std::uint32_t> old_keys);

/// The least separation of the result's points [m]; infinite without points.
[[nodiscard]] Real deepest_of(const ContactResult& result);

/// Swaps the roles of A and B.
void swap_sides(ContactResult& result);

/// Whether the family of round pairs handles the two: two spheres or capsules, or a sphere with a box,
/// cylinder or cone.
[[nodiscard]] bool is_round_pair(ShapeKind a, ShapeKind b);
/// Uses nearest points in closed form. Concentric spheres separate upward.
void collide_round(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// Uses the 15 axes of two boxes; `axis`: 1..6 faces of A and B, 7..15 pairs of edges.
void collide_boxes(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// Uses the planes of the faces and the pairs of edges of two polyhedra with `hull` set.
void collide_hulls(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// Handles any two convex shapes: takes the best of the obvious axes and improves it by pushing the shapes
/// apart along it and finding their nearest points there.
void collide_convex(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// A is the half-space below the plane through `origin` across the unit vector `normal`.
void collide_half_space(Vec3 origin, Vec3 normal, const Convex& b, const ContactQuery& query,
                        ContactResult& result);

/// Calls the family for the two kinds. Neither is a half-space or a mesh of more than one triangle.
void collide(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

}  // namespace hooke::collision
