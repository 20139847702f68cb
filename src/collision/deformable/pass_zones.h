#pragma once

#include "hooke/math.h"

#include "collision/deformable/body_passes.h"
#include "parallel/thread_pool.h"
#include "state/body_manifolds.h"
#include "state/tables.h"

#include <cstdint>
#include <span>

namespace hooke::collision {

/// What hold_back_passes did.
struct HeldBack {
  std::uint32_t moved = 0;  ///< Number of points and bodies that it moved.
  std::uint32_t left = 0;   ///< Number of elements that shapes have come through all the same.
};

/// Ends a particle substep of `h` [s] in which points and bodies have moved. Takes back the motion of those
/// that have come through each other: they go on as one, with their common momentum, or with what moves as
/// told (rigid impact zones after Provot 1997, without their rotation). What meets such a zone becomes part
/// of it, and so does a body that another is moved into, until nothing passes. Only what is pressed between
/// two that both move as told may be left. Of objects that `solved_whole` marks, by row, all points belong to
/// a zone that has one of them: a point that is moved by itself strains what is stiff.
HeldBack hold_back_passes(parallel::ThreadPool& pool, Real h, std::span<const std::uint8_t> solved_whole,
                          state::BodyManifolds& manifolds, BodyPassFinder& finder, state::Tables& tables);

}  // namespace hooke::collision
