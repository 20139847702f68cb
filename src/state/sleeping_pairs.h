#pragma once

#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Pairs whose bodies all rest stand in tables of their own, so that a step costs what moves and not what
/// there is. Whoever asks for all contacts looks at both.
///
/// Each of them is as it was when it was parked: what is at rest makes no new manifolds. So a step is the
/// same wherever they stand.

namespace hooke::state {

/// Whether the body stays where it is in this step.
[[nodiscard]] bool stands(const Bodies& bodies, std::uint32_t body);

/// Whether the manifolds of a pair stay those of the last step: it was tested, and both bodies stand.
[[nodiscard]] bool rests(const Bodies& bodies, const Colliders& colliders, const Pair& pair);

/// Rows stand in this order.
[[nodiscard]] inline bool comes_before(const Pair& p, const Pair& q) {
  return p.collider_a != q.collider_a ? p.collider_a < q.collider_a : p.collider_b < q.collider_b;
}

/// Memory for those below.
struct SleepingPairScratch {
  std::vector<Pair> moved = {};
  std::vector<Pair> pair = {};
  std::vector<Manifold> manifold = {};
};

/// Makes room for all pairs of a step to be parked in one to come.
void reserve_sleeping_pairs(Pairs& pairs, SleepingPairScratch& scratch);

/// Parks pairs that rest: all of them where there are as many as in the last step, or else when there are
/// many for those that are parked already, which have to be copied. Not those of sensors, which remember in
/// them who is inside.
void put_pairs_to_sleep(const Bodies& bodies, const Colliders& colliders, Pairs& pairs,
                        SleepingPairScratch& scratch);

/// Takes back the pairs that do not rest any more, if they belong to a body of `moving`. Rows of pairs and
/// manifolds change. Returns whether there were any.
bool wake_pairs(std::span<const std::uint32_t> moving, const Bodies& bodies, const Colliders& colliders,
                Pairs& pairs, SleepingPairScratch& scratch);

/// Removes the pairs with a body that goes; `goes` by row of body.
void remove_pairs(std::span<const std::uint8_t> goes, const Colliders& colliders, Pairs& pairs);

/// Calls `visit(manifold)` for all of them, parked or not, in order of pair and patch.
template <class Visit>
void for_each_manifold(const Pairs& pairs, Visit&& visit) {
  const auto visit_pair = [&visit](const Pair& pair, const std::vector<Manifold>& manifolds) {
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
