#include "solver/borne_contacts.h"

#include "base/sort_unique.h"
#include "solver/contact_colors.h"
#include "state/body_frames.h"

#include <algorithm>
#include <limits>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::BorneContact;
using state::Hook;
using state::Manifold;

/// What the choice is made from.
struct Candidates {
  Real gravity;           ///< [m/s^2]
  Real impulse_to_force;  ///< [1/s]
  const Bodies& bodies;
  std::span<const std::uint8_t> hooked;
  const Holders& holders;
  std::span<const std::pair<std::uint32_t, std::uint32_t>> borne_before;  ///< Bodies, ascending.
  std::span<const std::uint8_t> in_ragdoll;  ///< Of like masses: what presses there may err.

  [[nodiscard]] bool may_be_borne(const Manifold& m) const {
    return !m.borne && m.point_count > 0 && has_contact_rows(m, bodies);
  }

  [[nodiscard]] bool bears_on(std::uint32_t upper, std::uint32_t lower, const Manifold& m) const {
    const std::vector<Holding>& holding = holders.holding;
    const bool of_net = hooked[upper] != 0 && holding[upper] == Holding::kNone;
    if (of_net || holding[lower] == Holding::kNone || holding[upper] == Holding::kHangs) return false;
    // Of two that are hooked and hang on nothing, ragdolls in a heap, neither holds the other.
    if (hooked[upper] != 0 && holding[lower] == Holding::kHooked) return false;
    const Real w_upper = bodies.motion[upper].inverse_mass;
    const Real w_lower = bodies.motion[lower].inverse_mass;
    // Rows of one body that are exact leave nothing to the others.
    if (holding[upper] == Holding::kBorne || w_lower >= kBorneMass * w_upper) return true;
    if (holding[lower] == Holding::kHooked) return false;
    return w_lower * load_on(m) > (was_borne(m) ? Real(0) : kBorneLoad * gravity);
  }

  /// Whether it is pressed against what no force moves.
  [[nodiscard]] bool is_pressed(std::uint32_t body, const Manifold& m) const {
    if (holders.holding[body] == Holding::kNone || in_ragdoll[body] != 0) return false;
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

  [[nodiscard]] bool was_borne(const Manifold& m) const {
    return std::binary_search(borne_before.begin(), borne_before.end(), std::pair(m.body_a, m.body_b));
  }
};

/// The only manifold of a pair; null if there are none or more.
Manifold* only_manifold(const state::Pair& pair, std::vector<Manifold>& manifolds) {
  return pair.manifold_count == 1 ? &manifolds[pair.first_manifold] : nullptr;
}

/// Marks manifolds, from what hangs upwards: what lies on it holds others. Returns how many.
std::size_t choose(const Candidates& candidates, state::Pairs& pairs, std::vector<Holding>& holding) {
  constexpr int kMostLayers = 4;
  std::size_t chosen = 0;
  bool more = true;
  for (int layer = 0; more && layer < kMostLayers; ++layer) {
    more = false;
    for (const state::Pair& pair : pairs.pair) {
      Manifold* m = only_manifold(pair, pairs.manifold);
      if (m == nullptr) continue;
      if (holding[m->body_a] == Holding::kNone && holding[m->body_b] == Holding::kNone) continue;
      if (!is_moved(candidates.bodies, m->body_a) || !is_moved(candidates.bodies, m->body_b)) continue;
      if (m->restitution > Real(0) || !candidates.may_be_borne(*m)) continue;
      const bool a_is_upper = candidates.bears_on(m->body_a, m->body_b, *m);
      if (!a_is_upper && !candidates.bears_on(m->body_b, m->body_a, *m)) continue;
      if (chosen == kMostBorneManifolds) return chosen;
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

/// Marks manifolds of what is pressed on the ground, `chosen` being chosen already.
void choose_pressed(const Candidates& candidates, std::size_t chosen, state::Pairs& pairs) {
  const Bodies& bodies = candidates.bodies;
  for (const state::Pair& pair : pairs.pair) {
    Manifold* m = only_manifold(pair, pairs.manifold);
    if (m == nullptr || is_moved(bodies, m->body_a) == is_moved(bodies, m->body_b)) continue;
    const std::uint32_t body = is_moved(bodies, m->body_a) ? m->body_a : m->body_b;
    const bool may_bounce = m->restitution > Real(0) && !m->touching;
    if (may_bounce || !candidates.is_pressed(body, *m) || !candidates.may_be_borne(*m)) continue;
    if (chosen == kMostBorneManifolds) return;
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

void find_borne_contacts(const ContactStep& step, Real impulse_to_force, const Joints& joints,
                         std::span<const std::uint8_t> hooked, const Holders& holders, const Bodies& bodies,
                         const std::vector<Hook>& hooks, state::Pairs& pairs, BorneScratch& scratch) {
  if (hooks.empty() && pairs.borne.empty()) return;
  // Where none was borne no flag is set.
  if (!pairs.borne.empty()) {
    for (Manifold& m : pairs.manifold) m.borne = false;
  }
  scratch.borne_before.clear();
  for (const BorneContact& contact : pairs.borne)
    scratch.borne_before.emplace_back(contact.body_a, contact.body_b);
  base::sort_unique(scratch.borne_before);
  pairs.borne.clear();
  scratch.holders = holders;
  const Candidates candidates = {length(step.gravity), impulse_to_force,     bodies,           hooked,
                                 scratch.holders,      scratch.borne_before, joints.in_ragdoll};
  const std::size_t chosen = choose(candidates, pairs, scratch.holders.holding);
  if (chosen > 0) add_loads(joints, bodies, pairs, scratch.load, scratch.holders.burden);
  choose_pressed(candidates, chosen, pairs);
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
    Real load = Real(0);
    for (std::int32_t k = 0; k < m.point_count; ++k)
      load += m.point[static_cast<std::size_t>(k)].normal_impulse;
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
