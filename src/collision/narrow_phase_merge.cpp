#include "collision/narrow_phase.h"

#include <utility>
#include <vector>

namespace hooke::collision {

void merge_pairs(std::span<const ColliderPair> found, state::Pairs& pairs) {
  std::vector<state::Pair> merged;
  merged.reserve(found.size());
  auto old = pairs.pair.begin();
  for (const ColliderPair& f : found) {
    const auto key_of = [](const state::Pair& p) { return ColliderPair{p.collider_a, p.collider_b}; };
    while (old != pairs.pair.end() && key_of(*old) < f) ++old;
    if (old != pairs.pair.end() && key_of(*old) == f) {
      merged.push_back(*old);
    } else {
      merged.push_back({.collider_a = f.first, .collider_b = f.second});
    }
  }
  pairs.pair = std::move(merged);
}

}  // namespace hooke::collision
