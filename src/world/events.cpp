#include "world/events.h"

#include "base/assert.h"
#include "base/take_turns.h"
#include "collision/query/queries.h"
#include "state/body_frames.h"
#include "state/sleeping_pairs.h"
#include "world/object_edits.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace hooke::world {

namespace {

using state::Bodies;
using state::Manifold;
using state::Tables;

auto order_of(BodyPart p) {
  return std::tuple(p.body.slot, p.part);
}
auto order_of(const ContactEvent& e) {
  return std::tuple_cat(order_of(e.a), order_of(e.b));
}
auto order_of(const SensorEvent& e) {
  return std::tuple(e.sensor.slot, e.visitor.slot);
}
auto order_of(const HitEvent& e) {
  return std::tuple_cat(order_of(e.a), order_of(e.b), std::tuple(e.normal.x, e.normal.y, e.normal.z));
}
auto order_of(BodyId id) {
  return id.slot;
}

constexpr auto kComesFirst = [](const auto& p, const auto& q) { return order_of(p) < order_of(q); };

template <class Event>
void sort_events(std::vector<Event>& events) {
  std::sort(events.begin(), events.end(), kComesFirst);
}

/// Sorts `now` and lists what is new in it and what is gone. `before` then holds it for the next step.
template <class Event>
void compare(std::vector<Event>& now, std::vector<Event>& before, std::vector<Event>& begins,
             std::vector<Event>& ends) {
  HOOKE_ASSERT(std::is_sorted(before.begin(), before.end(), kComesFirst));
  sort_events(now);
  now.erase(std::unique(now.begin(), now.end()), now.end());
  begins.clear();
  ends.clear();
  std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(begins),
                      kComesFirst);
  std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(ends),
                      kComesFirst);
  base::take_turns(now, before);
}

ContactEvent parts_of(const Tables& t, const Manifold& m) {
  ContactEvent parts = {part_of(t, m.collider_a), part_of(t, m.collider_b)};
  if (is_swapped(t, m)) std::swap(parts.a, parts.b);
  return parts;
}

void gather_contacts(WorldData& world) {
  Tables& t = world.tables;
  std::vector<ContactEvent>& now = world.frame.contacts_now;
  now.clear();
  const auto asks = [&](std::uint32_t body) { return t.bodies.traits[body].reports_contacts; };
  state::for_each_manifold(t.pairs, [&](const Manifold& m) {
    if (m.touching && (asks(m.body_a) || asks(m.body_b))) now.push_back(parts_of(t, m));
  });
  compare(now, t.touches, world.last_step.events.contact_begins, world.last_step.events.contact_ends);
}

void gather_hits(const WorldData& world, Events& events) {
  const Tables& t = world.tables;
  events.hits.clear();
  for (const ClosingPair& closing_pair : world.frame.closing_pairs) {
    HOOKE_ASSERT(closing_pair.manifold < t.pairs.manifold.size());
    const Manifold& m = t.pairs.manifold[closing_pair.manifold];
    if (!m.touching) continue;
    const auto [a, b] = parts_of(t, m);
    const Vec3 normal = is_swapped(t, m) ? -m.normal : m.normal;
    events.hits.push_back({a, b, closing_pair.point, normal, closing_pair.speed, m.largest_impulse});
  }
  sort_events(events.hits);
}

/// Whether neither body moved in this step.
bool both_stood(const Bodies& bodies, std::uint32_t a, std::uint32_t b) {
  const auto stood = [&](std::uint32_t body) {
    return bodies.traits[body].kind == BodyKind::kStatic ||
           (bodies.asleep[body] != 0 && bodies.slept[body] != 0);
  };
  return stood(a) && stood(b);
}

/// Whether the shapes of a sensor's pair overlap. Such a pair has no manifolds, so its `gap` and `tested`
/// remember the answer while both bodies stand.
bool overlap(const Tables& t, state::Pair& pair) {
  const std::uint32_t a = t.colliders.body[pair.collider_a];
  const std::uint32_t b = t.colliders.body[pair.collider_b];
  if (!(pair.tested && both_stood(t.bodies, a, b))) {
    const bool overlap = collision::shapes_overlap(
        t.colliders.shape[pair.collider_a], state::frame_of_collider(t.bodies, t.colliders, pair.collider_a),
        t.colliders.shape[pair.collider_b], state::frame_of_collider(t.bodies, t.colliders, pair.collider_b));
    pair.gap = overlap ? Real(-1) : Real(1);
    pair.tested = true;
  }
  return pair.gap < Real(0);
}

void gather_visits(WorldData& world) {
  Tables& t = world.tables;
  std::vector<SensorEvent>& now = world.frame.visits_now;
  now.clear();
  for (state::Pair& pair : t.pairs.pair) {
    const std::uint32_t a = t.colliders.body[pair.collider_a];
    const std::uint32_t b = t.colliders.body[pair.collider_b];
    const bool senses_a = t.bodies.traits[a].sensor;
    if (!(senses_a || t.bodies.traits[b].sensor) || !overlap(t, pair)) continue;
    now.push_back(senses_a ? SensorEvent{id_of(t, a), id_of(t, b)} : SensorEvent{id_of(t, b), id_of(t, a)});
  }
  compare(now, t.visits, world.last_step.events.sensor_enters, world.last_step.events.sensor_leaves);
}

void gather_sleep(WorldData& world) {
  Bodies& bodies = world.tables.bodies;
  Events& events = world.last_step.events;
  events.fell_asleep.clear();
  events.woke_up.clear();
  for (const std::uint32_t body : world.frame.awake) {
    if (bodies.asleep[body] == bodies.slept[body]) continue;
    (bodies.asleep[body] != 0 ? events.fell_asleep : events.woke_up).push_back(id_of(world.tables, body));
    bodies.slept[body] = bodies.asleep[body];
  }
  sort_events(events.fell_asleep);
  sort_events(events.woke_up);
}

/// Returns the acceleration at which gravity drives two bodies together along the normal [m/s^2].
Real pull_of(const Tables& t, const Manifold& m) {
  const auto pull = [&](std::uint32_t body) {
    return is_dynamic(t.bodies, body) ? t.bodies.traits[body].gravity_scale : Real(0);
  };
  return (pull(m.body_a) - pull(m.body_b)) * dot(m.normal, t.desc.gravity);
}

/// Returns the fastest of the points that meet within `dt` [s]; the speed is zero if none do.
///
/// With the closing speed v and the closing acceleration g of now, two points close a gap s with sqrt(v^2 + 2
/// g s). Half a substep of g is added to v, because semi-implicit steps follow the parabola that begins with
/// that speed.
ClosingPair fastest_of(const Tables& t, std::uint32_t row, Real dt) {
  const Manifold& m = t.pairs.manifold[row];
  const Real pull = pull_of(t, m);
  const Real ahead = Real(0.5) * pull * dt / static_cast<Real>(t.desc.substeps);
  ClosingPair fastest = {.manifold = row};
  for (int i = 0; i < m.point_count; ++i) {
    const state::ContactPoint& p = m.point[i];
    const Real v_a = dot(m.normal, velocity_at(t.bodies, m.body_a, p.anchor_a));
    const Real v_b = dot(m.normal, velocity_at(t.bodies, m.body_b, p.anchor_b));
    const Real closing = v_a - v_b + ahead;
    if (!(closing > Real(0)) || p.separation > dt * (closing + std::max(pull, Real(0)) * dt)) continue;
    const Real squared = closing * closing + Real(2) * pull * p.separation;
    const Real speed = std::sqrt(std::max(squared, Real(0)));
    if (!(speed > fastest.speed)) continue;
    const double time = static_cast<double>(std::max(p.separation, Real(0)) / speed);
    const auto met = [&](std::uint32_t body, Vec3 anchor) {
      const Vec3 v = velocity_at(t.bodies, body, anchor);
      return t.bodies.center[body] + vector_cast<double>(anchor) + time * vector_cast<double>(v);
    };
    fastest.speed = speed;
    fastest.point = 0.5 * (met(m.body_a, p.anchor_a) + met(m.body_b, p.anchor_b));
  }
  return fastest;
}

}  // namespace

void note_closing_pairs(WorldData& world, Real dt) {
  const Tables& t = world.tables;
  world.frame.closing_pairs.clear();
  if (!t.any_reports) return;
  for (std::uint32_t row = 0; row < t.pairs.manifold.size(); ++row) {
    const Manifold& m = t.pairs.manifold[row];
    const Real least = std::min(t.bodies.traits[m.body_a].hit_speed, t.bodies.traits[m.body_b].hit_speed);
    if (!std::isfinite(least)) continue;
    const ClosingPair closing_pair = fastest_of(t, row, dt);
    if (closing_pair.speed > least) world.frame.closing_pairs.push_back(closing_pair);
  }
}

void clear_events(Events& events) {
  const auto clear = [](auto&... lists) { (lists.clear(), ...); };
  clear(events.contact_begins, events.contact_ends, events.hits, events.sensor_enters, events.sensor_leaves,
        events.fell_asleep, events.woke_up, events.deformable_begins, events.deformable_ends,
        events.deformable_hits, events.breaks, events.rope_breaks, events.tears, events.solid_tears,
        events.yields, events.freezes);
}

void gather_events(WorldData& world) {
  if (world.tables.any_reports) {
    gather_contacts(world);
    gather_hits(world, world.last_step.events);
    gather_visits(world);
  }
  gather_deformable_events(world);
  gather_sleep(world);
}

}  // namespace hooke::world
