#include "world/sleep.h"

#include "base/assert.h"
#include "collision/continuous/shape_bounds.h"
#include "state/sleeping_pairs.h"
#include "world/body_stages.h"
#include "world/hook_stages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hooke::world {

namespace {

using state::Bodies;
using state::Manifold;

constexpr Real kRestSpeed = Real(0.05);  ///< Largest speed of the fastest point of a body at rest [m/s].
constexpr Real kRestTime = Real(0.5);    ///< Time at rest after which an island sleeps [s].

/// Whether the bodies of a manifold push each other or overlap. Bodies that are only near do not wake each
/// other.
bool touches(const Manifold& manifold) {
  if (manifold.touching) return true;
  return std::any_of(manifold.point.begin(), manifold.point.begin() + manifold.point_count,
                     [](const state::ContactPoint& p) { return p.separation < Real(0); });
}

/// Whether the bodies will overlap within `dt` [s] at their present velocities. A sleeping body must be awake
/// in the step in which it is hit, or it takes the impact as if nothing could move it.
bool will_touch(const Bodies& bodies, const Manifold& manifold, Real dt) {
  const auto speed = [&](std::uint32_t body, Vec3 anchor) {
    return dot(manifold.normal, state::velocity_at(bodies, body, anchor));
  };
  return std::any_of(manifold.point.begin(), manifold.point.begin() + manifold.point_count,
                     [&](const state::ContactPoint& p) {
                       const Real parting =
                           speed(manifold.body_b, p.anchor_b) - speed(manifold.body_a, p.anchor_a);
                       return p.separation + dt * parting < Real(0);
                     });
}

bool sleeps(const Bodies& bodies, std::uint32_t body) {
  return body != state::HookPlace::kWorld && bodies.asleep[body] != 0;
}

/// Whether a body is awake and moves; a kinematic body that stands still wakes no other.
bool disturbs(const Bodies& bodies, std::uint32_t body) {
  if (body == state::HookPlace::kWorld || bodies.traits[body].kind == BodyKind::kStatic ||
      bodies.asleep[body] != 0)
    return false;
  return is_dynamic(bodies, body) || bodies.motion[body].v != Vec3{} ||
         bodies.angular_velocity[body] != Vec3{};
}

/// A particle wakes a sleeping body if it is faster than this [m/s] and presses on it.
constexpr Real kWakingSpeed = Real(0.2);

/// Share of its weight with which deformables may push a body that sleeps [ratio]. What bears a body or loads
/// it never comes quite to rest: a plate that slept on a jelly became a wall, which the jelly was then
/// pressed against, and a ball that slept on a net stayed in the air when the net sank. Smaller: a cloth that
/// lies on a heavy body keeps it awake.
constexpr Real kSleeperLoad = Real(0.1);

/// Calls visit(body, force, normal, particles) with each contact of points of deformables.
template <class Visit>
void for_point_contacts(const state::Tables& t, const Visit& visit) {
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    visit(t.contacts.body[row], t.contacts.normal_force[row], t.contacts.normal[row],
          std::span(t.contacts.particle).subspan(row, 1));
  }
  for (const state::ElementContact& contact : t.element_contacts) {
    visit(contact.body, contact.normal_force, contact.normal,
          std::span(contact.particle).first(contact.count));
  }
}

/// Sums up how deformables push each body.
void find_pushes(WorldData& world) {
  std::vector<Vec3>& pushes = world.frame.pushes;
  pushes.assign(world.tables.bodies.motion.size(), {});
  for_point_contacts(world.tables, [&](std::uint32_t body, Real force, Vec3 normal, auto&&) {
    pushes[body] -= force * normal;  // The normal points from the body to the deformable.
  });
}

/// Whether deformables bear a dynamic body, or load it.
bool is_pushed(const WorldData& world, std::uint32_t body) {
  const Bodies& bodies = world.tables.bodies;
  const Real gravity = length(world.tables.desc.gravity) * std::abs(bodies.traits[body].gravity_scale);
  return length(world.frame.pushes[body]) * bodies.motion[body].inverse_mass > kSleeperLoad * gravity;
}

/// Wakes the sleeping bodies that fast particles press on, and those that deformables push. A cloth that lies
/// still on a body does not wake it. Returns whether any woke.
bool wake_by_particles(WorldData& world) {
  state::Tables& t = world.tables;
  bool any = false;
  find_pushes(world);
  for_point_contacts(t, [&](std::uint32_t body, Real force, Vec3 /*normal*/, auto&& particles) {
    if (!is_dynamic(t.bodies, body) || t.bodies.asleep[body] == 0 || !(force > Real(0))) return;
    const bool is_hit = std::any_of(particles.begin(), particles.end(), [&](std::uint32_t p) {
      return length(t.particles.velocity[p].v) > kWakingSpeed;
    });
    if (!is_hit && !is_pushed(world, body)) return;
    state::wake(t.bodies, body);
    any = true;
  });
  return any;
}

/// Lets no body rest that deformables push.
void keep_pushed_awake(WorldData& world) {
  state::Tables& t = world.tables;
  if (t.contacts.particle.empty() && t.element_contacts.empty()) return;
  find_pushes(world);
  for (const std::uint32_t body : world.frame.awake) {
    if (is_dynamic(t.bodies, body) && is_pushed(world, body)) t.bodies.rest_time[body] = Real(0);
  }
}

/// Moves the pairs of bodies that woke from the sleeping pairs back to the pairs of the step.
void take_pairs_back(WorldData& world) {
  state::Tables& t = world.tables;
  state::wake_pairs(t.moving_bodies, t.bodies, t.colliders, t.pairs, world.frame.sleeping_pair_scratch);
}

/// Finds for how long each island has been at rest: the shortest time of its members, stored at its root.
void find_rest_of_islands(WorldData& world) {
  const Bodies& bodies = world.tables.bodies;
  world.frame.island_rest.assign(bodies.motion.size(), std::numeric_limits<Real>::infinity());
  for (const std::uint32_t body : world.frame.awake) {
    if (!is_dynamic(bodies, body)) continue;
    const Real own = bodies.traits[body].can_sleep ? bodies.rest_time[body] : Real(0);
    Real& least = world.frame.island_rest[world.frame.islands.root(body)];
    least = std::min(least, own);
  }
}

}  // namespace

bool wake_touched(WorldData& world, Real dt) {
  if (!any_sleeps(world)) return false;
  Bodies& bodies = world.tables.bodies;
  bool any = wake_by_particles(world);
  if (world.frame.awake.empty() && !any) return false;
  for (bool changed = true; changed;) {
    changed = false;
    if (any) take_pairs_back(world);
    for (const Manifold& m : world.tables.pairs.manifold) {
      const bool sleeper_a = bodies.asleep[m.body_a] != 0;
      const bool sleeper_b = bodies.asleep[m.body_b] != 0;
      if (sleeper_a == sleeper_b || !(touches(m) || will_touch(bodies, m, dt))) continue;
      if (!disturbs(bodies, sleeper_a ? m.body_b : m.body_a)) continue;
      state::wake(bodies, sleeper_a ? m.body_a : m.body_b);
      changed = any = true;
    }
    for (const state::Hook& hook : world.tables.hooks) {
      const bool sleeper_a = sleeps(bodies, hook.a.body);
      const bool sleeper_b = sleeps(bodies, hook.b.body);
      if (sleeper_a == sleeper_b || !disturbs(bodies, sleeper_a ? hook.b.body : hook.a.body)) continue;
      state::wake(bodies, sleeper_a ? hook.a.body : hook.b.body);
      changed = any = true;
    }
  }
  return any;
}

void put_to_sleep(WorldData& world, Real dt) {
  state::Tables& t = world.tables;
  Bodies& bodies = t.bodies;
  if (!t.desc.sleeping || world.frame.awake.empty()) return;
  for (const state::Hook& hook : t.hooks) {
    if (hook.holds_point()) wake_ends(hook, bodies);  // Ropes and cloths never rest.
  }
  for (const std::uint32_t body : world.frame.awake) {
    const Real speed =
        length(bodies.motion[body].v) + length(bodies.angular_velocity[body]) * bodies.traits[body].radius;
    bodies.rest_time[body] = speed < kRestSpeed ? bodies.rest_time[body] + dt : Real(0);
  }
  keep_pushed_awake(world);
  const bool any_rests =
      std::any_of(world.frame.awake.begin(), world.frame.awake.end(),
                  [&](std::uint32_t body) { return !(bodies.rest_time[body] < kRestTime); });
  if (!any_rests) return;
  base::DisjointSets& islands = world.frame.islands;
  islands.reset(bodies.motion.size());
  for (const Manifold& m : t.pairs.manifold) {
    if (touches(m) && is_dynamic(bodies, m.body_a) && is_dynamic(bodies, m.body_b))
      islands.merge(m.body_a, m.body_b);
  }
  for (const state::Hook& hook : t.hooks) {
    if (is_dynamic(bodies, hook.a.body) && is_dynamic(bodies, hook.b.body))
      islands.merge(hook.a.body, hook.b.body);
  }
  find_rest_of_islands(world);
  for (const std::uint32_t body : world.frame.awake) {
    if (!is_dynamic(bodies, body) || world.frame.island_rest[islands.root(body)] < kRestTime) continue;
    bodies.asleep[body] = 1;
    world.derived.placed_bodies.push_back(body);  // Its box is still that of its last displacement.
    bodies.motion[body].v = {};
    bodies.angular_momentum[body] = {};
    bodies.angular_velocity[body] = {};
    bodies.free_motion[body] = {};
  }
}

void wake_within(const geometry::Box& box, state::Tables& t) {
  for (const std::uint32_t body : t.moving_bodies) {
    if (t.bodies.asleep[body] == 0) continue;
    for (const std::uint32_t collider : state::colliders_of(t.bodies, body)) {
      if (overlap(t.colliders.bounds[collider], box)) state::wake(t.bodies, body);
    }
  }
}

void wake_near_points(const state::Deformable& object, state::Tables& t) {
  const auto sleeps = [&](std::uint32_t body) { return t.bodies.asleep[body] != 0; };
  if (std::none_of(t.moving_bodies.begin(), t.moving_bodies.end(), sleeps)) return;
  constexpr Real kNear = Real(0.01);  // Distance within which a body counts as touched [m].
  geometry::Box3<double> around;
  for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
    const state::PositionRecord& record = t.particles.position[p];
    const auto size = static_cast<double>(record.radius + kNear);
    const DVec3 place = object.origin + vector_cast<double>(record.x);
    const DVec3 half = {size, size, size};
    around = merge(around, geometry::Box3<double>{place - half, place + half});
  }
  wake_within({vector_cast<Real>(around.lower), vector_cast<Real>(around.upper)}, t);
}

void wake_near_body(std::uint32_t body, state::Tables& t) {
  const state::BodyTraits& traits = t.bodies.traits[body];
  if (traits.kind == BodyKind::kDynamic || !traits.collides || traits.sensor) return;
  for (const std::uint32_t collider : colliders_of(t.bodies, body))
    wake_within(collision::reach_of(t.bodies, t.colliders, collider, Real(0)), t);
}

}  // namespace hooke::world
