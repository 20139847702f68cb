#include "state/check_contacts.h"

#include "state/sleeping_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>

namespace hooke::state {

namespace {

// Each function returns what is wrong, or null.

/// Zero where there is none yet. What is not finite passes: quarantine finds it.
bool is_unit_or(Vec3 normal, bool may_be_zero) {
  if (normal == Vec3{}) return may_be_zero;
  return !(std::abs(length(normal) - Real(1)) > Real(1e-3));
}

const char* find_in_manifold(const Tables& t, const Pair& pair, const Manifold& m) {
  const BodyTraits& a = t.bodies.traits[m.body_a];
  const BodyTraits& b = t.bodies.traits[m.body_b];
  if (a.sensor || b.sensor) return "a manifold of a sensor";
  if (a.kind != BodyKind::kDynamic && b.kind != BodyKind::kDynamic) return "a manifold that pushes nothing";
  if (!is_unit_or(m.normal, false)) return "normal of a manifold";
  if (m.is_refreshed() != pair.is_refreshed()) return "refresh of a manifold";
  return nullptr;
}

const char* find_in_awake_pairs(const Tables& t) {
  std::size_t next = 0;
  for (const Pair& pair : t.pairs.pair) {
    if (t.colliders.body[pair.collider_a] == t.colliders.body[pair.collider_b]) return "a pair of one body";
    if (pair.first_manifold != next) return "gap between manifolds";
    next += pair.manifold_count;
    if (next > t.pairs.manifold.size()) return "manifolds of a pair";
    for (const Manifold& m : std::span(t.pairs.manifold).subspan(pair.first_manifold, pair.manifold_count)) {
      if (const char* what = find_in_manifold(t, pair, m)) return what;
    }
  }
  if (next != t.pairs.manifold.size()) return "manifolds of no pair";
  if (t.pairs.seen.size() != t.bodies.traits.size()) return "poses that were seen";
  return nullptr;
}

/// Both tables are in order: one walk finds who is in both.
const char* find_in_both_pairs(const Tables& t) {
  const std::vector<Pair>& sleeping = t.pairs.sleeping.pair;
  auto at = sleeping.begin();
  for (const Pair& pair : t.pairs.pair) {
    while (at != sleeping.end() && comes_before(*at, pair)) ++at;
    if (at != sleeping.end() && !comes_before(pair, *at)) return "a pair that sleeps and does not";
  }
  return nullptr;
}

const char* find_in_sleeping_pairs(const Tables& t) {
  const SleepingPairs& sleeping = t.pairs.sleeping;
  std::size_t ends = 0;
  std::uint32_t points = 0;
  for (const Pair& pair : sleeping.pair) {
    if (!rests(t.bodies, t.colliders, pair)) return "a sleeping pair that moves";
    for (const std::uint32_t collider : {pair.collider_a, pair.collider_b}) {
      const std::uint32_t body = t.colliders.body[collider];
      if (body >= sleeping.of_body.size() || sleeping.of_body[body] == 0) return "sleeping pairs of a body";
    }
    ends += 2;
    for (std::uint32_t i = 0; i < pair.manifold_count; ++i)
      points += pushing_points(sleeping.manifold[pair.first_manifold + i]);
  }
  for (const std::uint32_t count : sleeping.of_body) ends -= count;
  if (ends != 0) return "number of sleeping pairs";
  return points == sleeping.contacts ? nullptr : "number of sleeping contacts";
}

const char* find_in_particle_contacts(const Tables& t) {
  const Contacts& contacts = t.contacts;
  const auto key = [&](std::size_t i) {
    return std::tuple(contacts.particle[i], contacts.collider[i], contacts.feature[i]);
  };
  for (std::size_t i = 0; i < contacts.particle.size(); ++i) {
    if (i > 0 && !(key(i - 1) < key(i))) return "order of contacts";
    if (t.colliders.body[contacts.collider[i]] != contacts.body[i]) return "body of a contact";
  }
  return nullptr;
}

const char* find_in_elements_in_contact(const Tables& t) {
  const auto key = [](const ElementContact& c) {
    return std::tuple(c.object, c.collider, c.element, c.edge, c.feature);
  };
  for (std::size_t i = 0; i < t.element_contacts.size(); ++i) {
    const ElementContact& contact = t.element_contacts[i];
    if (i > 0 && !(key(t.element_contacts[i - 1]) < key(contact))) return "order of element contacts";
    if (t.colliders.body[contact.collider] != contact.body) return "body of an element contact";
    if (contact.count < 2 || contact.count > contact.particle.size()) return "number of an element's points";
    for (std::uint32_t k = 1; k < contact.count; ++k) {
      if (contact.particle[k - 1] >= contact.particle[k]) return "points of an element";
    }
    if (!is_unit_or(contact.normal, true)) return "normal of an element contact";
  }
  return nullptr;
}

/// Two segments of one rope have one point in common where they are neighbors: those have no row.
const char* find_in_ropes_in_contact(const Tables& t) {
  for (std::size_t i = 0; i < t.rope_contacts.size(); ++i) {
    const RopeContact& contact = t.rope_contacts[i];
    const auto& [a, b, c, d] = contact.particle;
    if (contact.segment_a >= contact.segment_b || a + 1 != b || c + 1 != d || b >= c)
      return "points of a contact of ropes";
    if (!is_unit_or(contact.normal, true)) return "normal of a contact of ropes";
    if (i == 0) continue;
    const RopeContact& before = t.rope_contacts[i - 1];
    if (std::tie(before.segment_a, before.segment_b) >= std::tie(contact.segment_a, contact.segment_b))
      return "order of contacts of ropes";
  }
  return nullptr;
}

}  // namespace

const char* find_in_body_contacts(const Tables& t) {
  if (const char* what = find_in_awake_pairs(t)) return what;
  if (const char* what = find_in_both_pairs(t)) return what;
  return find_in_sleeping_pairs(t);
}

const char* find_in_point_contacts(const Tables& t) {
  if (const char* what = find_in_particle_contacts(t)) return what;
  if (const char* what = find_in_elements_in_contact(t)) return what;
  return find_in_ropes_in_contact(t);
}

const char* find_in_sleepers(const Tables& t) {
  for (std::uint32_t body = 0; body < t.bodies.asleep.size(); ++body) {
    if (t.bodies.asleep[body] == 0) continue;
    if (!is_dynamic(t.bodies, body)) return "a sleeper that never rests";
    const MotionRecord& m = t.bodies.motion[body];
    if (m.v != Vec3{} || m.omega_scaled != Vec3{} || t.bodies.angular_velocity[body] != Vec3{} ||
        t.bodies.angular_momentum[body] != Vec3{})
      return "a sleeper that moves";
    if (m.dx != Vec3{} || m.theta_scaled != Vec3{}) return "a sleeper that is on its way";
  }
  return nullptr;
}

}  // namespace hooke::state
