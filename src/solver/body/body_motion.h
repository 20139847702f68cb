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
/// omega = I(q')^(-1) L with q' = exp(h omega / 2) q, by three fixed iterations from I(q)^(-1) L. Where those
/// would not converge (a rod spun at 300 rad/s gained energy 20-fold in a step) the turn is made of exact
/// ones: with 1/I = c and axes k, b, a, of which k is least like the others,
///
///   exp(h/2 (c_b - c_a) L_b^2/2), exp(h (c_a |L|^2 + (c_k - c_a) L_k^2)/2), and the first again,
///
/// each the flow of its part of the energy: two turns about an axis of the body, and one about L and k. |L|
/// is kept, energy within 2 % at 500 rad/s, of symmetric bodies exactly; at 5000 rad/s and more, which a hit
/// may give a small plate, it would go up and down by factors, so the last turn leads to the energy of
/// before. Source of the splitting: Dullweber, Leimkuhler, McLachlan 1997, "Symplectic splitting methods for
/// rigid body molecular dynamics".
void accelerate_bodies(std::span<const std::uint32_t> rows, const BodyStep& step, state::Bodies& bodies);

/// An impulse [N s] at `lever` from the center [m], now: like those of hooks it counts as free motion, not as
/// the doing of contacts between bodies.
void push_body(std::uint32_t row, Vec3 impulse, Vec3 lever, state::Bodies& bodies);

/// 1 / the mass that resists a push along unit `direction` at `lever` from the center [1/kg].
[[nodiscard]] Real inverse_mass_at(const state::Bodies& bodies, std::uint32_t row, Vec3 direction,
                                   Vec3 lever);

/// dx += h v, theta_scaled += h omega_scaled.
void move_bodies(std::span<const std::uint32_t> rows, Real h, state::Bodies& bodies);

/// Mean angular velocity of a free body over h, from L, as accelerate_bodies finds it.
[[nodiscard]] Vec3 mean_velocity(const state::BodyMass& mass, Quat rotation, Vec3 momentum, Real h);

/// After accelerate_bodies, and again after move_bodies (`moved`): bodies that touch something, and whose
/// rows know a wrong inertia by now, are in a steady turn from now on. `start_rotation` is that of the step's
/// start. With S of the rows and I of now, an impulse does up to
///
///   r = the largest eigenvalue of S^(-1) I^(-1) S^(-1), whose determinant is 1,
///
/// times what the rows think. Beyond r = 2 each pass makes energy: rods that spun about their own axis, and
/// were tipped over, gained factors of 1e11 in a step. Of a body with an axis of symmetry the trace is
/// 1 + r + 1/r. Before it moves, |omega_scaled|^2 tells too, which is beyond 2 E where the axis will tip over
/// within the substep. The body keeps its energy, |omega_scaled|^2 / 2 from now on.
void freeze_inertia(std::span<const std::uint32_t> rows, std::span<const Quat> start_rotation, Real h,
                    bool moved, state::Bodies& bodies);

/// Whether within h [s] the inertia of a body that forces move comes to be so different that an impulse would
/// do more than twice what rows know, as with r above.
[[nodiscard]] bool outgrows_rows(const state::Bodies& bodies, std::uint32_t row, Real h);

/// Gives a body that tumbles, after the last substep, the rotation at which it was stopped on its way. That
/// lies on the straight way from start to end, not quite on the body's own: with the same L it may have more
/// rotational energy than at the end of the step, in which case L shrinks.
void stop_rotation(std::uint32_t row, Quat rotation, state::Bodies& bodies);

/// End of a step: centers and rotations follow dx and theta, L follows the change of omega_scaled alone (so
/// that a free body keeps it exactly), angular_velocity follows L. A body in a steady turn has the rotational
/// energy |omega_scaled|^2 / 2 afterwards. Nothing but v is left in the motion lines. External forces end.
void finish_bodies(std::span<const std::uint32_t> rows, state::Bodies& bodies);

}  // namespace hooke::solver
