#include "solver/borne_contacts.h"

#include "base/sort_unique.h"
#include "solver/contact_colors.h"

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
  const std::vector<Holding>& holding;
  std::span<const std::pair<std::uint32_t, std::uint32_t>> borne_before;  ///< Bodies, ascending.

  [[nodiscard]] bool may_be_borne(const Manifold& m) const {
    return !m.borne && m.point_count > 0 && !(m.restitution > Real(0)) && has_contact_rows(m, bodies) &&
           is_moved(bodies, m.body_a) && is_moved(bodies, m.body_b);
  }

  [[nodiscard]] bool bears_on(std::uint32_t upper, std::uint32_t lower, const Manifold& m) const {
    const bool of_net = hooked[upper] != 0 && holding[upper] == Holding::kNone;
    if (of_net || holding[lower] == Holding::kNone || holding[upper] == Holding::kHangs) return false;
    // Of two that are hooked and hang on nothing, ragdolls in a heap, neither holds the other.
    if (hooked[upper] != 0 && holding[lower] == Holding::kHooked) return false;
    const Real w_upper = bodies.motion[upper].inverse_mass;
    const Real w_lower = bodies.motion[lower].inverse_mass;
    // Rows of one body that are exact leave nothing to the others.
    if (holding[upper] == Holding::kBorne || w_lower >= kBorneMass * w_upper) return true;
    if (holding[lower] == Holding::kHooked) return false;
    Real load = Real(0);
    for (int k = 0; k < m.point_count; ++k) load += impulse_to_force * m.point[k].normal_impulse;
    const bool was_borne =
        std::binary_search(borne_before.begin(), borne_before.end(), std::pair(m.body_a, m.body_b));
    return w_lower * load > (was_borne ? Real(0) : kBorneLoad * gravity);
  }
};

/// Marks manifolds, from what hangs upwards: what lies on it holds others.
void choose(const Candidates& candidates, state::Pairs& pairs, std::vector<Holding>& holding) {
  constexpr int kMostLayers = 4;
  std::size_t chosen = 0;
  bool more = true;
  for (int layer = 0; more && layer < kMostLayers; ++layer) {
    more = false;
    for (const state::Pair& pair : pairs.pair) {
      if (pair.manifold_count != 1) continue;
      Manifold& m = pairs.manifold[pair.first_manifold];
      if (holding[m.body_a] == Holding::kNone && holding[m.body_b] == Holding::kNone) continue;
      if (!candidates.may_be_borne(m)) continue;
      const bool a_is_upper = candidates.bears_on(m.body_a, m.body_b, m);
      if (!a_is_upper && !candidates.bears_on(m.body_b, m.body_a, m)) continue;
      if (++chosen > kMostBorneManifolds) return;
      m.borne = more = true;
      holding[a_is_upper ? m.body_a : m.body_b] = Holding::kBorne;
    }
  }
}

/// The hooks of articulations that a body of `bears` is part of.
void mark_hooks(const Joints& joints, const std::vector<std::uint8_t>& bears, std::vector<Hook>& hooks) {
  for (const std::uint32_t i : joints.order) {
    const Articulation& art = joints.articulations[i];
    const bool any = std::any_of(art.bodies.begin(), art.bodies.end(),
                                 [&](std::uint32_t body) { return body < bears.size() && bears[body] != 0; });
    if (!any) continue;
    for (const Articulation::Joint& joint : art.joints) {
      if (!joint.is_weld()) hooks[joint.hook].bears = true;
    }
  }
}

}  // namespace

void find_holding(const Joints& joints, const Bodies& bodies, const std::vector<Hook>& hooks,
                  std::vector<Holding>& holding) {
  holding.assign(bodies.motion.size(), Holding::kNone);
  const auto raise = [&](std::uint32_t body, Holding to) {
    if (is_dynamic(bodies, body)) holding[body] = std::max(holding[body], to);
  };
  for (const Hook& hook : hooks) {
    if (!hook.holds_point()) continue;
    raise(hook.a.body, Holding::kHangs);
    raise(hook.b.body, Holding::kHangs);
  }
  for (const std::uint32_t i : joints.order) {
    const std::vector<std::uint32_t>& members = joints.articulations[i].bodies;
    const bool hangs = std::any_of(members.begin(), members.end(), [&](std::uint32_t body) {
      return !is_dynamic(bodies, body) || holding[body] == Holding::kHangs;
    });
    for (const std::uint32_t body : members) raise(body, hangs ? Holding::kHangs : Holding::kHooked);
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
                         std::span<const std::uint8_t> hooked, std::span<const Holding> holding,
                         const Bodies& bodies, std::vector<Hook>& hooks, state::Pairs& pairs,
                         BorneScratch& scratch) {
  if (hooks.empty() && pairs.borne.empty()) return;
  // Where none was borne no flag is set.
  if (!pairs.borne.empty()) {
    for (Manifold& m : pairs.manifold) m.borne = false;
    for (Hook& hook : hooks) hook.bears = false;
  }
  scratch.borne_before.clear();
  for (const BorneContact& contact : pairs.borne)
    scratch.borne_before.emplace_back(contact.body_a, contact.body_b);
  base::sort_unique(scratch.borne_before);
  pairs.borne.clear();
  scratch.holding.assign(holding.begin(), holding.end());
  choose({length(step.gravity), impulse_to_force, bodies, hooked, scratch.holding, scratch.borne_before},
         pairs, scratch.holding);
  scratch.bears.assign(bodies.motion.size(), 0);
  for (std::uint32_t row = 0; row < pairs.pair.size(); ++row) {
    const std::uint32_t manifold = pairs.pair[row].first_manifold;
    if (pairs.pair[row].manifold_count != 1 || !pairs.manifold[manifold].borne) continue;
    const Manifold& m = pairs.manifold[manifold];
    for (std::int32_t k = 0; k < Manifold::kMaxPoints; ++k)
      pairs.borne.push_back(
          {.pair = row, .manifold = manifold, .point = k, .body_a = m.body_a, .body_b = m.body_b});
    scratch.bears[m.body_a] = scratch.bears[m.body_b] = 1;
  }
  if (pairs.borne.empty()) return;
  place_borne_contacts(impulse_to_force, bodies, pairs);
  mark_hooks(joints, scratch.bears, hooks);
}

void place_borne_contacts(Real impulse_to_force, const Bodies& bodies, state::Pairs& pairs) {
  const auto moved = [&](std::uint32_t body, Vec3 lever) {
    const state::MotionLine& line = bodies.motion[body];
    return line.dx + cross(bodies.scale[body] * line.theta_scaled, lever);
  };
  for (BorneContact& contact : pairs.borne) {
    const Manifold& m = pairs.manifold[contact.manifold];
    contact.separation = std::numeric_limits<Real>::infinity();
    contact.normal_force = Real(0);
    contact.friction_force = {};
    if (contact.point >= m.point_count) continue;
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(contact.point)];
    contact.separation =
        p.separation - dot(m.normal, moved(m.body_b, p.anchor_b) - moved(m.body_a, p.anchor_a));
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
