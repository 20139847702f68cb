#pragma once

#include "hooke/id.h"
#include "hooke/math.h"

#include <cstdint>
#include <vector>

/// \file
/// What happened in a step. Contacts, hits and visits are listed of what asks for them: reports_contacts,
/// hit_speed, sensor. Breaks, tears, yields, freezes and sleep are listed always. World::cut tells what it
/// did by CutResult, and is no event.

namespace hooke {

/// Two parts of bodies that began or ceased to touch.
struct ContactEvent {
  BodyPart a = {};  ///< The part of the body that was created first.
  BodyPart b = {};  ///< The part of the other body.

  friend constexpr bool operator==(const ContactEvent&, const ContactEvent&) = default;
};

/// Two parts of bodies that met at a speed. A body that meets others in several directions at once, as in the
/// corner of a mesh, hits once in each.
struct HitEvent {
  BodyPart a = {};   ///< The part of the body that was created first.
  BodyPart b = {};   ///< The part of the other body.
  DVec3 point = {};  ///< Where they met, in the world [m].
  Vec3 normal = {};  ///< Direction from a to b, of unit length.
  /// Speed along the normal at which they came together [m/s].
  Real speed = Real(0);
  /// Impulse along the normal [N s]: the largest of any substep, plus what bouncing added.
  Real impulse = Real(0);
};

/// A deformable that began or ceased to touch a body, another deformable or itself, anywhere.
struct DeformableContactEvent {
  PointRef a = {};   ///< The deformable, as its point 0; of two the first in the order of Events.
  PointRef b = {};   ///< The other deformable likewise, or `a` itself; empty if it is a body.
  BodyId body = {};  ///< The body; null if it is a deformable.

  friend constexpr bool operator==(const DeformableContactEvent&, const DeformableContactEvent&) = default;
};

/// A deformable that met a body, another deformable or itself at a speed. Two objects have one in a step, of
/// the place where they met fastest.
struct DeformableHitEvent {
  PointRef a = {};       ///< As in DeformableContactEvent.
  PointRef b = {};       ///< Likewise.
  BodyId body = {};      ///< Likewise.
  DVec3 point = {};      ///< Where they met, in the world [m].
  Vec3 normal = {};      ///< Direction from a to the other, of unit length.
  Real speed = Real(0);  ///< Speed along the normal at which they came together there [m/s].
  /// Impulse along the normals of all places where they touched [N s]: the largest of any particle substep.
  Real impulse = Real(0);
};

/// A body that came into a sensor or left it.
struct SensorEvent {
  BodyId sensor = {};   ///< The body with BodyDesc::sensor.
  BodyId visitor = {};  ///< The body that came or left.

  friend constexpr bool operator==(const SensorEvent&, const SensorEvent&) = default;
};

/// A hook that broke because it needed more than its break_force or break_torque. It is gone: its id is
/// stale.
struct BreakEvent {
  HookId hook = {};       ///< The id that it had.
  Real force = Real(0);   ///< Force that it needed, as a mean over the substep in which it broke [N].
  Real torque = Real(0);  ///< Torque that it needed, as a mean over the same substep [N m].
  double time = 0;        ///< Time of the world at the end of that substep [s].
};

/// A segment of a rope that broke because it needed more than RopeDesc::strength.
struct RopeBreakEvent {
  RopeId rope = {};           ///< The rope, which goes on as two.
  std::uint32_t segment = 0;  ///< The segment between points `segment` and `segment` + 1.
  DVec3 point = {};           ///< Middle of these points at the end of the step [m].
  Real force = Real(0);       ///< Tension that it needed, as a mean over the substep in which it broke [N].
  double time = 0;            ///< Time of the world at the end of that substep [s].
};

/// A point of a cloth that split because the cloth was strained more than ClothDesc::strength or tear_strain
/// allow.
struct ClothTearEvent {
  ClothId cloth = {};       ///< The cloth.
  std::uint32_t point = 0;  ///< The point that split; it keeps its pin and its hooks.
  std::uint32_t added = 0;  ///< The point that the other side of the crack got: the cloth's last one then.
  DVec3 place = {};         ///< Where both were [m].
  Real strain = Real(0);    ///< Largest strain there.
  double time = 0;          ///< Time of the world at the end of the step [s].
  bool burst = false;       ///< The cloth was closed, and lost its gas by this tear.
};

/// A point of a solid that split because the solid was stressed more than SolidDesc::strength.
struct SolidTearEvent {
  SolidId solid = {};       ///< The solid.
  std::uint32_t point = 0;  ///< The point that split; it keeps its pin and its hooks.
  std::uint32_t added = 0;  ///< The point that the other side of the crack got: the solid's last one then.
  DVec3 place = {};         ///< Where both were [m].
  Real stress = Real(0);    ///< Largest principal stress there [Pa].
  double time = 0;          ///< Time of the world at the end of the step [s].
};

/// A body that became soft because something gave it more than YieldsDesc::impulse.
struct YieldEvent {
  BodyId body = {};        ///< The body; its id stays valid.
  SolidId solid = {};      ///< The solid that it is now (World::soft_form).
  DVec3 place = {};        ///< Where it was hit hardest [m].
  Real impulse = Real(0);  ///< Impulse along the normal that it would have got in this step, so far [N s].
  double time = 0;         ///< Time of the world at the end of the substep in which that was too much [s].
};

/// A body that was soft and became rigid again, with its new shape.
struct FreezeEvent {
  BodyId body = {};        ///< The body.
  SolidId solid = {};      ///< The solid that it was; its id is stale.
  DVec3 place = {};        ///< Center of mass of the body [m].
  Real impulse = Real(0);  ///< The impulse of its YieldEvent [N s].
  double time = 0;         ///< Time of the world at the end of the step [s].
};

/// All events of one step. Lists of bodies are in the order of the bodies' creation, and the same for any
/// number of workers. A body that was removed while it touched something, or was in a sensor, ends that in
/// the next step; its id is stale by then.
struct Events {
  /// Parts that began to touch; one body at least has reports_contacts.
  std::vector<ContactEvent> contact_begins;
  /// Parts that ceased to touch; one body at least has reports_contacts.
  std::vector<ContactEvent> contact_ends;
  std::vector<HitEvent> hits;  ///< Parts that met faster than hit_speed.
  /// Deformables that began to touch something; one of the two has reports_contacts. The three lists are in
  /// the order of a's kind, then of its creation, then of the other deformable or the body likewise.
  std::vector<DeformableContactEvent> deformable_begins;
  /// Deformables that ceased to touch something; one of the two has reports_contacts.
  std::vector<DeformableContactEvent> deformable_ends;
  std::vector<DeformableHitEvent> deformable_hits;  ///< What met faster than the lower hit_speed of the two.
  std::vector<SensorEvent> sensor_enters;           ///< Bodies that came into a sensor.
  std::vector<SensorEvent> sensor_leaves;           ///< Bodies that left a sensor.
  std::vector<BodyId> fell_asleep;                  ///< Bodies that fell asleep.
  std::vector<BodyId> woke_up;                      ///< Bodies that woke up.
  std::vector<BreakEvent> breaks;  ///< Hooks that broke, in order of time, then of the hooks' creation.
  /// Segments of ropes that broke, in order of time, then of the ropes' creation, then along the rope.
  std::vector<RopeBreakEvent> rope_breaks;
  /// Points of cloths that split, in order of cloths' creation, then of need, then those that hung by a point
  /// alone. What a cut had scored opens without an event: World::splits lists all.
  std::vector<ClothTearEvent> tears;
  /// Points of solids that split, likewise. What then hangs by an edge or a point alone comes apart without
  /// an event.
  std::vector<SolidTearEvent> solid_tears;
  std::vector<YieldEvent> yields;    ///< Bodies that became soft, in order of time, then of their creation.
  std::vector<FreezeEvent> freezes;  ///< Bodies that became rigid again, in order of their creation.
};

}  // namespace hooke
