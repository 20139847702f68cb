#pragma once

#include "hooke/math.h"
#include "hooke/shape.h"

#include "geometry/convex/convex_hull.h"

#include <array>
#include <limits>

/// \file
/// Convex shapes in their places, and the distance between two of them.

namespace hooke::collision {

/// A convex shape with its position and rotation. Positions are offsets from a point near both shapes of a
/// pair, in world axes, so that Real resolves them wherever in the world they are. A sphere is a point and a
/// capsule a segment with a skin around it: `core` below means the shape without its skin.
struct Convex {
  Shape shape = {};  ///< Kind and sizes; kMesh: the one triangle `corners`. Never a half-space.
  Vec3 center = {};  ///< Origin of the shape's frame.
  Mat3 axes = {};    ///< Axes of the shape's frame.
  const geometry::ConvexHull* hull = nullptr;  ///< Set for a hull, and for a box that is to be treated as
                                               ///< one.
  std::array<Vec3, 3> corners = {};            ///< For kMesh, counter-clockwise from the front.
};

/// Thickness of the skin around the core [m].
[[nodiscard]] Real skin_of(const Convex& convex);

/// A point inside the shape, about its middle.
[[nodiscard]] Vec3 middle_of(const Convex& convex);

/// About half of the least width [m]; 0 for a triangle.
[[nodiscard]] Real thinness_of(const Convex& convex);

/// Unit vector along the part of `d` across the unit vector `axis`; `otherwise` if there is none.
[[nodiscard]] Vec3 direction_across(Vec3 axis, Vec3 d, Vec3 otherwise);

/// The point of the core that lies farthest along `direction` (any length; a zero one gives any point).
[[nodiscard]] Vec3 support_of(const Convex& convex, Vec3 direction);

/// Least distance between the planes across the unit vector `n` that separate `a` and `b`, b on the side of
/// n; negative when they overlap along n [m]. Never more than the distance of the shapes.
[[nodiscard]] Real separation_along(const Convex& a, const Convex& b, Vec3 n);

/// The nearest points of two shapes.
struct Distance {
  Real distance = Real(0);  ///< [m]; negative when only the skins overlap.
  Vec3 point_a = {};        ///< Point on the surface, if the cores are apart.
  Vec3 point_b = {};
  Vec3 normal = {};            ///< Unit vector from A to B; zero when the cores overlap.
  bool cores_overlap = false;  ///< Then `distance` is the skins' thickness, negated, and does not say how
                               ///< deep they overlap.
};

/// Distance by the method of Gilbert, Johnson and Keerthi (1988), with supports in Real and the simplex in
/// double. The number of iterations is bounded; the result is good to about 1e-6 of the shapes' size. For a
/// triangle (a) and a capsule (b) it is computed directly, whatever `enough` is.
///
/// Shapes farther apart than `enough` [m] are not refined: then the distance is a lower bound above `enough`,
/// without points and normal.
[[nodiscard]] Distance distance_between(const Convex& a, const Convex& b,
                                        Real enough = std::numeric_limits<Real>::infinity());

}  // namespace hooke::collision
