#pragma once

#include "hooke/math.h"

#include "collision/broad_phase/broad_phase_tree.h"
#include "geometry/box.h"
#include "geometry/ray_slabs.h"
#include "parallel/thread_pool.h"

#include <cmath>
#include <compare>
#include <cstdint>
#include <map>
#include <vector>

namespace hooke::collision {

/// Two colliders, first < second.
struct ColliderPair {
  std::uint32_t first = 0;
  std::uint32_t second = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): version 14 takes the comparison with 0 for a pointer's
  friend constexpr auto operator<=>(const ColliderPair&, const ColliderPair&) = default;
};

/// Finds overlapping boxes with two trees of eight-wide nodes, one for what stands and one for what moves.
/// The tree holds the boxes of movers with a margin (fat boxes). Pairs whose fat boxes overlap are remembered
/// as candidates, so that a step searches only for those that left their fat box and filters the rest.
///
/// What it finds depends on the boxes set alone, never on the history of the trees: a pair is reported when
/// its *tight* boxes overlap, so that a restored world finds the same pairs with a new tree.
///
/// Boxes may be infinite or beyond kHuge; those are kept outside the trees and are tested against every
/// mover. No box is empty and no coordinate NaN. Collider numbers are below 2^31; memory grows with the
/// largest.
class BroadPhase {
 public:
  /// Coordinates beyond this count as infinite: surfaces of boxes could overflow a float [m].
  static constexpr Real kHuge = Real(1e18);

  /// Adds or moves a collider's box. This is cheap while the box stays within its fat one. Two colliders that
  /// do not move are never a pair, nor two of the same collision group, which a collider joins when it is
  /// added (0: none).
  void set(std::uint32_t collider, const geometry::Box& box, bool moves, std::int32_t group = 0);
  /// Removes a collider's box. Does nothing for a collider that has none.
  void remove(std::uint32_t collider);
  /// Resets to the state of a new object, but keeps the memory.
  void clear();

  /// Brings the trees up to date. find_pairs does so too. Queries are right without it, but slower after many
  /// colliders were added.
  void update();

  /// Replaces `pairs` by all pairs of overlapping boxes of which at least one moves, sorted, each once.
  void find_pairs(parallel::ThreadPool& pool, std::vector<ColliderPair>& pairs);
  /// Finds only those pairs of which at least one collider is asked for (`asked`: by collider, 1 or 0; an
  /// empty list asks for all). Two colliders whose boxes have not changed are a pair if they were one before.
  void find_pairs_of(parallel::ThreadPool& pool, std::span<const std::uint8_t> asked,
                     std::vector<ColliderPair>& pairs);

  /// Replaces `found` by the colliders whose boxes overlap `box`, in ascending order.
  void query(const geometry::Box& box, std::vector<std::uint32_t>& found) const;
  /// Does the same, but leaves out the collision group of `collider`.
  void query_for(std::uint32_t collider, const geometry::Box& box, std::vector<std::uint32_t>& found) const;

  /// Replaces `found` by the colliders whose boxes, grown by `radius` on every side, are crossed by the
  /// segment from `origin` over `motion` (all finite, may be zero); in ascending order.
  void query_sweep(DVec3 origin, DVec3 motion, Real radius, std::vector<std::uint32_t>& found) const;

  /// Calls `visit(collider)` for the colliders that query_sweep would find, roughly from near to far. `visit`
  /// returns the fraction of `motion` beyond which the caller needs nothing more.
  template <class Visit>
  void visit_sweep(DVec3 origin, DVec3 motion, Real radius, Visit&& visit) const;

  /// Calls `visit(collider)` for the colliders whose boxes are at most `reach` from `point` [m], roughly from
  /// near to far. `visit` returns the distance beyond which the caller needs nothing more.
  template <class Visit>
  void visit_near(DVec3 point, double reach, Visit&& visit) const;

 private:
  /// The table that keeps a collider's box.
  enum class Home : std::uint8_t { kNone, kStanding, kMoving, kUnbounded };
  struct Entry {
    Home home = Home::kNone;
    bool moves = false;
    bool changed = false;  // since the last find_pairs: its candidates are no longer valid
    std::uint16_t group = 0;
  };

  /// Searches both trees and what is outside them; see BroadPhaseTree::visit_near.
  template <class Bound, class Visit>
  void visit_bounded(double limit, const Bound& bound, Visit&& visit) const;

  [[nodiscard]] std::uint16_t number_of(std::int32_t group);
  void query_without(std::uint16_t group, const geometry::Box& box, std::vector<std::uint32_t>& found) const;
  void enter_home(std::uint32_t collider);
  void leave_home(std::uint32_t collider);
  void mark_changed(std::uint32_t collider);
  [[nodiscard]] bool is_candidate(std::uint32_t changed, std::uint32_t other) const;
  void find_candidates_of(std::uint32_t collider, std::vector<ColliderPair>& found) const;
  void find_new_candidates(parallel::ThreadPool& pool);
  template <class IsAsked>
  void filter_candidates(parallel::ThreadPool& pool, IsAsked&& is_asked, std::vector<ColliderPair>& pairs);
  void merge_candidates();

  // This column is indexed by collider.
  std::vector<Entry> entries_;
  std::vector<geometry::Box> tight_;
  std::vector<geometry::Box> fat_;

  // Numbers of the collision groups, from 1. Groups beyond the available numbers are treated as no group.
  std::map<std::int32_t, std::uint16_t> groups_;

  BroadPhaseTree standing_;
  BroadPhaseTree moving_;
  std::vector<std::uint32_t> unbounded_;
  std::vector<std::uint32_t> changed_;    // those with Entry::changed
  std::vector<ColliderPair> candidates_;  // all pairs whose fat boxes overlap, sorted

  // These vectors are scratch and are kept for their memory.
  std::vector<std::vector<ColliderPair>> found_;  // one for each block of searches
  std::vector<ColliderPair> fresh_;
  std::vector<ColliderPair> sorted_;
  std::vector<std::size_t> ends_;  // ends of what is kept of each block of candidates
};

template <class Visit>
void BroadPhase::visit_sweep(DVec3 origin, DVec3 motion, Real radius, Visit&& visit) const {
  const auto ray = geometry::RaySlabs::of(origin, motion);
  const auto grown = static_cast<double>(radius);
  visit_bounded(
      1.0, [&](const geometry::Box& box) { return ray.enter(box, grown); }, visit);
}

template <class Visit>
void BroadPhase::visit_near(DVec3 point, double reach, Visit&& visit) const {
  const auto distance = [point](const geometry::Box& box) {
    const geometry::Box3<double> b = {vector_cast<double>(box.lower), vector_cast<double>(box.upper)};
    return std::sqrt(geometry::distance_squared(b, point));
  };
  visit_bounded(reach, distance, visit);
}

template <class Bound, class Visit>
void BroadPhase::visit_bounded(double limit, const Bound& bound, Visit&& visit) const {
  const auto visit_tight = [&](std::uint32_t collider) {
    if (bound(tight_[collider]) <= limit) limit = visit(collider);
    return limit;
  };
  for (const std::uint32_t collider : unbounded_) visit_tight(collider);
  standing_.visit_near(limit, bound, visit_tight);
  moving_.visit_near(limit, bound, visit_tight);
}

}  // namespace hooke::collision
