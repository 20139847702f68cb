#pragma once

#include "hooke/desc.h"

#include "collision/broad_phase.h"
#include "collision/continuous_sweep.h"
#include "parallel/thread_pool.h"
#include "state/colliders.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// No body passes through another within a step, whatever the solver did.

namespace hooke::collision {

/// What a sweep may do to a body.
enum class Stoppable : std::uint8_t {
  kNever,  ///< It stands, or moves as told.
  kSlow,   ///< Only something that nothing stops makes it give way: its own way is less than its thickness.
  kAlways,
};

/// Bodies in motion, by row.
struct SweptBodies {
  std::vector<Path> path = {};
  std::vector<Stoppable> stoppable = {};
};

/// Sweeps the pairs (sorted) along the paths of their bodies, and lets bodies stop where they would go
/// through each other: impacts in order of time, then of pair; whoever stops is swept again, standing. A body
/// stopped by one that moves as told is carried in front of it. Returns the number of bodies stopped. The
/// result does not depend on the pool's number of threads.
std::uint32_t stop_at_impacts(parallel::ThreadPool& pool, const state::Colliders& colliders,
                              std::span<const ColliderPair> pairs, SweptBodies& bodies);

}  // namespace hooke::collision
