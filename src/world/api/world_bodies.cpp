/// This file implements the public API over bodies: adding, removing, reading and pushing them.

#include "hooke/world.h"

#include "base/make_room.h"
#include "build/build.h"
#include "build/checks.h"
#include "math/rotation.h"
#include "solver/body/body_motion.h"
#include "state/body_frames.h"
#include "state/sleeping_pairs.h"
#include "world/claim.h"
#include "world/hook_stages.h"
#include "world/object_edits.h"
#include "world/sleep.h"
#include "world/soft_bodies.h"
#include "world/world_data.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hooke {

namespace {

using build::Checks;
using state::Bodies;
using state::Tables;

constexpr std::uint32_t kNone = state::SlotTable<BodyId>::kNone;

/// Angular velocity of a dynamic body with the angular momentum `momentum` [rad/s].
Vec3 angular_velocity_of(const Bodies& bodies, std::uint32_t row, Vec3 momentum) {
  return state::angular_velocity_of(bodies.mass[row], bodies.rotation[row], momentum);
}

Vec3 angular_velocity_of(const Bodies& bodies, std::uint32_t row) {
  if (!is_dynamic(bodies, row)) return bodies.angular_velocity[row];
  return angular_velocity_of(bodies, row, bodies.angular_momentum[row]);
}

/// Lever from the center of mass to the position `at` in the world [m].
Vec3 lever(const Bodies& bodies, std::uint32_t row, DVec3 at) {
  return vector_cast<Real>(at - bodies.center[row]);
}

/// The row of Tables::yielding of a body that is soft now, or null.
const state::Yielding* soft_row(const Tables& t, std::uint32_t body) {
  const std::uint32_t row = state::yielding_row(t, body);
  return row == Tables::kNoRow || !t.yielding[row].is_soft() ? nullptr : &t.yielding[row];
}

/// Pushes the points of a soft body as a rigid one would be pushed.
Result<void> push_soft(const state::Yielding& yielding, Vec3 force, Vec3 torque, Tables& t) {
  Result<void> good = world::check_force("force", force, force);
  if (good) good = world::check_force("torque", torque, torque);
  if (good) world::push_soft_body(yielding, force, torque, t);
  return good;
}

/// Adds a force and a torque that act during the next step, and wakes the body.
Result<void> push(Bodies& bodies, std::uint32_t row, Vec3 force, Vec3 torque) {
  const Vec3 force_in_all = bodies.force[row] + force;
  const Vec3 torque_in_all = bodies.torque[row] + torque;
  Result<void> good = world::check_force("force", force, force_in_all);
  if (good) good = world::check_force("torque", torque, torque_in_all);
  if (!good || !is_dynamic(bodies, row)) return good;
  bodies.force[row] = force_in_all;
  bodies.torque[row] = torque_in_all;
  state::wake(bodies, row);
  return {};
}

/// Appends the points of a manifold that touched, with the normal and friction as the body that was created
/// first sees them.
void append_contacts(const Tables& t, const state::Manifold& m, std::vector<BodyContact>& contacts) {
  const auto h = static_cast<Real>(t.body_substep);
  if (!m.touching || !(h > Real(0)) || m.point_count == 0) return;
  const BodyPart a = world::part_of(t, m.collider_a);
  const BodyPart b = world::part_of(t, m.collider_b);
  BodyContact contact = {
      .a = a.body,
      .b = b.body,
      .part_a = a.part,
      .part_b = b.part,
      .normal = m.normal,
      .friction_force = Real(1) / (h * static_cast<Real>(m.point_count)) * m.friction_impulse};
  if (world::is_swapped(t, m)) {
    std::swap(contact.a, contact.b);
    std::swap(contact.part_a, contact.part_b);
    contact.normal = -contact.normal;
    contact.friction_force = -contact.friction_force;
  }
  for (int i = 0; i < m.point_count; ++i) {
    const state::ContactPoint& p = m.point[i];
    const DVec3 on_a = t.bodies.center[m.body_a] + vector_cast<double>(p.anchor_a);
    const DVec3 on_b = t.bodies.center[m.body_b] + vector_cast<double>(p.anchor_b);
    contact.point = 0.5 * (on_a + on_b);
    contact.separation = p.separation;
    contact.normal_force = p.normal_impulse / h;
    contacts.push_back(contact);
  }
}

void sort_contacts(std::vector<BodyContact>& contacts) {
  const auto order = [](const BodyContact& c) { return std::tuple(c.a.slot, c.part_a, c.b.slot, c.part_b); };
  std::stable_sort(contacts.begin(), contacts.end(),
                   [&](const BodyContact& p, const BodyContact& q) { return order(p) < order(q); });
}

}  // namespace

BodyId BodyForceView::id(std::size_t i) const {
  return i < size() ? world::id_of(world_->tables, rows_[i]) : BodyId{};
}

Real BodyForceView::mass(std::size_t i) const {
  return i < size() ? world_->tables.bodies.mass[rows_[i]].mass : Real(0);
}

DVec3 BodyForceView::center_of_mass(std::size_t i) const {
  if (i >= size()) return {};
  const Bodies& b = world_->tables.bodies;
  return b.center[rows_[i]] + vector_cast<double>(b.motion[rows_[i]].dx);
}

Quat BodyForceView::rotation(std::size_t i) const {
  if (i >= size()) return {};
  const Bodies& b = world_->tables.bodies;
  return normalize(state::pose_now(b, rows_[i]).rotation);
}

Vec3 BodyForceView::velocity(std::size_t i) const {
  return i < size() ? world_->tables.bodies.motion[rows_[i]].v : Vec3{};
}

Vec3 BodyForceView::angular_velocity(std::size_t i) const {
  if (i >= size()) return {};
  const Bodies& b = world_->tables.bodies;
  return b.scale[rows_[i]] * b.motion[rows_[i]].omega_scaled;
}

void BodyForceView::add_force(std::size_t i, Vec3 force) {
  if (i < size()) world_->tables.bodies.force[rows_[i]] += force;
}

void BodyForceView::add_torque(std::size_t i, Vec3 torque) {
  if (i < size()) world_->tables.bodies.torque[rows_[i]] += torque;
}

Result<BodyId> World::add_body(const BodyDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Tables& t = claim.tables();
  t.body_slots.make_room();
  base::make_room(claim->derived.placed_bodies);
  const Result<std::uint32_t> row = build::add_body(desc, t);
  if (!row) return row.error();
  const BodyId id = t.body_slots.add(row.value());
  t.bodies.slot[row.value()] = id.slot;
  claim->derived.placed_bodies.push_back(row.value());
  claim->derived.boxes_are_current = false;
  world::wake_near_body(row.value(), t);
  return id;
}

bool World::remove(BodyId id) {
  return remove(std::span(&id, 1)) > 0;
}

std::size_t World::remove(std::span<const BodyId> ids) {
  const world::Claim claim(data_);
  if (!claim) return 0;
  Tables& t = claim.tables();
  std::vector<std::uint8_t> goes(t.bodies.traits.size(), 0);
  // All that may fail for lack of memory comes first.
  base::make_room(t.free_bodies, ids.size());
  base::make_room(t.free_colliders, ids.size());
  std::size_t count = 0;
  for (const BodyId id : ids) {
    const std::uint32_t row = t.body_slots.find(id);
    if (row == kNone) continue;
    for (const std::uint32_t collider : state::colliders_of(t.bodies, row))
      claim->derived.broad_phase.remove(collider);
    t.body_slots.move(id.slot, kNone);
    goes[row] = 1;
    ++count;
  }
  if (count == 0) return 0;
  world::wake_neighbors(t, [&](std::uint32_t row) { return goes[row] != 0; });
  world::remove_hooks_of(goes, t);
  world::remove_soft_forms_of(goes, t);
  std::erase_if(claim->derived.placed_bodies, [&](std::uint32_t row) { return goes[row] != 0; });
  build::remove_bodies(goes, t);
  t.contacts = {};  // Detect finds the remaining contacts again in the next step.
  t.element_contacts.clear();
  return count;
}

Pose World::pose(BodyId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().body_slots.find(id);
  return row == kNone ? Pose{} : state::frame_of_body(reading.tables().bodies, row);
}

Vec3 World::velocity(BodyId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().body_slots.find(id);
  return row == kNone ? Vec3{} : reading.tables().bodies.motion[row].v;
}

Vec3 World::angular_velocity(BodyId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().body_slots.find(id);
  return row == kNone ? Vec3{} : angular_velocity_of(reading.tables().bodies, row);
}

DVec3 World::center_of_mass(BodyId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().body_slots.find(id);
  return row == kNone ? DVec3{} : reading.tables().bodies.center[row];
}

Real World::mass(BodyId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().body_slots.find(id);
  if (row == kNone) return Real(0);
  const auto* soft = soft_row(reading.tables(), row);
  return soft != nullptr ? soft->mass.mass : reading.tables().bodies.mass[row].mass;
}

bool World::asleep(BodyId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().body_slots.find(id);
  return row != kNone && reading.tables().bodies.asleep[row] != 0;
}

std::vector<BodyContact> World::body_contacts() const {
  const world::Reading reading(data_);
  std::vector<BodyContact> contacts;
  state::for_each_manifold(reading.tables().pairs,
                           [&](const state::Manifold& m) { append_contacts(reading.tables(), m, contacts); });
  sort_contacts(contacts);
  return contacts;
}

std::vector<BodyContact> World::body_contacts(BodyId id) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const std::uint32_t row = t.body_slots.find(id);
  std::vector<BodyContact> contacts;
  if (row == kNone) return contacts;
  state::for_each_manifold(t.pairs, [&](const state::Manifold& m) {
    if (m.body_a == row || m.body_b == row) append_contacts(t, m, contacts);
  });
  sort_contacts(contacts);
  return contacts;
}

const Events& World::events() const {
  const world::Reading reading(data_);
  return reading->last_step.events;
}

std::vector<BodyId> World::visitors(BodyId sensor) const {
  const world::Reading reading(data_);
  std::vector<BodyId> visitors;
  for (const SensorEvent& visit : reading.tables().visits) {
    if (visit.sensor == sensor) visitors.push_back(visit.visitor);
  }
  return visitors;
}

Result<void> World::apply_force(BodyId body, Vec3 force) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  return apply_force(body, force, claim.tables().bodies.center[row]);
}

Result<void> World::apply_force(BodyId body, Vec3 force, DVec3 at) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (auto good = Checks("").place("at", at).result(); !good) return good;
  if (const auto* soft = soft_row(claim.tables(), row))
    return push_soft(*soft, force, cross(lever(bodies, row, at), force), claim.tables());
  return push(bodies, row, force, cross(lever(bodies, row, at), force));
}

Result<void> World::apply_torque(BodyId body, Vec3 torque) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (const auto* soft = soft_row(claim.tables(), row)) return push_soft(*soft, {}, torque, claim.tables());
  return push(bodies, row, {}, torque);
}

Result<void> World::apply_impulse(BodyId body, Vec3 impulse) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  return apply_impulse(body, impulse, claim.tables().bodies.center[row]);
}

Result<void> World::apply_impulse(BodyId body, Vec3 impulse, DVec3 at) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  Checks checks("");
  checks.within("impulse", impulse, limits::kForce, " N s").place("at", at);
  if (const auto* soft = soft_row(claim.tables(), row); soft != nullptr && checks.good()) {
    const Vec3 spin = world::soft_spin(*soft, cross(lever(bodies, row, at), impulse), claim.tables());
    world::change_soft_motion(*soft, Real(1) / soft->mass.mass * impulse, spin, claim.tables());
    return {};
  }
  if (!checks.good() || !is_dynamic(bodies, row)) return checks.result();
  const Vec3 v = bodies.motion[row].v + bodies.mass[row].inverse_mass * impulse;
  const Vec3 momentum = bodies.angular_momentum[row] + cross(lever(bodies, row, at), impulse);
  checks.within("impulse", v, limits::kSpeed, " m/s, the velocity that it gives")
      .within("impulse", angular_velocity_of(bodies, row, momentum), limits::kSpin,
              " rad/s, the angular velocity that it gives");
  if (!checks.good()) return checks.result();
  bodies.motion[row].v = v;
  bodies.angular_momentum[row] = momentum;
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_velocity(BodyId body, Vec3 velocity) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (auto good = Checks("").velocity("velocity", velocity).result(); !good) return good;
  if (const auto* soft = soft_row(claim.tables(), row)) {
    world::change_soft_motion(*soft, velocity - bodies.motion[row].v, {}, claim.tables());
    return {};
  }
  if (bodies.traits[row].kind != BodyKind::kStatic) bodies.motion[row].v = velocity;
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_angular_velocity(BodyId body, Vec3 angular_velocity) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  auto good = Checks("").within("angular_velocity", angular_velocity, limits::kSpin, " rad/s").result();
  if (!good) return good;
  if (const auto* soft = soft_row(claim.tables(), row)) {
    world::change_soft_motion(*soft, {}, angular_velocity - bodies.angular_velocity[row], claim.tables());
    return {};
  }
  if (bodies.traits[row].kind == BodyKind::kStatic) return {};
  bodies.angular_velocity[row] = angular_velocity;
  bodies.angular_momentum[row] =
      state::angular_momentum_of(bodies.mass[row], bodies.rotation[row], angular_velocity);
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_motion(BodyId body, const MotionDesc& motion) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  if (bodies.traits[row].kind != BodyKind::kKinematic) {
    return Error{ErrorCode::kOutOfRange, "body", "is not kinematic: only such a body moves as told"};
  }
  if (auto good = build::validate(motion, "motion"); !good) return good;
  bodies.path[row] = motion;
  bodies.path_start[row] = bodies.center[row];
  bodies.path_time[row] = claim.tables().time;
  if (motion.kind == MotionDesc::Kind::kStill) bodies.motion[row].v = {};
  state::wake(bodies, row);
  return {};
}

Result<void> World::set_pose(BodyId body, const Pose& pose) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Bodies& bodies = claim.tables().bodies;
  const std::uint32_t row = claim.tables().body_slots.find(body);
  if (row == kNone) return world::stale("body");
  auto good = Checks("pose")
                  .place("position", pose.position)
                  .require(build::is_rotation(pose.rotation), "rotation", "must be finite and not zero")
                  .result();
  if (!good) return good;
  if (const auto* soft = soft_row(claim.tables(), row)) {
    world::place_soft_body(*soft, pose, claim.tables());
    return {};
  }
  const Quat rotation = normalize(pose.rotation);
  const Vec3 omega = angular_velocity_of(bodies, row);
  bodies.rotation[row] = rotation;
  bodies.center[row] = pose.position + vector_cast<double>(rotate(rotation, bodies.mass[row].center));
  bodies.angular_momentum[row] = state::angular_momentum_of(bodies.mass[row], rotation, omega);
  bodies.path_start[row] = bodies.center[row];
  bodies.path_time[row] = claim.tables().time;
  claim->derived.placed_bodies.push_back(row);
  claim->derived.boxes_are_current = false;
  world::wake_neighbors(claim.tables(), [row](std::uint32_t near) { return near == row; });
  world::wake_near_body(row, claim.tables());
  state::wake(bodies, row);
  return {};
}

}  // namespace hooke
