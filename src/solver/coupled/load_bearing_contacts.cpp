#include "solver/coupled/load_bearing_contacts.h"

#include "base/assert.h"
#include "base/sort_unique.h"
#include "solver/contact/contact_colors.h"
#include "solver/coupled/coupled_tuning.h"
#include "state/body_frames.h"

#include <algorithm>
#include <limits>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::CoupledManifold;
using state::Hook;
using state::Manifold;
using state::normal_impulse;

constexpr Real kNeverStands = Real(-1);  ///< Weight of a body that is not tested.

bool is_touching(const Manifold& m) {
  for (std::int32_t k = 0; k < m.point_count; ++k) {
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
    if (p.normal_impulse > Real(0) || p.separation <= kLoadTouchingGap) return true;
  }
  return false;
}

/// Lists which body lies on which.
void find_props(const state::Pairs& pairs, const Bodies& bodies, Vec3 down, std::vector<Prop>& props) {
  props.clear();
  for (const Manifold& m : pairs.manifold) {
    const Real slope = dot(m.normal, down);  // positive where a lies on b
    if (std::abs(slope) < kLiesOnCosine || !is_touching(m)) continue;
    const bool a_is_upper = slope > Real(0);
    props.push_back(
        {.upper = a_is_upper ? m.body_a : m.body_b,
         .lower = a_is_upper ? m.body_b : m.body_a,
         .impulse = normal_impulse(m) * std::abs(slope),
         .deep = state::deepest_overlap(m) > kDeepShare * state::thinner_radius(bodies, m.body_a, m.body_b)});
  }
}

/// What the choice of contacts depends on.
struct Candidates {
  Real gravity;           ///< [m/s^2]
  Vec3 down;              ///< Unit; zero without gravity.
  Real impulse_to_force;  ///< [1/s]
  const Bodies& bodies;
  std::span<const std::uint8_t> hooked;
  const std::vector<SupportRole>& by_hooks;       ///< Roles by hooks alone, of all bodies.
  const std::vector<GroundLoad>& by_ground_load;  ///< Loads by hooks alone.
  /// The same without bodies that stand, and with what lies on the others.
  const Supports& supports;
  std::span<const Footing> footing;
  std::span<const CarriedLoad> carried;
  /// Pairs of bodies, ascending.
  std::span<const std::pair<std::uint32_t, std::uint32_t>> load_bearing_before;
  /// Ragdolls have like masses: contacts that press there may err.
  std::span<const std::uint8_t> in_ragdoll;

  [[nodiscard]] bool may_bear_load(const Manifold& m) const {
    return !m.is_coupled() && m.point_count > 0 && has_contact_rows(m, bodies);
  }

  [[nodiscard]] bool loads(std::uint32_t upper, std::uint32_t lower, const Manifold& m) const {
    const std::vector<SupportRole>& support_role = supports.support_role;
    const bool of_iterative = hooked[upper] != 0 && by_hooks[upper] == SupportRole::kNone;
    if (of_iterative || support_role[lower] == SupportRole::kNone ||
        support_role[upper] == SupportRole::kHangs)
      return false;
    // Of two hooked bodies that hang on nothing, as ragdolls in a heap, neither holds the other.
    if (hooked[upper] != 0 && support_role[lower] == SupportRole::kHooked) return false;
    const Real w_upper = bodies.motion[upper].inverse_mass;
    const Real w_lower = bodies.motion[lower].inverse_mass;
    // A body that stands beside, as a lamp beside a tower, does not rest on it; but a jaw may be driven
    // against it.
    const bool stands = footing[upper] == Footing::kStands && carried[upper].on_something;
    if (stands && !lies_on(upper, m) && !by_ground_load[lower].driven) return false;
    // Rows of one body that are exact leave nothing to the others.
    if (support_role[upper] == SupportRole::kSupported || w_lower >= kLoadBearingMassRatio * w_upper)
      return true;
    if (support_role[lower] == SupportRole::kHooked) return sinks(m);
    return w_lower * load_on(m) > (was_load_bearing(m) ? Real(0) : kLoadBearingLoadRatio * gravity);
  }

  /// Whether the body is pressed against what no force moves.
  [[nodiscard]] bool is_pressed(std::uint32_t body, const Manifold& m) const {
    if (by_hooks[body] == SupportRole::kNone || in_ragdoll[body] != 0) return false;
    const GroundLoad& ground_load = supports.ground_load[body];
    const Real w = bodies.motion[body].inverse_mass;
    if (w * ground_load.neighbor >= kPressedMass) return true;
    if (!(w * ground_load.group >= kPressedGroup)) return false;
    return w * load_on(m) > (was_load_bearing(m) ? kPressedAgainShare : Real(1)) * kPressedLoad * gravity;
  }

  /// Whether soft rows do not hold the contact: it is far inside, or has been coupled for that and still
  /// pushes.
  [[nodiscard]] bool sinks(const Manifold& m) const {
    if (in_ragdoll[m.body_a] != 0 || in_ragdoll[m.body_b] != 0) return false;
    if (was_load_bearing(m)) return load_on(m) > Real(0);
    const Real size = Real(2) * state::thinner_radius(bodies, m.body_a, m.body_b);
    return state::deepest_overlap(m) > kSunkShare * size;
  }

  /// Load on the upper body in the last step [N].
  [[nodiscard]] Real load_on(const Manifold& m) const {
    Real load = Real(0);
    for (int k = 0; k < m.point_count; ++k) load += impulse_to_force * m.point[k].normal_impulse;
    return load;
  }

  /// Whether `upper` presses on the other body by its weight; false if it leans on its side.
  [[nodiscard]] bool lies_on(std::uint32_t upper, const Manifold& m) const {
    const Real up = dot(m.normal, down) * (upper == m.body_a ? Real(1) : Real(-1));
    return up > kLiesOnCosine;
  }

  [[nodiscard]] bool was_load_bearing(const Manifold& m) const {
    return std::binary_search(load_bearing_before.begin(), load_bearing_before.end(),
                              std::pair(m.body_a, m.body_b));
  }
};

/// Marks manifolds upwards from what hangs, since what lies on it holds others in turn. Returns how many.
std::size_t choose(const Candidates& candidates, state::Pairs& pairs, std::vector<SupportRole>& support_role,
                   std::vector<std::uint32_t>& refused) {
  std::size_t chosen = 0;
  bool more = true;
  for (int layer = 0; more && layer < kMostLoadLayers; ++layer) {
    more = false;
    refused.clear();
    for (std::uint32_t row = 0; row < pairs.manifold.size(); ++row) {
      Manifold& m = pairs.manifold[row];
      if (support_role[m.body_a] == SupportRole::kNone && support_role[m.body_b] == SupportRole::kNone)
        continue;
      if (!is_moved(candidates.bodies, m.body_a) || !is_moved(candidates.bodies, m.body_b)) continue;
      if (!candidates.may_bear_load(m)) continue;
      const bool a_is_upper = candidates.loads(m.body_a, m.body_b, m);
      if (!a_is_upper && !candidates.loads(m.body_b, m.body_a, m)) continue;
      if (chosen == kMostLoadBearingManifolds) {
        refused.push_back(row);
        continue;
      }
      ++chosen;
      m.route = state::ContactRoute::kCoupled;
      more = true;
      support_role[a_is_upper ? m.body_a : m.body_b] = SupportRole::kSupported;
    }
  }
  return chosen;
}

/// What lies on one member of an articulation may press each of the members on the ground.
void add_loads(const Joints& joints, const Bodies& bodies, const state::Pairs& pairs, std::vector<Real>& load,
               std::vector<GroundLoad>& ground_load) {
  load.assign(bodies.motion.size(), Real(0));
  const auto add = [&](std::uint32_t body, std::uint32_t other) {
    HOOKE_ASSERT(bodies.motion[other].inverse_mass > Real(0));  // both of a contact that was chosen
    load[body] = std::max(load[body], Real(1) / bodies.motion[other].inverse_mass);
  };
  for (const Manifold& m : pairs.manifold) {
    if (!m.is_coupled()) continue;
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
      ground_load[body].neighbor = std::max(ground_load[body].neighbor, heaviest);
      ground_load[body].group += heaviest;
    }
  }
}

/// The body that may be pressed on the other one, the ground. It is the one that moves if the other does not,
/// or a hooked body that lies on an unhooked one that stands. Null if there is none.
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

/// Marks manifolds of bodies that are pressed on the ground; `chosen` have been marked before.
void choose_pressed(const Candidates& candidates, std::size_t chosen, state::Pairs& pairs,
                    std::vector<std::uint32_t>& refused) {
  for (std::uint32_t row = 0; row < pairs.manifold.size(); ++row) {
    Manifold& m = pairs.manifold[row];
    const std::uint32_t* body = pressed_body(candidates, m);
    if (body == nullptr) continue;
    if (!candidates.is_pressed(*body, m) || !candidates.may_bear_load(m)) continue;
    if (chosen == kMostLoadBearingManifolds) {
      refused.push_back(row);
      continue;
    }
    ++chosen;
    m.route = state::ContactRoute::kCoupled;
  }
}

/// Whether the hook keeps its bodies at their distance in every direction in which they may be pressed
/// together.
bool keeps_distance(const Hook& hook) {
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

void note_neighbors(const Hook& hook, const Bodies& bodies, std::vector<GroundLoad>& ground_load) {
  const auto note = [&](std::uint32_t body, std::uint32_t other) {
    if (!is_dynamic(bodies, body) || !is_dynamic(bodies, other)) return;
    ground_load[body].neighbor =
        std::max(ground_load[body].neighbor, Real(1) / bodies.motion[other].inverse_mass);
  };
  note(hook.a.body, hook.b.body);
  note(hook.b.body, hook.a.body);
}

void raise_role(const Bodies& bodies, std::uint32_t body, SupportRole to,
                std::vector<SupportRole>& support_role) {
  if (is_dynamic(bodies, body)) support_role[body] = std::max(support_role[body], to);
}

/// Notes what one hook does to its bodies.
void note_hook(const Hook& hook, const Bodies& bodies, Supports& supports) {
  if (keeps_distance(hook)) note_neighbors(hook, bodies, supports.ground_load);
  const bool driven = is_driven(hook);
  for (const std::uint32_t body : {hook.a.body, hook.b.body}) {
    if (driven && is_dynamic(bodies, body)) supports.ground_load[body].driven = true;
    if (hook.holds_point()) raise_role(bodies, body, SupportRole::kHangs, supports.support_role);
  }
}

/// Notes what the members of an articulation hold: all of them hang if one does, or if something holds one.
void note_articulation(const std::vector<std::uint32_t>& members, const Bodies& bodies, Supports& supports) {
  Real mass = Real(0);
  bool hangs = false;
  for (const std::uint32_t body : members) {
    const bool moves = is_dynamic(bodies, body);
    if (moves) mass += Real(1) / bodies.motion[body].inverse_mass;
    hangs = hangs || !moves || supports.support_role[body] == SupportRole::kHangs;
  }
  for (const std::uint32_t body : members) {
    raise_role(bodies, body, hangs ? SupportRole::kHangs : SupportRole::kHooked, supports.support_role);
    if (is_dynamic(bodies, body)) supports.ground_load[body].group = mass;
  }
}

}  // namespace

void find_supporting_bodies(const Joints& joints, const Bodies& bodies, const std::vector<Hook>& hooks,
                            Supports& supports) {
  supports.support_role.assign(bodies.motion.size(), SupportRole::kNone);
  supports.ground_load.assign(bodies.motion.size(), {});
  for (const Hook& hook : hooks) note_hook(hook, bodies, supports);
  for (const std::uint32_t i : joints.order)
    note_articulation(joints.articulations[i].bodies, bodies, supports);
  for (const std::vector<std::uint32_t>* rows : {&joints.iterative.hooks, &joints.balls.hooks}) {
    for (const std::uint32_t row : *rows) {
      for (const std::uint32_t body : {hooks[row].a.body, hooks[row].b.body}) {
        if (is_dynamic(bodies, body)) supports.support_role[body] = SupportRole::kNone;
      }
    }
  }
}

namespace {

/// Whether contacts under a body bring `share` of its weight and of what lies on it. Where nothing is known
/// yet, it is enough that something which stands touches the body from below.
bool is_carried(const CarriedLoad& by, Real weight, Real share) {
  const bool known = by.from_below > Real(0) || by.from_above > Real(0);
  return known ? by.from_below >= share * (by.from_above + weight) : by.on_something;
}

/// One pass from below upwards: finds who stands on what stands. Returns whether it found more than before.
bool find_more_standing(const std::vector<Real>& weights, const std::vector<Prop>& props,
                        LoadBearingScratch& scratch) {
  std::vector<CarriedLoad>& carried = scratch.carried;
  std::fill(carried.begin(), carried.end(), CarriedLoad{});
  for (const Prop& prop : props) {
    carried[prop.lower].from_above += prop.impulse;
    if (scratch.footing[prop.lower] != Footing::kStands) continue;
    carried[prop.upper].from_below += prop.impulse;
    carried[prop.upper].on_something = true;
  }
  bool more = false;
  for (const Prop& prop : props) {
    if (scratch.footing[prop.upper] != Footing::kHangs || weights[prop.upper] == kNeverStands) continue;
    const bool bore_load = std::binary_search(scratch.bore_load.begin(), scratch.bore_load.end(), prop.upper);
    if (!is_carried(carried[prop.upper], weights[prop.upper],
                    bore_load ? kStandingShareAgain : kStandingShare))
      continue;
    scratch.footing[prop.upper] = Footing::kStands;
    more = true;
  }
  return more;
}

/// A body does not stand where something much heavier lies on it, since soft rows do not hold that. It does
/// if it lies on what moves, since a direct island can hold all of them. It also does if a hook holds it
/// inside the ground: coupled rows of the hook and of the ground would contradict each other.
void let_heavy_loads_hang(const Bodies& bodies, const std::vector<Prop>& props, std::vector<Real>& weights) {
  const auto stands_anyway = [&](std::uint32_t body) {
    return std::any_of(props.begin(), props.end(), [&](const Prop& prop) {
      return prop.upper == body && (prop.deep || is_moved(bodies, prop.lower));
    });
  };
  for (const Prop& prop : props) {
    const Real w_upper = bodies.motion[prop.upper].inverse_mass;
    const Real w_lower = bodies.motion[prop.lower].inverse_mass;
    if (weights[prop.lower] == kNeverStands || !(w_upper > Real(0)) ||
        w_lower < kLoadBearingMassRatio * w_upper)
      continue;
    if (!stands_anyway(prop.lower)) weights[prop.lower] = kNeverStands;
  }
}

/// A hooked body stands if contacts with standing bodies under it bring most of its weight and of what lies
/// on it, and no motor or spring moves it.
void find_footing(const LoadBearingInputs& inputs, const Bodies& bodies, const state::Pairs& pairs,
                  LoadBearingScratch& scratch) {
  const ContactStep& step = inputs.step;
  HOOKE_ASSERT(inputs.hooked.size() == bodies.motion.size());
  HOOKE_ASSERT(inputs.joints.in_ragdoll.size() == bodies.motion.size());
  find_props(pairs, bodies, normalize(step.gravity), scratch.props);
  scratch.carried.resize(bodies.motion.size());
  scratch.weights.assign(bodies.motion.size(), kNeverStands);
  const Real before = step.h / step.impulse_scale * length(step.gravity);
  for (std::uint32_t body = 0; body < inputs.hooked.size(); ++body) {
    if (inputs.hooked[body] == 0 || !is_moved(bodies, body)) continue;
    scratch.footing[body] = inputs.joints.in_ragdoll[body] != 0 ? Footing::kRagdoll : Footing::kHangs;
    if (inputs.supports.ground_load[body].driven) continue;
    scratch.weights[body] = before / bodies.motion[body].inverse_mass;
  }
  let_heavy_loads_hang(bodies, scratch.props, scratch.weights);
  for (int pass = 0; pass < kMostStandingPasses; ++pass) {
    if (!find_more_standing(scratch.weights, scratch.props, scratch)) break;
  }
}

/// A body that stands holds others by its contacts, whatever its hooks are.
void let_stand(std::span<const Footing> footing, std::vector<SupportRole>& support_role) {
  HOOKE_ASSERT(footing.size() == support_role.size());
  for (std::size_t body = 0; body < support_role.size(); ++body) {
    if (footing[body] == Footing::kStands) support_role[body] = SupportRole::kNone;
  }
}

/// Notes which contacts bore load in the last step, and forgets them.
void take_back_last_choice(state::Pairs& pairs, LoadBearingScratch& scratch) {
  // Where no contact bore load, no flag is set.
  if (!pairs.coupled.empty()) {
    for (Manifold& m : pairs.manifold) {
      if (m.is_coupled()) m.route = state::ContactRoute::kSoft;
    }
  }
  scratch.load_bearing_before.clear();
  scratch.bore_load.clear();
  for (const CoupledManifold& contact : pairs.coupled) {
    if (!contact.bears_load) continue;
    scratch.load_bearing_before.emplace_back(contact.body_a, contact.body_b);
    scratch.bore_load.push_back(contact.body_a);
    scratch.bore_load.push_back(contact.body_b);
  }
  base::sort_unique(scratch.load_bearing_before);
  base::sort_unique(scratch.bore_load);
  pairs.coupled.clear();
}

/// Contacts that no longer bear load start without impulses. Those of a blow that a coupled group took would
/// push light bodies away, since soft rows need many passes to take them back.
void forget_impulses(std::span<const std::pair<std::uint32_t, std::uint32_t>> before, state::Pairs& pairs) {
  if (before.empty()) return;
  for (Manifold& m : pairs.manifold) {
    if (m.is_coupled() || !std::binary_search(before.begin(), before.end(), std::pair(m.body_a, m.body_b)))
      continue;
    for (state::ContactPoint& p : m.point) p.normal_impulse = Real(0);
    m.friction_impulse = {};
    m.twist_impulse = Real(0);
    m.rolling_impulse = {};
  }
}

/// Lists the manifolds that were chosen. What is light turns far within a step, and a plank would dig a
/// corner into its load that was no contact at the start: these contacts are found again in each substep.
void list_chosen(state::Pairs& pairs) {
  for (state::Pair& pair : pairs.pair) {
    const auto manifolds = std::span(pairs.manifold).subspan(pair.first_manifold, pair.manifold_count);
    if (std::none_of(manifolds.begin(), manifolds.end(), [](const Manifold& m) { return m.is_coupled(); }))
      continue;
    pair.refresh = state::ContactRefresh::kEachSubstep;
    for (Manifold& m : manifolds) {
      m.refresh = pair.refresh;
      if (!m.is_coupled()) continue;
      const auto row = static_cast<std::uint32_t>(&m - pairs.manifold.data());
      pairs.coupled.push_back({.manifold = row, .body_a = m.body_a, .body_b = m.body_b, .bears_load = true});
    }
  }
}

}  // namespace

void find_load_bearing_contacts(const LoadBearingInputs& inputs, const Bodies& bodies,
                                const std::vector<Hook>& hooks, state::Pairs& pairs,
                                LoadBearingScratch& scratch) {
  scratch.footing.assign(bodies.motion.size(), Footing::kStands);
  scratch.refused_manifolds.clear();
  if (hooks.empty() && pairs.coupled.empty()) return;
  take_back_last_choice(pairs, scratch);
  scratch.supports = inputs.supports;
  find_footing(inputs, bodies, pairs, scratch);
  let_stand(scratch.footing, scratch.supports.support_role);
  const Candidates candidates = {.gravity = length(inputs.step.gravity),
                                 .down = normalize(inputs.step.gravity),
                                 .impulse_to_force = inputs.impulse_to_force,
                                 .bodies = bodies,
                                 .hooked = inputs.hooked,
                                 .by_hooks = inputs.supports.support_role,
                                 .by_ground_load = inputs.supports.ground_load,
                                 .supports = scratch.supports,
                                 .footing = scratch.footing,
                                 .carried = scratch.carried,
                                 .load_bearing_before = scratch.load_bearing_before,
                                 .in_ragdoll = inputs.joints.in_ragdoll};
  const std::size_t chosen =
      choose(candidates, pairs, scratch.supports.support_role, scratch.refused_manifolds);
  if (chosen > 0) add_loads(inputs.joints, bodies, pairs, scratch.load, scratch.supports.ground_load);
  choose_pressed(candidates, chosen, pairs, scratch.refused_manifolds);
  base::sort_unique(scratch.refused_manifolds);  // One that is loaded may be pressed, too.
  forget_impulses(scratch.load_bearing_before, pairs);
  list_chosen(pairs);
}

}  // namespace hooke::solver
