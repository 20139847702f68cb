/// The public API over bodies: adding, removing, reading, pushing.

#include "hooke/world.h"

#include "build/build.h"
#include "state/body_frames.h"
#include "world/hooks.h"
#include "world/objects.h"
#include "world/world_data.h"

#include <cmath>

namespace hooke {

namespace {

using state::Bodies;
using state::Tables;

constexpr std::uint32_t kNone = state::SlotTable<BodyId>::kNone;

Vec3 angular_velocity_of(const Bodies& bodies, std::uint32_t row) {
  if (!is_dynamic(bodies, row)) return bodies.angular_velocity[row];
  const Quat axes = bodies.rotation[row] * bodies.mass[row].principal;
  const Vec3 inertia = bodies.mass[row].inertia;
  const Vec3 l = rotate(conjugate(axes), bodies.angular_momentum[row]);
  return rotate(axes, {l.x / inertia.x, l.y / inertia.y, l.z / inertia.z});
}

/// From the center of mass to a place in the world.
Vec3 lever(const Bodies& bodies, std::uint32_t row, DVec3 at) {
  return vector_cast<Real>(at - bodies.center[row]);
}

}  // namespace

Result<BodyId> World::add_body(const BodyDesc& desc) {
  Tables& t = data_->tables;
  const Result<std::uint32_t> row = build::add_body(desc, t);
  if (!row) return row.error();
  const BodyId id = t.body_slots.add(row.value());
  t.bodies.slot[row.value()] = id.slot;
  data_->bodies_placed.push_back(row.value());
  return id;
}

bool World::remove(BodyId id) {
  Tables& t = data_->tables;
  const std::uint32_t row = t.body_slots.find(id);
  if (row == kNone) return false;
  world::wake_neighbors(t, row);
  const std::uint32_t first = t.bodies.first_collider[row];
  for (std::uint32_t i = 0; i < t.bodies.collider_count[row]; ++i) data_->broad_phase.remove(first + i);
  std::erase(data_->bodies_placed, row);
  world::remove_hooks_of(row, t);
  build::remove_body(row, t);
  t.body_slots.move(id.slot, kNone);
  t.contacts = {};  // detect finds those that remain again
  return true;
}

Pose World::pose(BodyId id) const {
  const std::uint32_t row = data_->tables.body_slots.find(id);
  return row == kNone ? Pose{} : state::frame_of_body(data_->tables.bodies, row);
}

Vec3 World::velocity(BodyId id) const {
  const std::uint32_t row = data_->tables.body_slots.find(id);
  return row == kNone ? Vec3{} : data_->tables.bodies.motion[row].v;
}

Vec3 World::angular_velocity(BodyId id) const {
  const std::uint32_t row = data_->tables.body_slots.find(id);
  return row == kNone ? Vec3{} : angular_velocity_of(data_->tables.bodies, row);
}

DVec3 World::center_of_mass(BodyId id) const {
  const std::uint32_t row = data_->tables.body_slots.find(id);
  return row == kNone ? DVec3{} : data_->tables.bodies.center[row];
}

Real World::mass(BodyId id) const {
  const std::uint32_t row = data_->tables.body_slots.find(id);
  return row == kNone ? Real(0) : data_->tables.bodies.mass[row].mass;
}

bool World::asleep(BodyId id) const {
  const std::uint32_t row = data_->tables.body_slots.find(id);
  return row != kNone && data_->tables.bodies.asleep[row] != 0;
}

std::vector<BodyContact> World::body_contacts() const {
  const Tables& t = data_->tables;
  const auto id_of = [&](std::uint32_t body) { return t.body_slots.id_of(t.bodies.slot[body]); };
  const auto h = static_cast<Real>(t.body_substep);
  std::vector<BodyContact> contacts;
  for (const state::Manifold& m : t.pairs.manifold) {
    for (int i = 0; m.touching && i < m.point_count; ++i) {
      const state::ContactPoint& p = m.point[i];
      const DVec3 on_a = t.bodies.center[m.body_a] + vector_cast<double>(p.anchor_a);
      const DVec3 on_b = t.bodies.center[m.body_b] + vector_cast<double>(p.anchor_b);
      contacts.push_back({.a = id_of(m.body_a),
                          .b = id_of(m.body_b),
                          .point = 0.5 * (on_a + on_b),
                          .normal = m.normal,
                          .separation = p.separation,
                          .normal_force = h > Real(0) ? p.normal_impulse / h : Real(0)});
    }
  }
  return contacts;
}

Result<void> World::apply_force(BodyId body, Vec3 force) {
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  return apply_force(body, force, data_->tables.bodies.center[row]);
}

Result<void> World::apply_force(BodyId body, Vec3 force, DVec3 at) {
  Bodies& bodies = data_->tables.bodies;
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (!is_finite(force)) return world::not_finite("force");
  if (!is_finite(at)) return world::not_finite("at");
  bodies.force[row] += force;
  bodies.torque[row] += cross(lever(bodies, row, at), force);
  state::wake(bodies, row);
  return {};
}

Result<void> World::apply_torque(BodyId body, Vec3 torque) {
  Bodies& bodies = data_->tables.bodies;
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (!is_finite(torque)) return world::not_finite("torque");
  bodies.torque[row] += torque;
  state::wake(bodies, row);
  return {};
}

Result<void> World::apply_impulse(BodyId body, Vec3 impulse) {
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  return apply_impulse(body, impulse, data_->tables.bodies.center[row]);
}

Result<void> World::apply_impulse(BodyId body, Vec3 impulse, DVec3 at) {
  Bodies& bodies = data_->tables.bodies;
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (!is_finite(impulse)) return world::not_finite("impulse");
  if (!is_finite(at)) return world::not_finite("at");
  if (!is_dynamic(bodies, row)) return {};
  bodies.motion[row].v += bodies.mass[row].inverse_mass * impulse;
  bodies.angular_momentum[row] += cross(lever(bodies, row, at), impulse);
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_velocity(BodyId body, Vec3 velocity) {
  Bodies& bodies = data_->tables.bodies;
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (!is_finite(velocity)) return world::not_finite("velocity");
  if (bodies.traits[row].kind != BodyKind::kStatic) bodies.motion[row].v = velocity;
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_angular_velocity(BodyId body, Vec3 angular_velocity) {
  Bodies& bodies = data_->tables.bodies;
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (!is_finite(angular_velocity)) return world::not_finite("angular_velocity");
  if (bodies.traits[row].kind == BodyKind::kStatic) return {};
  bodies.angular_velocity[row] = angular_velocity;
  bodies.angular_momentum[row] =
      state::angular_momentum_of(bodies.mass[row], bodies.rotation[row], angular_velocity);
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_pose(BodyId body, const Pose& pose) {
  Bodies& bodies = data_->tables.bodies;
  const std::uint32_t row = data_->tables.body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (!is_finite(pose.position)) return world::not_finite("pose.position");
  const Quat rotation = normalize(pose.rotation);
  if (!std::isfinite(rotation.x + rotation.y + rotation.z + rotation.w)) {
    return world::not_finite("pose.rotation");
  }
  const Vec3 omega = angular_velocity_of(bodies, row);
  bodies.rotation[row] = rotation;
  bodies.center[row] = pose.position + vector_cast<double>(rotate(rotation, bodies.mass[row].center));
  bodies.angular_momentum[row] = state::angular_momentum_of(bodies.mass[row], rotation, omega);
  bodies.path_start[row] = bodies.center[row];
  bodies.path_time[row] = data_->tables.time;
  bodies.odometer[row] += Real(1e6);  // farther than any gap: every pair is tested anew
  data_->bodies_placed.push_back(row);
  world::wake_neighbors(data_->tables, row);
  state::wake(bodies, row);
  return {};
}

}  // namespace hooke
