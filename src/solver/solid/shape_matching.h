#pragma once

#include "state/objects.h"
#include "state/particles.h"

namespace hooke::solver {

/// The best fit of a solid's form at rest to its points: the center of mass c, and the rotation R for which
/// the form is nearest to them.
struct Match {
  DVec3 center = {};  ///< From the object's origin [m].
  Quaternion<double> turn = {};
};

/// Finds the match from the places of the points, plus `ahead` [s] times their velocities.
[[nodiscard]] Match find_match(const state::Deformable& object, const state::Particles& particles,
                               double ahead = 0);

/// Pulls each point towards its goal g = c + R q, where q is its place in the form at rest (Mueller,
/// Heidelberger, Teschner and Gross 2005). With p = x - c, e = p - R q, E = k sum m |e|^2 / 2: since R is
/// the nearest rotation, the force is -k m e, which has neither a sum nor a torque, and every deformation
/// swings with w^2 = k. One implicit step in closed form is:
///
///     u = (h k e + h^2 k (v - V)) / (1 + h^2 k),    v -= w m (u - I^-1 (sum m p x u) x p)
///
/// V is the mean velocity and I the inertia of the points. What remains of u has neither a sum nor a torque
/// to the last digit, whatever R is. Any k is stable, also for pinned points (w = 0). k = infinity gives u =
/// e / h + v - V, a body that is as rigid as one substep makes it. Sums are taken in the order of rows, in
/// double.
void match_shape(const state::Deformable& object, double h, state::Particles& particles);

/// Takes deformation out of the velocities with viscosity c: the same with u = h c (v - V) / (1 + h c). It
/// is called before forces act: what rests has no velocity then, and viscosity moves nothing.
void damp_shape(const state::Deformable& object, double h, state::Particles& particles);

/// E [J] with each point `ahead` [s] of its place; 0 for rigid shapes.
[[nodiscard]] double match_energy(const state::Deformable& object, const state::Particles& particles,
                                  double ahead);

}  // namespace hooke::solver
