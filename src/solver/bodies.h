#pragma once

#include "hooke/math.h"

#include "state/bodies.h"

#include <cstdint>
#include <span>

/// \file
/// Motion of rigid bodies. `rows` are rows of the table, those that are awake; work may be shared out by
/// giving each thread a part of them.

namespace hooke::solver {

/// One substep, the same for all bodies.
struct BodyStep {
  Vec3 gravity = {};   ///< [m/s^2]
  Real h = Real(0);    ///< [s]
  bool first = false;  ///< The first substep of a step.
};

/// Whether the axis of a free body's rotation visibly moves.
[[nodiscard]] bool tumbles(const state::BodyMass& mass);

/// Whether the body tumbles in this step. In the middle of a step the column of rotations is up to date for
/// such bodies; others turn at its end.
[[nodiscard]] bool tumbles_now(const state::Bodies& bodies, std::uint32_t body);

/// S = I^(-1/2) in world axes [1/sqrt(kg) 1/m], of a body turned by `rotation`.
[[nodiscard]] math::Symmetric3<Real> inertia_scale(const state::BodyMass& mass, Quat rotation);

/// Start of a step: S = I^(-1/2) in world axes, omega_scaled = S L, no displacement yet. Of kinematic bodies
/// S is the identity and omega_scaled their angular velocity. Of a body in a steady turn S is that of the
/// impact, and omega_scaled = S^(-1) omega.
void prepare_bodies(std::span<const std::uint32_t> rows, state::Bodies& bodies);

/// Start of a substep: gravity, external force and torque, damping; then, as warm start, what contact rows
/// did in the substep before. Kinematic bodies keep their velocity.
///
/// A body whose inertia differs by axis turns as a free body does. The state is L, which nothing but torque
/// changes; the angular velocity of the substep is that halfway through its turn (Lie midpoint rule):
/// omega = I(q')^(-1) L with q' = exp(h omega / 2) q, by three fixed iterations from I(q)^(-1) L.
void accelerate_bodies(std::span<const std::uint32_t> rows, const BodyStep& step, state::Bodies& bodies);

/// dx += h v, theta_scaled += h omega_scaled.
void move_bodies(std::span<const std::uint32_t> rows, Real h, state::Bodies& bodies);

/// End of a step: centers and rotations follow dx and theta, L follows the change of omega_scaled alone (so
/// that a free body keeps it exactly), angular_velocity follows L, odometers grow by the way of the fastest
/// point. A body in a steady turn has the rotational energy |omega_scaled|^2 / 2 afterwards. Nothing but v is
/// left in the motion lines. External forces end.
void finish_bodies(std::span<const std::uint32_t> rows, state::Bodies& bodies);

}  // namespace hooke::solver
