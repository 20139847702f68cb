#pragma once

#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <optional>

/// \file
/// A hand that grabs what a ray meets, pulls it along by a damped spring, and throws it. It uses public calls
/// alone.

namespace hooke {

/// How a hand pulls. With m the mass that is held, w = 2 pi `frequency_hz`, x the place that is held, v its
/// velocity and t the target, the force is
///
///     F = m w^2 (t - x) - 2 `damping_ratio` m w v,  at most `max_force` long
///
/// A free mass that is critically damped comes within 1 % of a new target in 6.7 / w without passing it, and
/// follows a target of the velocity V at a distance of 2 `damping_ratio` V / w.
struct HandDesc {
  Real frequency_hz = Real(4);   ///< Frequency of the held mass on the spring [Hz]. [0.1, 30]
  Real damping_ratio = Real(1);  ///< Damping of the spring; 1 is critical. [0, 10]
  /// Largest force [N], positive; kRigid for no limit. It holds for the mean over a step of what moves as in
  /// the step before. In a step in which what is held is torn away or stopped, the spring may exceed it.
  Real max_force = Real(1000);
  /// Mass m that the spring is made for [kg]. [1e-9, 1e12] By default that of the body or of the whole rope,
  /// cloth or solid. Give more for a light link of a heavy mechanism.
  std::optional<Real> mass = {};
  /// How far a ray may pass beside ropes and particles and still grab them [m]. [0, 1e6]
  Real margin = Real(0.02);
};

/// A hand holds one thing of one World: a dynamic body, or a point of a rope, cloth, solid or group of
/// particles. Call grab or grab_along, then move_to and before_step before each step, then release.
///
/// The hand is a hook of kind HookKind::kSixDegrees with three springs, from a kinematic body without
/// contacts to the body that it holds. Of a deformable, and of a body that yields (BodyDesc::yields), it
/// holds a small ball of a fiftieth of the object's mass, without weight or contacts, that is hooked to the
/// place. It keeps a body that becomes soft, and one that becomes rigid again. So all that it does is in the
/// state of the World, and steps with a hand give the same bits as any others. What it holds stays awake
/// while the hand moves.
///
/// A Hand is a value. Keep a copy with each snapshot, and take the copy back when the snapshot is restored. A
/// hand that grabbed after the snapshot was taken finds out in before_step that it holds nothing any more. A
/// hand that let go since then left its hook in the snapshot: only a copy of that time can let go again.
class Hand {
 public:
  /// Grabs what the ray from `origin` over `motion` [m] meets first, where it meets it, and lets go of what
  /// it held. Returns whether it grabbed something: it does not if the ray meets nothing, or first meets a
  /// body that is not dynamic. Errors: those of World::cast_ray, of the fields of `desc`, and any call during
  /// a step.
  Result<bool> grab_along(World& world, DVec3 origin, DVec3 motion, const HandDesc& desc = {});
  /// Grabs a body at a place in the world [m], and lets go of what it held. Errors also: a stale id, a body
  /// that is not dynamic.
  Result<void> grab(World& world, BodyId body, DVec3 at, const HandDesc& desc = {});
  /// Grabs the place of a deformable that is nearest to `at` [m], and lets go of what it held. The index of
  /// `object` does not count. The soft form of a body that yields counts as that body. Errors also: a stale
  /// id.
  Result<void> grab(World& world, PointRef object, DVec3 at, const HandDesc& desc = {});

  /// Says where the held place is to go, in the world [m]. At first that is where it was grabbed.
  void move_to(DVec3 target) { target_ = target; }
  /// Pulls during the next step, of `dt` [s]; call it before each one. Returns whether the hand still holds
  /// something: it lets go of what was removed from the World, or is gone after World::restore. Errors: a
  /// target beyond hooke/limits.h, and any call during a step.
  Result<bool> before_step(World& world, Real dt);
  /// Lets go. What was held keeps its velocity, and so flies on. Returns whether anything was held. Call it
  /// between steps: during one the World refuses to remove the spring, which then stays for good.
  bool release(World& world);

  /// Whether it holds something, as far as it knows: see before_step.
  [[nodiscard]] bool holds() const { return static_cast<bool>(handle_); }
  /// The body that is held; null for none.
  [[nodiscard]] BodyId body() const { return body_; }
  /// The object whose point is held, with the index PointRef::kNearest; empty for none.
  [[nodiscard]] PointRef object() const { return object_; }
  /// Where the hand wants the held place to be [m].
  [[nodiscard]] DVec3 target() const { return target_; }
  /// The place that is held now [m]; the target if nothing is held.
  [[nodiscard]] DVec3 place(const World& world) const;
  /// Force of the hand on what it holds, as a mean over the last step [N].
  [[nodiscard]] Vec3 force(const World& world) const;
  /// Stiffness of the spring [N/m].
  [[nodiscard]] Real stiffness() const { return stiffness_; }

 private:
  [[nodiscard]] bool is_there(const World& world) const;
  Result<void> hold(World& world, const HookEnd& end, DVec3 at, const HandDesc& desc, Real mass);
  Result<void> hold_by_ball(World& world, const HookEnd& end, DVec3 at, const HandDesc& desc, Real mass);

  BodyId body_ = {};      // what is held: a body ...
  PointRef object_ = {};  // ... or a place of a deformable
  BodyId handle_ = {};    // the kinematic body at the other end of the spring
  BodyId ball_ = {};      // between the spring and a deformable or a body that yields; null for others
  HookId spring_ = {};
  HookId ball_hook_ = {};
  DVec3 target_ = {};
  Vec3 velocity_ = {};  // of the held place, before the last step [m/s]
  Real stiffness_ = Real(0);
  Real damping_ = Real(0);
  Real max_force_ = Real(0);
};

}  // namespace hooke
