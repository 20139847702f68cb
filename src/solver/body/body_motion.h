#pragma once

#include "hooke/math.h"

#include "state/bodies.h"

#include <cstdint>
#include <span>

/// \file
/// Motion of rigid bodies. `rows` are rows of the table, those that are awake. Work may be shared out by
/// giving each thread a part of them.

namespace hooke::solver {

/// One substep, the same for all bodies.
struct BodyStep {
  Vec3 gravity = {};   ///< Gravity [m/s^2].
  Real h = Real(0);    ///< Length of the substep [s].
  bool first = false;  ///< Whether it is the first substep of a step.
};

/// S = I^(-1/2) in world axes [1/sqrt(kg) 1/m] of a body with the rotation `rotation`.
[[nodiscard]] math::Symmetric3<Real> inertia_scale(const state::BodyMass& mass, Quat rotation);

/// Starts a step: S = I^(-1/2) in world axes, omega_scaled = S L, no displacement yet. For kinematic bodies
/// S is the identity and omega_scaled their angular velocity. For a body with frozen inertia S is that of
/// the impact, and omega_scaled = S^(-1) omega.
void prepare_bodies(std::span<const std::uint32_t> rows, state::Bodies& bodies);

/// Starts a substep: applies gravity, external force and torque, and damping; then, as warm start, the
/// effect of contact rows in the substep before. Kinematic bodies keep their velocity.
///
/// A body whose inertia differs by axis turns as a free body does. The state is L, which nothing but torque
/// changes. The angular velocity of the substep is that halfway through its rotation (Lie midpoint rule):
/// omega = I(q')^(-1) L with q' = exp(h omega / 2) q, by three fixed iterations from I(q)^(-1) L. Where
/// those would not converge (a rod spun at 300 rad/s gained energy 20-fold in a step) the rotation is made
/// of exact ones. With 1/I = c and axes k, b, a, of which k is least like the others, they are
///
///   exp(h/2 (c_b - c_a) L_b^2/2), exp(h (c_a |L|^2 + (c_k - c_a) L_k^2)/2), and the first again,
///
/// each the flow of its part of the energy: two rotations about an axis of the body, and one about L and k.
/// |L| is kept, and energy within 2 % at 500 rad/s; for symmetric bodies exactly. At 5000 rad/s and more,
/// which an impact may give a small plate, energy would go up and down by factors, so the last rotation
/// restores the earlier energy. Source of the splitting: Dullweber, Leimkuhler, McLachlan 1997, "Symplectic
/// splitting methods for rigid body molecular dynamics".
void accelerate_bodies(std::span<const std::uint32_t> rows, const BodyStep& step, state::Bodies& bodies);

/// Applies an impulse [N s] at `lever` from the center [m], now. Like impulses of hooks it counts as free
/// motion, not as an effect of contacts between bodies.
void push_body(std::uint32_t row, Vec3 impulse, Vec3 lever, state::Bodies& bodies);

/// The same for an impulse [N s] at the center and an angular impulse [N m s].
void push_and_turn_body(std::uint32_t row, Vec3 impulse, Vec3 angular, state::Bodies& bodies);

/// 1 / the mass that resists a push along the unit vector `direction` at `lever` from the center [1/kg].
[[nodiscard]] Real inverse_mass_at(const state::Bodies& bodies, std::uint32_t row, Vec3 direction,
                                   Vec3 lever);

/// Applies dx += h v and theta_scaled += h omega_scaled.
void move_bodies(std::span<const std::uint32_t> rows, Real h, state::Bodies& bodies);

/// Mean angular velocity of a free body over h, found from L as accelerate_bodies does.
[[nodiscard]] Vec3 mean_velocity(const state::BodyMass& mass, Quat rotation, Vec3 momentum, Real h);

/// Freezes the inertia of bodies that touch something and whose rows know a wrong inertia by now. It is
/// called after accelerate_bodies, and again after move_bodies (`moved`). `start_rotation` is that of the
/// step's start. With S of the rows and the present I, an impulse does up to
///
///   r = the largest eigenvalue of S^(-1) I^(-1) S^(-1), whose determinant is 1,
///
/// times what the rows think. Beyond r = 2 each pass makes energy: rods that spun about their own axis, and
/// were tipped over, gained factors of 1e11 in a step. For a body with an axis of symmetry the trace is
/// 1 + r + 1/r. Before the body moves, |omega_scaled|^2 tells too: it is beyond 2 E where the axis will tip
/// over within the substep. The body keeps its energy, which is |omega_scaled|^2 / 2 from now on.
void freeze_inertia(std::span<const std::uint32_t> rows, std::span<const Quat> start_rotation, Real h,
                    bool moved, state::Bodies& bodies);

/// Whether, within h [s], the inertia of a body that forces move becomes so different that an impulse would
/// do more than twice what rows know, with r as above.
[[nodiscard]] bool outgrows_rows(const state::Bodies& bodies, std::uint32_t row, Real h);

/// Gives a body that makes a gyroscopic turn, after the last substep, the rotation at which it was stopped
/// in its motion. That rotation lies on the straight path from start to end, not quite on the body's own.
/// With the same L it may have more rotational energy than at the end of the step, in which case L shrinks.
void stop_rotation(std::uint32_t row, Quat rotation, state::Bodies& bodies);

/// Ends a step: centers and rotations follow dx and theta. L follows the change of omega_scaled alone (so
/// that a free body keeps it exactly), and angular_velocity follows L. A body with frozen inertia has the
/// rotational energy |omega_scaled|^2 / 2 afterwards. Nothing but v is left in the motion records. External
/// forces end.
void finish_bodies(std::span<const std::uint32_t> rows, state::Bodies& bodies);

}  // namespace hooke::solver
