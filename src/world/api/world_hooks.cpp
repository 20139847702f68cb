/// This file implements the public API over hooks: adding, removing, reading and driving them.

#include "hooke/world.h"

#include "build/build.h"
#include "build/checks.h"
#include "build/connection_points.h"
#include "build/hook_ends.h"
#include "collision/deformable/particle_contacts.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/joint_rows/joint_rows.h"
#include "world/api/undo.h"
#include "world/claim.h"
#include "world/hook_stages.h"
#include "world/object_edits.h"
#include "world/world_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke {

namespace {

using state::Hook;
using state::Tables;

const Hook* find_hook(const Tables& t, HookId id) {
  const std::uint32_t row = t.hook_slots.find(id);
  return row == t.hook_slots.kNone ? nullptr : &t.hooks[row];
}

/// Index of the freedom that a hook's kind moves; -1 for a kind with none or with several.
int main_freedom(HookKind kind) {
  switch (kind) {
    case HookKind::kHinge:
      return 3;
    case HookKind::kSlider:
    case HookKind::kDistance:
    case HookKind::kWheel:
      return 0;
    case HookKind::kBall:
    case HookKind::kFixed:
    case HookKind::kSixDegrees:
    case HookKind::kRopeSlide:
      break;
  }
  return -1;
}

Error no_such_freedom(const char* what) {
  return {ErrorCode::kUnsupported, what, "does not exist on a hook of this kind"};
}

/// Changes a hook and wakes what it holds. If the number of its rows changes, the stored impulses belong to
/// other rows and are cleared.
template <class Change>
Result<void> change_hook(Tables& t, HookId id, Change&& change) {
  const std::uint32_t row = t.hook_slots.find(id);
  if (row == t.hook_slots.kNone) return world::stale("hook");
  Hook& hook = t.hooks[row];
  const int rows_before = solver::count_joint_rows(hook);
  const Result<void> done = change(hook);
  if (!done) return done.error();
  if (solver::count_joint_rows(hook) != rows_before) hook.row_impulse = {};
  world::wake_ends(hook, t.bodies);
  ++t.hook_revision;
  return {};
}

/// Gives a new hook its id, and wakes what it holds. Points that are now inside the body at the other end are
/// listed, so that they do not touch it.
HookId enter_hook(Tables& t, std::size_t row) {
  Hook& hook = t.hooks[row];
  const HookId id = t.hook_slots.add(static_cast<std::uint32_t>(row));
  hook.slot = id.slot;
  collision::note_hooked_points(t, hook);
  world::wake_ends(hook, t.bodies);
  return id;
}

}  // namespace

Result<HookId> World::add_hook(const HookDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Tables& t = claim.tables();
  world::Undo undo(t);
  const Result<void> added = build::add_hook(desc, t);
  if (!added) return added.error();
  const HookId id = enter_hook(t, t.hooks.size() - 1);
  undo.keep();
  return id;
}

Result<std::vector<HookId>> World::sew(const SeamDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Tables& t = claim.tables();
  world::Undo undo(t);
  const Result<std::uint32_t> sewn = build::sew(desc, t);
  if (!sewn) return sewn.error();
  std::vector<HookId> stitches;
  for (std::size_t row = t.hooks.size() - sewn.value(); row < t.hooks.size(); ++row)
    stitches.push_back(enter_hook(t, row));
  undo.keep();
  return stitches;
}

bool World::remove(HookId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  Tables& t = claim.tables();
  const Hook* hook = find_hook(t, id);
  if (hook == nullptr) return false;
  world::wake_ends(*hook, t.bodies);
  ++t.hook_revision;
  return world::remove_row(t.hook_slots, id, t.hooks);
}

HookForce World::hook_force(HookId id) const {
  const world::Reading reading(data_);
  const Hook* hook = find_hook(reading.tables(), id);
  return hook == nullptr ? HookForce{} : HookForce{hook->force, hook->torque};
}

Real World::hook_value(HookId id) const {
  const world::Reading reading(data_);
  const Hook* hook = find_hook(reading.tables(), id);
  if (hook == nullptr || main_freedom(hook->kind) < 0) return Real(0);
  return static_cast<Real>(hook->value[main_freedom(hook->kind)]);
}

std::array<DVec3, 2> World::hook_anchors(HookId id) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const Hook* hook = find_hook(t, id);
  if (hook == nullptr) return {};
  const auto place = [&](const state::HookPlace& end) {
    const solver::JointBody body = solver::joint_end(t, end);
    return body.center + rotate(body.rotation, end.anchor);
  };
  return {place(hook->a), place(hook->b)};
}

std::vector<std::string> World::connection_points(const HookEnd& of) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const std::uint32_t object = state::object_row(t, of.point);
  const std::uint32_t body = t.body_slots.find(of.body);
  std::vector<std::string> names;
  const auto list = [&](const state::NamedPlaces& places) {
    for (const state::NamedPlace& place : places) names.push_back(place.name);
  };
  if (object != Tables::kNoRow) {
    list(*t.objects[object].connection_points);
  } else if (body != Tables::kNoRow) {
    list(build::connection_points_of_body(body, t));
  }
  return names;
}

Result<DVec3> World::find_place(const HookEnd& end) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const Result<build::FoundEnd> found = build::find_end(end, {}, "end", t);
  if (!found) return found.error();
  const std::uint32_t body = found.value().place.body;
  const bool nearest = end.connection_point.empty() && end.point.index == PointRef::kNearest;
  if (nearest || (!found.value().is_given && body == state::HookPlace::kWorld))
    return Error{ErrorCode::kOutOfRange, "end", "does not say which place is meant"};
  return found.value().is_given ? found.value().position : pose(end.body).position;
}

Real World::hook_gap(HookId id) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const Hook* hook = find_hook(t, id);
  return hook == nullptr ? Real(0) : static_cast<Real>(world::gap_of(*hook, t));
}

const std::vector<HookId>& World::broken_hooks() const {
  const world::Reading reading(data_);
  return reading->last_step.broken_hooks;
}

Result<void> World::set_motor(HookId id, const HookMotor& motor) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const Result<void> good = build::validate(motor);
  if (!good) return good.error();
  return change_hook(claim.tables(), id, [&](Hook& hook) -> Result<void> {
    if (hook.kind == HookKind::kBall) {
      for (int i = 3; i < 6; ++i) hook.freedom[i].motor = {Real(0), motor.max_force};
      hook.freedom[3].motor.speed = motor.speed;
      return {};
    }
    const int i = hook.kind == HookKind::kWheel ? 5 : main_freedom(hook.kind);
    if (i < 0) return no_such_freedom("motor");
    HookFreedom& freedom = hook.freedom[i];
    freedom.motor = motor;
    if (hook.kind == HookKind::kDistance && !build::is_closed(freedom.limits)) {
      freedom.locked = false;  // The motor changes the distance, so the hook is no longer a rigid rod.
      freedom = build::line_freedom(freedom, Real(0));
    }
    return {};
  });
}

Result<void> World::set_spring(HookId id, const HookSpring& spring) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const Result<void> good = build::validate(spring);
  if (!good) return good.error();
  return change_hook(claim.tables(), id, [&](Hook& hook) -> Result<void> {
    if (hook.kind == HookKind::kBall) {
      for (int i = 3; i < 6; ++i) hook.freedom[i].spring = {spring.stiffness, spring.damping};
      return {};
    }
    if (main_freedom(hook.kind) < 0) return no_such_freedom("spring");
    HookFreedom& freedom = hook.freedom[main_freedom(hook.kind)];
    if (build::is_closed(freedom.limits)) return {};  // It stays where its limits hold it.
    if (hook.kind == HookKind::kDistance) {
      freedom = build::line_freedom({.limits = freedom.limits, .spring = spring, .motor = freedom.motor},
                                    hook.rest_distance);
    } else {
      freedom.spring = spring;
    }
    return {};
  });
}

Result<void> World::set_steering(HookId id, Real angle) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const double most = limits::kSpin;
  if (auto good = build::Checks("").in_range("angle", static_cast<double>(angle), -most, most).result();
      !good)
    return good;
  return change_hook(claim.tables(), id, [&](Hook& hook) -> Result<void> {
    if (hook.kind != HookKind::kWheel) return no_such_freedom("steering");
    hook.freedom[3].spring.target = angle;
    return {};
  });
}

}  // namespace hooke
