#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_points.h"

#include <cstdint>

namespace hooke::collision {

/// A direction that may hold two shapes apart.
struct Axis {
  Vec3 n = {};                ///< From A to B, unit.
  Real separation = Real(0);  ///< Along n [m].
  std::uint32_t code = 0;     ///< Meeting::axis.
};

/// Codes of meet_convex: an axis that no feature gave, then faces of A and of B.
inline constexpr std::uint32_t kFreeAxis = 1;
inline constexpr std::uint32_t kAxisOfA = 0x10000;
inline constexpr std::uint32_t kAxisOfB = 0x20000;

// From evidence: with less, stacks of boxes change between equally good axes from step to step.
inline constexpr Real kKeepAxis = Real(5e-4);  ///< The last axis stays unless one is better by this [m].
inline constexpr Real kPreferFaces =
    Real(2e-3);  ///< Pairs of edges have to be better than faces by this [m].

/// A preference in meters, less for shapes that are themselves small.
[[nodiscard]] Real preference(Real full, const Convex& a, const Convex& b);

/// Nearest points, as offsets like those of Convex, and along which direction.
struct Nearest {
  Vec3 on_a = {};
  Vec3 on_b = {};
  bool known = false;
};

/// Moves `axis` to where the separation is largest nearby, starting from a good guess: pushes the shapes
/// apart along it and takes the direction between their nearest points, until that gains less than
/// `tolerance` [m]. Each step can only gain. (With B pushed by p along n to distance D in direction m, the
/// separation along m was D - p n.m, and D is at least the separation along n then.)
Nearest improve_axis(const Convex& a, const Convex& b, Real tolerance, Axis& axis);

/// The same for two shapes whose distance was found: where they are clearly apart it tells the axis.
Nearest improve_axis(const Convex& a, const Convex& b, const Distance& apart, Real tolerance, Axis& axis);

/// What gains by improve_axis are above rounding [m].
[[nodiscard]] Real axis_tolerance(const Convex& a, const Convex& b);

/// Drops points that are deeper than the shapes are (beside the end of a feature), and adds `nearest` if none
/// is as deep as the meeting's separation says.
void complete_points(const Nearest& nearest, Real tolerance, ContactResult& result);

}  // namespace hooke::collision
