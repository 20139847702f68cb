#include "world/impacts.h"

#include "collision/continuous.h"
#include "collision/shape_bounds.h"
#include "math/rotation.h"
#include "solver/bodies.h"
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

constexpr Real kOfThickness = Real(0.5);  // how far a body may move unseen, in half thicknesses

/// By how much a body turned in this step, as far as its line tells [rad].
Vec3 turn_of(const Bodies& bodies, std::uint32_t body) {
  const MotionLine& m = bodies.motion[body];
  return m.inverse_mass > Real(0) ? bodies.scale[body] * m.theta_scaled : m.theta_scaled;
}

/// The way that the solver has found for a body in this step.
Path path_of(const WorldData& world, std::uint32_t body) {
  const Bodies& bodies = world.tables.bodies;
  const MotionLine& m = bodies.motion[body];
  Path path = {.center = bodies.center[body],
               .rotation = bodies.rotation[body],
               .way = m.dx,
               .turn = turn_of(bodies, body),
               .radius = bodies.traits[body].radius};
  if (m.inverse_mass > Real(0) && solver::tumbles_now(bodies, body)) {
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
  return way > kOfThickness * traits.inner_radius;
}

/// Who hangs on hooks goes on: stopped alone, it would tear away from those it hangs together with.
Stoppable stoppable(const WorldData& world, std::uint32_t body, bool fast) {
  const Bodies& bodies = world.tables.bodies;
  if (world.hooked[body] != 0) return Stoppable::kNever;
  if (bodies.traits[body].kind != BodyKind::kDynamic || bodies.asleep[body] != 0) return Stoppable::kNever;
  return fast ? Stoppable::kAlways : Stoppable::kSlow;
}

/// Whether the body may turn so far in the step that its inertia in world axes changes by a large part: it
/// does, or will be hit fast enough (`foreseen`, or faster than its size). A top does not, whose axis stays.
/// Rows know only one inertia, and would make energy with that of another time.
bool turns_over(const Bodies& bodies, std::uint32_t body, bool foreseen, Real dt) {
  constexpr Real kFar = Real(0.25);        // [rad]
  constexpr Real kLargePart = Real(0.25);  // of the largest entry
  if (!state::is_dynamic(bodies, body) || bodies.asleep[body] != 0) return false;
  if (!solver::tumbles(bodies.mass[body])) return false;
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

/// Boxes around what bodies really did, which may be more than detect thought they could.
void enter_ways(WorldData& world) {
  state::Tables& t = world.tables;
  for_bodies(world, [&](auto rows) {
    for (const std::uint32_t body : rows) {
      const Path path = path_of(world, body);
      for (const std::uint32_t c : colliders_of(t.bodies, body))
        t.colliders.bounds[c] = collision::reach_of(t.colliders, c, path);
    }
  });
  for (const std::uint32_t body : world.awake) enter_broad_phase(world, body);
  world.broad_phase.update();
}

/// What each fast body's colliders may run into; pairs in order, each once.
std::vector<ColliderPair> find_swept_pairs(const WorldData& world, const std::vector<std::uint32_t>& fast) {
  const state::Tables& t = world.tables;
  const auto solid = [&](std::uint32_t collider) {
    return !t.bodies.traits[t.colliders.body[collider]].sensor;
  };
  std::vector<ColliderPair> pairs;
  std::vector<std::uint32_t> found;
  for (const std::uint32_t body : fast) {
    for (const std::uint32_t c : colliders_of(t.bodies, body)) {
      world.broad_phase.query(t.colliders.bounds[c], found);
      for (const std::uint32_t other : found) {
        const ColliderPair pair = {std::min(c, other), std::max(c, other)};
        if (solid(other) && may_collide(world, pair)) pairs.push_back(pair);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Rows of the bodies that have a part in some pair, each once.
std::vector<std::uint32_t> bodies_of(const std::vector<ColliderPair>& pairs,
                                     const state::Colliders& colliders) {
  std::vector<std::uint32_t> rows;
  for (const ColliderPair& pair : pairs)
    rows.insert(rows.end(), {colliders.body[pair.first], colliders.body[pair.second]});
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// Cuts what the body did short at where its path ends.
void follow(const Path& path, std::uint32_t body, Bodies& bodies) {
  MotionLine& m = bodies.motion[body];
  m.dx = vector_cast<Real>(collision::pose_at(path, Real(1)).position - path.center);
  m.theta_scaled = path.stop * m.theta_scaled;
  if (solver::tumbles_now(bodies, body))
    solver::turn_back(body, collision::pose_at(path, Real(1)).rotation, bodies);
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

void stop_at_impacts(WorldData& world) {
  Bodies& bodies = world.tables.bodies;
  std::vector<std::uint32_t> fast;
  for (const std::uint32_t body : world.awake) {
    if (is_fast(bodies, body)) fast.push_back(body);
  }
  if (fast.empty()) return;
  enter_ways(world);
  const std::vector<ColliderPair> pairs = find_swept_pairs(world, fast);
  if (pairs.empty()) return;
  collision::SweptBodies swept;
  swept.path.resize(bodies.motion.size());
  swept.stoppable.resize(bodies.motion.size(), Stoppable::kNever);
  for (const std::uint32_t body : bodies_of(pairs, world.tables.colliders)) {
    const bool awake = std::binary_search(world.awake.begin(), world.awake.end(), body);
    swept.path[body] = awake ? path_of(world, body) : collision::path_ahead(bodies, body, Real(0));
    swept.stoppable[body] = stoppable(world, body, std::binary_search(fast.begin(), fast.end(), body));
  }
  if (collision::stop_at_impacts(*world.pool, world.tables.colliders, pairs, swept) == 0) return;
  for (const std::uint32_t body : world.awake) {
    if (swept.path[body].stop < Real(1)) follow(swept.path[body], body, bodies);
  }
}

}  // namespace hooke::world
