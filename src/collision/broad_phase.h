#pragma once

#include "hooke/math.h"

#include "geometry/box.h"
#include "parallel/thread_pool.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::collision {

/// Who may meet whom, as the broad phase asks it.
struct BroadPhaseEntry {
  std::uint32_t collider = 0;
  bool moves = false;  ///< Two entries that do not move are never a pair.
};

/// Two colliders, first < second.
struct ColliderPair {
  std::uint32_t first = 0;
  std::uint32_t second = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): version 14 takes the comparison with 0 for a pointer's
  friend constexpr auto operator<=>(const ColliderPair&, const ColliderPair&) = default;
};

/// Finds overlapping boxes: trees of eight-wide nodes over fat boxes, one for what stands and one for what
/// moves. What it finds depends on the boxes alone, never on the history of the trees: a pair is reported
/// when its *tight* boxes overlap, so that a restored world finds the same pairs with a new tree.
class BroadPhase {
 public:
  /// Adds or moves a collider's box. Cheap while the box stays within its fat one.
  void set(std::uint32_t collider, const geometry::Box& box, bool moves);
  void remove(std::uint32_t collider);
  void clear();

  /// All pairs of overlapping boxes of which one moves, sorted, each once.
  void find_pairs(parallel::ThreadPool& pool, std::vector<ColliderPair>& pairs);

  /// Colliders whose boxes overlap `box`, in ascending order.
  void query(const geometry::Box& box, std::vector<std::uint32_t>& found) const;

  /// Colliders whose boxes, grown by `radius`, the segment from `origin` over `motion` passes; in ascending
  /// order.
  void query_sweep(DVec3 origin, DVec3 motion, Real radius, std::vector<std::uint32_t>& found) const;
};

}  // namespace hooke::collision
