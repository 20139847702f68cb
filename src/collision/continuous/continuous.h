#pragma once

#include "hooke/desc.h"

#include "collision/broad_phase/broad_phase.h"
#include "collision/continuous/continuous_sweep.h"
#include "parallel/thread_pool.h"
#include "state/colliders.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

/// \file
/// No body passes through another within a step, whatever the solver did.

namespace hooke::collision {

/// How far bodies may move unseen, in half thicknesses.
inline constexpr Real kUnseenDisplacement = Real(0.5);

/// What a sweep may do to a body.
enum class Stoppable : std::uint8_t {
  kNever,  ///< It stands, moves as told, or hangs on others.
  kSlow,   ///< Only something heavy that nothing stops makes it give way: its own way is less than its
           ///< thickness.
  kAlways,
};

/// Bodies in motion, by row.
struct SweptBodies {
  struct Clamps {
    int count = 0;
    Real first = Real(1);  ///< When it gave way first; from then on it does not turn.
  };

  std::vector<Path> path = {};
  std::vector<Stoppable> stoppable = {};
  std::vector<Real> inverse_mass = {};  ///< [1/kg]; zero of what moves as told.
  std::vector<Clamps> clamps = {};
};

/// Two colliders that may run into each other.
struct ImpactCandidate {
  ColliderPair pair = {};
  Vec3 apart = {};  ///< From the first to the second: may hold them apart; zero if none is known.
};

/// What is in the way of a body.
struct PathScratch {
  std::vector<ColliderPair> pairs = {};
  std::vector<std::uint32_t> near = {};  ///< Colliders; for FindPairs to use.
};

/// Replaces `scratch.pairs` by the pairs of a body's colliders with all that may be in their way, now that
/// the body has given way; those that gave way before are in each other's way where they go now.
using FindPairs = std::function<void(std::uint32_t body, PathScratch& scratch)>;

/// Memory of give_way_at_impacts.
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

/// Sweeps `encounters`, each pair once, along the paths of their bodies, and lets bodies give way where they
/// would go through each other: impacts in order of time, then of pair; whoever gives way is swept again from
/// there against what `find_pairs` finds.
///
/// A body that gives way ceases to turn, and loses that part of its own speed which takes it towards the
/// other (so that it never leaves the ball of half its way around it); before one that nothing stops, and
/// that is no lighter, it goes as that one does. What comes together slowly for its thickness is left to
/// contacts. Returns how often bodies gave way. The result does not depend on the pool's number of threads.
std::uint32_t clamp_to_impact_times(parallel::ThreadPool& pool, const state::Colliders& colliders,
                                    std::span<const ImpactCandidate> candidates, const FindPairs& find_pairs,
                                    ContinuousScratch& scratch, SweptBodies& bodies);

}  // namespace hooke::collision
