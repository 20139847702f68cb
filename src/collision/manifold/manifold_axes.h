#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_points.h"
#include "collision/manifold/manifold_tuning.h"

#include <cstdint>

namespace hooke::collision {

/// A direction that may separate two shapes.
struct Axis {
  Vec3 n = {};                ///< Unit vector from A to B.
  Real separation = Real(0);  ///< Separation along n [m].
  std::uint32_t code = 0;     ///< Code as in ContactResult::axis.
};

/// Codes of collide_convex: an axis that no feature gave, then faces of A and of B.
inline constexpr std::uint32_t kFreeAxis = 1;
inline constexpr std::uint32_t kAxisOfA = 0x10000;
inline constexpr std::uint32_t kAxisOfB = 0x20000;

/// A preference in meters; it is reduced for shapes that are themselves small.
[[nodiscard]] Real preference(Real full, const Convex& a, const Convex& b);

/// Nearest points, as offsets like those of Convex, and the direction along which they are nearest.
struct Nearest {
  Vec3 on_a = {};
  Vec3 on_b = {};
  bool known = false;
};

/// Moves `axis` to where the separation is largest nearby, starting from a good guess. It pushes the shapes
/// apart along the axis and takes the direction between their nearest points, until that gains less than
/// `tolerance` [m]. Each step can only gain. (With B pushed by p along n to distance D in direction m, the
/// separation along m was D - p n.m, and D is at least the separation along n then.)
Nearest improve_axis(const Convex& a, const Convex& b, Real tolerance, Axis& axis);

/// Does the same for two shapes whose distance is known. If they are clearly apart, that distance gives the
/// axis.
Nearest improve_axis(const Convex& a, const Convex& b, const Distance& apart, Real tolerance, Axis& axis);

/// Gain of improve_axis that is above rounding [m].
[[nodiscard]] Real axis_tolerance(const Convex& a, const Convex& b);

/// Drops points that are deeper than the shapes are (beside the end of a feature), and adds `nearest` if none
/// is as deep as the result's separation says.
void complete_points(const Nearest& nearest, Real tolerance, ContactResult& result);

}  // namespace hooke::collision
