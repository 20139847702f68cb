#pragma once

#include "lab/rigid/rigid_body.h"
#include "math/symmetric.h"

#include <span>
#include <vector>

/// \file
/// Computes what contacts do to velocities, at once.
///
/// At a contact with normal n from A to B, v = (v_B + omega_B x r_B) - (v_A + omega_A x r_A). An impulse
/// lambda n + tau on B, and its opposite on A, obeys
///
/// lambda >= 0,  n.v' >= target,  lambda (n.v' - target) = 0          (Signorini)
/// |tau| <= mu lambda; where the contact slides tau = -mu lambda v_t' / |v_t'|   (Coulomb)
///
/// with the static coefficient for contacts that stick. Restitution is Newton's: target = -e n.v of before.
///
/// All contacts together are solved by projected Gauss-Seidel (Moreau 1988; Jean 1999, "The non-smooth
/// contact dynamics method") to rounding, in their order. Between two sweeps the impulses go on along the
/// direction of the earlier sweeps, after Fletcher and Reeves (Silcowitz-Hansen, Niebe, Erleben 2010, "A
/// nonsmooth nonlinear conjugate gradient method for interactive contact force problems"). Wide bodies on
/// small supports, and bodies in a row, then take a tenth of the sweeps.

namespace hooke::lab {

/// An ImpulseBody is a body as impulses see it.
struct ImpulseBody {
  double inverse_mass = 0;                        ///< 0 means that nothing moves it [1/kg].
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
  double lambda = 0;   ///< Impulse along the normal [N s]; an output of the functions below.
  DVec3 tangent = {};  ///< Impulse across the normal [N s]; an output, too.
};

/// Returns v at a contact point [m/s].
[[nodiscard]] DVec3 relative_velocity(std::span<const ImpulseBody> bodies, const ImpulsePoint& point);
[[nodiscard]] inline double normal_speed(std::span<const ImpulseBody> bodies, const ImpulsePoint& point) {
  return dot(point.contact.normal, relative_velocity(bodies, point));
}

/// Solves all points at once for their targets. \return Whether it converged within a bounded number of
/// sweeps.
bool solve_impulses(std::span<ImpulseBody> bodies, std::span<ImpulsePoint> points);

/// Resolves impacts. Points of one pair of bodies must stand next to each other; they form a group. The pair
/// that closes fastest is resolved first, with all its own points at once. So the impacts of one instant
/// follow each other, and a row of touching balls passes an impact on. A point slower than its `rest_speed`
/// [m/s] does not bounce. If a pair collides more than 200 times, as a body between two others may, all
/// points are solved together without bounce. \return The number of impacts in which some point bounced.
int resolve_impacts(std::span<ImpulseBody> bodies, std::span<ImpulsePoint> points,
                    std::span<const double> rest_speed);

}  // namespace hooke::lab
