#include "solver/contact/impacts.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/contact/contact_tuning.h"
#include "solver/contact/impact_impulse.h"
#include "solver/joint_rows/joint_rows.h"
#include "state/body_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::Hook;
using state::Manifold;
using state::MotionRecord;

bool is_later(const NextImpact& a, const NextImpact& b) {
  return a.time != b.time ? a.time > b.time : a.index > b.index;
}

/// Finds where contacts that do not bounce hold bodies.
void find_supports(const std::vector<Manifold>& manifolds, const Bodies& bodies, Impacts& impacts) {
  impacts.supports.clear();
  for (const Manifold& m : manifolds) {
    if (m.restitution > Real(0)) continue;
    const auto end = m.point.begin() + m.point_count;
    if (std::none_of(m.point.begin(), end, [](const auto& p) { return p.separation < kImpactSupportGap; }))
      continue;
    if (is_moved(bodies, m.body_a)) impacts.supports.push_back({m.body_a, m.body_b, m.normal});
    if (is_moved(bodies, m.body_b)) impacts.supports.push_back({m.body_b, m.body_a, -m.normal});
  }
  std::sort(impacts.supports.begin(), impacts.supports.end(),
            [](const auto& p, const auto& q) { return p.body < q.body; });
}

/// Whether an impulse along `push` presses the body against what does not give way, with at most `behind`
/// bodies between them.
bool is_backed(std::uint32_t body, Vec3 push, int behind, const Bodies& bodies, const Impacts& impacts) {
  const auto first =
      std::lower_bound(impacts.supports.begin(), impacts.supports.end(), body,
                       [](const Impacts::Support& s, std::uint32_t row) { return s.body < row; });
  for (auto s = first; s != impacts.supports.end() && s->body == body; ++s) {
    if (!(dot(push, s->outward) > kImpactSupportCosine)) continue;
    if (!is_moved(bodies, s->other)) return true;
    if (behind > 0 && is_backed(s->other, push, behind - 1, bodies, impacts)) return true;
  }
  return false;
}

/// Finds lanes that have restitution, by the row of their manifold; -1 elsewhere. False if there are none.
bool find_lanes(const BodyContacts& contacts, const std::vector<Manifold>& manifolds,
                std::vector<std::int32_t>& lane_of) {
  bool any = false;
  for (std::size_t i = 0; i < contacts.blocks.size(); ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (!block.bounces) continue;
    if (!any) lane_of.assign(manifolds.size(), -1);
    any = true;
    for (int lane = 0; lane < block.count; ++lane) {
      const auto lane_index = static_cast<std::int32_t>(i * kContactLanes) + lane;
      const std::uint32_t row = contacts.manifold_of[static_cast<std::size_t>(lane_index)];
      HOOKE_ASSERT(row < manifolds.size() && lane_of[row] == -1);  // a manifold has one lane
      if (manifolds[row].restitution > Real(0)) lane_of[row] = lane_index;
    }
  }
  return any;
}

void list_pairs(const state::Pairs& pairs, const std::vector<std::uint8_t>& hooked, Impacts& impacts) {
  HOOKE_ASSERT(impacts.lane_of.size() == pairs.manifold.size());
  for (std::uint32_t row = 0; row < pairs.pair.size(); ++row) {
    const state::Pair& pair = pairs.pair[row];
    const auto first = static_cast<std::uint32_t>(impacts.lanes.size());
    for (std::uint32_t i = pair.first_manifold; i < pair.first_manifold + pair.manifold_count; ++i) {
      const std::int32_t lane_index = impacts.lane_of[i];
      if (lane_index >= 0)
        impacts.lanes.push_back({lane_index / kContactLanes, lane_index % kContactLanes, i});
    }
    const auto count = static_cast<std::uint32_t>(impacts.lanes.size()) - first;
    if (count == 0) continue;
    const Manifold& m = pairs.manifold[pair.first_manifold];
    impacts.pairs.push_back({.pair = row,
                             .a = m.body_a,
                             .b = m.body_b,
                             .first_lane = first,
                             .lane_count = count,
                             .a_is_hooked = hooked[m.body_a] != 0,
                             .b_is_hooked = hooked[m.body_b] != 0});
  }
}

void find_backed_bodies(const std::vector<Manifold>& manifolds, const Bodies& bodies, Impacts& impacts) {
  for (ImpactPair& pair : impacts.pairs) {
    HOOKE_ASSERT(pair.lane_count > 0 && pair.first_lane + pair.lane_count <= impacts.lanes.size());
    const Vec3 n = manifolds[impacts.lanes[pair.first_lane].manifold].normal;
    pair.a_is_backed = is_backed(pair.a, -n, kMostBackingBodies, bodies, impacts);
    pair.b_is_backed = is_backed(pair.b, n, kMostBackingBodies, bodies, impacts);
  }
}

/// Where bodies are in a dense pile, only pairs that did not touch in the last step bounce.
void filter_dense_piles(const std::vector<Manifold>& manifolds, const Bodies& bodies, Impacts& impacts) {
  const auto is_in_dense_pile = [&](std::uint32_t body) {
    return is_moved(bodies, body) &&
           impacts.pairs_begin[body + 1] - impacts.pairs_begin[body] >= kImpactPairsOfPile;
  };
  for (ImpactPair& pair : impacts.pairs)
    pair.in_dense_pile = is_in_dense_pile(pair.a) || is_in_dense_pile(pair.b);
  std::erase_if(impacts.pairs, [&](const ImpactPair& pair) {
    const auto lanes = lanes_of(pair, impacts);
    return pair.in_dense_pile && std::any_of(lanes.begin(), lanes.end(), [&](const ContactLane& lane) {
             return manifolds[lane.manifold].touching;
           });
  });
}

/// Fills pairs_begin and pairs_of_body.
void index_bodies(std::size_t body_count, Impacts& impacts) {
  impacts.pairs_begin.assign(body_count + 1, 0);
  for (const ImpactPair& pair : impacts.pairs) {
    ++impacts.pairs_begin[pair.a];
    ++impacts.pairs_begin[pair.b];
  }
  std::partial_sum(impacts.pairs_begin.begin(), impacts.pairs_begin.end(), impacts.pairs_begin.begin());
  HOOKE_ASSERT(impacts.pairs_begin.back() == 2 * impacts.pairs.size());
  impacts.pairs_of_body.resize(2 * impacts.pairs.size());
  for (auto i = static_cast<std::uint32_t>(impacts.pairs.size()); i-- > 0;) {
    impacts.pairs_of_body[--impacts.pairs_begin[impacts.pairs[i].a]] = i;
    impacts.pairs_of_body[--impacts.pairs_begin[impacts.pairs[i].b]] = i;
  }
}

Real least_speed(const ImpactPair& pair) {
  return pair.in_dense_pile ? kLeastImpactSpeedInPile : kLeastImpactSpeed;
}

/// When a point of a lane meets, from `since` on and no slower than `least`: see solver/contact/impacts.h.
Real impact_time(Real gap, Real v, Real a, Real since, Real h, Real least) {
  const auto speed = [&](Real t) { return v + a * (t - Real(0.5) * h); };
  const Real b = v - Real(0.5) * a * h;
  const Real gap_since = gap + since * (b + Real(0.5) * a * since);
  if (gap_since <= Real(0)) return speed(since) < -least ? since : Impacts::kNever;
  // The earlier root of 0 = gap_since + u t + a t^2 / 2.
  const Real u = speed(since);
  const Real square = u * u - Real(2) * a * gap_since;
  if (square <= least * least) return Impacts::kNever;
  const Real root = std::sqrt(square);
  if (root <= u) return Impacts::kNever;
  const Real time = since + Real(2) * gap_since / (root - u);
  // An impact that rounding delays until just after the end would be stopped by the relaxation of this
  // substep.
  return time <= (Real(1) + kImpactTimeShare) * h ? time : Impacts::kNever;
}

Real lane_time(const ContactLane& at, Real since, Real least, const ContactStep& step,
               const BodyContacts& contacts, const Bodies& bodies) {
  const ContactBlock& block = contacts.blocks[static_cast<std::size_t>(at.block)];
  const int lane = at.lane;
  const std::uint32_t row_a = block.record_a[lane] / 16;
  const std::uint32_t row_b = block.record_b[lane] / 16;
  const MotionRecord& a = bodies.motion[row_a];
  const MotionRecord& b = bodies.motion[row_b];
  const state::FreeMotionRecord from_a = state::motion_before_contacts(bodies, row_a);
  const state::FreeMotionRecord from_b = state::motion_before_contacts(bodies, row_b);
  const Vec3 n = vector_of(block.normal, lane);
  const Real pull =
      dot(n, free_acceleration(bodies, row_b, step.gravity) - free_acceleration(bodies, row_a, step.gravity));
  const Real closing_speed = dot(n, from_b.v - from_a.v);
  const Real displacement = dot(n, b.dx - a.dx);
  Real earliest = Impacts::kNever;
  for (int k = 0; k < block.point_count; ++k) {
    const ContactBlock::Point& p = block.point[k];
    if (!(p.mass[lane] > Real(0))) continue;
    const Vec3 j_a = vector_of(p.j_a, lane);
    const Vec3 j_b = vector_of(p.j_b, lane);
    const Real gap =
        p.separation[lane] + displacement + (dot(j_b, b.theta_scaled) - dot(j_a, a.theta_scaled));
    const Real v = closing_speed + (dot(j_b, from_b.omega_scaled) - dot(j_a, from_a.omega_scaled));
    earliest = std::min(earliest, impact_time(gap, v, pull, since, step.h, least));
  }
  return earliest;
}

/// Whether no point of the body is as fast as half of what bounces. Resting pairs are not tested.
bool is_slow(const Bodies& bodies, std::uint32_t body) {
  const state::FreeMotionRecord motion = state::motion_before_contacts(bodies, body);
  const Real turning = bodies.traits[body].radius * length(bodies.scale[body] * motion.omega_scaled);
  return length(motion.v) + turning < kRestingImpactSpeed;
}

/// The time of the pair's next impact.
Real time_of(const ImpactPair& pair, const ContactStep& step, const BodyContacts& contacts,
             const Bodies& bodies, const Impacts& impacts) {
  if (pair.count >= (pair.in_dense_pile ? kMostImpactsInPile : kMostImpacts)) return Impacts::kNever;
  if (is_slow(bodies, pair.a) && is_slow(bodies, pair.b)) return Impacts::kNever;
  const Real since = std::max(impacts.since[pair.a], impacts.since[pair.b]);
  Real earliest = Impacts::kNever;
  for (const ContactLane& lane : lanes_of(pair, impacts))
    earliest = std::min(earliest, lane_time(lane, since, least_speed(pair), step, contacts, bodies));
  return earliest;
}

void await(std::uint32_t index, Real time, Impacts& impacts) {
  HOOKE_ASSERT(index < impacts.pairs.size());
  impacts.pairs[index].time = time;
  if (time == Impacts::kNever) return;
  impacts.queue.push_back({index, time});
  std::push_heap(impacts.queue.begin(), impacts.queue.end(), is_later);
}

/// Predicts what else the bodies of an impact will meet.
void predict_next(std::uint32_t body, const ContactStep& step, const BodyContacts& contacts,
                  const Bodies& bodies, Impacts& impacts) {
  HOOKE_ASSERT(impacts.pairs_begin[body + 1] <= impacts.pairs_of_body.size());
  for (std::uint32_t k = impacts.pairs_begin[body]; k < impacts.pairs_begin[body + 1]; ++k) {
    const std::uint32_t index = impacts.pairs_of_body[k];
    impacts.pairs[index].refreshes = 0;
    await(index, time_of(impacts.pairs[index], step, contacts, bodies, impacts), impacts);
  }
}

/// Null if the body had no impact.
template <class AnyImpacts>
auto find_hooked_impact(std::uint32_t body, AnyImpacts& impacts) -> decltype(impacts.hooked_impacts.data()) {
  const auto at = std::find_if(impacts.hooked_impacts.begin(), impacts.hooked_impacts.end(),
                               [&](const HookedImpact& s) { return s.body == body; });
  return at != impacts.hooked_impacts.end() ? &*at : nullptr;
}

/// Counts an impact of a body on hooks; `before` is its state before the impact.
void note_hooked_impact(const HookedImpact& before, Real time, Impacts& impacts) {
  HookedImpact* impacted = find_hooked_impact(before.body, impacts);
  if (impacted == nullptr) impacted = &impacts.hooked_impacts.emplace_back(before);
  ++impacted->count;
  impacted->time_sum += time;
}

/// Whether the change by the impacts goes against a lock of the hook, at more than the share
/// kImpactAgainstJoint of the speeds.
bool goes_against(const Hook& hook, const Bodies& bodies, double h, const Impacts& impacts) {
  const auto change_of = [&](std::uint32_t body) {
    state::FreeMotionRecord change;
    const HookedImpact* impacted = find_hooked_impact(body, impacts);
    if (impacted == nullptr) return change;
    const MotionRecord& m = bodies.motion[body];
    change.v = m.v - impacted->before.record.v;
    change.omega_scaled = m.omega_scaled - impacted->before.record.omega_scaled;
    return change;
  };
  const auto size_of = [&](std::uint32_t body) {
    return body == state::HookPlace::kWorld ? Real(0) : bodies.traits[body].radius;
  };
  const state::FreeMotionRecord a = change_of(hook.a.body);
  const state::FreeMotionRecord b = change_of(hook.b.body);
  const auto speed = static_cast<double>(std::max(length(a.v), length(b.v)));
  const auto size = static_cast<double>(std::max(size_of(hook.a.body), size_of(hook.b.body)));
  std::array<JointRow, Hook::kMaxRows> rows;
  Hook copy = hook;  // its values are still those of the last substep
  const int count =
      make_joint_rows(copy, joint_body(bodies, hook.a.body), joint_body(bodies, hook.b.body), h, rows);
  return std::any_of(rows.begin(), rows.begin() + count, [&](const JointRow& row) {
    if (row.role != RowRole::kLock) return false;
    const double rate = dot(row.n, vector_cast<double>(b.v - a.v)) +
                        dot(row.j_b, vector_cast<double>(b.omega_scaled)) -
                        dot(row.j_a, vector_cast<double>(a.omega_scaled));
    return std::abs(rate) * (row.n == DVec3{} ? size : 1) > kImpactAgainstJoint * speed;
  });
}

}  // namespace

std::span<const ContactLane> lanes_of(const ImpactPair& pair, const Impacts& impacts) {
  return std::span(impacts.lanes).subspan(pair.first_lane, pair.lane_count);
}

void list_impact_pairs(const state::Pairs& pairs, const Bodies& bodies,
                       const std::vector<std::uint8_t>& hooked, const BodyContacts& contacts,
                       Impacts& impacts) {
  impacts.pairs.clear();
  impacts.lanes.clear();
  impacts.hooked_impacts.clear();
  if (!find_lanes(contacts, pairs.manifold, impacts.lane_of)) return;
  list_pairs(pairs, hooked, impacts);
  index_bodies(bodies.motion.size(), impacts);
  filter_dense_piles(pairs.manifold, bodies, impacts);
  index_bodies(bodies.motion.size(), impacts);
  find_supports(pairs.manifold, bodies, impacts);
  find_backed_bodies(pairs.manifold, bodies, impacts);
  impacts.since.assign(bodies.motion.size(), Real(0));
}

bool predict_impacts(const ContactStep& step, const std::vector<Manifold>& manifolds, BodyContacts& contacts,
                     Bodies& bodies, Impacts& impacts) {
  HOOKE_ASSERT(impacts.pairs.empty() || impacts.since.size() == bodies.motion.size());
  impacts.queue.clear();
  for (const std::uint32_t body : impacts.impacted) impacts.since[body] = Real(0);
  impacts.impacted.clear();
  impacts.hooked_impacts.clear();
  // If an impulse is repeated and its row then removed by an impact, it would act once too often.
  for (const ImpactPair& pair : impacts.pairs) {
    if (is_slow(bodies, pair.a) && is_slow(bodies, pair.b)) continue;
    for (const ContactLane& lane : lanes_of(pair, impacts))
      drop_warm_start(lane, manifolds, contacts, bodies);
  }
  for (std::uint32_t i = 0; i < impacts.pairs.size(); ++i) {
    ImpactPair& pair = impacts.pairs[i];
    pair.refreshes = 0;
    if (!pair.in_dense_pile) pair.count = 0;
    await(i, time_of(pair, step, contacts, bodies, impacts), impacts);
  }
  return !impacts.queue.empty();
}

std::optional<NextImpact> next_impact(Impacts& impacts) {
  while (!impacts.queue.empty()) {
    std::pop_heap(impacts.queue.begin(), impacts.queue.end(), is_later);
    const NextImpact impact = impacts.queue.back();
    impacts.queue.pop_back();
    if (impacts.pairs[impact.index].time == impact.time) return impact;
  }
  return std::nullopt;
}

void resolve_impact(const NextImpact& impact, const ContactStep& step, const state::Pairs& pairs,
                    BodyContacts& contacts, Bodies& bodies, Impacts& impacts) {
  ImpactPair& pair = impacts.pairs[impact.index];
  const std::span<const ContactLane> lanes = lanes_of(pair, impacts);
  refill_lanes(lanes, pairs.manifold, impact.time, bodies, contacts);
  const Real time = time_of(pair, step, contacts, bodies, impacts);
  const bool is_there = std::abs(time - impact.time) <= kImpactTimeShare * step.h;
  if (!is_there && (time == Impacts::kNever || ++pair.refreshes < kMostImpactRefreshes)) {
    await(impact.index, time, impacts);
    return;
  }
  pair.time = Impacts::kNever;
  const auto as_it_is = [&](std::uint32_t body) {
    return HookedImpact{.body = body, .before = {bodies.motion[body], bodies.rotation[body]}};
  };
  const HookedImpact a_before = as_it_is(pair.a);
  const HookedImpact b_before = as_it_is(pair.b);
  if (!apply_impact({lanes, pair.in_dense_pile, pair.a_is_backed, pair.b_is_backed}, pairs.manifold,
                    impact.time, step, contacts, bodies))
    return;
  ++pair.count;
  if (pair.a_is_hooked) note_hooked_impact(a_before, impact.time, impacts);
  if (pair.b_is_hooked) note_hooked_impact(b_before, impact.time, impacts);
  // What stands takes no impact: others meet it as before.
  for (const std::uint32_t body : {pair.a, pair.b}) {
    if (!is_moved(bodies, body)) continue;
    impacts.since[body] = impact.time;
    impacts.impacted.push_back(body);
  }
  for (const std::uint32_t body : {pair.a, pair.b}) {
    if (is_moved(bodies, body)) predict_next(body, step, contacts, bodies, impacts);
  }
}

void reset_hooked_bodies(const std::vector<Hook>& hooks, Real h, Bodies& bodies, Impacts& impacts) {
  if (impacts.hooked_impacts.empty()) return;
  for (const Hook& hook : hooks) {
    HookedImpact* a = find_hooked_impact(hook.a.body, impacts);
    HookedImpact* b = find_hooked_impact(hook.b.body, impacts);
    if (a == nullptr && b == nullptr) continue;
    if (hook.holds_point() || !goes_against(hook, bodies, static_cast<double>(h), impacts)) continue;
    for (HookedImpact* impacted : {a, b}) {
      if (impacted != nullptr) impacted->is_reset = true;
    }
  }
  std::erase_if(impacts.hooked_impacts, [](const HookedImpact& impacted) { return !impacted.is_reset; });
  for (const HookedImpact& impacted : impacts.hooked_impacts) {
    MotionRecord& m = bodies.motion[impacted.body];
    m.dx = impacted.before.record.dx;
    m.theta_scaled = impacted.before.record.theta_scaled;
    bodies.rotation[impacted.body] = impacted.before.rotation;
  }
}

void propagate_impacts(Bodies& bodies, Impacts& impacts) {
  for (const HookedImpact& impacted : impacts.hooked_impacts) {
    const MotionRecord& before = impacted.before.record;
    MotionRecord& m = bodies.motion[impacted.body];
    HOOKE_ASSERT(impacted.count > 0);
    Quat& rotation = bodies.rotation[impacted.body];
    const Real time = impacted.time_sum / static_cast<Real>(impacted.count);
    if (state::is_gyroscopic_now(bodies, impacted.body)) {
      const auto turn = [&](Real t, Vec3 omega_scaled) {
        return math::quaternion_of(t * (bodies.scale[impacted.body] * omega_scaled));
      };
      rotation = normalize(turn(-time, m.omega_scaled) * turn(time, before.omega_scaled) * rotation);
    }
    m.dx += time * (before.v - m.v);
    m.theta_scaled += time * (before.omega_scaled - m.omega_scaled);
  }
  impacts.hooked_impacts.clear();
}

}  // namespace hooke::solver
