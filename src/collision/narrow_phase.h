#pragma once

#include "hooke/desc.h"

#include "collision/broad_phase.h"
#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hooke::collision {

/// What the narrow phase did in a step.
struct NarrowPhaseCounts {
  std::uint32_t tested = 0;  ///< Pairs tested exactly.
  std::uint32_t kept = 0;    ///< Pairs that hardly moved, whose manifolds were carried along.
  std::uint32_t skipped =
      0;  ///< Pairs at rest, and those that cannot have come together since their last test.
  std::uint32_t ghosts = 0;  ///< Manifolds that were left out because another surface covers them.
};

/// Makes manifolds of pairs; what it holds is memory to be used again.
class NarrowPhase {
 public:
  NarrowPhase();
  ~NarrowPhase();
  NarrowPhase(NarrowPhase&&) noexcept;
  NarrowPhase& operator=(NarrowPhase&&) noexcept;

  /// Brings `pairs` up to date with the pairs the broad phase found (sorted): new ones come, lost ones go,
  /// those that stay keep what they remember. Filters by body, category, mask, group and hooks happen before.
  void merge_pairs(std::span<const ColliderPair> found, state::Pairs& pairs);

  /// Makes the manifolds of all pairs for this step, in order of pair and patch. Impulses of points that were
  /// there before are carried over: by key, then by the nearest anchor within 2 cm. `materials` is the
  /// world's table.
  ///
  /// Points up to 2 cm + (|v| + |omega| r) dt apart are kept: the solver lets them come together and no
  /// farther. A pair whose bodies both sleep or stand keeps its manifolds as they are. A pair that was apart
  /// is tested again when the odometers of its bodies say that they may have met. Manifolds of convex shapes
  /// that hardly moved against each other are carried along.
  NarrowPhaseCounts update_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                     const state::Colliders& colliders,
                                     std::span<const MaterialPairDesc> materials, Real dt,
                                     state::Pairs& pairs);

 private:
  struct Buffers;  // narrow_phase.cpp
  std::unique_ptr<Buffers> buffers_;
  std::vector<state::Pair> merged_;
};

}  // namespace hooke::collision
