#pragma once

#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <span>
#include <vector>

/// \file
/// Manifolds of pairs that hardly move against each other are kept instead of being made anew.
///
/// Between calm bodies of islands that are too large to be solved directly it is more than a saving of time.
/// Levers that follow what soft contacts let a stack lean are what it buckles by; the stiff one it stands for
/// would not lean. Rows that stay the same know only small displacements, and give a stack nothing to buckle
/// by (docs/decisions/0004-body-contacts.md).

namespace hooke::collision {

/// How a body moved since the narrow phase last saw it.
struct SmallMotion {
  Vec3 displacement = {};  ///< Of the center of mass [m].
  Vec3 angle = {};         ///< [rad]
  Mat3 rotation_change = {
      {}, {}, {}};           ///< How far points moved from their place about the center by turning.
  Real radius = Real(0);     ///< Of the body, around its center of mass [m].
  Real reach = Real(0);      ///< No point of the body moved farther [m].
  Real tolerance = Real(0);  ///< What two bodies may move against each other before a new test [m].
  bool slow = false;         ///< And of a large island.
};

/// How all bodies moved, from one narrow phase to the next.
class SmallMotions {
 public:
  /// Since `seen`, which becomes what is seen now. Those not `stirred` (rows) are where they were.
  void find(parallel::ThreadPool& pool, const state::Bodies& bodies, std::span<const std::uint32_t> moved_set,
            std::vector<state::SeenPose>& seen);

  [[nodiscard]] std::span<const SmallMotion> of_bodies() const { return motions_; }

 private:
  std::vector<SmallMotion> motions_ = {};
  std::vector<std::uint32_t> before_ = {};  // stirred in the last step: they may stand now
  std::vector<std::uint32_t> rows_ = {};
  std::vector<std::uint8_t> is_listed_ = {};
};

/// Adds what the two moved.
void add_drift(const SmallMotion& a, const SmallMotion& b, state::Drift& drift);

/// How far points of the two can be from where they were against each other [m].
[[nodiscard]] Real largest_drift(const SmallMotion& a, const SmallMotion& b, const state::Drift& drift);

/// What is left for certain of a gap [m] after what the two moved since the last step. Rounded downwards, so
/// that it may be called any number of times.
[[nodiscard]] Real gap_after(const SmallMotion& a, const SmallMotion& b, Real gap);

/// Moves points and normals along with their bodies; the normal belongs to `fixed`, A or B. Separations
/// follow to first order in what the bodies turned against each other. Between two calm bodies only they do.
void move_cached_manifold(const SmallMotion& a, const SmallMotion& b, bool fixed_is_a,
                          state::Manifold& manifold);

}  // namespace hooke::collision
