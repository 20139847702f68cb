#include "world/bodies.h"

#include "collision/narrow_phase.h"
#include "collision/shape_bounds.h"
#include "solver/forces.h"
#include "world/hooks.h"

#include <algorithm>
#include <cmath>

namespace hooke::world {

namespace {

using state::BodyTraits;
using state::Tables;

bool moves(const BodyTraits& traits) {
  return traits.kind != BodyKind::kStatic;
}

bool filters_agree(const FilterDesc& a, const FilterDesc& b) {
  if (a.group == b.group && a.group != 0) return a.group > 0;
  return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

bool may_collide(const WorldData& world, collision::ColliderPair pair) {
  const Tables& t = world.tables;
  const std::uint32_t a = t.colliders.body[pair.first];
  const std::uint32_t b = t.colliders.body[pair.second];
  const BodyTraits& ta = t.bodies.traits[a];
  const BodyTraits& tb = t.bodies.traits[b];
  const bool one_moves = ta.kind == BodyKind::kDynamic || tb.kind == BodyKind::kDynamic;
  return a != b && one_moves && ta.collides && tb.collides && filters_agree(ta.filter, tb.filter) &&
         !are_hooked(world, a, b);
}

/// What the colliders of a body can reach in this step.
void update_bounds(Tables& t, std::uint32_t body, Real dt) {
  const std::uint32_t first = t.bodies.first_collider[body];
  for (std::uint32_t c = first; c < first + t.bodies.collider_count[body]; ++c)
    t.colliders.bounds[c] = collision::reach_of(t.bodies, t.colliders, c, dt);
}

void enter_broad_phase(WorldData& world, std::uint32_t body) {
  const Tables& t = world.tables;
  const std::uint32_t first = t.bodies.first_collider[body];
  for (std::uint32_t c = first; c < first + t.bodies.collider_count[body]; ++c)
    world.broad_phase.set(c, t.colliders.bounds[c], moves(t.bodies.traits[body]));
}

/// Bodies that were added, or put elsewhere by hand, since the last step.
void refresh_broad_phase(WorldData& world, Real dt) {
  Tables& t = world.tables;
  if (world.broad_phase_stale) {
    world.broad_phase.clear();
    world.bodies_placed.clear();
    for (std::uint32_t body = 0; body < t.bodies.motion.size(); ++body) {
      if (t.bodies.traits[body].alive) world.bodies_placed.push_back(body);
    }
    world.broad_phase_stale = false;
  }
  for (const std::uint32_t body : world.bodies_placed) {
    if (!t.bodies.traits[body].alive) continue;
    update_bounds(t, body, dt);
    enter_broad_phase(world, body);
  }
  world.bodies_placed.clear();
}

}  // namespace

void list_awake_bodies(WorldData& world) {
  const state::Bodies& bodies = world.tables.bodies;
  world.awake.clear();
  for (const std::uint32_t body : world.tables.moving_bodies) {
    if (bodies.asleep[body] == 0) world.awake.push_back(body);
  }
}

void find_body_contacts(WorldData& world, Real dt) {
  Tables& t = world.tables;
  refresh_broad_phase(world, dt);
  for_bodies(world, [&](auto rows) {
    for (const std::uint32_t body : rows) update_bounds(t, body, dt);
  });
  for (const std::uint32_t body : world.awake) enter_broad_phase(world, body);
  world.broad_phase.find_pairs(*world.pool, world.pairs_found);
  std::erase_if(world.pairs_found, [&](collision::ColliderPair pair) { return !may_collide(world, pair); });
  collision::merge_pairs(world.pairs_found, t.pairs);
  collision::update_manifolds(*world.pool, t.bodies, t.colliders, t.desc.materials, dt, t.pairs);
}

void prepare_body_contacts(WorldData& world, Real h) {
  Tables& t = world.tables;
  const WorldDesc& desc = t.desc;
  const auto before = static_cast<Real>(t.body_substep);
  world.contact_step = {.gravity = desc.gravity,
                        .h = h,
                        .hz = desc.contact_hz,
                        .damping_ratio = desc.contact_damping_ratio,
                        .sweeps = desc.bias_sweeps,
                        .impulse_scale = before > Real(0) ? h / before : Real(1)};
  t.body_substep = static_cast<double>(h);
  solver::find_hard_islands(world.awake, t.pairs.manifold, t.bodies, world.body_contacts, world.hard_islands);
  solver::prepare_body_contacts(*world.pool, t.pairs.manifold, t.bodies, world.contact_step,
                                world.body_contacts);
  solver::prepare_hard_islands(*world.pool, world.body_contacts, t.bodies, world.hard_islands);
}

void drive_kinematic_bodies(WorldData& world, double time, Real h) {
  state::Bodies& b = world.tables.bodies;
  for (const std::uint32_t body : world.awake) {
    if (b.traits[body].kind != BodyKind::kKinematic) continue;
    if (b.path[body].kind == MotionDesc::Kind::kStill) continue;
    const DVec3 goal = b.path_start[body] + solver::motion_offset(b.path[body], time - b.path_time[body]);
    const DVec3 now = b.center[body] + vector_cast<double>(b.motion[body].dx);
    b.motion[body].v = vector_cast<Real>((1.0 / static_cast<double>(h)) * (goal - now));
  }
}

std::uint32_t quarantine_bodies(WorldData& world) {
  state::Bodies& b = world.tables.bodies;
  std::uint32_t count = 0;
  for (const std::uint32_t body : world.awake) {
    const state::MotionLine& m = b.motion[body];
    if (is_finite(m.v) && is_finite(m.omega_scaled) && is_finite(m.dx) && is_finite(m.theta_scaled)) continue;
    b.motion[body] = {.inverse_mass = m.inverse_mass};
    b.angular_momentum[body] = {};
    b.free_motion[body] = {};
    ++count;
  }
  return count;
}

}  // namespace hooke::world
