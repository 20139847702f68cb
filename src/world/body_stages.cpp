#include "world/body_stages.h"

#include "base/assert.h"
#include "collision/continuous/shape_bounds.h"
#include "solver/air/force_fields.h"
#include "solver/body/body_motion.h"
#include "solver/check_routes.h"
#include "solver/contact/dense_pile_limit.h"
#include "solver/coupled/coupled_manifolds.h"
#include "solver/routes.h"
#include "state/body_frames.h"
#include "state/check_contacts.h"
#include "state/sleeping_pairs.h"
#include "world/events.h"
#include "world/force_stages.h"
#include "world/hook_stages.h"
#include "world/impact_clamp.h"
#include "world/sleep.h"

#include <algorithm>
#include <cmath>

namespace hooke::world {

namespace {

using state::BodyTraits;
using state::Tables;

bool moves(const BodyTraits& traits) {
  return traits.kind != BodyKind::kStatic;
}

/// Whether two bodies may push each other or one is a sensor that may see the other. A sensor never sees
/// another sensor. A dynamic sensor sees static bodies too; any other sensor sees only bodies that are not
/// static.
bool may_meet(const BodyTraits& a, const BodyTraits& b) {
  if (a.sensor && b.sensor) return false;
  if (a.kind == BodyKind::kDynamic || b.kind == BodyKind::kDynamic) return true;
  return (a.sensor && moves(b)) || (b.sensor && moves(a));
}

/// Sets the box of a collider. Bodies with the same negative filter group never collide, so they are a
/// collision group.
void set_box(WorldData& world, std::uint32_t body, std::uint32_t collider, const geometry::Box& box) {
  const BodyTraits& traits = world.tables.bodies.traits[body];
  world.derived.broad_phase.set(collider, box, moves(traits), std::min(traits.filter.group, 0));
}

/// Updates the boxes that the colliders of a body can reach in this step.
void update_bounds(Tables& t, std::uint32_t body, Real dt) {
  for (const std::uint32_t c : colliders_of(t.bodies, body))
    t.colliders.bounds[c] = collision::reach_of(t.bodies, t.colliders, c, dt);
}

template <class Visit>
void for_all_bodies(const state::Bodies& bodies, Visit&& visit) {
  for (std::uint32_t body = 0; body < bodies.traits.size(); ++body) {
    if (bodies.traits[body].alive) visit(body);
  }
}

/// Lists the bodies that may have moved since the pairs of the last step were found.
void list_moved_set(WorldData& world) {
  const Tables& t = world.tables;
  world.frame.moved_set = world.frame.awake;
  world.frame.moved_set.insert(world.frame.moved_set.end(), world.derived.placed_bodies.begin(),
                               world.derived.placed_bodies.end());
  world.frame.in_moved_set.clear();
  if (!any_sleeps(world)) return;
  world.frame.in_moved_set.assign(t.colliders.body.size(), 0);
  for (const std::uint32_t body : world.frame.moved_set)
    for (const std::uint32_t c : colliders_of(t.bodies, body)) world.frame.in_moved_set[c] = 1;
}

/// Enters the boxes of bodies that were added or placed by hand since the last step.
void refresh_broad_phase(WorldData& world, Real dt) {
  Tables& t = world.tables;
  if (world.derived.broad_phase_stale) {
    world.derived.broad_phase.clear();
    world.derived.placed_bodies.clear();
    for_all_bodies(t.bodies, [&](std::uint32_t body) { world.derived.placed_bodies.push_back(body); });
    world.derived.broad_phase_stale = false;
  }
  for (const std::uint32_t body : world.derived.placed_bodies) {
    if (!t.bodies.traits[body].alive) continue;
    update_bounds(t, body, dt);
    enter_broad_phase(world, body);
  }
  list_moved_set(world);
  world.derived.placed_bodies.clear();
}

/// Whether a pair is among the sleeping pairs. The broad phase finds such pairs again, for example those of a
/// kinematic body that is awake but stands still.
bool is_sleeping(const Tables& t, collision::ColliderPair pair) {
  if (t.pairs.sleeping.pair.empty()) return false;
  const auto stands = [&](std::uint32_t collider) {
    return state::stands(t.bodies, t.colliders.body[collider]);
  };
  if (!stands(pair.first) || !stands(pair.second)) return false;
  return std::binary_search(t.pairs.sleeping.pair.begin(), t.pairs.sleeping.pair.end(),
                            state::Pair{.collider_a = pair.first, .collider_b = pair.second},
                            state::comes_before);
}

void list_awake_bodies(WorldData& world) {
  const state::Bodies& bodies = world.tables.bodies;
  world.frame.awake.clear();
  for (const std::uint32_t body : world.tables.moving_bodies) {
    if (bodies.asleep[body] == 0) world.frame.awake.push_back(body);
  }
}

void limit_dense_piles(WorldData& world) {
  const std::span<const std::uint32_t> begins = world.frame.dense_piles.begins();
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    HOOKE_ASSERT(begins[i] < begins[i + 1] && begins[i + 1] <= world.frame.dense_piles.members().size());
    const auto pile = world.frame.dense_piles.members().subspan(begins[i], begins[i + 1] - begins[i]);
    solver::limit_dense_pile(pile, world.tables.bodies);
  }
}

void drive_kinematic_bodies(WorldData& world, double time, Real h) {
  state::Bodies& b = world.tables.bodies;
  for (const std::uint32_t body : world.frame.awake) {
    if (b.traits[body].kind != BodyKind::kKinematic) continue;
    if (b.path[body].kind == MotionDesc::Kind::kStill) continue;
    const DVec3 goal = b.path_start[body] + solver::motion_offset(b.path[body], time - b.path_time[body]);
    const DVec3 now = b.center[body] + vector_cast<double>(b.motion[body].dx);
    b.motion[body].v = vector_cast<Real>((1.0 / static_cast<double>(h)) * (goal - now));
  }
}

}  // namespace

bool may_collide(const WorldData& world, collision::ColliderPair pair) {
  const Tables& t = world.tables;
  const std::uint32_t a = t.colliders.body[pair.first];
  const std::uint32_t b = t.colliders.body[pair.second];
  HOOKE_ASSERT(std::max(a, b) < t.bodies.traits.size());  // no holes
  const BodyTraits& ta = t.bodies.traits[a];
  const BodyTraits& tb = t.bodies.traits[b];
  return a != b && may_meet(ta, tb) && ta.collides && tb.collides &&
         state::filters_agree(ta.filter, tb.filter) && !are_hooked(world, a, b);
}

void enter_broad_phase(WorldData& world, std::uint32_t body) {
  const Tables& t = world.tables;
  for (const std::uint32_t c : colliders_of(t.bodies, body)) set_box(world, body, c, t.colliders.bounds[c]);
}

const collision::BroadPhase& boxes_for_queries(WorldData& world) {
  if (world.derived.boxes_are_current.load(std::memory_order_acquire)) return world.derived.broad_phase;
  const std::lock_guard lock(world.derived.boxes_mutex);
  if (world.derived.boxes_are_current.load(std::memory_order_relaxed)) return world.derived.broad_phase;
  const Tables& t = world.tables;
  // The next step sets the boxes of the same bodies again, so that no query changes what a step does.
  const auto enter = [&](std::uint32_t body) {
    for (const std::uint32_t c : colliders_of(t.bodies, body))
      set_box(world, body, c, collision::reach_of(t.bodies, t.colliders, c, Real(0)));
  };
  if (world.derived.broad_phase_stale) {
    world.derived.broad_phase.clear();
    for_all_bodies(t.bodies, enter);
  } else {
    for (const std::uint32_t body : world.derived.placed_bodies) enter(body);
    for (const std::uint32_t body : t.moving_bodies) {
      if (t.bodies.asleep[body] == 0) enter(body);
    }
  }
  world.derived.broad_phase.update();
  world.derived.boxes_are_current.store(true, std::memory_order_release);
  return world.derived.broad_phase;
}

static void find_manifolds(WorldData& world, Real dt) {
  Tables& t = world.tables;
  world.derived.boxes_are_current = false;  // From now on they are the boxes of the step.
  refresh_broad_phase(world, dt);
  for_bodies(world, [&](auto rows) {
    for (const std::uint32_t body : rows) update_bounds(t, body, dt);
  });
  for (const std::uint32_t body : world.frame.awake) enter_broad_phase(world, body);
  world.derived.broad_phase.find_pairs_of(*world.pool, world.frame.in_moved_set, world.frame.pairs_found);
  state::wake_pairs(world.frame.awake, t.bodies, t.colliders, t.pairs, world.frame.sleeping_pair_scratch);
  std::erase_if(world.frame.pairs_found, [&](collision::ColliderPair pair) {
    return !may_collide(world, pair) || is_sleeping(t, pair);
  });
  world.frame.dense_piles.thin_out(t.bodies, t.colliders, world.frame.pairs_found);
  world.frame.narrow_phase.merge_pairs(world.frame.pairs_found, world.frame.in_moved_set, t.pairs);
  world.frame.narrow_phase.update_manifolds(*world.pool, t.bodies, t.colliders, t.desc.materials,
                                            {.dt = dt,
                                             .substeps = t.desc.substeps,
                                             .has_several_neighbors = world.derived.joints.in_ragdoll,
                                             .moved_set = world.frame.moved_set},
                                            t.pairs);
  world.frame.dense_piles.thin_out(t.bodies, t.pairs);
  if (t.desc.sleeping) state::reserve_sleeping_pairs(t.pairs, world.frame.sleeping_pair_scratch);
  if (any_sleeps(world))
    state::put_pairs_to_sleep(t.bodies, t.colliders, t.pairs, world.frame.sleeping_pair_scratch);
}

void find_body_contacts(WorldData& world, Real dt) {
  list_awake_bodies(world);
  solver::evaluate_ragdolls(*world.pool, world.tables.hooks, world.tables.bodies, world.derived.joints);
  find_manifolds(world, dt);
  if (wake_touched(world, dt)) list_awake_bodies(world);
  HOOKE_VALIDATE(state::find_in_body_contacts(world.tables));
}

void prepare_body_contacts(WorldData& world, Real h) {
  Tables& t = world.tables;
  const WorldDesc& desc = t.desc;
  HOOKE_ASSERT(h > Real(0) && std::is_sorted(world.frame.awake.begin(), world.frame.awake.end()));
  const auto before = static_cast<Real>(t.body_substep);
  world.frame.contact_step = {.gravity = desc.gravity,
                              .h = h,
                              .hz = desc.contact_hz,
                              .damping_ratio = desc.contact_damping_ratio,
                              .sweeps = desc.bias_sweeps,
                              .impulse_scale = before > Real(0) ? h / before : Real(1)};
  t.body_substep = static_cast<double>(h);
  world.frame.routes = solver::choose_contact_routes(
      {.step = world.frame.contact_step,
       .impulse_to_force = before > Real(0) ? Real(1) / before : Real(0),
       .joints = world.derived.joints,
       .hooked = world.derived.hooked,
       .supports = world.derived.supports},
      world.frame.awake, world.frame.body_marks, world.frame.load_bearing, world.frame.direct_islands, t);
  world.frame.narrow_phase.list_refreshed(t.pairs);  // No pair changes its row any more in this step.
  solver::prepare_body_contacts(*world.pool, t.pairs.manifold, t.bodies, world.frame.contact_step,
                                world.frame.body_contacts);
  solver::prepare_direct_islands(*world.pool, world.frame.body_contacts, t.bodies,
                                 world.frame.direct_islands);
  solver::find_coupled_lanes(world.frame.body_contacts, t.pairs);
  solver::list_impact_pairs(t.pairs, t.bodies, world.derived.hooked, world.frame.body_contacts,
                            world.frame.impacts);
  note_closing_pairs(world, h * static_cast<Real>(desc.substeps));
  HOOKE_VALIDATE(solver::find_in_contact_routes(t, world.frame.body_contacts, world.frame.direct_islands,
                                                world.frame.check_marks));
  HOOKE_VALIDATE(solver::find_in_joint_routes(t, world.derived.joints, world.frame.check_marks));
}

void accelerate_bodies(WorldData& world, double time, Real h, bool first) {
  drive_kinematic_bodies(world, time + static_cast<double>(h), h);
  force_bodies(world, time, h);
  const solver::BodyStep step = {.gravity = world.tables.desc.gravity, .h = h, .first = first};
  for_bodies(world, [&](auto rows) { solver::accelerate_bodies(rows, step, world.tables.bodies); });
  freeze_inertia(world, h, false);
}

void solve_body_contacts(WorldData& world, Real h, bool first) {
  state::Bodies& bodies = world.tables.bodies;
  solver::BodyContacts& contacts = world.frame.body_contacts;
  for (int sweep = 0; sweep < world.tables.desc.bias_sweeps; ++sweep) {
    for_contact_colors(world, [&](parallel::Range blocks) {
      solver::solve_body_contacts(blocks, world.frame.contact_step, contacts, bodies);
    });
  }
  const solver::BodyStep step = {.gravity = world.tables.desc.gravity, .h = h, .first = first};
  solver::solve_direct_islands(*world.pool, step, world.frame.direct_islands, contacts, bodies);
  limit_dense_piles(world);
}

void move_bodies(WorldData& world, Real h) {
  for_bodies(world, [&](auto rows) { solver::move_bodies(rows, h, world.tables.bodies); });
}

void relax_body_contacts(WorldData& world) {
  for_contact_colors(world, [&](parallel::Range blocks) {
    solver::relax_body_contacts(blocks, world.frame.contact_step, world.frame.body_contacts,
                                world.tables.bodies);
  });
  limit_dense_piles(world);
}

namespace {

/// Clears what a contact carries over to the next step if any of it is not finite.
void reset_if_not_finite(state::Manifold& m) {
  Real sum = m.twist_impulse + m.largest_impulse;
  for (std::int32_t k = 0; k < m.point_count; ++k) sum += m.point[static_cast<std::size_t>(k)].normal_impulse;
  if (std::isfinite(sum) && is_finite(m.friction_impulse) && is_finite(m.rolling_impulse)) return;
  for (state::ContactPoint& p : m.point) p.normal_impulse = Real(0);
  m.friction_impulse = m.rolling_impulse = {};
  m.twist_impulse = m.largest_impulse = Real(0);
}

/// Does the same for a hook, and for the forces and values that it tells.
void reset_if_not_finite(state::Hook& hook) {
  for (double& value : hook.value) value = std::isfinite(value) ? value : 0;
  Real sum = hook.last_impulse + hook.last_angular_impulse;
  for (const Real impulse : hook.row_impulse) sum += impulse;
  const bool finite = std::isfinite(sum) && is_finite(hook.impulse) && is_finite(hook.angular_impulse) &&
                      is_finite(hook.impulse_sum) && is_finite(hook.angular_impulse_sum) &&
                      is_finite(hook.force) && is_finite(hook.torque) && std::isfinite(hook.energy_debt) &&
                      std::isfinite(hook.spring_energy);
  if (finite) return;
  hook.force = hook.torque = {};
  hook.row_impulse = {};
  hook.impulse = hook.angular_impulse = hook.impulse_sum = hook.angular_impulse_sum = {};
  hook.last_impulse = hook.last_angular_impulse = Real(0);
  hook.energy_debt = 0;
  hook.spring_energy = -1;
}

}  // namespace

std::uint32_t finish_bodies(WorldData& world, Real dt) {
  state::Tables& t = world.tables;
  for_bodies(world, [&](auto rows) { solver::finish_bodies(rows, t.bodies); });
  solver::finish_joints(*world.pool, dt, t.desc.substeps, t.bodies, world.derived.joints, t.hooks);
  // Motion that is finite, but only just, has too large an angular momentum.
  std::uint32_t count = 0;
  for (const std::uint32_t body : world.frame.awake) {
    if (is_finite(t.bodies.angular_momentum[body]) && is_finite(t.bodies.angular_velocity[body])) continue;
    t.bodies.angular_momentum[body] = t.bodies.angular_velocity[body] = {};
    t.bodies.motion[body].omega_scaled = {};
    ++count;
  }
  if (!world.frame.bodies_quarantined && count == 0) return 0;
  // Otherwise what touched or held a quarantined body would send it back to quarantine in every step.
  for (state::Manifold& m : t.pairs.manifold) reset_if_not_finite(m);
  for (state::Hook& hook : t.hooks) reset_if_not_finite(hook);
  return count;
}

void resolve_impacts(WorldData& world, Real h) {
  Tables& t = world.tables;
  solver::BodyContacts& contacts = world.frame.body_contacts;
  if (!solver::predict_impacts(world.frame.contact_step, t.pairs.manifold, contacts, t.bodies,
                               world.frame.impacts))
    return;
  while (const std::optional<solver::NextImpact> impact = solver::next_impact(world.frame.impacts)) {
    const solver::ImpactPair& pair = world.frame.impacts.pairs[impact->index];
    solver::store_lanes(solver::lanes_of(pair, world.frame.impacts), contacts, t.pairs.manifold);
    const collision::PosedPair posed = {pair.pair, state::pose_after(t.bodies, pair.a, impact->time),
                                        state::pose_after(t.bodies, pair.b, impact->time)};
    world.frame.narrow_phase.refresh_at(t.bodies, t.colliders, t.desc.materials, h, posed, t.pairs);
    solver::resolve_impact(*impact, world.frame.contact_step, t.pairs, contacts, t.bodies,
                           world.frame.impacts);
  }
  solver::reset_hooked_bodies(t.hooks, h, t.bodies, world.frame.impacts);
}

void refresh_contacts(WorldData& world, Real h) {
  freeze_inertia(world, h, true);
  Tables& t = world.tables;
  if (world.frame.body_contacts.refreshed.empty()) return;
  solver::BodyContacts& contacts = world.frame.body_contacts;
  solver::store_lanes(contacts.refreshed, contacts, t.pairs.manifold);
  world.frame.narrow_phase.refresh_manifolds(*world.pool, t.bodies, t.colliders, t.desc.materials, h,
                                             t.pairs);
  solver::refill_lanes(contacts.refreshed, t.pairs.manifold, Real(0), t.bodies, contacts);
}

void finish_body_contacts(WorldData& world) {
  Tables& t = world.tables;
  parallel::for_ranges(*world.pool, static_cast<int>(world.frame.body_contacts.blocks.size()),
                       kContactBlockGrain, [&](parallel::Range blocks) {
                         solver::store_body_contacts(blocks, world.frame.body_contacts, t.pairs.manifold);
                       });
  solver::evaluate_direct_islands(world.frame.awake, world.frame.contact_step, world.frame.body_contacts,
                                  world.frame.load_bearing.footing, world.frame.direct_islands, t.bodies);
}

std::uint32_t quarantine_bodies(WorldData& world) {
  state::Bodies& b = world.tables.bodies;
  std::uint32_t count = 0;
  for (const std::uint32_t body : world.frame.awake) {
    const state::MotionRecord& m = b.motion[body];
    if (is_finite(m.v) && is_finite(m.omega_scaled) && is_finite(m.dx) && is_finite(m.theta_scaled)) continue;
    b.motion[body] = {.inverse_mass = m.inverse_mass};
    b.angular_momentum[body] = {};
    b.free_motion[body] = {};
    ++count;
  }
  world.frame.bodies_quarantined = count > 0;
  return count;
}

}  // namespace hooke::world
