#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "math/symmetric.h"
#include "state/objects.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

/// \file
/// Rigid bodies in columns. A row keeps its number as long as its body lives; a removed body leaves a hole
/// that the next one fills.

namespace hooke::state {

/// What the solver reads and writes of the motion of one body within a step, in one cache line.
///
/// Angular columns are scaled by the root of the inertia, which is constant within a step: with world inertia
/// I and S = I^(-1/2), omega_scaled = S^(-1) omega and theta_scaled = S^(-1) theta, where theta is the
/// rotation since the start of the step. Then a row with direction n at lever r has the angular Jacobian j =
/// S (r x n), an impulse lambda changes omega_scaled by lambda j, and the effective mass needs only |j|^2.
/// (docs/notation.md)
struct alignas(16 * sizeof(Real)) MotionRecord {
  Vec3 v = {};                  ///< Velocity of the center of mass [m/s].
  Vec3 omega_scaled = {};       ///< Scaled angular velocity [sqrt(J)].
  Vec3 dx = {};                 ///< Displacement of the center of mass since the start of the step [m].
  Vec3 theta_scaled = {};       ///< Scaled rotation since the start of the step [sqrt(kg) m].
  Real inverse_mass = Real(0);  ///< [1/kg]; 0: nothing moves the body, and no kernel writes its record.
  Real padding[3] = {};
};

/// Mass of a body about its center, in its own frame. All values are zero for bodies that nothing moves.
struct BodyMass {
  Vec3 center = {};             ///< Center of mass in the body's frame [m].
  Quat principal = {};          ///< Rotation from the principal axes of inertia to the body's frame.
  Vec3 inertia = {};            ///< Moments of inertia about the principal axes [kg m^2].
  Real mass = Real(0);          ///< [kg]
  Real inverse_mass = Real(0);  ///< [1/kg]
};

/// The velocities that a body would have if the contact rows of this substep had done nothing. The motion
/// record less these is what the rows did, and it is the warm start of the next substep. The layout is that
/// of the first half of a MotionRecord.
struct alignas(8 * sizeof(Real)) FreeMotionRecord {
  Vec3 v = {};             ///< Velocity of the center of mass [m/s].
  Vec3 omega_scaled = {};  ///< Scaled angular velocity [sqrt(J)].
  Real padding[2] = {};
};

/// A body has frozen inertia when it rotates so far within the step that its inertia in world axes changes,
/// and touches something in that step. Its contacts are then solved with the inertia at the time of the first
/// contact, and its angular velocity stays between contacts. So contacts alone decide its energy, but not its
/// angular momentum. A touching body that was not foreseen to rotate so far gets frozen inertia in the
/// substep in which it has. A body that spins so far on hooks keeps its angular velocity too, except for what
/// rows change.
struct FrozenInertia {
  bool on = false;
  bool touches = false;    ///< The body makes a gyroscopic turn and has contacts in this step.
  bool hooked = false;     ///< The body spins on hooks; it has the mean inertia of its rotation.
  Vec3 until_impact = {};  ///< Rotation until the first contact [rad].
};

/// Properties of a body that the step reads but does not change.
struct BodyTraits {
  BodyKind kind = BodyKind::kStatic;
  bool alive = false;  ///< False: the row is a hole.
  bool collides = true;
  bool sensor = false;
  bool bullet = false;
  bool can_sleep = true;
  bool reports_contacts = false;
  Real hit_speed = kRigid;  ///< Approach speed from which hits are reported [m/s].
  Real linear_damping = Real(0);
  Real angular_damping = Real(0);
  Real gravity_scale = Real(1);
  Real drag_coefficient = Real(0);
  Real magnus_volume = Real(0);  ///< Magnus coefficient times the volume of the shapes [m^3].
  Vec3 dipole_moment = {};       ///< Dipole moment in the body's frame [A m^2].
  Real radius = Real(0);         ///< Radius of the smallest sphere about the center of mass that holds all
                                 ///< shapes [m].
  Real inner_radius = Real(0);   ///< Radius of a sphere that fits into the largest shape, which says how thin
                                 ///< the body is [m].
  FilterDesc filter = {};
};

/// Columns of equal length; row i describes body i.
struct Bodies {
  static constexpr std::int8_t kNew = 127;  ///< A value of direct_state.

  std::vector<MotionRecord> motion;
  std::vector<DVec3> center;           ///< Center of mass at the start of the step [m].
  std::vector<Quat> rotation;          ///< Rotation of the body's frame at the start of the step; for bodies
                                       ///< in a gyroscopic turn, the rotation now
                                       ///< (solver/body/body_motion.h).
  std::vector<Vec3> angular_momentum;  ///< Angular momentum about the center of mass [kg m^2/s]: the state of
                                       ///< rotation.
  std::vector<Vec3> angular_velocity;  ///< Angular velocity at the start of the step [rad/s]; for kinematic
                                       ///< bodies, as given.
  std::vector<math::Symmetric3<Real>> scale;  ///< S = I^(-1/2) in world axes; written by prepare_bodies.
  std::vector<FrozenInertia> frozen_inertia;  ///< Written by begin_motion and freeze_inertia
                                              ///< (world/impact_clamp.h).
  std::vector<BodyMass> mass;
  std::vector<BodyTraits> traits;
  std::vector<Vec3> force;                    ///< External force for the current step [N]; cleared by finish.
  std::vector<Vec3> torque;                   ///< External torque for the current step [N m]; cleared by
                                              ///< finish.
  std::vector<FreeMotionRecord> free_motion;  ///< Used within one substep; written by the solver.
  std::vector<Real> rest_time;                ///< Time spent slower than the sleep threshold [s].
  std::vector<std::uint8_t> asleep;
  std::vector<std::uint8_t> slept;        ///< `asleep` at the end of the last step; written by gather_events.
  std::vector<std::int8_t> direct_state;  ///< Whether the contacts of the body are solved directly, and since
                                          ///< when (solver/coupled/direct_islands.h); kNew before its first
                                          ///< step.
  std::vector<std::uint32_t> first_collider;  ///< The body's colliders are consecutive rows.
  std::vector<std::uint32_t> collider_count;
  std::vector<std::uint32_t> slot;  ///< Slot of the body's id.
  std::vector<MotionDesc> path;     ///< Path of a kinematic body.
  std::vector<DVec3> path_start;    ///< Where the center was when the path began [m].
  std::vector<double> path_time;    ///< Time when the path began [s].
  std::vector<std::shared_ptr<const NamedPlaces>> connection_points;  ///< The body's own named places; null
                                                                      ///< for none.

  [[nodiscard]] int count() const { return static_cast<int>(motion.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.motion);
    visit(self.center);
    visit(self.rotation);
    visit(self.angular_momentum);
    visit(self.angular_velocity);
    visit(self.scale);
    visit(self.frozen_inertia);
    visit(self.mass);
    visit(self.traits);
    visit(self.force);
    visit(self.torque);
    visit(self.free_motion);
    visit(self.rest_time);
    visit(self.asleep);
    visit(self.slept);
    visit(self.direct_state);
    visit(self.first_collider);
    visit(self.collider_count);
    visit(self.slot);
    visit(self.path);
    visit(self.path_start);
    visit(self.path_time);
    visit(self.connection_points);
  }
};

/// Whether forces move the body; never the world (HookPlace::kWorld).
inline bool is_dynamic(const Bodies& bodies, std::uint32_t body) {
  return body < bodies.traits.size() && bodies.traits[body].kind == BodyKind::kDynamic;
}

/// Whether forces move the body now: it is dynamic and awake.
inline bool gives_way(const Bodies& bodies, std::uint32_t body) {
  return is_dynamic(bodies, body) && bodies.asleep[body] == 0;
}

/// The motion of a body after accelerate_bodies, without the contact impulses of the last substep that were
/// applied again. The solver may still take those back.
inline FreeMotionRecord motion_before_contacts(const Bodies& bodies, std::uint32_t body) {
  const MotionRecord& m = bodies.motion[body];
  if (gives_way(bodies, body)) return bodies.free_motion[body];
  return {.v = m.v, .omega_scaled = m.omega_scaled};
}

/// Consecutive rows, for range-based loops (clang 14 does not know std::views::iota of libstdc++ 12).
struct RowRange {
  struct Iterator {
    std::uint32_t row = 0;
    std::uint32_t operator*() const { return row; }
    Iterator& operator++() {
      ++row;
      return *this;
    }
    bool operator==(const Iterator&) const = default;
  };
  std::uint32_t first = 0;
  std::uint32_t last = 0;  ///< Excluded.
  [[nodiscard]] Iterator begin() const { return {first}; }
  [[nodiscard]] Iterator end() const { return {last}; }
};

/// The rows of a body's colliders.
inline RowRange colliders_of(const Bodies& bodies, std::uint32_t body) {
  const std::uint32_t first = bodies.first_collider[body];
  return {first, first + bodies.collider_count[body]};
}

/// The smaller inner radius of two bodies [m].
inline Real thinner_radius(const Bodies& bodies, std::uint32_t a, std::uint32_t b) {
  return std::min(bodies.traits[a].inner_radius, bodies.traits[b].inner_radius);
}

/// Velocity at the start of the step of the point at `anchor` from the center of mass [m/s].
inline Vec3 velocity_at(const Bodies& bodies, std::uint32_t body, Vec3 anchor) {
  return bodies.motion[body].v + cross(bodies.angular_velocity[body], anchor);
}

/// Velocity of that point in the middle of a step [m/s].
inline Vec3 velocity_now(const Bodies& bodies, std::uint32_t body, Vec3 anchor) {
  const MotionRecord& m = bodies.motion[body];
  return m.v + cross(bodies.scale[body] * m.omega_scaled, anchor);
}

/// Whether two bodies, or two deformables, may collide by their FilterDesc.
inline bool filters_agree(const FilterDesc& a, const FilterDesc& b) {
  if (a.group == b.group && a.group != 0) return a.group > 0;
  return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

/// Wakes a body and sets its rest time to zero.
inline void wake(Bodies& bodies, std::uint32_t body) {
  bodies.asleep[body] = 0;
  bodies.rest_time[body] = Real(0);
}

}  // namespace hooke::state
