#pragma once

#include "hooke/math.h"
#include "hooke/world.h"

#include "collision/manifold/manifold_points.h"
#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// Finds when two moving shapes meet within one step. Time is the part of the step that has passed, in [0,
/// 1].

namespace hooke::collision {

/// The even motion of a body through the rest of a step.
struct Path {
  DVec3 center = {};       ///< Center of mass at `since` [m].
  Quat rotation = {};      ///< Rotation at `since`.
  Vec3 displacement = {};  ///< Displacement of the center in a whole step [m].
  Vec3 turn = {};          ///< Rotation in a whole step, in world axes [rad].
  Real radius = Real(0);   ///< Radius of all shapes around the center of mass [m].
  Real inner = Real(0);    ///< Radius of a ball within the largest shape [m].
  Real since = Real(0);
};

/// The motion of a body in the next `dt` [s] if nothing changes its velocity.
[[nodiscard]] Path path_ahead(const state::Bodies& bodies, std::uint32_t body, Real dt);

/// Upper bound of the displacement of a point of the smaller body in a step as seen from the larger one [m].
/// It is small for bodies that fall or ride together.
[[nodiscard]] Real relative_displacement(const Path& a, const Path& b);

/// Center of mass and rotation of the body at `time`, which is not before `since`.
[[nodiscard]] Pose pose_at(const Path& path, Real time);

/// A collider and the path of its body.
struct SweptCollider {
  const state::Colliders& colliders;
  std::uint32_t row = 0;
  const Path& path;
};

/// Upper bound of how far a rotation can carry a point of the collider's core in a step [m]. It is zero for a
/// ball about the center of mass, whatever its spin.
[[nodiscard]] Real rotation_reach(const SweptCollider& collider);

struct Impact {
  Real time = Real(0);
  Vec3 normal = {};  ///< Unit vector from A to B.
};

/// Memory for find_impact.
struct SweepScratch {
  std::vector<std::uint32_t> triangles = {};
  std::vector<std::uint32_t> near = {};  ///< Triangles near a position.
  ContactResult result = {};
};

/// Overlap of two shapes from which a sweep says that they have met [m]. It is less than what would let them
/// pass each other, and more than the depth to which bodies at rest sink in. Shapes that slide along each
/// other do not meet.
[[nodiscard]] Real overlap_allowance(const SweptCollider& a, const SweptCollider& b);

/// Whether a single test shows that convex shapes cannot overlap by more than `allowance` [m] until the
/// step's end: along n, a unit vector from A to B, they are too far apart for how fast they come together. If
/// n is zero, the line between their middles is used. False for other shapes.
[[nodiscard]] bool are_separated(const SweptCollider& a, const SweptCollider& b, Vec3 n, Real allowance,
                                 Real begin);

/// When the shapes first overlap by more than `allowance` [m], which is positive, or by more than they do at
/// `begin`, which is not before the start of their paths. A mesh can be met from the front only. Finds
/// nothing for pairs that have no manifolds either (two meshes).
///
/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation", 1996): along the direction n that
/// separates the shapes most they cannot come together faster than
///
///   mu = n.(v_a - v_b) + |n x omega_a| r_a + |n x omega_b| r_b
///
/// so that nothing happens for gap / mu. n may be anything: the gap is measured along it, so a direction that
/// is not the best costs time, but misses nothing. After too many rounds the shapes count as having met.
[[nodiscard]] std::optional<Impact> find_impact(const SweptCollider& a, const SweptCollider& b,
                                                Real allowance, Real begin, SweepScratch& scratch);

}  // namespace hooke::collision
