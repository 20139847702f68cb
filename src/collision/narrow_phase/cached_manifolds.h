#pragma once

#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <span>
#include <vector>

/// \file
/// Manifolds of pairs that hardly move against each other are kept instead of being made again.
///
/// For slow bodies of islands that are too large to be solved directly, this is more than a saving of time. A
/// stack buckles because the levers of its contacts follow the tilt that soft contacts allow. The stiff stack
/// that it stands for would not tilt. Rows that stay the same describe small displacements only, and under
/// them a stack does not buckle (docs/decisions/0004-body-contacts.md).

namespace hooke::collision {

/// Motion of a body since the narrow phase last saw it.
struct SmallMotion {
  Vec3 displacement = {};  ///< Displacement of the center of mass [m].
  Vec3 angle = {};         ///< Rotation [rad].
  Mat3 rotation_change = {
      {}, {}, {}};           ///< Maps an offset from the center to its displacement by the rotation.
  Real radius = Real(0);     ///< Radius of the body around its center of mass [m].
  Real reach = Real(0);      ///< Upper bound of the displacement of the body's points [m].
  Real tolerance = Real(0);  ///< Motion of two bodies against each other that is allowed before a new test
                             ///< [m].
  bool slow = false;         ///< The body is slow and belongs to a large island.
};

/// Motion of all bodies from one narrow phase to the next.
class SmallMotions {
 public:
  /// Finds the motion since `seen`, which is then replaced by the present poses. Bodies that are not in
  /// `moved_set` (rows) have not moved.
  void find(parallel::ThreadPool& pool, const state::Bodies& bodies, std::span<const std::uint32_t> moved_set,
            std::vector<state::SeenPose>& seen);

  [[nodiscard]] std::span<const SmallMotion> of_bodies() const { return motions_; }

 private:
  std::vector<SmallMotion> motions_ = {};
  std::vector<std::uint32_t> before_ = {};  // moved set of the last step: these may stand now
  std::vector<std::uint32_t> rows_ = {};
  std::vector<std::uint8_t> is_listed_ = {};
};

/// Adds the motion of the two bodies to `drift`.
void add_drift(const SmallMotion& a, const SmallMotion& b, state::Drift& drift);

/// Upper bound of how far points of the two have moved against each other [m].
[[nodiscard]] Real largest_drift(const SmallMotion& a, const SmallMotion& b, const state::Drift& drift);

/// Lower bound of a gap [m] after the motion of the two since the last step. It is rounded downwards, so that
/// this may be called any number of times.
[[nodiscard]] Real gap_after(const SmallMotion& a, const SmallMotion& b, Real gap);

/// Moves points and normals along with their bodies; the normal belongs to A if `fixed_is_a`, otherwise to B.
/// Separations follow to first order in the rotation of the bodies against each other. Between two slow
/// bodies only the separations change.
void move_cached_manifold(const SmallMotion& a, const SmallMotion& b, bool fixed_is_a,
                          state::Manifold& manifold);

}  // namespace hooke::collision
