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

/// What the narrow phase did in a step.
struct NarrowPhaseCounts {
  std::uint32_t tested = 0;  ///< Pairs tested exactly.
  std::uint32_t cached = 0;  ///< Pairs that hardly moved, whose manifolds were carried along.
  std::uint32_t skipped =
      0;  ///< Pairs at rest, and those that cannot have come together since their last test.
  std::uint32_t ghosts = 0;  ///< Manifolds that were left out because another surface covers them.
};

/// The step that manifolds are made for.
struct NarrowPhaseStep {
  Real dt = Real(0);  ///< [s]
  int substeps = 1;
  std::span<const std::uint8_t> has_several_neighbors =
      {};  ///< By body row: 1 for what counts as in a crowd anyway.
  /// Rows of bodies: all others are where they were in the last step. Without a list it may be any.
  std::optional<std::span<const std::uint32_t>> moved_set = {};
};

/// Makes manifolds of pairs; what it holds is memory to be used again.
class NarrowPhase {
 public:
  NarrowPhase();
  ~NarrowPhase();
  NarrowPhase(NarrowPhase&&) noexcept;
  NarrowPhase& operator=(NarrowPhase&&) noexcept;

  /// Brings `pairs` up to date with the pairs the broad phase found (sorted): new ones come, lost ones go,
  /// those that stay keep what they remember. Those that nobody asked for stay, too (`asked`: as
  /// find_pairs_of has it; without any, for all). Filters by body, category, mask, group and hooks happen
  /// before.
  void merge_pairs(std::span<const ColliderPair> found, std::span<const std::uint8_t> asked,
                   state::Pairs& pairs);
  void merge_pairs(std::span<const ColliderPair> found, state::Pairs& pairs) {
    merge_pairs(found, {}, pairs);
  }

  /// Makes the manifolds of all pairs for this step, in order of pair and patch. Impulses of points that were
  /// there before are carried over: by key, then by the nearest anchor within 2 cm. `materials` is the
  /// world's table.
  ///
  /// Points up to 2 cm + (|v| + |omega| r) dt apart are kept: the solver lets them come together and no
  /// farther. Of triangles only where the way goes towards them. A pair whose bodies both sleep or stand
  /// keeps its manifolds as they are. A pair that was apart is tested again when its bodies may have come
  /// as near as that since. Manifolds of convex shapes that hardly moved against each other are carried
  /// along.
  ///
  /// A pair is lively whose points, levers or normals of the step's start would be wrong before its end: a
  /// body turns by more than 0.2 rad (0.02 where one of them is round), or the pair touches and one goes over
  /// the other by more than it is thick; and which as many looks as there are substeps are enough for. Not in
  /// a crowd. It has at least one manifold, a mesh some more, which may be without points until
  /// update_lively_manifolds finds some.
  NarrowPhaseCounts update_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                     const state::Colliders& colliders,
                                     std::span<const MaterialPairDesc> materials, const NarrowPhaseStep& step,
                                     state::Pairs& pairs);

  /// Which pairs update_lively_manifolds is for. To be called when no pair changes its row any more in this
  /// step: after update_manifolds, and after pairs were parked or taken back
  /// (state/sleeping_pairs.h).
  void list_refreshed(const state::Pairs& pairs);

  /// In the middle of a step: makes the manifolds of the lively pairs anew from where bodies are, in place,
  /// with separations of now and the impulses of the points that are still there. Anchors of A and B are the
  /// same place but for their way along the normal, halfway between the surfaces: an impulse there keeps the
  /// angular momentum. Points farther apart than 2 cm and what the bodies can come together in `h` [s] are
  /// left out.
  void refresh_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                         const state::Colliders& colliders, std::span<const MaterialPairDesc> materials,
                         Real h, state::Pairs& pairs);

  /// The same for one pair, lively or not, with its bodies in these poses, of their centers of mass. Not to
  /// be called by several threads at once.
  void refresh_at(const state::Bodies& bodies, const state::Colliders& colliders,
                  std::span<const MaterialPairDesc> materials, Real h, const Pose& a, const Pose& b,
                  std::uint32_t pair, state::Pairs& pairs);

 private:
  struct Buffers;  // narrow_phase.cpp
  std::unique_ptr<Buffers> buffers_;
  std::vector<state::Pair> merged_;
};

/// Closes the gaps that manifolds without points leave; those of lively pairs stay.
void remove_empty(state::Pairs& pairs);

}  // namespace hooke::collision
