#include "solver/borne_contacts.h"

#include "solver/contact_colors.h"

#include <algorithm>
#include <limits>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::BorneContact;
using state::Hook;
using state::Manifold;

/// Bodies that hang: on points, or by an articulation. Those of nets do not count.
void find_hanging(const Joints& joints, const Bodies& bodies, const std::vector<Hook>& hooks,
                  std::vector<std::uint8_t>& holds) {
  holds.assign(bodies.motion.size(), 0);
  const auto hang = [&](std::uint32_t body) {
    if (state::gives_way(bodies, body)) holds[body] = 1;
  };
  for (const Hook& hook : hooks) {
    if (!hook.holds_point()) continue;
    hang(hook.a.body);
    hang(hook.b.body);
  }
  for (const std::uint32_t i : joints.order)
    std::for_each(joints.articulations[i].bodies.begin(), joints.articulations[i].bodies.end(), hang);
  for (const std::uint32_t row : joints.net.hooks) {
    for (const std::uint32_t body : {hooks[row].a.body, hooks[row].b.body}) {
      if (is_dynamic(bodies, body)) holds[body] = 0;
    }
  }
}

/// What the choice is made from.
struct Candidates {
  Real gravity;           ///< [m/s^2]
  Real impulse_to_force;  ///< [1/s]
  const Bodies& bodies;
  std::span<const std::uint8_t> hooked;
  const std::vector<std::uint8_t>& holds;

  [[nodiscard]] bool may_be_borne(const Manifold& m) const {
    return !m.borne && m.point_count > 0 && !(m.restitution > Real(0)) && has_contact_rows(m, bodies) &&
           is_moved(bodies, m.body_a) && is_moved(bodies, m.body_b);
  }

  [[nodiscard]] bool bears_on(std::uint32_t upper, std::uint32_t lower, const Manifold& m) const {
    if (holds[lower] == 0 || hooked[upper] != 0) return false;
    const Real w_upper = bodies.motion[upper].inverse_mass;
    const Real w_lower = bodies.motion[lower].inverse_mass;
    // Rows of one body that are exact leave nothing to the others.
    if (holds[upper] != 0 || w_lower >= kBorneMass * w_upper) return true;
    Real load = Real(0);
    for (int k = 0; k < m.point_count; ++k) load += impulse_to_force * m.point[k].normal_impulse;
    return std::max(w_lower, w_upper) * load > kBorneLoad * gravity;
  }
};

/// Marks manifolds, from what hangs upwards: what lies on it holds others.
void choose(const Candidates& candidates, state::Pairs& pairs, std::vector<std::uint8_t>& holds) {
  constexpr int kMostLayers = 4;
  std::size_t chosen = 0;
  bool more = true;
  for (int layer = 0; more && layer < kMostLayers; ++layer) {
    more = false;
    for (const state::Pair& pair : pairs.pair) {
      if (pair.manifold_count != 1) continue;
      Manifold& m = pairs.manifold[pair.first_manifold];
      if ((holds[m.body_a] == 0 && holds[m.body_b] == 0) || !candidates.may_be_borne(m)) continue;
      if (!candidates.bears_on(m.body_a, m.body_b, m) && !candidates.bears_on(m.body_b, m.body_a, m))
        continue;
      if (++chosen > kMostBorneManifolds) return;
      m.borne = more = true;
      holds[m.body_a] = holds[m.body_b] = 1;
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

void find_borne_contacts(const ContactStep& step, Real impulse_to_force, const Joints& joints,
                         std::span<const std::uint8_t> hooked, const Bodies& bodies, std::vector<Hook>& hooks,
                         state::Pairs& pairs, BorneScratch& scratch) {
  if (hooks.empty() && pairs.borne.empty()) return;
  pairs.borne.clear();
  for (Manifold& m : pairs.manifold) m.borne = false;
  for (Hook& hook : hooks) hook.bears = false;
  find_hanging(joints, bodies, hooks, scratch.holds);
  choose({length(step.gravity), impulse_to_force, bodies, hooked, scratch.holds}, pairs, scratch.holds);
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
