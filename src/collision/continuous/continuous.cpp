#include "collision/continuous/continuous.h"

#include "base/assert.h"
#include "collision/continuous/continuous_tuning.h"

#include <algorithm>
#include <tuple>

namespace hooke::collision {

namespace {

using parallel::for_ranges;
using parallel::Range;

constexpr int kSweepGrain = 64;

/// An impact of a pair, found when its bodies had been clamped `clamps` times.
struct Event {
  Impact impact = {};
  ColliderPair pair = {};
  int clamps = 0;

  /// Orders a heap that gives the first event: by time, then by pair.
  friend bool operator<(const Event& a, const Event& b) {
    return std::tie(a.impact.time, a.pair) > std::tie(b.impact.time, b.pair);
  }
};

/// Results and memory of one thread.
struct ImpactSearch {
  PathScratch path_scratch = {};
  SweepScratch sweep = {};
  std::vector<Event> found = {};
};

/// Whether two bodies cannot pass each other in the rest of the step, as long as neither is clamped.
bool go_together(const Path& a, const Path& b, Real time) {
  return (Real(1) - time) * relative_displacement(a, b) <= kUnseenDisplacement * std::min(a.inner, b.inner);
}

}  // namespace

struct ContinuousScratch::Buffers {
  std::vector<ImpactSearch> searches = {};  ///< One for each part of a parallel loop.
  std::vector<Event> queue = {};            ///< A heap.
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

  std::uint32_t run(parallel::ThreadPool& pool, std::span<const ImpactCandidate> candidates) {
    find_first(pool, candidates);
    std::uint32_t count = 0;
    while (!queue_.empty()) {
      const Event event = queue_.front();
      std::pop_heap(queue_.begin(), queue_.end());
      queue_.pop_back();
      if (event.clamps == clamps_of(event.pair)) count += resolve_impact(event);
    }
    return count;
  }

 private:
  [[nodiscard]] std::uint32_t body_of(std::uint32_t collider) const { return colliders_.body[collider]; }

  [[nodiscard]] int clamps_of(ColliderPair pair) const {
    return bodies_.clamps[body_of(pair.first)].count + bodies_.clamps[body_of(pair.second)].count;
  }

  void sweep(const ImpactCandidate& candidate, Real begin, SweepScratch& scratch,
             std::vector<Event>& events) const {
    const ColliderPair pair = candidate.pair;
    const std::uint32_t body_a = body_of(pair.first);
    const std::uint32_t body_b = body_of(pair.second);
    HOOKE_ASSERT(body_a != body_b && std::max(body_a, body_b) < bodies_.path.size());
    if (bodies_.stoppable[body_a] == Stoppable::kNever && bodies_.stoppable[body_b] == Stoppable::kNever)
      return;
    const SweptCollider a = {colliders_, pair.first, bodies_.path[body_a]};
    const SweptCollider b = {colliders_, pair.second, bodies_.path[body_b]};
    if (go_together(a.path, b.path, begin)) return;
    const Real allowance = overlap_allowance(a, b);
    if (are_separated(a, b, candidate.apart, allowance, begin)) return;
    if (const auto impact = find_impact(a, b, allowance, begin, scratch))
      events.push_back({*impact, pair, clamps_of(pair)});
  }

  void take_up(std::span<const Event> events) {
    for (const Event& event : events) {
      queue_.push_back(event);
      std::push_heap(queue_.begin(), queue_.end());
    }
  }

  void find_first(parallel::ThreadPool& pool, std::span<const ImpactCandidate> candidates) {
    queue_.clear();
    searches_.resize(static_cast<std::size_t>(pool.workers()));
    for (ImpactSearch& search : searches_) search.found.clear();
    for_ranges(pool, static_cast<int>(candidates.size()), kSweepGrain, [&](Range range, int part) {
      ImpactSearch& search = searches_[static_cast<std::size_t>(part)];
      for (int i = range.begin; i < range.end; ++i)
        sweep(candidates[static_cast<std::size_t>(i)], Real(0), search.sweep, search.found);
    });
    for (const ImpactSearch& search : searches_) take_up(search.found);
  }

  /// Returns how many of the two bodies are clamped.
  std::uint32_t resolve_impact(const Event& event) {
    const std::uint32_t a = body_of(event.pair.first);
    const std::uint32_t b = body_of(event.pair.second);
    const Push on_a = push_of(b, a, event.impact, Real(-1));
    const Push on_b = push_of(a, b, event.impact, Real(1));
    const bool clamps_a = clamp_path(a, on_a, event.impact.time);
    const bool clamps_b = clamp_path(b, on_b, event.impact.time);
    if (clamps_a) sweep_again(a, event.impact.time);
    if (clamps_b) sweep_again(b, event.impact.time);
    return (clamps_a ? 1u : 0u) + (clamps_b ? 1u : 0u);
  }

  /// The obstacle in a body's path.
  struct Push {
    Vec3 out = {};         // away from the obstacle, unit
    Real speed = Real(0);  // of the obstacle, along `out` [m per step]
    bool firm = false;     // the obstacle cannot be clamped, and is no lighter
  };

  [[nodiscard]] Push push_of(std::uint32_t pusher, std::uint32_t body, const Impact& impact,
                             Real sign) const {
    const Path& path = bodies_.path[pusher];
    // A plank on ropes would throw a ton about, if that had to follow the plank.
    const bool firm = bodies_.stoppable[pusher] == Stoppable::kNever &&
                      bodies_.inverse_mass[pusher] <= bodies_.inverse_mass[body];
    Push push = {.out = sign * impact.normal, .firm = firm};
    const DVec3 lever =
        pose_at(bodies_.path[body], impact.time).position - pose_at(path, impact.time).position;
    // If both are clamped, neither rotates any more.
    const Vec3 turning = push.firm ? cross(path.turn, vector_cast<Real>(lever)) : Vec3{};
    push.speed = dot(push.out, path.displacement + turning);
    return push;
  }

  /// Returns false if the body keeps its path.
  bool clamp_path(std::uint32_t body, const Push& push, Real time) {
    Path& path = bodies_.path[body];
    SweptBodies::Clamps& clamps = bodies_.clamps[body];
    HOOKE_ASSERT(clamps.count <= kMostClamps);
    const Stoppable stoppable = bodies_.stoppable[body];
    if (stoppable == Stoppable::kNever || (stoppable == Stoppable::kSlow && !push.firm)) return false;
    if (clamps.count == kMostClamps) return false;
    const Real own = dot(push.out, path.displacement);
    const Real closing_distance = std::max(Real(0), push.speed - own);
    const Real given = push.firm ? closing_distance : std::min(closing_distance, std::max(Real(0), -own));
    if (!(given > Real(0)) && path.turn == Vec3{}) return false;
    clamps.first = std::min(clamps.first, time);
    const Pose now = pose_at(path, time);
    path.center = now.position;
    path.rotation = now.rotation;
    path.since = time;
    path.displacement = ++clamps.count < kMostClamps ? path.displacement + given * push.out : Vec3{};
    path.turn = {};
    return true;
  }

  void sweep_again(std::uint32_t body, Real time) {
    ImpactSearch& search = searches_.front();
    search.found.clear();
    find_pairs_(body, search.path_scratch);
    for (const ColliderPair pair : search.path_scratch.pairs)
      sweep({.pair = pair}, time, search.sweep, search.found);
    take_up(search.found);
  }

  const state::Colliders& colliders_;
  const FindPairs& find_pairs_;
  std::vector<ImpactSearch>& searches_;
  std::vector<Event>& queue_;
  SweptBodies& bodies_;
};

}  // namespace

ContinuousScratch::ContinuousScratch() : buffers_(std::make_unique<Buffers>()) {}
ContinuousScratch::~ContinuousScratch() = default;
ContinuousScratch::ContinuousScratch(ContinuousScratch&&) noexcept = default;
ContinuousScratch& ContinuousScratch::operator=(ContinuousScratch&&) noexcept = default;

std::uint32_t clamp_to_impact_times(parallel::ThreadPool& pool, const state::Colliders& colliders,
                                    std::span<const ImpactCandidate> candidates, const FindPairs& find_pairs,
                                    ContinuousScratch& scratch, SweptBodies& bodies) {
  return ImpactQueue(colliders, find_pairs, scratch.buffers(), bodies).run(pool, candidates);
}

}  // namespace hooke::collision
