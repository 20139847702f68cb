#pragma once

#include "base/assert.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Pairs whose bodies all rest stand in tables of their own, so that a step costs only what moves. Code that
/// needs all contacts must read both tables.
///
/// A sleeping pair stays as it was when it was put to sleep, because bodies at rest make no new manifolds. So
/// a step has the same result in whichever table pairs stand.

namespace hooke::state {

/// Whether the body stays where it is in this step.
[[nodiscard]] bool stands(const Bodies& bodies, std::uint32_t body);

/// Whether a pair keeps the manifolds of the last step: it was tested, and both bodies stand.
[[nodiscard]] bool rests(const Bodies& bodies, const Colliders& colliders, const Pair& pair);

/// Rows of pairs stand in this order.
[[nodiscard]] inline bool comes_before(const Pair& p, const Pair& q) {
  return p.collider_a != q.collider_a ? p.collider_a < q.collider_a : p.collider_b < q.collider_b;
}

/// Memory for the functions below.
struct SleepingPairScratch {
  std::vector<Pair> moved = {};
  std::vector<Pair> pair = {};
  std::vector<Manifold> manifold = {};
};

/// Makes room for all pairs of a step, so that a later step can put them to sleep.
void reserve_sleeping_pairs(Pairs& pairs, SleepingPairScratch& scratch);

/// Puts pairs that rest to sleep. It takes all of them if their number is that of the last step, or if they
/// are many compared with the sleeping pairs, which have to be copied. Pairs of sensors stay awake, because
/// they remember who is inside.
void put_pairs_to_sleep(const Bodies& bodies, const Colliders& colliders, Pairs& pairs,
                        SleepingPairScratch& scratch);

/// Takes back the pairs that do not rest any more, if they belong to a body of `moving`. Rows of pairs and
/// manifolds change. Returns whether there were any.
bool wake_pairs(std::span<const std::uint32_t> moving, const Bodies& bodies, const Colliders& colliders,
                Pairs& pairs, SleepingPairScratch& scratch);

/// Removes the pairs of bodies that are removed; `goes` says which, by row of body.
void remove_pairs(std::span<const std::uint8_t> goes, const Colliders& colliders, Pairs& pairs);

/// Calls `visit(manifold)` for all manifolds, sleeping or not, in order of pair and patch.
template <class Visit>
void for_each_manifold(const Pairs& pairs, Visit&& visit) {
  const auto visit_pair = [&visit](const Pair& pair, const std::vector<Manifold>& manifolds) {
    HOOKE_ASSERT(std::size_t{pair.first_manifold} + pair.manifold_count <= manifolds.size());
    for (std::size_t i = 0; i < pair.manifold_count; ++i) visit(manifolds[pair.first_manifold + i]);
  };
  auto sleeping = pairs.sleeping.pair.begin();
  const auto visit_sleeping = [&] { visit_pair(*sleeping++, pairs.sleeping.manifold); };
  for (const Pair& pair : pairs.pair) {
    while (sleeping != pairs.sleeping.pair.end() && comes_before(*sleeping, pair)) visit_sleeping();
    visit_pair(pair, pairs.manifold);
  }
  while (sleeping != pairs.sleeping.pair.end()) visit_sleeping();
}

}  // namespace hooke::state
