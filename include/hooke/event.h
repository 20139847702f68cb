#pragma once

#include "hooke/id.h"
#include "hooke/math.h"

#include <vector>

/// \file
/// What happened in a step, for those who asked: see BodyDesc::reports_contacts, hit_speed, sensor.

namespace hooke {

/// Two parts of bodies that touch; `a` was created before `b`.
struct ContactEvent {
  BodyPart a = {};
  BodyPart b = {};

  friend constexpr bool operator==(const ContactEvent&, const ContactEvent&) = default;
};

/// Two parts of bodies that met at a speed. A body that meets others in several directions at once, as in the
/// corner of a mesh, hits once in each.
struct HitEvent {
  BodyPart a = {};  ///< Created before `b`.
  BodyPart b = {};
  DVec3 point = {};        ///< Where they met [m].
  Vec3 normal = {};        ///< From a to b.
  Real speed = Real(0);    ///< Along the normal, with which they came together [m/s].
  Real impulse = Real(0);  ///< Along the normal [N s]: the largest of a substep, and what bouncing added.
};

struct SensorEvent {
  BodyId sensor = {};
  BodyId visitor = {};

  friend constexpr bool operator==(const SensorEvent&, const SensorEvent&) = default;
};

/// A hook that broke, as it needed more than its break_force or break_torque. It is gone: its id is stale.
struct BreakEvent {
  HookId hook = {};
  Real force = Real(0);   ///< That it needed, mean over the substep in which it broke [N].
  Real torque = Real(0);  ///< The same [N m].
  double time = 0;        ///< Of the world, at the end of that substep [s].
};

/// Each list is in order of the bodies' creation, and the same for any number of workers. A body that was
/// removed while it touched something or was in a sensor ends that in the next step: its id is stale then.
struct Events {
  std::vector<ContactEvent> contact_begins;
  std::vector<ContactEvent> contact_ends;
  std::vector<HitEvent> hits;
  std::vector<SensorEvent> sensor_enters;
  std::vector<SensorEvent> sensor_leaves;
  std::vector<BodyId> fell_asleep;
  std::vector<BodyId> woke_up;
  std::vector<BreakEvent> breaks;  ///< In order of time, then of the hooks' creation.
};

}  // namespace hooke
