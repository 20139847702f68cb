#include "world/impact_clamp.h"

#include "base/assert.h"
#include "collision/continuous/continuous.h"
#include "collision/continuous/shape_bounds.h"
#include "math/rotation.h"
#include "solver/body/body_motion.h"
#include "state/body_frames.h"
#include "world/body_stages.h"

#include <algorithm>
#include <cmath>

namespace hooke::world {

namespace {

using collision::ColliderPair;
using collision::Path;
using collision::Stoppable;
using state::Bodies;
using state::MotionRecord;

/// Rotation of a body in this step [rad], as its motion record has it.
Vec3 rotation_of(const Bodies& bodies, std::uint32_t body) {
  const MotionRecord& m = bodies.motion[body];
  return m.inverse_mass > Real(0) ? bodies.scale[body] * m.theta_scaled : m.theta_scaled;
}

/// The path on which the solver has moved a body in this step.
Path path_of(const WorldData& world, std::uint32_t body) {
  const Bodies& bodies = world.tables.bodies;
  const MotionRecord& m = bodies.motion[body];
  Path path = collision::path_ahead(bodies, body, Real(0));
  path.displacement = m.dx;
  path.turn = rotation_of(bodies, body);
  if (m.inverse_mass > Real(0) && state::is_gyroscopic_now(bodies, body)) {
    HOOKE_ASSERT(body < world.frame.start_rotation.size());
    path.rotation = world.frame.start_rotation[body];
    path.turn = math::turn_between(path.rotation, bodies.rotation[body], path.turn);
  }
  return path;
}

/// Whether the body moves or rotates in this step by much of its thickness, so that it might pass through
/// others.
bool is_fast(const Bodies& bodies, std::uint32_t body) {
  const state::BodyTraits& traits = bodies.traits[body];
  if (!traits.collides || traits.sensor) return false;
  const Real displacement =
      length(bodies.motion[body].dx) + length(rotation_of(bodies, body)) * traits.radius;
  return displacement > collision::kUnseenDisplacement * traits.inner_radius;
}

/// Bodies on hooks are never stopped: one that is stopped alone would tear away from the others.
bool may_be_stopped(const WorldData& world, std::uint32_t body) {
  return world.derived.hooked[body] == 0 && state::gives_way(world.tables.bodies, body);
}

Stoppable stoppable(const WorldData& world, std::uint32_t body, bool fast) {
  if (!may_be_stopped(world, body)) return Stoppable::kNever;
  return fast ? Stoppable::kAlways : Stoppable::kSlow;
}

/// Whether the body may rotate so far within the step that its inertia in world axes changes by a large part.
/// Either it rotates so far by itself, or an impact may make it: one that detect foresaw (`foreseen`), or any
/// if the body moves by more than its radius. A top that spins about its fixed axis does not count. Rows know
/// only one inertia per step, and would add energy with that of another time.
bool changes_inertia(const Bodies& bodies, std::uint32_t body, bool foreseen, Real dt) {
  constexpr Real kFar = Real(0.25);        // [rad]
  constexpr Real kLargePart = Real(0.25);  // Share of the largest diagonal entry.
  if (!state::gives_way(bodies, body)) return false;
  if (!state::is_gyroscopic(bodies.mass[body])) return false;
  if (foreseen || dt * length(bodies.motion[body].v) > bodies.traits[body].radius) return true;
  const Vec3 turn = dt * bodies.angular_velocity[body];
  if (!(length(turn) > kFar)) return false;
  const auto now = solver::inertia_scale(bodies.mass[body], bodies.rotation[body]);
  // The inertia is compared at two times, because after half a turn it may be what it was.
  for (const Real part : {Real(0.37), Real(1)}) {
    const auto then =
        solver::inertia_scale(bodies.mass[body], math::quaternion_of(part * turn) * bodies.rotation[body]);
    const Real change =
        std::max({std::abs(then.xx - now.xx), std::abs(then.yy - now.yy), std::abs(then.zz - now.zz),
                  std::abs(then.xy - now.xy), std::abs(then.xz - now.xz), std::abs(then.yz - now.yz)});
    if (change > kLargePart * std::max({now.xx, now.yy, now.zz})) return true;
  }
  return false;
}

/// Marks the bodies that are fast for their thickness. Returns false if there are none, or if none may be
/// stopped.
bool find_fast_bodies(WorldData& world) {
  const Bodies& bodies = world.tables.bodies;
  world.frame.fast.assign(bodies.motion.size(), 0);
  bool any_is_fast = false;
  bool any_gives_way = false;
  for (const std::uint32_t body : world.frame.awake) {
    world.frame.fast[body] = is_fast(bodies, body) ? 1 : 0;
    any_is_fast |= world.frame.fast[body] != 0;
    any_gives_way |= may_be_stopped(world, body);
  }
  return any_is_fast && any_gives_way;
}

bool is_one_fast(const WorldData& world, ColliderPair pair) {
  const std::vector<std::uint32_t>& body = world.tables.colliders.body;
  return world.frame.fast[body[pair.first]] != 0 || world.frame.fast[body[pair.second]] != 0;
}

bool is_solid(const WorldData& world, std::uint32_t collider) {
  return !world.tables.bodies.traits[world.tables.colliders.body[collider]].sensor;
}

/// Whether the body leaves the boxes that detect expected it to stay in. Then the pairs of the step do not
/// contain everything in its way.
bool goes_astray(const WorldData& world, std::uint32_t body, const Path& path) {
  const state::Colliders& colliders = world.tables.colliders;
  constexpr Vec3 kMargin = {collision::kReachMargin, collision::kReachMargin, collision::kReachMargin};
  for (const std::uint32_t c : colliders_of(world.tables.bodies, body)) {
    const geometry::Box foreseen = {colliders.bounds[c].lower - kMargin, colliders.bounds[c].upper + kMargin};
    if (!contains(foreseen, collision::reach_of(colliders, c, path))) return true;
  }
  return false;
}

/// Enters the body of a collider as a swept body if it stands. Standing bodies are entered only when a path
/// may reach them, because there may be far too many of them.
void enter_standing(WorldData& world, std::uint32_t collider) {
  HOOKE_ASSERT(world.frame.swept.path.size() == world.tables.bodies.motion.size());
  const Bodies& bodies = world.tables.bodies;
  collision::SweptBodies& swept = world.frame.swept;
  const std::uint32_t body = world.tables.colliders.body[collider];
  if (bodies.traits[body].kind != BodyKind::kStatic && bodies.asleep[body] == 0) return;
  swept.path[body] = collision::path_ahead(bodies, body, Real(0));
  swept.stoppable[body] = Stoppable::kNever;
  swept.inverse_mass[body] = bodies.motion[body].inverse_mass;
  swept.clamps[body] = {};
}

/// Finds the paths of awake bodies, and marks those that leave their boxes.
void find_paths(WorldData& world) {
  const Bodies& bodies = world.tables.bodies;
  collision::SweptBodies& swept = world.frame.swept;
  const std::size_t count = bodies.motion.size();
  HOOKE_ASSERT(world.frame.fast.size() == count && world.derived.hooked.size() == count);
  swept.path.resize(count);
  swept.stoppable.resize(count);
  swept.inverse_mass.resize(count);
  swept.clamps.resize(count);
  world.frame.astray.assign(count, 0);
  for_bodies(world, [&](auto rows) {
    for (const std::uint32_t body : rows) {
      swept.inverse_mass[body] = bodies.motion[body].inverse_mass;
      swept.clamps[body] = {};
      swept.path[body] = path_of(world, body);
      swept.stoppable[body] = stoppable(world, body, world.frame.fast[body] != 0);
      world.frame.astray[body] = goes_astray(world, body, swept.path[body]) ? 1 : 0;
    }
  });
}

/// Sets the boxes of a body's colliders to what its path reaches.
void enter_path(WorldData& world, std::uint32_t body) {
  state::Tables& t = world.tables;
  for (const std::uint32_t c : colliders_of(t.bodies, body))
    t.colliders.bounds[c] = collision::reach_of(t.colliders, c, world.frame.swept.path[body]);
  enter_broad_phase(world, body);
}

/// Finds the pairs of a body's colliders with what its path may meet.
void find_in_path(WorldData& world, std::uint32_t body, collision::PathScratch& scratch) {
  const state::Tables& t = world.tables;
  scratch.pairs.clear();
  for (const std::uint32_t c : colliders_of(t.bodies, body)) {
    world.derived.broad_phase.query_for(c, t.colliders.bounds[c], scratch.near);
    for (const std::uint32_t other : scratch.near) {
      const ColliderPair pair = {std::min(c, other), std::max(c, other)};
      if (!is_solid(world, other) || !may_collide(world, pair)) continue;
      scratch.pairs.push_back(pair);
      enter_standing(world, other);
    }
  }
}

/// Lists the pairs of solid colliders that may run into each other and of which one at least is fast.
void list_impact_candidates(WorldData& world, std::vector<collision::ImpactCandidate>& impact_candidates) {
  const state::Pairs& pairs = world.tables.pairs;
  impact_candidates.clear();
  for (const state::Pair& p : pairs.pair) {
    const ColliderPair pair = {p.collider_a, p.collider_b};
    if (!is_one_fast(world, pair) || !is_solid(world, pair.first) || !is_solid(world, pair.second)) continue;
    impact_candidates.push_back(
        {pair, p.manifold_count > 0 ? pairs.manifold[p.first_manifold].normal : Vec3{}});
    for (const std::uint32_t collider : {p.collider_a, p.collider_b}) enter_standing(world, collider);
  }
  const std::size_t foreseen = impact_candidates.size();
  const auto for_each_astray = [&](auto&& visit) {
    for (const std::uint32_t body : world.frame.awake) {
      if (world.frame.astray[body] != 0 && !world.tables.bodies.traits[body].sensor) visit(body);
    }
  };
  for_each_astray([&](std::uint32_t body) { enter_path(world, body); });
  world.derived.broad_phase.update();
  for_each_astray([&](std::uint32_t body) {
    find_in_path(world, body, world.frame.path_scratch);
    for (const ColliderPair pair : world.frame.path_scratch.pairs) {
      if (is_one_fast(world, pair)) impact_candidates.push_back({.pair = pair});
    }
  });
  if (impact_candidates.size() == foreseen) return;
  std::sort(impact_candidates.begin(), impact_candidates.end(), [](const auto& p, const auto& q) {
    return p.pair != q.pair ? p.pair < q.pair : p.apart != Vec3{} && q.apart == Vec3{};
  });
  const auto same = [](const auto& p, const auto& q) { return p.pair == q.pair; };
  impact_candidates.erase(std::unique(impact_candidates.begin(), impact_candidates.end(), same),
                          impact_candidates.end());
}

/// Moves the body to the end of its clamped path. `turned` is the share of its rotation that it keeps.
void follow(const Path& path, Real turned, std::uint32_t body, Bodies& bodies) {
  MotionRecord& m = bodies.motion[body];
  const Pose end = collision::pose_at(path, Real(1));
  m.dx = vector_cast<Real>(end.position - bodies.center[body]);
  m.theta_scaled = turned * m.theta_scaled;
  if (state::is_gyroscopic_now(bodies, body)) solver::stop_rotation(body, end.rotation, bodies);
}

}  // namespace

void begin_motion(WorldData& world, Real dt) {
  Bodies& bodies = world.tables.bodies;
  const Real h = dt / static_cast<Real>(world.tables.desc.substeps);
  world.frame.start_rotation.resize(bodies.rotation.size());
  for (const std::uint32_t body : world.frame.awake) {
    world.frame.start_rotation[body] = bodies.rotation[body];
    bodies.frozen_inertia[body] = {};
    if (world.derived.hooked[body] != 0 && solver::outgrows_rows(bodies, body, h))
      bodies.frozen_inertia[body] = {.on = true, .hooked = true};
  }
  for (const collision::BodyPassFinder::Pair& pair : world.frame.body_passes.pairs) {
    if (!state::gives_way(bodies, pair.body) || !state::is_gyroscopic(bodies.mass[pair.body])) continue;
    state::FrozenInertia& frozen = bodies.frozen_inertia[pair.body];
    frozen.touches = true;
    frozen.on = frozen.on || changes_inertia(bodies, pair.body, false, dt);
  }
  for (const state::Pair& pair : world.tables.pairs.pair) {
    if (pair.manifold_count == 0) continue;
    for (const std::uint32_t collider : {pair.collider_a, pair.collider_b}) {
      const std::uint32_t body = world.tables.colliders.body[collider];
      state::FrozenInertia& frozen = bodies.frozen_inertia[body];
      const Vec3 turn = pair.time * dt * bodies.angular_velocity[body];
      frozen.touches = state::gives_way(bodies, body) && state::is_gyroscopic(bodies.mass[body]);
      if (frozen.on) {
        if (length_squared(turn) < length_squared(frozen.until_impact)) frozen.until_impact = turn;
      } else if (changes_inertia(bodies, body, pair.time > Real(0), dt)) {
        frozen.on = true;
        frozen.until_impact = turn;
      }
    }
  }
}

void freeze_inertia(WorldData& world, Real h, bool moved) {
  for_bodies(world, [&](auto rows) {
    solver::freeze_inertia(rows, world.frame.start_rotation, h, moved, world.tables.bodies);
  });
}

void clamp_to_impact_times(WorldData& world) {
  Bodies& bodies = world.tables.bodies;
  if (!find_fast_bodies(world)) return;
  find_paths(world);
  list_impact_candidates(world, world.frame.impact_candidates);
  const auto find_pairs = [&world](std::uint32_t body, collision::PathScratch& scratch) {
    enter_path(world, body);
    find_in_path(world, body, scratch);
  };
  collision::SweptBodies& swept = world.frame.swept;
  if (collision::clamp_to_impact_times(*world.pool, world.tables.colliders, world.frame.impact_candidates,
                                       find_pairs, world.frame.continuous, swept) == 0)
    return;
  for (const std::uint32_t body : world.frame.awake) {
    if (swept.clamps[body].count > 0) follow(swept.path[body], swept.clamps[body].first, body, bodies);
  }
}

}  // namespace hooke::world
