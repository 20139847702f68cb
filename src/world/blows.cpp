#include "world/blows.h"

#include "base/assert.h"
#include "solver/contact/body_contacts.h"
#include "state/body_frames.h"
#include "world/soft_bodies.h"
#include "world/stepping.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <vector>

namespace hooke::world {

namespace {

using state::Bodies;
using state::Tables;

/// Share of YieldsDesc::impulse that two bodies on their way to each other must be able to give for the step
/// to be watched [ratio]. Larger: bodies that others push from behind yield a step too late. Smaller: more
/// copies. Chosen by hand; no measurement is recorded.
constexpr double kRisk = 0.25;
/// How often one step is taken back. What yields beyond that does so at its end. Larger: a step with many
/// blows takes as many times as long. Smaller: more bodies take the whole blow as rigid ones.
constexpr int kMostReturns = 8;

/// Angular velocity of a dynamic body between steps, as an upper bound of its size [rad/s].
double most_spin(const Bodies& b, std::uint32_t body) {
  if (!is_dynamic(b, body)) return static_cast<double>(length(b.angular_velocity[body]));
  const Vec3 inertia = b.mass[body].inertia;
  const Real least = std::min({inertia.x, inertia.y, inertia.z});
  return static_cast<double>(length(b.angular_momentum[body]) / least);
}

/// Largest speed of a point of a body [m/s], as an upper bound.
double most_speed(const Bodies& b, std::uint32_t body) {
  return static_cast<double>(length(b.motion[body].v)) +
         most_spin(b, body) * static_cast<double>(b.traits[body].radius);
}

/// Whether `other` may come to a body within the step, fast enough to give it the impulse.
bool may_hit(const Bodies& b, std::uint32_t body, std::uint32_t other, double impulse, double dt) {
  const double speed = most_speed(b, body) + most_speed(b, other);
  const auto m = static_cast<double>(b.mass[body].mass);
  const auto n = static_cast<double>(b.mass[other].mass);
  const double mass = is_dynamic(b, other) ? m * n / (m + n) : m;
  if (speed * mass < kRisk * impulse) return false;
  const double reach = static_cast<double>(b.traits[body].radius + b.traits[other].radius) + 2 * speed * dt;
  return length(b.center[body] - b.center[other]) <= reach;
}

bool is_at_risk(const Tables& t, const state::Yielding& yielding, double dt) {
  const Bodies& b = t.bodies;
  const std::uint32_t body = yielding.body;
  const auto impulse = static_cast<double>(yielding.desc.impulse);
  if (most_speed(b, body) * static_cast<double>(b.mass[body].mass) >= kRisk * impulse) return true;
  return std::any_of(t.moving_bodies.begin(), t.moving_bodies.end(), [&](std::uint32_t other) {
    return other != body && b.asleep[other] == 0 && may_hit(b, body, other, impulse, dt);
  });
}

void keep_copy(WorldData& world, double dt) {
  const Tables& t = world.tables;
  const auto at_risk = [&](const state::Yielding& y) { return !y.is_soft() && is_at_risk(t, y, dt); };
  world.blows.may_return =
      world.blows.returns < kMostReturns && std::any_of(t.yielding.begin(), t.yielding.end(), at_risk);
  if (!world.blows.may_return) return;
  if (!world.blows.before) world.blows.before = std::make_unique<Tables>();
  *world.blows.before = t;
}

BlowSum& sum_of(std::vector<BlowSum>& sums, std::uint32_t yielding, std::uint32_t other) {
  for (BlowSum& sum : sums) {
    if (sum.yielding == yielding && sum.other == other) return sum;
  }
  return sums.emplace_back(BlowSum{.yielding = yielding, .other = other});
}

/// Adds the impulse that one contact gave in a substep.
void add_blow(BlowSum& sum, Real impulse, DVec3 place) {
  sum.impulse += impulse;
  if (!(impulse > sum.largest)) return;
  sum.largest = impulse;
  sum.place = place;
}

/// Adds what contacts of bodies gave to those that yield.
void add_body_contacts(WorldData& world) {
  const Tables& t = world.tables;
  const solver::BodyContacts& contacts = world.frame.body_contacts;
  for (std::size_t index = 0; index < contacts.blocks.size(); ++index) {
    const solver::ContactBlock& block = contacts.blocks[index];
    for (int lane = 0; lane < block.count; ++lane) {
      const state::Manifold& m =
          t.pairs
              .manifold[contacts.manifold_of[solver::kContactLanes * index + static_cast<std::size_t>(lane)]];
      for (const auto& [body, other, is_a] :
           {std::tuple(m.body_a, m.body_b, true), std::tuple(m.body_b, m.body_a, false)}) {
        const std::uint32_t row = world.blows.row_of[body];
        if (row == Tables::kNoRow || t.yielding[row].is_soft() || m.point_count == 0) continue;
        Real impulse = Real(0);
        for (int k = 0; k < block.point_count; ++k) impulse += block.point[k].impulse[lane];
        BlowSum& sum = sum_of(world.blows.sums, row, other | kIsBody);
        const Vec3 anchor = is_a ? m.point[0].anchor_a : m.point[0].anchor_b;
        add_blow(sum, impulse, state::pose_now(t.bodies, body).position + vector_cast<double>(anchor));
        sum.pushed = std::max(sum.pushed, block.pushed[lane]);
      }
    }
  }
}

/// Adds what points, edges and faces of deformables gave them in a substep of `h` [s].
void add_point_contacts(WorldData& world, Real h) {
  const Tables& t = world.tables;
  const auto add = [&](std::uint32_t body, std::uint32_t object, Real force, DVec3 place) {
    const std::uint32_t row = body < world.blows.row_of.size() ? world.blows.row_of[body] : Tables::kNoRow;
    if (row == Tables::kNoRow || t.yielding[row].is_soft() || !(force > Real(0))) return;
    add_blow(sum_of(world.blows.sums, row, object), force * h, place);
  };
  const auto place_of = [&](std::uint32_t object, std::uint32_t particle) {
    return t.objects[object].origin + vector_cast<double>(t.particles.position[particle].x);
  };
  for (std::size_t i = 0; i < t.contacts.particle.size(); ++i) {
    add(t.contacts.body[i], t.contacts.object[i], t.contacts.normal_force[i],
        place_of(t.contacts.object[i], t.contacts.particle[i]));
  }
  for (const state::ElementContact& c : t.element_contacts)
    add(c.body, c.object, c.normal_force, place_of(c.object, c.particle[0]));
}

Real impulse_of(const BlowSum& sum) {
  return std::max(sum.impulse, sum.pushed);
}

/// Makes those soft that were given too much, in order of their creation. Returns whether there were any.
bool soften_hit(WorldData& world, const std::vector<BlowSum>& sums, double time) {
  bool any = false;
  for (std::uint32_t row = 0; row < world.tables.yielding.size(); ++row) {
    const BlowSum* worst = nullptr;
    for (const BlowSum& sum : sums) {
      if (sum.yielding == row && (worst == nullptr || impulse_of(sum) > impulse_of(*worst))) worst = &sum;
    }
    if (worst == nullptr || !(impulse_of(*worst) > world.tables.yielding[row].desc.impulse)) continue;
    any |= soften(world, row, {.place = worst->place, .impulse = impulse_of(*worst), .time = time});
  }
  return any;
}

/// Puts the tables back. What is derived from them may have changed since: rows of what flows, for example.
void put_back(WorldData& world) {
  Tables& t = world.tables;
  const std::uint64_t revision = t.revision;
  const std::uint64_t hook_revision = t.hook_revision;
  t = *world.blows.before;
  t.revision = std::max(t.revision, revision);
  t.hook_revision = std::max(t.hook_revision, hook_revision) + 1;
  state::note_change_of_all(t);
  world.derived.broad_phase_stale = true;
  world.derived.placed_bodies.clear();
  world.derived.boxes_are_current = false;
}

}  // namespace

void watch_for_blows(WorldData& world, double dt) {
  world.last_step.events.yields.clear();
  world.last_step.events.freezes.clear();
  const Tables& t = world.tables;
  world.blows.may_return = false;
  world.blows.returns = 0;
  world.blows.sums.clear();
  if (t.yielding.empty()) return;
  world.blows.row_of.assign(t.bodies.traits.size(), Tables::kNoRow);
  for (std::uint32_t row = 0; row < t.yielding.size(); ++row) world.blows.row_of[t.yielding[row].body] = row;
  keep_copy(world, dt);
}

bool take_back_for_blows(WorldData& world, double dt, double time, Real h) {
  if (world.tables.yielding.empty()) return false;
  add_body_contacts(world);
  add_point_contacts(world, h);
  if (!world.blows.may_return) return false;
  const auto is_too_much = [&](const BlowSum& sum) {
    return impulse_of(sum) > world.tables.yielding[sum.yielding].desc.impulse;
  };
  if (std::none_of(world.blows.sums.begin(), world.blows.sums.end(), is_too_much)) return false;
  put_back(world);
  soften_hit(world, world.blows.sums, time);
  world.blows.sums.clear();
  ++world.blows.returns;
  note_start(world);
  keep_copy(world, dt);
  return true;
}

void soften_pressed(WorldData& world, double time) {
  if (world.blows.sums.empty()) return;
  soften_hit(world, world.blows.sums, time);
  world.blows.sums.clear();
}

}  // namespace hooke::world
