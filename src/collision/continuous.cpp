#include "collision/continuous.h"

#include <algorithm>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

namespace hooke::collision {

namespace {

using parallel::for_ranges;
using parallel::Range;

constexpr int kSweepGrain = 8;

/// An impact that was found when the bodies of its pair had been stopped `stops` times.
struct Event {
  Impact impact = {};
  std::uint32_t pair = 0;
  std::uint32_t stops = 0;

  /// For a queue that gives the first: the last in order of time, then of pair.
  friend bool operator<(const Event& a, const Event& b) {
    return std::tie(a.impact.time, a.pair) > std::tie(b.impact.time, b.pair);
  }
};

class Stopper {
 public:
  Stopper(const state::Colliders& colliders, std::span<const ColliderPair> pairs, SweptBodies& bodies)
      : colliders_(colliders), pairs_(pairs), bodies_(bodies), stops_(pairs.size(), 0) {}

  std::uint32_t run(parallel::ThreadPool& pool) {
    find_first(pool);
    if (queue_.empty()) return 0;
    list_pairs_of_bodies();
    std::uint32_t count = 0;
    while (!queue_.empty()) {
      const Event event = queue_.top();
      queue_.pop();
      if (event.stops == stops_[event.pair]) count += meet_at(event);
    }
    return count;
  }

 private:
  [[nodiscard]] std::uint32_t body_of(std::uint32_t collider) const { return colliders_.body[collider]; }

  [[nodiscard]] std::optional<Impact> sweep(std::uint32_t pair, Real begin, SweepScratch& scratch) const {
    const auto [a, b] = pairs_[pair];
    const SweptCollider swept_a = {colliders_, a, bodies_.path[body_of(a)]};
    const SweptCollider swept_b = {colliders_, b, bodies_.path[body_of(b)]};
    return find_impact(swept_a, swept_b, overlap_allowance(swept_a, swept_b), begin, scratch);
  }

  void find_first(parallel::ThreadPool& pool) {
    std::vector<std::optional<Impact>> impacts(pairs_.size());
    for_ranges(pool, static_cast<int>(pairs_.size()), kSweepGrain, [&](Range range) {
      SweepScratch scratch;
      for (int i = range.begin; i < range.end; ++i)
        impacts[static_cast<std::size_t>(i)] = sweep(static_cast<std::uint32_t>(i), Real(0), scratch);
    });
    for (std::uint32_t i = 0; i < impacts.size(); ++i) {
      if (impacts[i]) queue_.push({*impacts[i], i, 0});
    }
  }

  void list_pairs_of_bodies() {
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
      pairs_of_.emplace_back(body_of(pairs_[i].first), i);
      pairs_of_.emplace_back(body_of(pairs_[i].second), i);
    }
    std::sort(pairs_of_.begin(), pairs_of_.end());
  }

  /// Returns how many of the two bodies stop.
  std::uint32_t meet_at(const Event& event) {
    const std::uint32_t a = body_of(pairs_[event.pair].first);
    const std::uint32_t b = body_of(pairs_[event.pair].second);
    const bool stops_a = gives_way(a, b, event.impact, Real(-1));
    const bool stops_b = gives_way(b, a, event.impact, Real(1));
    if (stops_a) sweep_again(a, event.impact.time);
    if (stops_b) sweep_again(b, event.impact.time);
    return (stops_a ? 1u : 0u) + (stops_b ? 1u : 0u);
  }

  /// Stops `body`, which is on the side of `sign` times the normal. False if it stood, or may go on.
  bool gives_way(std::uint32_t body, std::uint32_t other, const Impact& impact, Real sign) {
    Path& path = bodies_.path[body];
    const Path& pusher = bodies_.path[other];
    const Stoppable stoppable = bodies_.stoppable[body];
    const bool pushed = bodies_.stoppable[other] == Stoppable::kNever;
    if (stoppable == Stoppable::kNever || (stoppable == Stoppable::kSlow && !pushed)) return false;
    if (impact.time >= path.release) return false;
    if (impact.time >= path.stop) {
      const bool was_carried = path.carry != Vec3{};
      path.release = impact.time;
      return was_carried;
    }
    path.stop = impact.time;
    if (pushed) {
      const Vec3 out = sign * impact.normal;
      const Vec3 lever =
          vector_cast<Real>(pose_at(path, impact.time).position - pose_at(pusher, impact.time).position);
      path.carry = std::max(Real(0), dot(out, pusher.way + cross(pusher.turn, lever))) * out;
    }
    return true;
  }

  void sweep_again(std::uint32_t body, Real time) {
    const auto first = std::lower_bound(pairs_of_.begin(), pairs_of_.end(), std::pair{body, 0u});
    for (auto it = first; it != pairs_of_.end() && it->first == body; ++it) {
      const std::uint32_t pair = it->second;
      ++stops_[pair];
      if (const auto impact = sweep(pair, time, scratch_)) queue_.push({*impact, pair, stops_[pair]});
    }
  }

  const state::Colliders& colliders_;
  std::span<const ColliderPair> pairs_;
  SweptBodies& bodies_;
  std::vector<std::uint32_t> stops_;                               // of the bodies of each pair
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_of_;  // (body, pair), sorted
  std::priority_queue<Event> queue_;
  SweepScratch scratch_;
};

}  // namespace

std::uint32_t stop_at_impacts(parallel::ThreadPool& pool, const state::Colliders& colliders,
                              std::span<const ColliderPair> pairs, SweptBodies& bodies) {
  return Stopper(colliders, pairs, bodies).run(pool);
}

}  // namespace hooke::collision
