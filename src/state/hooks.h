#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "state/route.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::state {

/// Where a hook holds an end: a body, the world, or up to four particles of one object, which move the place
/// between them by their weights.
struct HookPlace {
  static constexpr std::uint32_t kWorld = 0xFFFFFFFF;
  static constexpr std::uint32_t kMostParticles = 4;

  std::uint32_t body = kWorld;  ///< Row; a row keeps its number as long as its body lives.
  DVec3 anchor = {};  ///< From the center of mass, in the body's frame; of the world, in the world [m].
  Quat axes = {};     ///< From the hook's axes to the body's frame, or to the world.
  std::uint32_t object = 0;          ///< Row of the deformable, where there are particles.
  std::uint32_t particle_count = 0;  ///< Not 0: an end at particles; `body` is kWorld then and `anchor` zero.
  std::array<std::uint32_t, kMostParticles> particle = {};  ///< Rows.
  std::array<Real, kMostParticles> weight = {};             ///< With the sum 1.

  [[nodiscard]] bool is_point() const { return particle_count > 0; }
};

/// Two ends held together. What each kind leaves free is written out in `freedom` when the hook is made. What
/// every step looks at stands first, close together; impulses and values are the solver's.
struct Hook {
  /// A freedom has three rows at most: lock or spring, motor, limit.
  static constexpr int kMaxRows = 18;

  std::uint32_t slot = 0;  ///< Of its id.
  HookKind kind = HookKind::kBall;
  bool collide = false;
  bool broken = false;
  JointRoute route = JointRoute::kNone;  ///< How it is solved in this step; see solver/routes.h.
  HookPlace a = {};
  HookPlace b = {};
  Real break_force = kRigid;
  Vec3 impulse = {};                            ///< On b in the last substep [N s].
  Vec3 impulse_sum = {};                        ///< Over the step so far.
  Vec3 force = {};                              ///< On b, mean over the last step [N].
  std::array<double, 6> value = {};             ///< Of each freedom; angles also beyond whole turns.
  std::array<Real, kMaxRows> row_impulse = {};  ///< Of the last substep, in the order of its rows.

  Vec3 angular_impulse = {};  ///< [N m s]
  Vec3 angular_impulse_sum = {};
  Vec3 torque = {};  ///< [N m]
  Real break_torque = kRigid;
  // Of solver/joint/hook_breaks.h.
  enum class Giving : std::uint8_t {
    kHolds,
    kNothing,  ///< It takes nothing in this solution, which shows how fast its ends part then.
    kSome,     ///< Nearly what it can.
    kMost,     ///< What it can.
  };
  Giving giving = Giving::kHolds;
  std::array<double, 2> compliance = {};  ///< In series with its ways [1/kg] and angles [1/(kg m^2)].
  std::array<double, 2> most = {};        ///< What they take while it gives way [N s, N m s].
  Real needed_force = Real(0);            ///< In the substep in which it breaks [N].
  Real needed_torque = Real(0);           ///< [N m]
  double held = 0;                        ///< How long it has held in this step [s].
  Real last_impulse = Real(0);            ///< Of nets: what was needed in the substep before [N s].
  Real last_angular_impulse = Real(0);    ///< [N m s]
  // Of solver/joint/joint_energy.h, while something turns far.
  double energy_debt = 0;     ///< Its part of what joints have added to the energy of bodies [J].
  double spring_energy = -1;  ///< What its springs should hold after the last substep [J]; -1: not known.
  /// Ways along a's x, y, z, then angles. kDistance uses the first, along the line between the anchors; kBall
  /// has its twist limits in the fourth and one spring and motor for each axis.
  std::array<HookFreedom, 6> freedom = {};
  /// Whether a particle is at an end: such hooks are solved with their ropes
  /// (solver/coupled/coupled_groups.h).
  [[nodiscard]] bool holds_point() const { return a.is_point() || b.is_point(); }
  [[nodiscard]] bool can_break() const { return break_force < kRigid || break_torque < kRigid; }
  /// Whether it is solved in a bundle.
  [[nodiscard]] bool is_in_coupled_group() const { return route == JointRoute::kCoupled || holds_point(); }
  /// Of such a hook, the end at particles, the first if both are, and the other one.
  [[nodiscard]] const HookPlace& point_end() const { return a.is_point() ? a : b; }
  [[nodiscard]] const HookPlace& other_end() const { return a.is_point() ? b : a; }

  /// Points of the object at an end, counted within it, that were inside the body at the other end when they
  /// were hooked, as where a rope ends at the middle of a crate: they do not touch it.
  std::vector<std::uint32_t> inside = {};
  Real cone = kRigid;            ///< kBall: largest angle between the x axes [rad].
  Real rest_distance = Real(0);  ///< kDistance: of the anchors when they were hooked [m].
};

}  // namespace hooke::state
