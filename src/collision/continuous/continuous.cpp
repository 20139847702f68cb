#include "collision/continuous/continuous.h"

#include <algorithm>
#include <tuple>

namespace hooke::collision {

namespace {

using parallel::for_ranges;
using parallel::Range;

constexpr int kSweepGrain = 64;
constexpr int kMostBends = 4;  // of a body in a step; then it stands

/// An impact that was found when the bodies of its pair had given way `bends` times.
struct Event {
  Impact impact = {};
  ColliderPair pair = {};
  int bends = 0;

  /// For a heap that gives the first: the last in order of time, then of pair.
  friend bool operator<(const Event& a, const Event& b) {
    return std::tie(a.impact.time, a.pair) > std::tie(b.impact.time, b.pair);
  }
};

/// Of some bodies that one thread looks at.
struct WaySearch {
  WayScratch way = {};
  SweepScratch sweep = {};
  std::vector<Event> found = {};
};

/// Whether two bodies cannot pass each other in what is left of the step, as long as neither gives way.
bool go_together(const Path& a, const Path& b, Real time) {
  return (Real(1) - time) * relative_way(a, b) <= kUnseenWay * std::min(a.inner, b.inner);
}

}  // namespace

struct ContinuousScratch::Buffers {
  std::vector<WaySearch> searches = {};  ///< One for each part of a parallel loop.
  std::vector<Event> queue = {};         ///< A heap.
};

namespace {

class ImpactQueue {
 public:
  ImpactQueue(const state::Colliders& colliders, const FindPairs& find_pairs,
              ContinuousScratch::Buffers& buffers, SweptBodies& bodies)
      : colliders_(colliders),
        find_pairs_(find_pairs),
        searches_(buffers.searches),
        queue_(buffers.queue),
        bodies_(bodies) {}

  std::uint32_t run(parallel::ThreadPool& pool, std::span<const Encounter> encounters) {
    find_first(pool, encounters);
    std::uint32_t count = 0;
    while (!queue_.empty()) {
      const Event event = queue_.front();
      std::pop_heap(queue_.begin(), queue_.end());
      queue_.pop_back();
      if (event.bends == bends_of(event.pair)) count += meet_at(event);
    }
    return count;
  }

 private:
  [[nodiscard]] std::uint32_t body_of(std::uint32_t collider) const { return colliders_.body[collider]; }

  [[nodiscard]] int bends_of(ColliderPair pair) const {
    return bodies_.bends[body_of(pair.first)].count + bodies_.bends[body_of(pair.second)].count;
  }

  void sweep(const Encounter& encounter, Real begin, SweepScratch& scratch,
             std::vector<Event>& events) const {
    const ColliderPair pair = encounter.pair;
    const std::uint32_t body_a = body_of(pair.first);
    const std::uint32_t body_b = body_of(pair.second);
    if (bodies_.stoppable[body_a] == Stoppable::kNever && bodies_.stoppable[body_b] == Stoppable::kNever)
      return;
    const SweptCollider a = {colliders_, pair.first, bodies_.path[body_a]};
    const SweptCollider b = {colliders_, pair.second, bodies_.path[body_b]};
    if (go_together(a.path, b.path, begin)) return;
    const Real allowance = overlap_allowance(a, b);
    if (are_held_apart(a, b, encounter.apart, allowance, begin)) return;
    if (const auto impact = find_impact(a, b, allowance, begin, scratch))
      events.push_back({*impact, pair, bends_of(pair)});
  }

  void take_up(std::span<const Event> events) {
    for (const Event& event : events) {
      queue_.push_back(event);
      std::push_heap(queue_.begin(), queue_.end());
    }
  }

  void find_first(parallel::ThreadPool& pool, std::span<const Encounter> encounters) {
    queue_.clear();
    searches_.resize(static_cast<std::size_t>(pool.workers()));
    for (WaySearch& search : searches_) search.found.clear();
    for_ranges(pool, static_cast<int>(encounters.size()), kSweepGrain, [&](Range range, int part) {
      WaySearch& search = searches_[static_cast<std::size_t>(part)];
      for (int i = range.begin; i < range.end; ++i)
        sweep(encounters[static_cast<std::size_t>(i)], Real(0), search.sweep, search.found);
    });
    for (const WaySearch& search : searches_) take_up(search.found);
  }

  /// Returns how many of the two bodies give way.
  std::uint32_t meet_at(const Event& event) {
    const std::uint32_t a = body_of(event.pair.first);
    const std::uint32_t b = body_of(event.pair.second);
    const Push on_a = push_of(b, a, event.impact, Real(-1));
    const Push on_b = push_of(a, b, event.impact, Real(1));
    const bool bends_a = gives_way(a, on_a, event.impact.time);
    const bool bends_b = gives_way(b, on_b, event.impact.time);
    if (bends_a) sweep_again(a, event.impact.time);
    if (bends_b) sweep_again(b, event.impact.time);
    return (bends_a ? 1u : 0u) + (bends_b ? 1u : 0u);
  }

  /// What is in a body's way.
  struct Push {
    Vec3 out = {};         // away from it, unit
    Real speed = Real(0);  // of it, along `out` [m per step]
    bool firm = false;     // it gives no way itself, and is no lighter
  };

  [[nodiscard]] Push push_of(std::uint32_t pusher, std::uint32_t body, const Impact& impact,
                             Real sign) const {
    const Path& path = bodies_.path[pusher];
    // A plank on ropes would throw a ton about, if that had to go as the plank does.
    const bool firm = bodies_.stoppable[pusher] == Stoppable::kNever &&
                      bodies_.inverse_mass[pusher] <= bodies_.inverse_mass[body];
    Push push = {.out = sign * impact.normal, .firm = firm};
    const DVec3 lever =
        pose_at(bodies_.path[body], impact.time).position - pose_at(path, impact.time).position;
    // Of two that give way, neither turns any more.
    const Vec3 turning = push.firm ? cross(path.turn, vector_cast<Real>(lever)) : Vec3{};
    push.speed = dot(push.out, path.way + turning);
    return push;
  }

  /// False if the body goes on as before.
  bool gives_way(std::uint32_t body, const Push& push, Real time) {
    Path& path = bodies_.path[body];
    SweptBodies::Bends& bends = bodies_.bends[body];
    const Stoppable stoppable = bodies_.stoppable[body];
    if (stoppable == Stoppable::kNever || (stoppable == Stoppable::kSlow && !push.firm)) return false;
    if (bends.count == kMostBends) return false;
    const Real own = dot(push.out, path.way);
    const Real approach = std::max(Real(0), push.speed - own);
    const Real given = push.firm ? approach : std::min(approach, std::max(Real(0), -own));
    if (!(given > Real(0)) && path.turn == Vec3{}) return false;
    bends.first = std::min(bends.first, time);
    const Pose now = pose_at(path, time);
    path.center = now.position;
    path.rotation = now.rotation;
    path.since = time;
    path.way = ++bends.count < kMostBends ? path.way + given * push.out : Vec3{};
    path.turn = {};
    return true;
  }

  void sweep_again(std::uint32_t body, Real time) {
    WaySearch& search = searches_.front();
    search.found.clear();
    find_pairs_(body, search.way);
    for (const ColliderPair pair : search.way.pairs) sweep({.pair = pair}, time, search.sweep, search.found);
    take_up(search.found);
  }

  const state::Colliders& colliders_;
  const FindPairs& find_pairs_;
  std::vector<WaySearch>& searches_;
  std::vector<Event>& queue_;
  SweptBodies& bodies_;
};

}  // namespace

ContinuousScratch::ContinuousScratch() : buffers_(std::make_unique<Buffers>()) {}
ContinuousScratch::~ContinuousScratch() = default;
ContinuousScratch::ContinuousScratch(ContinuousScratch&&) noexcept = default;
ContinuousScratch& ContinuousScratch::operator=(ContinuousScratch&&) noexcept = default;

std::uint32_t give_way_at_impacts(parallel::ThreadPool& pool, const state::Colliders& colliders,
                                  std::span<const Encounter> encounters, const FindPairs& find_pairs,
                                  ContinuousScratch& scratch, SweptBodies& bodies) {
  return ImpactQueue(colliders, find_pairs, scratch.buffers(), bodies).run(pool, encounters);
}

}  // namespace hooke::collision
