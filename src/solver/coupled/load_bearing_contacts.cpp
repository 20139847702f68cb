#include "solver/coupled/load_bearing_contacts.h"

#include "base/sort_unique.h"
#include "solver/contact/contact_colors.h"
#include "state/body_frames.h"

#include <algorithm>
#include <limits>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::BorneContact;
using state::Hook;
using state::Manifold;
using state::normal_impulse;

constexpr Real kTouches = Real(1e-3);      ///< Surfaces so near may press on each other [m].
constexpr Real kLiesOn = Real(0.3);        ///< Cosine between the normal and gravity.
constexpr Real kCarried = Real(0.5);       ///< Share of load and weight that contacts under a body bring.
constexpr Real kNeverStands = Real(-1);    ///< Weight of a body that is not asked.
constexpr Real kCarriedAgain = Real(0.9);  ///< The same of a body whose hooks carried it before.

bool touches(const Manifold& m) {
  for (std::int32_t k = 0; k < m.point_count; ++k) {
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
    if (p.normal_impulse > Real(0) || p.separation <= kTouches) return true;
  }
  return false;
}

/// Lists what lies on what.
void find_props(const state::Pairs& pairs, Vec3 down, std::vector<Prop>& props) {
  props.clear();
  for (const Manifold& m : pairs.manifold) {
    const Real slope = dot(m.normal, down);  // positive where a lies on b
    if (std::abs(slope) < kLiesOn || !touches(m)) continue;
    const bool a_is_upper = slope > Real(0);
    props.push_back({.upper = a_is_upper ? m.body_a : m.body_b,
                     .lower = a_is_upper ? m.body_b : m.body_a,
                     .impulse = normal_impulse(m) * std::abs(slope)});
  }
}

/// What the choice is made from.
struct Candidates {
  Real gravity;           ///< [m/s^2]
  Vec3 down;              ///< Unit; zero without gravity.
  Real impulse_to_force;  ///< [1/s]
  const Bodies& bodies;
  std::span<const std::uint8_t> hooked;
  const std::vector<Holding>& by_hooks;  ///< What hooks alone say, of all bodies.
  const std::vector<Burden>& by_burden;  ///< The same.
  const Holders& holders;                ///< The same of those that do not stand, with what lies on them.
  std::span<const Footing> footing;
  std::span<const Carried> carried;
  std::span<const std::pair<std::uint32_t, std::uint32_t>> borne_before;  ///< Bodies, ascending.
  std::span<const std::uint8_t> in_ragdoll;  ///< Of like masses: what presses there may err.

  [[nodiscard]] bool may_be_borne(const Manifold& m) const {
    return !m.borne && m.point_count > 0 && has_contact_rows(m, bodies);
  }

  [[nodiscard]] bool bears_on(std::uint32_t upper, std::uint32_t lower, const Manifold& m) const {
    const std::vector<Holding>& holding = holders.holding;
    const bool of_net = hooked[upper] != 0 && by_hooks[upper] == Holding::kNone;
    if (of_net || holding[lower] == Holding::kNone || holding[upper] == Holding::kHangs) return false;
    // Of two that are hooked and hang on nothing, ragdolls in a heap, neither holds the other.
    if (hooked[upper] != 0 && holding[lower] == Holding::kHooked) return false;
    const Real w_upper = bodies.motion[upper].inverse_mass;
    const Real w_lower = bodies.motion[lower].inverse_mass;
    // What stands beside, as a lamp beside a tower, does not rest on it; but a jaw may be driven against it.
    const bool stands = footing[upper] == Footing::kStands && carried[upper].on_something;
    if (stands && !lies_on(upper, m) && !by_burden[lower].driven) return false;
    // Rows of one body that are exact leave nothing to the others.
    if (holding[upper] == Holding::kBorne || w_lower >= kBorneMass * w_upper) return true;
    if (holding[lower] == Holding::kHooked) return false;
    return w_lower * load_on(m) > (was_borne(m) ? Real(0) : kBorneLoad * gravity);
  }

  /// Whether it is pressed against what no force moves.
  [[nodiscard]] bool is_pressed(std::uint32_t body, const Manifold& m) const {
    if (by_hooks[body] == Holding::kNone || in_ragdoll[body] != 0) return false;
    const Burden& burden = holders.burden[body];
    const Real w = bodies.motion[body].inverse_mass;
    if (w * burden.neighbor >= kPressedMass) return true;
    if (!(w * burden.group >= kPressedGroup)) return false;
    return w * load_on(m) > (was_borne(m) ? Real(0.25) : Real(1)) * kPressedLoad * gravity;
  }

  /// In the last step [N].
  [[nodiscard]] Real load_on(const Manifold& m) const {
    Real load = Real(0);
    for (int k = 0; k < m.point_count; ++k) load += impulse_to_force * m.point[k].normal_impulse;
    return load;
  }

  /// Whether it presses on the other one by its weight: not one that leans on its side.
  [[nodiscard]] bool lies_on(std::uint32_t upper, const Manifold& m) const {
    const Real up = dot(m.normal, down) * (upper == m.body_a ? Real(1) : Real(-1));
    return up > kLiesOn;
  }

  [[nodiscard]] bool was_borne(const Manifold& m) const {
    return std::binary_search(borne_before.begin(), borne_before.end(), std::pair(m.body_a, m.body_b));
  }
};

/// The only manifold of a pair; null if there are none or more.
Manifold* only_manifold(const state::Pair& pair, std::vector<Manifold>& manifolds) {
  return pair.manifold_count == 1 ? &manifolds[pair.first_manifold] : nullptr;
}

/// Marks manifolds, from what hangs upwards: what lies on it holds others. Returns how many.
std::size_t choose(const Candidates& candidates, state::Pairs& pairs, std::vector<Holding>& holding,
                   std::uint32_t& refused) {
  constexpr int kMostLayers = 4;
  std::size_t chosen = 0;
  bool more = true;
  for (int layer = 0; more && layer < kMostLayers; ++layer) {
    more = false;
    refused = 0;
    for (const state::Pair& pair : pairs.pair) {
      Manifold* m = only_manifold(pair, pairs.manifold);
      if (m == nullptr) continue;
      if (holding[m->body_a] == Holding::kNone && holding[m->body_b] == Holding::kNone) continue;
      if (!is_moved(candidates.bodies, m->body_a) || !is_moved(candidates.bodies, m->body_b)) continue;
      const bool may_bounce = m->restitution > Real(0) && !m->touching;
      if (may_bounce || !candidates.may_be_borne(*m)) continue;
      const bool a_is_upper = candidates.bears_on(m->body_a, m->body_b, *m);
      if (!a_is_upper && !candidates.bears_on(m->body_b, m->body_a, *m)) continue;
      if (chosen == kMostBorneManifolds) {
        ++refused;
        continue;
      }
      ++chosen;
      m->borne = more = true;
      holding[a_is_upper ? m->body_a : m->body_b] = Holding::kBorne;
    }
  }
  return chosen;
}

/// What lies on one member of an articulation may press each of them on the ground.
void add_loads(const Joints& joints, const Bodies& bodies, const state::Pairs& pairs, std::vector<Real>& load,
               std::vector<Burden>& burden) {
  load.assign(bodies.motion.size(), Real(0));
  const auto add = [&](std::uint32_t body, std::uint32_t other) {
    load[body] = std::max(load[body], Real(1) / bodies.motion[other].inverse_mass);
  };
  for (const Manifold& m : pairs.manifold) {
    if (!m.borne) continue;
    add(m.body_a, m.body_b);
    add(m.body_b, m.body_a);
  }
  for (const std::uint32_t i : joints.order) {
    const std::vector<std::uint32_t>& members = joints.articulations[i].bodies;
    Real heaviest = Real(0);
    for (const std::uint32_t body : members) {
      if (body != state::HookPlace::kWorld) heaviest = std::max(heaviest, load[body]);
    }
    for (const std::uint32_t body : members) {
      if (body == state::HookPlace::kWorld) continue;
      burden[body].neighbor = std::max(burden[body].neighbor, heaviest);
      burden[body].group += heaviest;
    }
  }
}

/// The body that may be pressed on the other one, the ground: what moves against what does not, or what is
/// hooked and lies on something loose that stands. Null if there is none.
const std::uint32_t* pressed_body(const Candidates& candidates, const Manifold& m) {
  const bool a_moves = is_moved(candidates.bodies, m.body_a);
  const bool b_moves = is_moved(candidates.bodies, m.body_b);
  if (a_moves != b_moves) return a_moves ? &m.body_a : &m.body_b;
  if (!a_moves) return nullptr;
  const auto lies = [&](std::uint32_t body, std::uint32_t other) {
    return candidates.hooked[body] != 0 && candidates.hooked[other] == 0 &&
           candidates.footing[other] == Footing::kStands && candidates.lies_on(body, m);
  };
  if (lies(m.body_a, m.body_b)) return &m.body_a;
  return lies(m.body_b, m.body_a) ? &m.body_b : nullptr;
}

/// Marks manifolds of what is pressed on the ground, `chosen` being chosen already.
void choose_pressed(const Candidates& candidates, std::size_t chosen, state::Pairs& pairs,
                    std::uint32_t& refused) {
  for (const state::Pair& pair : pairs.pair) {
    Manifold* m = only_manifold(pair, pairs.manifold);
    const std::uint32_t* body = m == nullptr ? nullptr : pressed_body(candidates, *m);
    if (body == nullptr) continue;
    const bool may_bounce = m->restitution > Real(0) && !m->touching;
    if (may_bounce || !candidates.is_pressed(*body, *m) || !candidates.may_be_borne(*m)) continue;
    if (chosen == kMostBorneManifolds) {
      ++refused;
      continue;
    }
    ++chosen;
    m->borne = true;
  }
}

/// Whether what it joins stays at its distance along any direction in which they may be pressed together.
bool holds_place(const Hook& hook) {
  if (hook.holds_point()) return false;
  if (hook.kind == HookKind::kDistance) return hook.freedom[0].locked;
  return hook.freedom[0].locked && hook.freedom[1].locked && hook.freedom[2].locked;
}

bool is_driven(const Hook& hook) {
  return std::any_of(hook.freedom.begin(), hook.freedom.end(), [](const HookFreedom& freedom) {
    const bool turns = freedom.motor.max_force > Real(0) && freedom.motor.speed != Real(0);
    return turns || (!freedom.locked && freedom.spring.stiffness > Real(0));
  });
}

void note_neighbors(const Hook& hook, const Bodies& bodies, std::vector<Burden>& burden) {
  const auto note = [&](std::uint32_t body, std::uint32_t other) {
    if (!is_dynamic(bodies, body) || !is_dynamic(bodies, other)) return;
    burden[body].neighbor = std::max(burden[body].neighbor, Real(1) / bodies.motion[other].inverse_mass);
  };
  note(hook.a.body, hook.b.body);
  note(hook.b.body, hook.a.body);
}

/// What has to be lifted for the two to leave each other: the heavier one, or what presses on the ground.
Real lifted_mass(const Manifold& m, const Bodies& bodies, const std::vector<Burden>& burden) {
  const Real w_a = bodies.motion[m.body_a].inverse_mass;
  const Real w_b = bodies.motion[m.body_b].inverse_mass;
  if (is_moved(bodies, m.body_a) && is_moved(bodies, m.body_b)) return Real(1) / std::min(w_a, w_b);
  return burden[is_moved(bodies, m.body_a) ? m.body_a : m.body_b].group;
}

}  // namespace

void find_holders(const Joints& joints, const Bodies& bodies, const std::vector<Hook>& hooks,
                  Holders& holders) {
  auto& [holding, burden] = holders;
  holding.assign(bodies.motion.size(), Holding::kNone);
  burden.assign(bodies.motion.size(), {});
  const auto raise = [&holding = holding, &bodies](std::uint32_t body, Holding to) {
    if (is_dynamic(bodies, body)) holding[body] = std::max(holding[body], to);
  };
  for (const Hook& hook : hooks) {
    if (holds_place(hook)) note_neighbors(hook, bodies, burden);
    if (is_driven(hook)) {
      if (is_dynamic(bodies, hook.a.body)) burden[hook.a.body].driven = true;
      if (is_dynamic(bodies, hook.b.body)) burden[hook.b.body].driven = true;
    }
    if (!hook.holds_point()) continue;
    raise(hook.a.body, Holding::kHangs);
    raise(hook.b.body, Holding::kHangs);
  }
  for (const std::uint32_t i : joints.order) {
    const std::vector<std::uint32_t>& members = joints.articulations[i].bodies;
    Real mass = Real(0);
    bool hangs = false;
    for (const std::uint32_t body : members) {
      const bool moves = is_dynamic(bodies, body);
      if (moves) mass += Real(1) / bodies.motion[body].inverse_mass;
      hangs = hangs || !moves || holding[body] == Holding::kHangs;
    }
    for (const std::uint32_t body : members) {
      raise(body, hangs ? Holding::kHangs : Holding::kHooked);
      if (is_dynamic(bodies, body)) burden[body].group = mass;
    }
  }
  for (const std::vector<std::uint32_t>* rows : {&joints.net.hooks, &joints.balls.hooks}) {
    for (const std::uint32_t row : *rows) {
      for (const std::uint32_t body : {hooks[row].a.body, hooks[row].b.body}) {
        if (is_dynamic(bodies, body)) holding[body] = Holding::kNone;
      }
    }
  }
}

namespace {

/// Whether contacts under a body bring `share` of its weight and of what lies on it, or where nothing is
/// known yet, something that stands touches it from below.
bool is_carried(const Carried& by, Real weight, Real share) {
  const bool known = by.from_below > Real(0) || by.from_above > Real(0);
  return known ? by.from_below >= share * (by.from_above + weight) : by.on_something;
}

/// One look from below upwards: who stands on what stands. Returns whether it found more than before.
bool find_more_standing(const std::vector<Real>& weights, const std::vector<Prop>& props,
                        BorneScratch& scratch) {
  std::vector<Carried>& carried = scratch.carried;
  std::fill(carried.begin(), carried.end(), Carried{});
  for (const Prop& prop : props) {
    carried[prop.lower].from_above += prop.impulse;
    if (scratch.footing[prop.lower] != Footing::kStands) continue;
    carried[prop.upper].from_below += prop.impulse;
    carried[prop.upper].on_something = true;
  }
  bool more = false;
  for (const Prop& prop : props) {
    if (scratch.footing[prop.upper] != Footing::kHangs || weights[prop.upper] == kNeverStands) continue;
    const bool bore = std::binary_search(scratch.bore.begin(), scratch.bore.end(), prop.upper);
    if (!is_carried(carried[prop.upper], weights[prop.upper], bore ? kCarriedAgain : kCarried)) continue;
    scratch.footing[prop.upper] = Footing::kStands;
    more = true;
  }
  return more;
}

/// A hooked body stands if contacts under it, with what stands itself, bring most of its weight and of what
/// lies on it, and no motor or spring moves it.
void find_footing(const ContactStep& step, std::span<const std::uint8_t> hooked, const Joints& joints,
                  const std::vector<Burden>& burden, const Bodies& bodies, const state::Pairs& pairs,
                  BorneScratch& scratch) {
  constexpr int kMostLooks = 32;  // one for each hooked body that stands on another one
  find_props(pairs, normalize(step.gravity), scratch.props);
  scratch.carried.resize(bodies.motion.size());
  scratch.weights.assign(bodies.motion.size(), kNeverStands);
  const Real before = step.h / step.impulse_scale * length(step.gravity);
  for (std::uint32_t body = 0; body < hooked.size(); ++body) {
    if (hooked[body] == 0 || !is_moved(bodies, body)) continue;
    scratch.footing[body] = joints.in_ragdoll[body] != 0 ? Footing::kRagdoll : Footing::kHangs;
    if (!burden[body].driven) scratch.weights[body] = before / bodies.motion[body].inverse_mass;
  }
  for (int look = 0; look < kMostLooks; ++look) {
    if (!find_more_standing(scratch.weights, scratch.props, scratch)) break;
  }
}

/// What stands holds by its contacts, whatever its hooks are.
void let_stand(std::span<const Footing> footing, std::vector<Holding>& holding) {
  for (std::size_t body = 0; body < holding.size(); ++body) {
    if (footing[body] == Footing::kStands) holding[body] = Holding::kNone;
  }
}

}  // namespace

void find_borne_contacts(const ContactStep& step, Real impulse_to_force, const Joints& joints,
                         std::span<const std::uint8_t> hooked, const Holders& holders, const Bodies& bodies,
                         const std::vector<Hook>& hooks, state::Pairs& pairs, BorneScratch& scratch) {
  scratch.footing.assign(bodies.motion.size(), Footing::kStands);
  scratch.refused = 0;
  if (hooks.empty() && pairs.borne.empty()) return;
  // Where none was borne no flag is set.
  if (!pairs.borne.empty()) {
    for (Manifold& m : pairs.manifold) m.borne = false;
  }
  scratch.borne_before.clear();
  for (const BorneContact& contact : pairs.borne)
    scratch.borne_before.emplace_back(contact.body_a, contact.body_b);
  base::sort_unique(scratch.borne_before);
  scratch.bore.clear();
  for (const BorneContact& contact : pairs.borne) {
    scratch.bore.push_back(contact.body_a);
    scratch.bore.push_back(contact.body_b);
  }
  base::sort_unique(scratch.bore);
  pairs.borne.clear();
  scratch.holders = holders;
  find_footing(step, hooked, joints, holders.burden, bodies, pairs, scratch);
  let_stand(scratch.footing, scratch.holders.holding);
  const Candidates candidates = {.gravity = length(step.gravity),
                                 .down = normalize(step.gravity),
                                 .impulse_to_force = impulse_to_force,
                                 .bodies = bodies,
                                 .hooked = hooked,
                                 .by_hooks = holders.holding,
                                 .by_burden = holders.burden,
                                 .holders = scratch.holders,
                                 .footing = scratch.footing,
                                 .carried = scratch.carried,
                                 .borne_before = scratch.borne_before,
                                 .in_ragdoll = joints.in_ragdoll};
  const std::size_t chosen = choose(candidates, pairs, scratch.holders.holding, scratch.refused);
  if (chosen > 0) add_loads(joints, bodies, pairs, scratch.load, scratch.holders.burden);
  choose_pressed(candidates, chosen, pairs, scratch.refused);
  for (std::uint32_t row = 0; row < pairs.pair.size(); ++row) {
    const std::uint32_t manifold = pairs.pair[row].first_manifold;
    if (pairs.pair[row].manifold_count != 1 || !pairs.manifold[manifold].borne) continue;
    const Manifold& m = pairs.manifold[manifold];
    const Real load = lifted_mass(m, bodies, scratch.holders.burden);
    for (std::int32_t k = 0; k < Manifold::kMaxPoints; ++k)
      pairs.borne.push_back({.pair = row,
                             .manifold = manifold,
                             .point = k,
                             .body_a = m.body_a,
                             .body_b = m.body_b,
                             .load = load});
  }
  place_borne_contacts(impulse_to_force, bodies, pairs);
}

void place_borne_contacts(Real impulse_to_force, const Bodies& bodies, state::Pairs& pairs) {
  for (BorneContact& contact : pairs.borne) {
    const Manifold& m = pairs.manifold[contact.manifold];
    contact.separation = std::numeric_limits<Real>::infinity();
    contact.normal_force = Real(0);
    contact.friction_force = {};
    if (contact.point >= m.point_count) continue;
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(contact.point)];
    contact.separation = p.separation - dot(m.normal, way_between(bodies, m, p));
    contact.normal_force = impulse_to_force * p.normal_impulse;
    const Real load = normal_impulse(m);
    if (load > Real(0))
      contact.friction_force = (impulse_to_force * p.normal_impulse / load) * m.friction_impulse;
  }
}

void store_borne_contacts(Real h, state::Pairs& pairs) {
  for (const BorneContact& contact : pairs.borne) {
    Manifold& m = pairs.manifold[contact.manifold];
    if (contact.point == 0) {
      m.friction_impulse = m.rolling_impulse = {};
      m.twist_impulse = m.largest_impulse = Real(0);
    }
    if (contact.point < m.point_count)
      m.point[static_cast<std::size_t>(contact.point)].normal_impulse = h * contact.normal_force;
    m.friction_impulse += h * contact.friction_force;
    m.largest_impulse = std::max(m.largest_impulse, h * contact.largest_force);
    m.touching = m.largest_impulse > Real(0);
  }
}

}  // namespace hooke::solver
