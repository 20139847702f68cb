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
/// When two shapes in motion meet, within one step. Time is the part of the step that has gone by, in [0, 1].

namespace hooke::collision {

/// How a body moves through the rest of a step, evenly.
struct Path {
  DVec3 center = {};       ///< Of mass, at `since` [m].
  Quat rotation = {};      ///< At `since`.
  Vec3 displacement = {};  ///< Of the center, in a whole step [m].
  Vec3 turn = {};          ///< In a whole step, in world axes [rad].
  Real radius = Real(0);   ///< Around the center of mass, of all its shapes [m].
  Real inner = Real(0);    ///< Of a ball within its largest shape [m].
  Real since = Real(0);
};

/// How a body will move in the next `dt` [s] if nothing changes its velocity.
[[nodiscard]] Path path_ahead(const state::Bodies& bodies, std::uint32_t body, Real dt);

/// How far a point of the smaller body can get in a step as seen from the larger one, at most [m]: little for
/// those that fall, or ride, together.
[[nodiscard]] Real relative_displacement(const Path& a, const Path& b);

/// Where the center of mass is, and how the body is turned. Not before `since`.
[[nodiscard]] Pose pose_at(const Path& path, Real time);

/// A collider and the path of its body.
struct SweptCollider {
  const state::Colliders& colliders;
  std::uint32_t row = 0;
  const Path& path;
};

/// How far a point of the collider's core can get in a step by turning, at most [m]: none for a ball about
/// the center of mass, whatever its spin.
[[nodiscard]] Real rotation_reach(const SweptCollider& collider);

struct Impact {
  Real time = Real(0);
  Vec3 normal = {};  ///< From A to B, unit.
};

/// Memory for find_impact.
struct SweepScratch {
  std::vector<std::uint32_t> triangles = {};
  std::vector<std::uint32_t> near = {};  ///< Triangles at a place.
  ContactResult result = {};
};

/// How deep two shapes may overlap before a sweep says that they have met [m]: less than what would let them
/// pass each other, and more than what bodies at rest on each other sink in. Shapes that slide along each
/// other do not meet.
[[nodiscard]] Real overlap_allowance(const SweptCollider& a, const SweptCollider& b);

/// Whether one look shows that convex shapes cannot overlap by more than `allowance` [m] until the step's
/// end: along n, a unit vector from A to B, they are too far apart for how fast they come together. If n is
/// zero, along the line of their middles. False for other shapes.
[[nodiscard]] bool are_separated(const SweptCollider& a, const SweptCollider& b, Vec3 n, Real allowance,
                                 Real begin);

/// When the shapes first overlap by more than `allowance` [m], positive, or by more than they do at `begin`,
/// which is not before their paths'.
/// A mesh is met from the front only. Nothing for pairs that have no manifolds either (two meshes).
///
/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation", 1996): along the direction n that
/// holds the shapes farthest apart they cannot come together faster than
///
///   mu = n.(v_a - v_b) + |n x omega_a| r_a + |n x omega_b| r_b
///
/// so that nothing happens for gap / mu. n may be anything: the gap is measured along it, so a direction that
/// is not the best costs time, but misses nothing. After too many rounds the shapes count as having met.
[[nodiscard]] std::optional<Impact> find_impact(const SweptCollider& a, const SweptCollider& b,
                                                Real allowance, Real begin, SweepScratch& scratch);

}  // namespace hooke::collision
