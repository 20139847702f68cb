#include "solver/contact/impacts.h"

#include "math/rotation.h"
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
using state::MotionLine;

constexpr int kMostLooks = 5;            // for one hit
constexpr int kMostHits = 16;            // of a pair in a substep; what then still comes together stops
constexpr int kMostHitsInCrowd = 1;      // in a step
constexpr std::uint32_t kCrowd = 3;      // pairs of a body
constexpr Real kTouching = Real(1e-3);   // what rests is nearer to its support [m]
constexpr Real kAgainst = Real(0.2);     // cosine between impulse and support
constexpr Real kTimeShare = Real(2e-3);  // how well a time has to be known, of h

bool is_later(const Hit& a, const Hit& b) {
  return a.time != b.time ? a.time > b.time : a.index > b.index;
}

/// Where contacts that do not bounce hold bodies.
void find_supports(const std::vector<Manifold>& manifolds, const Bodies& bodies, Hits& hits) {
  hits.supports.clear();
  for (const Manifold& m : manifolds) {
    if (m.restitution > Real(0)) continue;
    const auto end = m.point.begin() + m.point_count;
    if (std::none_of(m.point.begin(), end, [](const auto& p) { return p.separation < kTouching; })) continue;
    if (is_moved(bodies, m.body_a)) hits.supports.push_back({m.body_a, m.body_b, m.normal});
    if (is_moved(bodies, m.body_b)) hits.supports.push_back({m.body_b, m.body_a, -m.normal});
  }
  std::sort(hits.supports.begin(), hits.supports.end(),
            [](const auto& p, const auto& q) { return p.body < q.body; });
}

/// Whether an impulse along `push` presses the body against what does not give way, at most so many bodies
/// behind it.
bool is_backed(std::uint32_t body, Vec3 push, int behind, const Bodies& bodies, const Hits& hits) {
  const auto first = std::lower_bound(hits.supports.begin(), hits.supports.end(), body,
                                      [](const Hits::Support& s, std::uint32_t row) { return s.body < row; });
  for (auto s = first; s != hits.supports.end() && s->body == body; ++s) {
    if (!(dot(push, s->outward) > kAgainst)) continue;
    if (!is_moved(bodies, s->other)) return true;
    if (behind > 0 && is_backed(s->other, push, behind - 1, bodies, hits)) return true;
  }
  return false;
}

/// Lanes that have restitution, by the row of their manifold; -1 elsewhere. False if there are none.
bool find_lanes(const BodyContacts& contacts, const std::vector<Manifold>& manifolds,
                std::vector<std::int32_t>& lane_of) {
  bool any = false;
  for (std::size_t i = 0; i < contacts.blocks.size(); ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (!block.bounces) continue;
    if (!any) lane_of.assign(manifolds.size(), -1);
    any = true;
    for (int lane = 0; lane < block.count; ++lane) {
      const auto place = static_cast<std::int32_t>(i * kContactLanes) + lane;
      const std::uint32_t row = contacts.manifold_of[static_cast<std::size_t>(place)];
      if (manifolds[row].restitution > Real(0)) lane_of[row] = place;
    }
  }
  return any;
}

void list_pairs(const state::Pairs& pairs, const std::vector<std::uint8_t>& hooked, Hits& hits) {
  for (std::uint32_t row = 0; row < pairs.pair.size(); ++row) {
    const state::Pair& pair = pairs.pair[row];
    const auto first = static_cast<std::uint32_t>(hits.lanes.size());
    for (std::uint32_t i = pair.first_manifold; i < pair.first_manifold + pair.manifold_count; ++i) {
      const std::int32_t place = hits.lane_of[i];
      if (place >= 0) hits.lanes.push_back({place / kContactLanes, place % kContactLanes, i});
    }
    const auto count = static_cast<std::uint32_t>(hits.lanes.size()) - first;
    if (count == 0) continue;
    const Manifold& m = pairs.manifold[pair.first_manifold];
    hits.pairs.push_back({.pair = row,
                          .a = m.body_a,
                          .b = m.body_b,
                          .first_lane = first,
                          .lane_count = count,
                          .a_is_hooked = hooked[m.body_a] != 0,
                          .b_is_hooked = hooked[m.body_b] != 0});
  }
}

void find_backed_bodies(const std::vector<Manifold>& manifolds, const Bodies& bodies, Hits& hits) {
  constexpr int kMostBehind = 8;
  for (HitPair& pair : hits.pairs) {
    const Vec3 n = manifolds[hits.lanes[pair.first_lane].manifold].normal;
    pair.a_is_backed = is_backed(pair.a, -n, kMostBehind, bodies, hits);
    pair.b_is_backed = is_backed(pair.b, n, kMostBehind, bodies, hits);
  }
}

/// Where bodies are in a crowd, only what did not touch in the last step bounces.
void calm_crowds(const std::vector<Manifold>& manifolds, const Bodies& bodies, Hits& hits) {
  const auto is_in_crowd = [&](std::uint32_t body) {
    return is_moved(bodies, body) && hits.pairs_begin[body + 1] - hits.pairs_begin[body] >= kCrowd;
  };
  for (HitPair& pair : hits.pairs) pair.in_crowd = is_in_crowd(pair.a) || is_in_crowd(pair.b);
  std::erase_if(hits.pairs, [&](const HitPair& pair) {
    const auto lanes = lanes_of(pair, hits);
    return pair.in_crowd && std::any_of(lanes.begin(), lanes.end(), [&](const ContactLane& lane) {
             return manifolds[lane.manifold].touching;
           });
  });
}

/// Fills pairs_begin and pairs_of_body.
void index_bodies(std::size_t body_count, Hits& hits) {
  hits.pairs_begin.assign(body_count + 1, 0);
  for (const HitPair& pair : hits.pairs) {
    ++hits.pairs_begin[pair.a];
    ++hits.pairs_begin[pair.b];
  }
  std::partial_sum(hits.pairs_begin.begin(), hits.pairs_begin.end(), hits.pairs_begin.begin());
  hits.pairs_of_body.resize(2 * hits.pairs.size());
  for (auto i = static_cast<std::uint32_t>(hits.pairs.size()); i-- > 0;) {
    hits.pairs_of_body[--hits.pairs_begin[hits.pairs[i].a]] = i;
    hits.pairs_of_body[--hits.pairs_begin[hits.pairs[i].b]] = i;
  }
}

Real least_speed(const HitPair& pair) {
  return pair.in_crowd ? kLeastHitInCrowd : kLeastHit;
}

/// When a point of a lane meets, from `since` on and no slower than `least`: see the head of hits.h.
Real meeting_time(Real gap, Real v, Real a, Real since, Real h, Real least) {
  const auto speed = [&](Real t) { return v + a * (t - Real(0.5) * h); };
  const Real b = v - Real(0.5) * a * h;
  const Real gap_since = gap + since * (b + Real(0.5) * a * since);
  if (gap_since <= Real(0)) return speed(since) < -least ? since : Hits::kNever;
  // The earlier root of 0 = gap_since + u t + a t^2 / 2.
  const Real u = speed(since);
  const Real square = u * u - Real(2) * a * gap_since;
  if (square <= least * least) return Hits::kNever;
  const Real root = std::sqrt(square);
  if (root <= u) return Hits::kNever;
  const Real time = since + Real(2) * gap_since / (root - u);
  // What rounding puts off until just after the end would be stopped by the relaxation of this substep.
  return time <= (Real(1) + kTimeShare) * h ? time : Hits::kNever;
}

Real lane_time(const ContactLane& at, Real since, Real least, const ContactStep& step,
               const BodyContacts& contacts, const Bodies& bodies) {
  const ContactBlock& block = contacts.blocks[static_cast<std::size_t>(at.block)];
  const int lane = at.lane;
  const std::uint32_t row_a = block.line_a[lane] / 16;
  const std::uint32_t row_b = block.line_b[lane] / 16;
  const MotionLine& a = bodies.motion[row_a];
  const MotionLine& b = bodies.motion[row_b];
  const state::FreeLine from_a = state::motion_before_contacts(bodies, row_a);
  const state::FreeLine from_b = state::motion_before_contacts(bodies, row_b);
  const Vec3 n = vector_of(block.normal, lane);
  const Real pull =
      dot(n, free_acceleration(bodies, row_b, step.gravity) - free_acceleration(bodies, row_a, step.gravity));
  const Real approach = dot(n, from_b.v - from_a.v);
  const Real way = dot(n, b.dx - a.dx);
  Real earliest = Hits::kNever;
  for (int k = 0; k < block.point_count; ++k) {
    const ContactBlock::Point& p = block.point[k];
    if (!(p.mass[lane] > Real(0))) continue;
    const Vec3 j_a = vector_of(p.j_a, lane);
    const Vec3 j_b = vector_of(p.j_b, lane);
    const Real gap = p.separation[lane] + way + (dot(j_b, b.theta_scaled) - dot(j_a, a.theta_scaled));
    const Real v = approach + (dot(j_b, from_b.omega_scaled) - dot(j_a, from_a.omega_scaled));
    earliest = std::min(earliest, meeting_time(gap, v, pull, since, step.h, least));
  }
  return earliest;
}

/// Whether no point of the body is as fast as half of what bounces: what rests is not looked at.
bool is_slow(const Bodies& bodies, std::uint32_t body) {
  constexpr Real kSlow = Real(0.5) * kLeastHit;
  const state::FreeLine motion = state::motion_before_contacts(bodies, body);
  const Real turning = bodies.traits[body].radius * length(bodies.scale[body] * motion.omega_scaled);
  return length(motion.v) + turning < kSlow;
}

/// The pair's next time.
Real time_of(const HitPair& pair, const ContactStep& step, const BodyContacts& contacts, const Bodies& bodies,
             const Hits& hits) {
  if (pair.count >= (pair.in_crowd ? kMostHitsInCrowd : kMostHits)) return Hits::kNever;
  if (is_slow(bodies, pair.a) && is_slow(bodies, pair.b)) return Hits::kNever;
  const Real since = std::max(hits.since[pair.a], hits.since[pair.b]);
  Real earliest = Hits::kNever;
  for (const ContactLane& lane : lanes_of(pair, hits))
    earliest = std::min(earliest, lane_time(lane, since, least_speed(pair), step, contacts, bodies));
  return earliest;
}

void await(std::uint32_t index, Real time, Hits& hits) {
  hits.pairs[index].time = time;
  if (time == Hits::kNever) return;
  hits.queue.push_back({index, time});
  std::push_heap(hits.queue.begin(), hits.queue.end(), is_later);
}

/// What else the bodies of a hit will meet.
void look_ahead(std::uint32_t body, const ContactStep& step, const BodyContacts& contacts,
                const Bodies& bodies, Hits& hits) {
  for (std::uint32_t k = hits.pairs_begin[body]; k < hits.pairs_begin[body + 1]; ++k) {
    const std::uint32_t index = hits.pairs_of_body[k];
    hits.pairs[index].looks = 0;
    await(index, time_of(hits.pairs[index], step, contacts, bodies, hits), hits);
  }
}

/// Null if it was not struck.
template <class AnyHits>
auto find_struck(std::uint32_t body, AnyHits& hits) -> decltype(hits.on_hooks.data()) {
  const auto at = std::find_if(hits.on_hooks.begin(), hits.on_hooks.end(),
                               [&](const StruckOnHooks& s) { return s.body == body; });
  return at != hits.on_hooks.end() ? &*at : nullptr;
}

/// Counts a hit of a body on hooks, that was so before it.
void note_on_hooks(const StruckOnHooks& before, Real time, Hits& hits) {
  StruckOnHooks* struck = find_struck(before.body, hits);
  if (struck == nullptr) struck = &hits.on_hooks.emplace_back(before);
  ++struck->count;
  struck->time_sum += time;
}

/// Whether what the hits changed goes against a lock of the hook, at more than this share of the speeds.
bool goes_against(const Hook& hook, const Bodies& bodies, double h, const Hits& hits) {
  constexpr double kShare = 0.1;
  const auto change_of = [&](std::uint32_t body) {
    state::FreeLine change;
    const StruckOnHooks* struck = find_struck(body, hits);
    if (struck == nullptr) return change;
    const MotionLine& m = bodies.motion[body];
    change.v = m.v - struck->before.line.v;
    change.omega_scaled = m.omega_scaled - struck->before.line.omega_scaled;
    return change;
  };
  const auto size_of = [&](std::uint32_t body) {
    return body == state::HookPlace::kWorld ? Real(0) : bodies.traits[body].radius;
  };
  const state::FreeLine a = change_of(hook.a.body);
  const state::FreeLine b = change_of(hook.b.body);
  const auto speed = static_cast<double>(std::max(length(a.v), length(b.v)));
  const auto size = static_cast<double>(std::max(size_of(hook.a.body), size_of(hook.b.body)));
  std::array<JointRow, Hook::kMaxRows> rows;
  Hook copy = hook;  // its values are those of the last substep still
  const int count =
      make_joint_rows(copy, joint_body(bodies, hook.a.body), joint_body(bodies, hook.b.body), h, rows);
  return std::any_of(rows.begin(), rows.begin() + count, [&](const JointRow& row) {
    if (row.role != RowRole::kLock) return false;
    const double rate = dot(row.n, vector_cast<double>(b.v - a.v)) +
                        dot(row.j_b, vector_cast<double>(b.omega_scaled)) -
                        dot(row.j_a, vector_cast<double>(a.omega_scaled));
    return std::abs(rate) * (row.n == DVec3{} ? size : 1) > kShare * speed;
  });
}

}  // namespace

std::span<const ContactLane> lanes_of(const HitPair& pair, const Hits& hits) {
  return std::span(hits.lanes).subspan(pair.first_lane, pair.lane_count);
}

void list_hits(const state::Pairs& pairs, const Bodies& bodies, const std::vector<std::uint8_t>& hooked,
               const BodyContacts& contacts, Hits& hits) {
  hits.pairs.clear();
  hits.lanes.clear();
  hits.on_hooks.clear();
  if (!find_lanes(contacts, pairs.manifold, hits.lane_of)) return;
  list_pairs(pairs, hooked, hits);
  index_bodies(bodies.motion.size(), hits);
  calm_crowds(pairs.manifold, bodies, hits);
  index_bodies(bodies.motion.size(), hits);
  find_supports(pairs.manifold, bodies, hits);
  find_backed_bodies(pairs.manifold, bodies, hits);
  hits.since.assign(bodies.motion.size(), Real(0));
}

bool foresee_hits(const ContactStep& step, BodyContacts& contacts, Bodies& bodies, Hits& hits) {
  hits.queue.clear();
  for (const std::uint32_t body : hits.struck) hits.since[body] = Real(0);
  hits.struck.clear();
  hits.on_hooks.clear();
  // An impulse that is repeated and then loses its row in a hit would be one too many.
  for (const HitPair& pair : hits.pairs) {
    if (is_slow(bodies, pair.a) && is_slow(bodies, pair.b)) continue;
    for (const ContactLane& lane : lanes_of(pair, hits)) drop_warm_start(lane, contacts, bodies);
  }
  for (std::uint32_t i = 0; i < hits.pairs.size(); ++i) {
    HitPair& pair = hits.pairs[i];
    pair.looks = 0;
    if (!pair.in_crowd) pair.count = 0;
    await(i, time_of(pair, step, contacts, bodies, hits), hits);
  }
  return !hits.queue.empty();
}

std::optional<Hit> next_hit(Hits& hits) {
  while (!hits.queue.empty()) {
    std::pop_heap(hits.queue.begin(), hits.queue.end(), is_later);
    const Hit hit = hits.queue.back();
    hits.queue.pop_back();
    if (hits.pairs[hit.index].time == hit.time) return hit;
  }
  return std::nullopt;
}

void take_hit(const Hit& hit, const ContactStep& step, const state::Pairs& pairs, BodyContacts& contacts,
              Bodies& bodies, Hits& hits) {
  HitPair& pair = hits.pairs[hit.index];
  const std::span<const ContactLane> lanes = lanes_of(pair, hits);
  refill_lanes(lanes, pairs.manifold, hit.time, bodies, contacts);
  const Real time = time_of(pair, step, contacts, bodies, hits);
  const bool is_there = std::abs(time - hit.time) <= kTimeShare * step.h;
  if (!is_there && (time == Hits::kNever || ++pair.looks < kMostLooks)) {
    await(hit.index, time, hits);
    return;
  }
  pair.time = Hits::kNever;
  const auto as_it_is = [&](std::uint32_t body) {
    return StruckOnHooks{.body = body, .before = {bodies.motion[body], bodies.rotation[body]}};
  };
  const StruckOnHooks a_before = as_it_is(pair.a);
  const StruckOnHooks b_before = as_it_is(pair.b);
  if (!strike({lanes, pair.in_crowd, pair.a_is_backed, pair.b_is_backed}, pairs.manifold, hit.time, step,
              contacts, bodies))
    return;
  ++pair.count;
  if (pair.a_is_hooked) note_on_hooks(a_before, hit.time, hits);
  if (pair.b_is_hooked) note_on_hooks(b_before, hit.time, hits);
  // What stands is not struck: others come upon it as before.
  for (const std::uint32_t body : {pair.a, pair.b}) {
    if (!is_moved(bodies, body)) continue;
    hits.since[body] = hit.time;
    hits.struck.push_back(body);
  }
  for (const std::uint32_t body : {pair.a, pair.b}) {
    if (is_moved(bodies, body)) look_ahead(body, step, contacts, bodies, hits);
  }
}

void put_back_on_hooks(const std::vector<Hook>& hooks, Real h, Bodies& bodies, Hits& hits) {
  if (hits.on_hooks.empty()) return;
  for (const Hook& hook : hooks) {
    StruckOnHooks* a = find_struck(hook.a.body, hits);
    StruckOnHooks* b = find_struck(hook.b.body, hits);
    if (a == nullptr && b == nullptr) continue;
    if (hook.holds_point() || !goes_against(hook, bodies, static_cast<double>(h), hits)) continue;
    for (StruckOnHooks* struck : {a, b}) {
      if (struck != nullptr) struck->is_led = true;
    }
  }
  std::erase_if(hits.on_hooks, [](const StruckOnHooks& struck) { return !struck.is_led; });
  for (const StruckOnHooks& struck : hits.on_hooks) {
    MotionLine& m = bodies.motion[struck.body];
    m.dx = struck.before.line.dx;
    m.theta_scaled = struck.before.line.theta_scaled;
    bodies.rotation[struck.body] = struck.before.rotation;
  }
}

void lead_from_hits(Bodies& bodies, Hits& hits) {
  for (const StruckOnHooks& struck : hits.on_hooks) {
    const MotionLine& before = struck.before.line;
    MotionLine& m = bodies.motion[struck.body];
    Quat& rotation = bodies.rotation[struck.body];
    const Real time = struck.time_sum / static_cast<Real>(struck.count);
    if (state::tumbles_now(bodies, struck.body)) {
      const auto turn = [&](Real t, Vec3 omega_scaled) {
        return math::quaternion_of(t * (bodies.scale[struck.body] * omega_scaled));
      };
      rotation = normalize(turn(-time, m.omega_scaled) * turn(time, before.omega_scaled) * rotation);
    }
    m.dx += time * (before.v - m.v);
    m.theta_scaled += time * (before.omega_scaled - m.omega_scaled);
  }
  hits.on_hooks.clear();
}

}  // namespace hooke::solver
