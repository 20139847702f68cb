#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"

#include <array>
#include <cstdint>

/// \file
/// When a convex shape and a face or segment of a deformable meet, both in motion.

namespace hooke::collision {

/// A face or a segment whose corners move straight. Positions are offsets from a point near it.
struct MovingElement {
  std::array<Vec3, 3> corner = {};        ///< For a segment the last two are the same [m].
  std::array<Vec3, 3> displacement = {};  ///< [m]
  std::uint32_t count = 0;                ///< Number of points: 2 or 3.

  [[nodiscard]] Convex at(Real share) const;
};

/// A shape that moves straight and turns evenly about its body's center of mass. Positions are offsets from
/// the same point as those of the element.
struct MovingShape {
  Convex convex = {};      ///< At the start; not a mesh, and not a half-space.
  Vec3 pivot = {};         ///< Center of mass at the start [m].
  Vec3 displacement = {};  ///< Displacement of the center of mass [m].
  Vec3 turn = {};          ///< Rotation [rad].
  Real reach = Real(0);    ///< Largest distance of the shape's core from the center of mass [m].

  [[nodiscard]] Convex at(Real share) const;
};

/// Upper bound of how far a corner of the element moves as seen from the shape [m].
[[nodiscard]] Real relative_displacement(const MovingElement& element, const MovingShape& shape);

/// The first state in the motion of two in which they are as near as asked for.
struct ElementMeeting {
  bool met = false;
  bool crossed = false;             ///< The core of the shape crosses the element from the start.
  Real share = Real(0);             ///< Share of the motion after which they meet.
  Vec3 normal = {};                 ///< Unit vector from the shape to the element.
  Real distance = Real(0);          ///< Distance then; without a meeting, a lower bound at the start [m].
  std::array<Real, 3> weight = {};  ///< Weights of the points at the nearest place, with the sum 1.
  Vec3 place = {};                  ///< The nearest place of the element, then.
};

/// Looks for the first state in which the distance is `near` [m] or less; negative for as deep into the skin
/// of a sphere or a capsule. Uses conservative advancement along the normal of the nearest points: as along
/// it they are apart, they cannot meet before that distance is used up. After 40 rounds it says that they
/// have met.
[[nodiscard]] ElementMeeting meet(const MovingElement& element, const MovingShape& shape, Real near);

}  // namespace hooke::collision
