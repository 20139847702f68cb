#pragma once

#include "hooke/math.h"

#include "base/assert.h"
#include "state/route.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// Contacts between bodies: pairs of colliders that are near each other, and the points where they touch.

namespace hooke::state {

/// A place where two colliders are closest or overlap.
struct ContactPoint {
  Vec3 anchor_a = {};             ///< Point on A, from A's center of mass, in world axes [m].
  Vec3 anchor_b = {};             ///< Point on B, from B's center of mass, in world axes [m].
  Real separation = Real(0);      ///< Gap along the normal; negative: overlap [m].
  Real normal_impulse = Real(0);  ///< Impulse of the last substep [N s], 0 or more.
  std::uint32_t key = 0;          ///< Names the features of A and B that meet here; it stays the same from
                                  ///< step to step.
};

/// Up to four points with one normal. A pair of convex shapes has at most one manifold; a body on a mesh has
/// one per patch.
struct Manifold {
  static constexpr int kMaxPoints = 4;
  static constexpr std::uint32_t kNoPatch = 0xFFFFFFFF;  ///< Patch of a manifold that has never had points.

  std::uint32_t collider_a = 0;  ///< Row; smaller than collider_b.
  std::uint32_t collider_b = 0;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t patch = 0;  ///< 0, or the lowest triangle of the patch of a mesh.
  std::int32_t point_count = 0;
  Vec3 normal = {};  ///< Unit vector from A to B.
  std::array<ContactPoint, kMaxPoints> point = {};
  // Impulses of the last substep are carried over for the next step's warm start.
  Vec3 friction_impulse = {};    ///< Impulse on B, across the normal [N s].
  Real twist_impulse = Real(0);  ///< Impulse about the normal [N m s].
  Vec3 rolling_impulse = {};     ///< [N m s]
  // The surface values of the pair come from its materials.
  Real friction = Real(0);
  Real static_friction = Real(0);
  Real restitution = Real(0);
  Real rolling_friction = Real(0);   ///< [m]
  Real spinning_friction = Real(0);  ///< [m]
  Vec3 surface_velocity = {};        ///< Velocity of B's surface relative to A's, in world axes [m/s].
  Real largest_impulse = Real(0);    ///< Largest sum over all points in one substep of the last step [N s].
  bool touching = false;             ///< Some point pushed in the last step; written by the solver.
  ContactRefresh refresh =
      ContactRefresh::kAtStart;  ///< How often its points are found; with kEachSubstep it may have none now.
  ContactRoute route = ContactRoute::kSoft;  ///< How it is solved in this step; see solver/routes.h.

  [[nodiscard]] bool is_refreshed() const { return refresh == ContactRefresh::kEachSubstep; }
  /// Whether it is in Pairs::coupled in this step.
  [[nodiscard]] bool is_coupled() const { return route == ContactRoute::kCoupled; }
};

/// Number of points that pushed in the last substep.
inline std::uint32_t pushing_points(const Manifold& m) {
  HOOKE_ASSERT(m.point_count >= 0 && m.point_count <= Manifold::kMaxPoints);
  std::uint32_t count = 0;
  for (std::int32_t i = 0; i < m.point_count; ++i)
    count += m.point[static_cast<std::size_t>(i)].normal_impulse > Real(0) ? 1 : 0;
  return count;
}

/// Sum of the impulses of its points in the last substep [N s].
inline Real normal_impulse(const Manifold& m) {
  Real sum = Real(0);
  for (std::int32_t i = 0; i < m.point_count; ++i) sum += m.point[static_cast<std::size_t>(i)].normal_impulse;
  return sum;
}

/// Deepest overlap of its points; 0 if none overlaps [m].
inline Real deepest_overlap(const Manifold& m) {
  Real deepest = Real(0);
  for (std::int32_t i = 0; i < m.point_count; ++i)
    deepest = std::max(deepest, -m.point[static_cast<std::size_t>(i)].separation);
  return deepest;
}

/// A manifold that is solved with the hooks and ropes of a coupled group (solver/coupled/coupled_groups.h).
struct CoupledManifold {
  std::uint32_t manifold = 0;  ///< Its row.
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  bool bears_load = false;  ///< It was chosen for its load (solver/coupled/load_bearing_contacts.h), not for
                            ///< what its bodies touch besides.
  // The fields below live for one step.
  std::int32_t block = -1;  ///< Its lane of solver::BodyContacts; -1 if it has none.
  std::int32_t lane = 0;
};

/// Motion of two bodies since their last exact test.
struct Drift {
  Vec3 displacement = {};  ///< Displacement of B's center relative to A's [m].
  Vec3 angle_a = {};       ///< Rotation of A [rad].
  Vec3 angle_b = {};
};

/// Two colliders whose boxes overlap. Rows stand in order of (collider_a, collider_b).
struct Pair {
  std::uint32_t collider_a = 0;  ///< Row; smaller than collider_b.
  std::uint32_t collider_b = 0;
  // The result of the last exact test is kept so that the next one can be skipped or start from it.
  Real gap = Real(0);      ///< Separation at that test, less what the bodies moved since; negative: overlap
                           ///< [m].
  Drift drift = {};        ///< Motion since that test.
  std::uint32_t axis = 0;  ///< Code of the narrow phase for the features that separated or touched.
  bool tested = false;     ///< False until the first exact test.
  // The fields below describe the manifolds of this step.
  std::uint32_t first_manifold = 0;
  std::uint32_t manifold_count = 0;
  Real time = Real(0);  ///< Part of the step after which the bodies are as the manifolds say; 0: now.
  ContactRefresh refresh = ContactRefresh::kAtStart;  ///< When its manifolds are made; see solver/routes.h.

  [[nodiscard]] bool is_refreshed() const { return refresh == ContactRefresh::kEachSubstep; }
};

/// Pose of a body when the narrow phase last read it.
struct SeenPose {
  DVec3 center = {};
  Quat rotation = {};
};

/// Pairs whose bodies all rest; see state/sleeping_pairs.h.
struct SleepingPairs {
  std::vector<Pair> pair;              ///< In order of colliders; first_manifold counts in `manifold`.
  std::vector<Manifold> manifold;      ///< In order of pair, then patch; some may no longer belong to a pair.
  std::vector<std::uint32_t> of_body;  ///< Number of sleeping pairs of each body, by its row; may be too
                                       ///< short for new bodies.
  std::uint32_t contacts = 0;          ///< Number of points that push.
  std::size_t waiting = 0;             ///< Number of pairs at rest that were not put to sleep in the last
                                       ///< step.
};

struct Pairs {
  std::vector<Pair> pair;
  std::vector<Manifold> manifold;        ///< In order of pair, then patch.
  std::vector<CoupledManifold> coupled;  ///< In order of manifold; valid in this step only.
  std::vector<SeenPose> seen;            ///< One for each body.
  SleepingPairs sleeping;                ///< These pairs are not among those above.
};

}  // namespace hooke::state
