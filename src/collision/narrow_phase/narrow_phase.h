#pragma once

#include "hooke/desc.h"
#include "hooke/world.h"

#include "collision/broad_phase/broad_phase.h"
#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace hooke::collision {

/// Counts what the narrow phase did in a step.
struct NarrowPhaseCounts {
  std::uint32_t tested = 0;  ///< Pairs tested exactly.
  std::uint32_t cached = 0;  ///< Pairs that hardly moved, whose cached manifolds were kept.
  std::uint32_t skipped =
      0;  ///< Pairs at rest, and those that cannot have come together since their last test.
  std::uint32_t ghosts = 0;  ///< Manifolds that were left out because another surface covers them.
};

/// The step for which manifolds are made.
struct NarrowPhaseStep {
  Real dt = Real(0);  ///< Length of the step [s].
  int substeps = 1;
  std::span<const std::uint8_t> has_several_neighbors =
      {};  ///< By body row: 1 for a body that counts as having several neighbors anyway.
  /// Rows of bodies: all others are where they were in the last step. Without a list any body may have moved.
  std::optional<std::span<const std::uint32_t>> moved_set = {};
};

/// A pair and the poses of its bodies' centers of mass for which its manifolds are to be made.
struct PosedPair {
  std::uint32_t pair = 0;  ///< Row of the pair.
  Pose a, b;
};

/// Makes the manifolds of pairs. Its members are memory to be used again.
class NarrowPhase {
 public:
  NarrowPhase();
  ~NarrowPhase();
  NarrowPhase(NarrowPhase&&) noexcept;
  NarrowPhase& operator=(NarrowPhase&&) noexcept;

  /// Brings `pairs` up to date with the pairs that the broad phase found (sorted). New pairs are added, lost
  /// ones are removed, and the others keep what they remember. Pairs that nobody asked for stay, too
  /// (`asked`: as in find_pairs_of; an empty list asks for all). Filters by body, category, mask, group and
  /// hooks are applied before.
  void merge_pairs(std::span<const ColliderPair> found, std::span<const std::uint8_t> asked,
                   state::Pairs& pairs);
  void merge_pairs(std::span<const ColliderPair> found, state::Pairs& pairs) {
    merge_pairs(found, {}, pairs);
  }

  /// Makes the manifolds of all pairs for this step, in order of pair and patch. Impulses of points that
  /// existed before are carried over: by key, then by the nearest anchor within 2 cm. `materials` is the
  /// world's table.
  ///
  /// Points up to 2 cm + (|v| + |omega| r) dt apart are kept: the solver lets them come together and no
  /// farther. Triangles need this margin only where the motion goes towards them. A pair whose bodies both
  /// sleep or stand keeps its manifolds as they are. A pair that was apart is tested again when its bodies
  /// may have come as near as that since. Cached manifolds of convex shapes that hardly moved against each
  /// other are moved along.
  ///
  /// A pair is refreshed each substep if the points, levers or normals of the step's start would be wrong
  /// before its end: a body rotates by more than 0.2 rad (0.02 where one of them is round), or the pair
  /// touches and one moves over the other by more than it is thick. One refresh per substep must be enough
  /// for that motion, and the pair must not be in a dense pile. Such a pair has at least one manifold, with a
  /// mesh some more. They may be without points until refresh_manifolds finds some.
  NarrowPhaseCounts update_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                     const state::Colliders& colliders,
                                     std::span<const MaterialPairDesc> materials, const NarrowPhaseStep& step,
                                     state::Pairs& pairs);

  /// Lists the pairs for refresh_manifolds. To be called when no pair changes its row any more in this step:
  /// after update_manifolds, and after pairs were put to sleep or woken (state/sleeping_pairs.h).
  void list_refreshed(const state::Pairs& pairs);

  /// Makes the manifolds of the refreshed pairs again in the middle of a step, in place. Separations are
  /// those of the present poses, and points that still exist keep their impulses. Anchors of A and B are the
  /// same position except along the normal, halfway between the surfaces: an impulse there keeps the angular
  /// momentum. Points farther apart than 2 cm and what the bodies can come together in `h` [s] are left out.
  void refresh_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                         const state::Colliders& colliders, std::span<const MaterialPairDesc> materials,
                         Real h, state::Pairs& pairs);

  /// Does the same for one pair, listed or not, with its bodies in the given poses. Not to be called by
  /// several threads at once.
  void refresh_at(const state::Bodies& bodies, const state::Colliders& colliders,
                  std::span<const MaterialPairDesc> materials, Real h, const PosedPair& posed,
                  state::Pairs& pairs);

 private:
  struct Buffers;  // narrow_phase.cpp
  std::unique_ptr<Buffers> buffers_;
  std::vector<state::Pair> merged_;
};

/// Closes the gaps that manifolds without points leave; those of refreshed pairs stay.
void remove_empty(state::Pairs& pairs);

}  // namespace hooke::collision
