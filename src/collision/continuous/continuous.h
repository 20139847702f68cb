#pragma once

#include "hooke/desc.h"

#include "collision/broad_phase/broad_phase.h"
#include "collision/continuous/continuous_sweep.h"
#include "collision/continuous/continuous_tuning.h"
#include "parallel/thread_pool.h"
#include "state/colliders.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

/// \file
/// Keeps bodies from passing through each other within a step, whatever the solver did.

namespace hooke::collision {

/// The effect that a sweep may have on a body.
enum class Stoppable : std::uint8_t {
  kNever,  ///< The body stands, moves as told, or hangs on others.
  kSlow,   ///< Only something heavy that nothing stops can clamp the body: its own displacement is less than
           ///< its thickness.
  kAlways,
};

/// Columns of moving bodies, by row.
struct SweptBodies {
  struct Clamps {
    int count = 0;
    Real first = Real(1);  ///< Time at which the body was first clamped; from then on it does not rotate.
  };

  std::vector<Path> path = {};
  std::vector<Stoppable> stoppable = {};
  std::vector<Real> inverse_mass = {};  ///< [1/kg]; zero for bodies that move as told.
  std::vector<Clamps> clamps = {};
};

/// Two colliders that may run into each other.
struct ImpactCandidate {
  ColliderPair pair = {};
  Vec3 apart = {};  ///< Direction from the first to the second that may separate them; zero if none is known.
};

/// The pairs that lie in the path of a body.
struct PathScratch {
  std::vector<ColliderPair> pairs = {};
  std::vector<std::uint32_t> near = {};  ///< Colliders; for FindPairs to use.
};

/// Replaces `scratch.pairs` by the pairs of a body's colliders with all that its path may meet, now that the
/// body has been clamped. Bodies that were clamped before count with their present paths.
using FindPairs = std::function<void(std::uint32_t body, PathScratch& scratch)>;

/// Memory of clamp_to_impact_times.
class ContinuousScratch {
 public:
  struct Buffers;  // continuous.cpp

  ContinuousScratch();
  ~ContinuousScratch();
  ContinuousScratch(ContinuousScratch&&) noexcept;
  ContinuousScratch& operator=(ContinuousScratch&&) noexcept;

  [[nodiscard]] Buffers& buffers() { return *buffers_; }

 private:
  std::unique_ptr<Buffers> buffers_;
};

/// Sweeps `candidates`, each pair once, along the paths of their bodies, and clamps bodies where they would
/// go through each other. Impacts are handled in order of time, then of pair. A clamped body is swept again
/// from there against what `find_pairs` finds.
///
/// A clamped body stops its rotation and loses the part of its displacement that takes it towards the other
/// body, so that it never leaves the ball of half its displacement around it. If the other body is one that
/// nothing stops, and is no lighter, it follows that one. Shapes that approach slowly for their thickness are
/// left to contacts. Returns how often bodies were clamped. The result does not depend on the pool's number
/// of threads.
std::uint32_t clamp_to_impact_times(parallel::ThreadPool& pool, const state::Colliders& colliders,
                                    std::span<const ImpactCandidate> candidates, const FindPairs& find_pairs,
                                    ContinuousScratch& scratch, SweptBodies& bodies);

}  // namespace hooke::collision
