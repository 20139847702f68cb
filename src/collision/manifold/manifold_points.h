#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"

#include <array>
#include <cstdint>
#include <span>

/// \file
/// Where two convex shapes meet, before it becomes a state::Manifold: a normal, and points in order of
/// discovery. Each family of pairs has its file, manifold_*.cpp.

namespace hooke::collision {

/// Points where features of A and B meet. Offsets as in Convex.
struct ContactResultPoint {
  Vec3 on_a = {};
  Vec3 on_b = {};
  Real separation = Real(0);  ///< Along the normal [m].
  std::uint32_t key = 0;      ///< Of the features that meet: the same from step to step.
};

struct ContactResult {
  static constexpr int kMaxPoints = 32;

  Vec3 normal = {};  ///< From A to B, unit.
  Real separation =
      Real(0);             ///< Along it [m]: the shapes are not nearer to each other, except by overlapping.
  std::uint32_t axis = 0;  ///< What gave the normal, for the next step; each family has its code.
  int count = 0;           ///< 0 when they are farther apart than the margin.
  std::array<ContactResultPoint, kMaxPoints> point;

  /// More points than there is room for are dropped.
  void add(const ContactResultPoint& p) {
    if (count < kMaxPoints) point[static_cast<std::size_t>(count++)] = p;
  }
};

/// What a family of pairs needs to know beyond the shapes.
struct ContactQuery {
  Real margin = Real(0);        ///< Points farther apart are not wanted [m].
  std::uint32_t last_axis = 0;  ///< Meeting::axis of the last step; 0 if there was none.
};

// Keys: what kind of place it is, and the vertices or edges of A and B.
inline constexpr std::uint32_t kVertexOfA = 0u << 30;
inline constexpr std::uint32_t kVertexOfB = 1u << 30;
inline constexpr std::uint32_t kCrossing = 2u << 30;
inline constexpr std::uint32_t kNearest = 3u << 30;

/// Keeps at most four points: the deepest, and those that span the largest area with it. Points whose keys
/// are among `old_keys` are preferred a little, so that the choice lasts from step to step. Points farther
/// apart than `margin` go.
void reduce_points(ContactResult& result, Real margin, std::span<const std::uint32_t> old_keys);

/// The least separation of the meeting's points [m]; infinite without points.
[[nodiscard]] Real deepest_of(const ContactResult& result);

/// Swaps the roles of A and B.
void swap_sides(ContactResult& result);

/// Whether the family of round pairs knows the two: a sphere, capsule or a sphere with box, cylinder, cone.
[[nodiscard]] bool is_round_pair(ShapeKind a, ShapeKind b);
/// By nearest points in closed form. Concentric spheres separate upward.
void collide_round(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// Two boxes, by their 15 axes; `axis`: 1..6 faces of A and B, 7..15 pairs of edges.
void collide_boxes(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// Two polyhedra with `hull` set, by the planes of their faces and pairs of edges.
void collide_hulls(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// Any two convex shapes: the best of the obvious axes, improved by pushing the shapes apart along it and
/// looking where they are nearest then.
void collide_convex(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

/// A is the half-space below the plane through `origin` across the unit vector `normal`.
void collide_half_space(Vec3 origin, Vec3 normal, const Convex& b, const ContactQuery& query,
                        ContactResult& result);

/// The family that the two kinds ask for. Neither is a half-space or a mesh of more than one triangle.
void collide(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result);

}  // namespace hooke::collision
