#include "base/assert.h"
#include "base/take_turns.h"
#include "collision/narrow_phase/narrow_phase.h"

#include <algorithm>
#include <functional>

namespace hooke::collision {

void remove_empty(state::Pairs& pairs) {
  std::uint32_t remaining = 0;
  for (state::Pair& pair : pairs.pair) {
    const std::uint32_t end = pair.first_manifold + pair.manifold_count;
    HOOKE_ASSERT(remaining <= pair.first_manifold && end <= pairs.manifold.size());
    const std::uint32_t first = remaining;
    for (std::uint32_t i = pair.first_manifold; i < end; ++i) {
      if (pairs.manifold[i].point_count == 0 && !pair.is_refreshed()) continue;
      pairs.manifold[remaining++] = pairs.manifold[i];
    }
    pair.first_manifold = first;
    pair.manifold_count = remaining - first;
  }
  pairs.manifold.resize(remaining);
}

void NarrowPhase::merge_pairs(std::span<const ColliderPair> found, std::span<const std::uint8_t> asked,
                              state::Pairs& pairs) {
  HOOKE_ASSERT(std::adjacent_find(found.begin(), found.end(), std::greater_equal<>()) == found.end());
  merged_.clear();
  auto old = pairs.pair.begin();
  const auto key_of = [](const state::Pair& p) { return ColliderPair{p.collider_a, p.collider_b}; };
  const auto is_asked = [asked](const state::Pair& p) {
    return asked.empty() || (asked[p.collider_a] | asked[p.collider_b]) != 0;
  };
  const auto pass_while = [&](const auto& is_before) {
    for (; old != pairs.pair.end() && is_before(key_of(*old)); ++old)
      if (!is_asked(*old)) merged_.push_back(*old);
  };
  for (const ColliderPair& f : found) {
    pass_while([&f](const ColliderPair& key) { return key < f; });
    if (old != pairs.pair.end() && key_of(*old) == f) {
      merged_.push_back(*old++);
    } else {
      merged_.push_back({.collider_a = f.first, .collider_b = f.second});
    }
  }
  pass_while([](const ColliderPair&) { return true; });
  base::take_turns(merged_, pairs.pair);
}

}  // namespace hooke::collision
