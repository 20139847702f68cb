#pragma once

#include "hooke/math.h"

#include "state/route.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// Contacts between bodies: pairs of colliders that are near each other, and the points where they touch.

namespace hooke::state {

/// Where two colliders are closest or overlap.
struct ContactPoint {
  Vec3 anchor_a = {};             ///< On A, from A's center of mass, in world axes [m].
  Vec3 anchor_b = {};             ///< On B, from B's center of mass, in world axes [m].
  Real separation = Real(0);      ///< Along the normal; negative: overlap [m].
  Real normal_impulse = Real(0);  ///< Of the last substep [N s], 0 or more.
  std::uint32_t key = 0;          ///< Features of A and B that meet here: the same from step to step.
};

/// Up to four points with one normal. A convex pair has one at most; a body on a mesh has one per patch.
struct Manifold {
  static constexpr int kMaxPoints = 4;
  static constexpr std::uint32_t kNoPatch = 0xFFFFFFFF;  ///< Of a manifold that has never had points.

  std::uint32_t collider_a = 0;  ///< Row; less than collider_b.
  std::uint32_t collider_b = 0;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t patch = 0;  ///< 0, or the lowest triangle of the patch of a mesh.
  std::int32_t point_count = 0;
  Vec3 normal = {};  ///< From A to B, unit.
  std::array<ContactPoint, kMaxPoints> point = {};
  // Impulses of the last substep, carried over for the next step's warm start.
  Vec3 friction_impulse = {};    ///< On B, across the normal [N s].
  Real twist_impulse = Real(0);  ///< About the normal [N m s].
  Vec3 rolling_impulse = {};     ///< [N m s]
  // Surface of the pair, from its materials.
  Real friction = Real(0);
  Real static_friction = Real(0);
  Real restitution = Real(0);
  Real rolling_friction = Real(0);   ///< [m]
  Real spinning_friction = Real(0);  ///< [m]
  Vec3 surface_velocity = {};        ///< Of B's surface relative to A's, in world axes [m/s].
  Real largest_impulse = Real(0);    ///< Of all points in one substep of the last step [N s].
  bool touching = false;             ///< Some point pushed in the last step; written by the solver.
  ContactRefresh refresh = ContactRefresh::kAtStart;  ///< As its pair; each substep: may have no points now.
  ContactRoute route = ContactRoute::kSoft;           ///< How it is solved in this step; see solver/routes.h.

  [[nodiscard]] bool is_refreshed() const { return refresh == ContactRefresh::kEachSubstep; }
  /// Whether its points have slots in Pairs::load_bearing in this step.
  [[nodiscard]] bool is_load_bearing() const { return route == ContactRoute::kCoupled; }
};

/// Number of points that pushed in the last substep.
inline std::uint32_t pushing_points(const Manifold& m) {
  std::uint32_t count = 0;
  for (std::int32_t i = 0; i < m.point_count; ++i)
    count += m.point[static_cast<std::size_t>(i)].normal_impulse > Real(0) ? 1 : 0;
  return count;
}

/// Sum over its points of the last substep [N s].
inline Real normal_impulse(const Manifold& m) {
  Real sum = Real(0);
  for (std::int32_t i = 0; i < m.point_count; ++i) sum += m.point[static_cast<std::size_t>(i)].normal_impulse;
  return sum;
}

/// A place for a point of a manifold that is solved with what one of its bodies hangs on, in place of the
/// rows that others have (solver/coupled/load_bearing_contacts.h).
struct LoadBearingContact {
  std::uint32_t pair = 0;      ///< Row.
  std::uint32_t manifold = 0;  ///< Row: the only one of the pair.
  std::int32_t point = 0;      ///< Of Manifold::kMaxPoints; the manifold may have fewer now.
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  Real load = Real(0);          ///< What is lifted where they leave each other [kg].
  Real separation = Real(0);    ///< Where the bodies were at the start of the step, along their lines [m].
  Real normal_force = Real(0);  ///< In the last particle substep [N].
  Vec3 friction_force = {};     ///< On B [N].
  bool slides = false;
  Real largest_force = Real(0);  ///< Along the normal, in this step [N].
};

/// How two bodies moved since something was looked at.
struct Drift {
  Vec3 displacement = {};  ///< Of B's center against A's [m].
  Vec3 angle_a = {};       ///< [rad]
  Vec3 angle_b = {};
};

/// Two colliders whose boxes overlap. Rows stand in order of (collider_a, collider_b).
struct Pair {
  std::uint32_t collider_a = 0;  ///< Row; less than collider_b.
  std::uint32_t collider_b = 0;
  // What the last exact test found, so that the next can be skipped or begin where it ended.
  Real gap = Real(0);      ///< Separation then, less what the bodies moved since; negative: overlap [m].
  Drift drift = {};        ///< Since then.
  std::uint32_t axis = 0;  ///< Features that separated or touched: narrow phase's own code.
  bool tested = false;     ///< False until the first exact test.
  // Its manifolds of this step.
  std::uint32_t first_manifold = 0;
  std::uint32_t manifold_count = 0;
  Real time = Real(0);  ///< Part of the step after which they are as the manifolds say; 0: now.
  ContactRefresh refresh = ContactRefresh::kAtStart;  ///< When its manifolds are made; see solver/routes.h.

  [[nodiscard]] bool is_refreshed() const { return refresh == ContactRefresh::kEachSubstep; }
};

/// Where the narrow phase saw a body last.
struct SeenPose {
  DVec3 center = {};
  Quat rotation = {};
};

/// Pairs whose bodies all rest; see state/sleeping_pairs.h.
struct SleepingPairs {
  std::vector<Pair> pair;              ///< In order of colliders; first_manifold counts in `manifold`.
  std::vector<Manifold> manifold;      ///< In order of pair, then patch; some may belong to no pair any more.
  std::vector<std::uint32_t> of_body;  ///< Number of pairs, by row of body; may be too short for new ones.
  std::uint32_t contacts = 0;          ///< Points that push.
  std::size_t waiting = 0;             ///< Pairs at rest that were not parked in the last step.
};

struct Pairs {
  std::vector<Pair> pair;
  std::vector<Manifold> manifold;                ///< In order of pair, then patch.
  std::vector<LoadBearingContact> load_bearing;  ///< In order of manifold and point; of this step only.
  std::vector<SeenPose> seen;                    ///< Of each body.
  SleepingPairs sleeping;                        ///< Not among those above.
};

}  // namespace hooke::state
