#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "state/route.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::state {

/// One end of a hook: a body, the world, or a place between up to four particles of one object, which move
/// that place by their weights.
struct HookPlace {
  static constexpr std::uint32_t kWorld = 0xFFFFFFFF;
  static constexpr std::uint32_t kMostParticles = 4;

  std::uint32_t body = kWorld;  ///< Row of the body; it stays the same as long as the body lives.
  DVec3 anchor = {};  ///< Offset from the center of mass in the body's frame, or position in the world [m].
  Quat axes = {};     ///< Rotation from the hook's axes to the body's frame, or to the world.
  std::uint32_t object = 0;          ///< Row of the deformable, where there are particles.
  std::uint32_t particle_count = 0;  ///< Not 0 for an end at particles, where `body` is kWorld and `anchor`
                                     ///< is zero.
  std::array<std::uint32_t, kMostParticles> particle = {};  ///< Rows of the particles.
  std::array<Real, kMostParticles> weight = {};             ///< Weights of the particles, with the sum 1.

  [[nodiscard]] bool is_point() const { return particle_count > 0; }
};

/// Two ends held together. `freedom` says what each kind leaves free; it is filled in when the hook is made.
/// The fields that every step reads stand first, close together. Impulses and values belong to the solver.
struct Hook {
  /// A freedom has three rows at most: lock or spring, motor, limit.
  static constexpr int kMaxRows = 18;

  std::uint32_t slot = 0;  ///< Slot of the hook's id.
  HookKind kind = HookKind::kBall;
  bool collide = false;
  bool broken = false;
  JointRoute route = JointRoute::kNone;  ///< How it is solved in this step; see solver/routes.h.
  HookPlace a = {};
  HookPlace b = {};
  Real break_force = kRigid;
  Vec3 impulse = {};                            ///< Impulse on b in the last substep [N s].
  Vec3 impulse_sum = {};                        ///< Sum of `impulse` over the step so far [N s].
  Vec3 force = {};                              ///< Force on b, mean over the last step [N].
  std::array<double, 6> value = {};             ///< Value of each freedom [m or rad]; angles also beyond
                                                ///< whole turns.
  std::array<Real, kMaxRows> row_impulse = {};  ///< Impulses of the last substep, in the order of the hook's
                                                ///< rows.

  Vec3 angular_impulse = {};  ///< Angular impulse on b in the last substep [N m s].
  Vec3 angular_impulse_sum = {};
  Vec3 torque = {};  ///< Torque on b, mean over the last step [N m].
  Real break_torque = kRigid;
  // The fields below belong to solver/joint/hook_breaks.h.
  enum class Giving : std::uint8_t {
    kHolds,
    kNothing,  ///< The hook transmits nothing in this solution, which shows how fast its ends part then.
    kSome,     ///< The hook transmits nearly what it can.
    kMost,     ///< The hook transmits what it can.
  };
  Giving giving = Giving::kHolds;
  std::array<double, 2> compliance = {};  ///< Compliance in series with its translations [1/kg] and with its
                                          ///< angles [1/(kg m^2)].
  std::array<double, 2> most = {};        ///< Impulses that they transmit while the hook breaks [N s, N m s].
  Real needed_force = Real(0);            ///< Force that the hook needed in the substep in which it breaks
                                          ///< [N].
  Real needed_torque = Real(0);           ///< Torque that it needed in that substep [N m].
  double held = 0;                        ///< Time for which the hook has held in this step [s].
  Real last_impulse = Real(0);            ///< For iterative joints: impulse needed in the substep before [N
                                          ///< s].
  Real last_angular_impulse = Real(0);    ///< Angular impulse needed in the substep before [N m s].
  // The fields below belong to solver/joint/joint_energy.h. They are used while something rotates far.
  double energy_debt = 0;     ///< Share of this hook in what joints have added to the energy of bodies [J].
  double spring_energy = -1;  ///< Energy that its springs should hold after the last substep [J]; -1: not
                              ///< known.
  /// Translations along a's x, y, z, then angles. kDistance uses the first, along the line between the
  /// anchors; kBall has its twist limits in the fourth and one spring and motor for each axis.
  std::array<HookFreedom, 6> freedom = {};
  /// Whether an end is at particles: such hooks are solved with their ropes
  /// (solver/coupled/coupled_groups.h).
  [[nodiscard]] bool holds_point() const { return a.is_point() || b.is_point(); }
  [[nodiscard]] bool can_break() const { return break_force < kRigid || break_torque < kRigid; }
  /// Whether the hook is solved in a coupled group.
  [[nodiscard]] bool is_in_coupled_group() const { return route == JointRoute::kCoupled || holds_point(); }
  /// The end at particles of such a hook, the first if both are, and the other end.
  [[nodiscard]] const HookPlace& point_end() const { return a.is_point() ? a : b; }
  [[nodiscard]] const HookPlace& other_end() const { return a.is_point() ? b : a; }

  /// Points of the object at one end that were inside the body at the other end when they were hooked,
  /// counted within the object. They do not touch that body: a rope may end at the middle of a crate.
  std::vector<std::uint32_t> inside = {};
  Real cone = kRigid;  ///< kBall: largest angle between the x axes [rad].
  /// kDistance: distance of the anchors when they were hooked. kBall between points and a body: distance of
  /// the object's nearest point outside the body when they were hooked [m].
  Real rest_distance = Real(0);
};

}  // namespace hooke::state
