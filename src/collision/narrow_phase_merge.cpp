#include "base/take_turns.h"
#include "collision/narrow_phase.h"

namespace hooke::collision {

void NarrowPhase::merge_pairs(std::span<const ColliderPair> found, state::Pairs& pairs) {
  merged_.clear();
  auto old = pairs.pair.begin();
  for (const ColliderPair& f : found) {
    const auto key_of = [](const state::Pair& p) { return ColliderPair{p.collider_a, p.collider_b}; };
    while (old != pairs.pair.end() && key_of(*old) < f) ++old;
    if (old != pairs.pair.end() && key_of(*old) == f) {
      merged_.push_back(*old);
    } else {
      merged_.push_back({.collider_a = f.first, .collider_b = f.second});
    }
  }
  base::take_turns(merged_, pairs.pair);
}

}  // namespace hooke::collision
