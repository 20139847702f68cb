#include "world/stepping.h"

#include "base/assert.h"
#include "state/check_contacts.h"
#include "state/check_tables.h"
#include "world/events.h"

#include <algorithm>

namespace hooke::world {

namespace {

void put_bodies_back(WorldData& world) {
  state::Bodies& b = world.tables.bodies;
  for (const std::uint32_t row : world.tables.moving_bodies) {
    // Bodies that slept are where they were and have no velocity.
    b.motion[row] = {.inverse_mass = b.motion[row].inverse_mass};
    b.free_motion[row] = {};
    b.frozen_inertia[row] = {};
    b.angular_momentum[row] = b.angular_velocity[row] = {};
    b.asleep[row] = 1;
  }
  for (const StartOfBody& start : world.frame.start_bodies) {
    const std::uint32_t row = start.row;
    b.rest_time[row] = start.rest_time;
    b.center[row] = start.center;
    b.rotation[row] = start.rotation;
    b.motion[row].v = start.v;
    b.angular_momentum[row] = start.angular_momentum;
    b.angular_velocity[row] = start.angular_velocity;
    b.force[row] = start.force;
    b.torque[row] = start.torque;
    b.asleep[row] = 0;
  }
}

void put_points_back(WorldData& world) {
  state::Tables& t = world.tables;
  HOOKE_ASSERT(world.frame.start_position.size() == t.particles.position.size());
  HOOKE_ASSERT(world.frame.start_origin.size() == t.objects.size());
  std::copy(world.frame.start_position.begin(), world.frame.start_position.end(),
            t.particles.position.begin());
  std::copy(world.frame.start_velocity.begin(), world.frame.start_velocity.end(),
            t.particles.velocity.begin());
  for (std::size_t i = 0; i < t.objects.size(); ++i) t.objects[i].origin = world.frame.start_origin[i];
}

/// Clears all that the next step finds or derives again, since the broken step may have left it half done.
void reset_contacts(WorldData& world) {
  state::Tables& t = world.tables;
  t.pairs = {};
  t.contacts = {};
  t.element_contacts.clear();
  t.rope_contacts.clear();
  for (state::Hook& hook : t.hooks) {
    hook.broken = false;
    hook.giving = state::Hook::Giving::kHolds;
  }
  for (state::SegmentHold& hold : t.segments.hold) {
    if (hold == state::SegmentHold::kBroken) hold = state::SegmentHold::kHolds;
  }
  state::note_change_of_all(t);  // Copies of rows that yield may be half changed.
  ++t.hook_revision;
  world.derived.broad_phase_stale = true;
  world.derived.placed_bodies.clear();
  world.derived.boxes_are_current = false;
  clear_events(world.last_step.events);
}

}  // namespace

void note_start(WorldData& world) {
  const state::Tables& t = world.tables;
  world.frame.start_position = t.particles.position;
  world.frame.start_velocity = t.particles.velocity;
  world.frame.start_origin.clear();
  for (const state::Deformable& object : t.objects) world.frame.start_origin.push_back(object.origin);
  const state::Bodies& b = t.bodies;
  world.frame.start_bodies.clear();
  for (const std::uint32_t row : t.moving_bodies) {
    if (b.asleep[row] != 0) continue;
    world.frame.start_bodies.push_back({.row = row,
                                        .rest_time = b.rest_time[row],
                                        .center = b.center[row],
                                        .rotation = b.rotation[row],
                                        .v = b.motion[row].v,
                                        .angular_momentum = b.angular_momentum[row],
                                        .angular_velocity = b.angular_velocity[row],
                                        .force = b.force[row],
                                        .torque = b.torque[row]});
  }
}

Stepping::Stepping(WorldData& world) : world_(world) {
  state::check_tables(world.tables);  // This covers the calls since the last step.
  note_start(world);
  world.stepping = true;
}

void Stepping::end() {
  ended_ = true;
  state::check_tables(world_.tables);
  HOOKE_VALIDATE(state::find_in_sleepers(world_.tables));
}

Stepping::~Stepping() {
  world_.stepping = false;
  if (ended_) return;
  put_bodies_back(world_);
  put_points_back(world_);
  reset_contacts(world_);
}

}  // namespace hooke::world
