#include "world/impacts.h"

#include "collision/continuous.h"
#include "collision/shape_bounds.h"
#include "math/rotation.h"
#include "solver/bodies.h"
#include "state/body_frames.h"
#include "world/bodies.h"

#include <algorithm>
#include <cmath>

namespace hooke::world {

namespace {

using collision::ColliderPair;
using collision::Path;
using collision::Stoppable;
using state::Bodies;
using state::MotionLine;

/// By how much a body turned in this step, as far as its line tells [rad].
Vec3 turn_of(const Bodies& bodies, std::uint32_t body) {
  const MotionLine& m = bodies.motion[body];
  return m.inverse_mass > Real(0) ? bodies.scale[body] * m.theta_scaled : m.theta_scaled;
}

/// The way that the solver has found for a body in this step.
Path path_of(const WorldData& world, std::uint32_t body) {
  const Bodies& bodies = world.tables.bodies;
  const MotionLine& m = bodies.motion[body];
  Path path = collision::path_ahead(bodies, body, Real(0));
  path.way = m.dx;
  path.turn = turn_of(bodies, body);
  if (m.inverse_mass > Real(0) && state::tumbles_now(bodies, body)) {
    path.rotation = world.start_rotation[body];
    path.turn = math::turn_between(path.rotation, bodies.rotation[body], path.turn);
  }
  return path;
}

/// Whether the body goes or turns far for its thickness.
bool is_fast(const Bodies& bodies, std::uint32_t body) {
  const state::BodyTraits& traits = bodies.traits[body];
  if (!traits.collides || traits.sensor) return false;
  const Real way = length(bodies.motion[body].dx) + length(turn_of(bodies, body)) * traits.radius;
  return way > collision::kUnseenWay * traits.inner_radius;
}

/// Who hangs on hooks goes on: stopped alone, it would tear away from those it hangs together with.
Stoppable stoppable(const WorldData& world, std::uint32_t body, bool fast) {
  const Bodies& bodies = world.tables.bodies;
  if (world.hooked[body] != 0) return Stoppable::kNever;
  if (!state::gives_way(bodies, body)) return Stoppable::kNever;
  return fast ? Stoppable::kAlways : Stoppable::kSlow;
}

/// Whether the body may turn so far in the step that its inertia in world axes changes by a large part: it
/// does, or will be hit fast enough (`foreseen`, or faster than its size). A top does not, whose axis stays.
/// Rows know only one inertia, and would make energy with that of another time.
bool turns_over(const Bodies& bodies, std::uint32_t body, bool foreseen, Real dt) {
  constexpr Real kFar = Real(0.25);        // [rad]
  constexpr Real kLargePart = Real(0.25);  // of the largest entry
  if (!state::gives_way(bodies, body)) return false;
  if (!state::tumbles(bodies.mass[body])) return false;
  if (foreseen || dt * length(bodies.motion[body].v) > bodies.traits[body].radius) return true;
  const Vec3 turn = dt * bodies.angular_velocity[body];
  if (!(length(turn) > kFar)) return false;
  const auto now = solver::inertia_scale(bodies.mass[body], bodies.rotation[body]);
  // Two looks: after half a turn things may be as they were.
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

/// How bodies go, and boxes around that, which may be more than detect thought they could, and around where
/// fast ones may be driven.
void enter_ways(WorldData& world, const std::vector<std::uint32_t>& fast, collision::SweptBodies& swept) {
  state::Tables& t = world.tables;
  const std::size_t count = t.bodies.motion.size();
  swept.path.resize(count);
  swept.stoppable.assign(count, Stoppable::kNever);
  swept.bends.assign(count, {});
  parallel::for_ranges(*world.pool, static_cast<int>(count), kBodyGrain, [&](parallel::Range rows) {
    for (int row = rows.begin; row < rows.end; ++row) {
      const auto body = static_cast<std::uint32_t>(row);
      swept.path[body] = collision::path_ahead(t.bodies, body, Real(0));
    }
  });
  for_bodies(world, [&](auto rows) {
    for (const std::uint32_t body : rows) {
      const bool goes_far = std::binary_search(fast.begin(), fast.end(), body);
      const Path path = path_of(world, body);
      swept.path[body] = path;
      swept.stoppable[body] = stoppable(world, body, goes_far);
      const Real aside = goes_far ? Real(0.5) * length(path.way) : Real(0);
      const Vec3 pad = {aside, aside, aside};
      for (const std::uint32_t c : colliders_of(t.bodies, body)) {
        const geometry::Box reach = collision::reach_of(t.colliders, c, path);
        t.colliders.bounds[c] = {reach.lower - pad, reach.upper + pad};
      }
    }
  });
  for (const std::uint32_t body : world.awake) enter_broad_phase(world, body);
  world.broad_phase.update();
}

/// What a body's colliders may run into.
void find_in_the_way(const WorldData& world, std::uint32_t body, collision::WayScratch& scratch) {
  const state::Tables& t = world.tables;
  scratch.pairs.clear();
  for (const std::uint32_t c : colliders_of(t.bodies, body)) {
    world.broad_phase.query_for(c, t.colliders.bounds[c], scratch.near);
    for (const std::uint32_t other : scratch.near) {
      const ColliderPair pair = {std::min(c, other), std::max(c, other)};
      const bool solid = !t.bodies.traits[t.colliders.body[other]].sensor;
      if (solid && may_collide(world, pair)) scratch.pairs.push_back(pair);
    }
  }
}

/// Lets the body be where its path ends.
void follow(const Path& path, Real turned, std::uint32_t body, Bodies& bodies) {
  MotionLine& m = bodies.motion[body];
  const Pose end = collision::pose_at(path, Real(1));
  m.dx = vector_cast<Real>(end.position - bodies.center[body]);
  m.theta_scaled = turned * m.theta_scaled;
  if (state::tumbles_now(bodies, body)) solver::turn_back(body, end.rotation, bodies);
}

}  // namespace

void begin_motion(WorldData& world, Real dt) {
  Bodies& bodies = world.tables.bodies;
  world.start_rotation.resize(bodies.rotation.size());
  for (const std::uint32_t body : world.awake) {
    world.start_rotation[body] = bodies.rotation[body];
    bodies.steady_turn[body] = {};
  }
  for (const state::Pair& pair : world.tables.pairs.pair) {
    if (pair.manifold_count == 0) continue;
    for (const std::uint32_t collider : {pair.collider_a, pair.collider_b}) {
      const std::uint32_t body = world.tables.colliders.body[collider];
      state::SteadyTurn& steady = bodies.steady_turn[body];
      const Vec3 turn = pair.time * dt * bodies.angular_velocity[body];
      if (steady.on) {
        if (length_squared(turn) < length_squared(steady.until_impact)) steady.until_impact = turn;
      } else if (turns_over(bodies, body, pair.time > Real(0), dt)) {
        steady = {true, turn};
      }
    }
  }
}

void give_way_at_impacts(WorldData& world) {
  Bodies& bodies = world.tables.bodies;
  std::vector<std::uint32_t>& fast = world.fast_bodies;
  fast.clear();
  for (const std::uint32_t body : world.awake) {
    if (is_fast(bodies, body)) fast.push_back(body);
  }
  if (fast.empty()) return;
  collision::SweptBodies& swept = world.swept;
  enter_ways(world, fast, swept);
  const auto find_pairs = [&world](std::uint32_t body, collision::WayScratch& scratch) {
    find_in_the_way(world, body, scratch);
  };
  if (collision::give_way_at_impacts(*world.pool, world.tables.colliders, fast, find_pairs, world.continuous,
                                     swept) == 0)
    return;
  for (const std::uint32_t body : world.awake) {
    if (swept.bends[body].count > 0) follow(swept.path[body], swept.bends[body].first, body, bodies);
  }
}

}  // namespace hooke::world
