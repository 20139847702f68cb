#pragma once

#include "lab/rigid/rigid_body.h"
#include "math/symmetric.h"

#include <span>
#include <vector>

/// \file
/// What contacts do to velocities, at once.
///
/// At a contact with normal n from A to B, v = (v_B + omega_B x r_B) - (v_A + omega_A x r_A). An impulse
/// lambda n + tau on B, and its opposite on A, obeys
///
///     lambda >= 0,  n.v' >= target,  lambda (n.v' - target) = 0          (Signorini)
///     |tau| <= mu lambda; where the contact slides tau = -mu lambda v_t' / |v_t'|   (Coulomb)
///
/// with the static coefficient for contacts that stick. Restitution is Newton's: target = -e n.v of before.
/// All contacts together are solved by projected Gauss-Seidel (Moreau 1988; Jean 1999, "The non-smooth
/// contact dynamics method") to rounding, in their order. Between two sweeps goes a step along the way of
/// those before, after Fletcher and Reeves (Silcowitz-Hansen, Niebe, Erleben 2010, "A nonsmooth nonlinear
/// conjugate gradient method for interactive contact force problems"): what stands flat on little, or hangs
/// in a row, takes a tenth of the sweeps.

namespace hooke::lab {

/// A body as impulses see it.
struct ImpulseBody {
  double inverse_mass = 0;                        ///< 0: nothing moves it [1/kg].
  math::Symmetric3<double> inverse_inertia = {};  ///< In world axes [1/(kg m^2)].
  DVec3 center = {};
  DVec3 velocity = {};
  DVec3 spin = {};
};

[[nodiscard]] ImpulseBody impulse_body(const RigidBody& body, const BodyMotion& at);

struct ImpulsePoint {
  std::uint32_t a = 0, b = 0;  ///< Bodies.
  Contact contact = {};
  double target = 0;   ///< Least normal speed afterwards [m/s].
  double lambda = 0;   ///< Impulse along the normal [N s]; written by the functions below.
  DVec3 tangent = {};  ///< Impulse across it [N s]; likewise.
};

/// v at a point [m/s].
[[nodiscard]] DVec3 relative_velocity(std::span<const ImpulseBody> bodies, const ImpulsePoint& point);
[[nodiscard]] inline double normal_speed(std::span<const ImpulseBody> bodies, const ImpulsePoint& point) {
  return dot(point.contact.normal, relative_velocity(bodies, point));
}

/// Solves all points at once for their targets. \return Whether it converged: it is bounded.
bool solve_impulses(std::span<ImpulseBody> bodies, std::span<ImpulsePoint> points);

/// Hits. Points are in groups, one for each pair of bodies, in a row. The pair that comes together fastest
/// hits first, as if the hits of one instant came one after another (so a row of touching balls passes one
/// on); its own points at once. A point slower than its `rest_speed` [m/s] does not bounce. Hits that do not
/// end (a body between two) end as one, without bounce. \return The number of hits faster than that.
int resolve_impacts(std::span<ImpulseBody> bodies, std::span<ImpulsePoint> points,
                    std::span<const double> rest_speed);

}  // namespace hooke::lab
