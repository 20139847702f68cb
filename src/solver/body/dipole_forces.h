#pragma once

#include "hooke/desc.h"

#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/objects.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// A magnetic dipole where it is in the middle of a step: a body's or a field's.
struct Dipole {
  static constexpr std::uint32_t kFixed = 0xffffffff;

  std::uint32_t row = kFixed;  ///< Of the body; kFixed: a field.
  DVec3 center = {};           ///< [m]; of a body its center of mass.
  DVec3 moment = {};           ///< In the world's axes [A m^2].
  double size = 0;             ///< Of the moment [A m^2].
  double inverse_mass = 0;     ///< [1/kg]; 0: forces do not move it.
  double inverse_inertia = 0;  ///< Mean across the moment [1/(kg m^2)].
};

/// Replaces `rows` by those of all bodies with a dipole moment, also of those that forces do not move, in
/// ascending order.
void list_bodies_with_dipoles(const state::Bodies& bodies, std::vector<std::uint32_t>& rows);

/// Lists all dipoles that there are: those of fields, then those of the bodies in `rows`.
void gather_dipoles(const std::vector<state::Field>& fields, std::span<const std::uint32_t> rows,
                    const state::Bodies& bodies, std::vector<Dipole>& dipoles);

/// Adds to `bodies.force` and `bodies.torque` what magnetic fields and all other dipoles do to the dipoles of
/// dynamic bodies in `range`, in a substep of length h (elements/dipoles.h):
///
///     torque = m x B,   force = grad (m.B)
///
/// What two dipoles a and b do to each other is opposite to the last bit, and so are its moments up to
/// rounding: each pair keeps momentum and angular momentum.
///
/// Dipoles that come close pull and turn ever harder. A pair with the rate
/// omega^2 = mu_0 / 4 pi |a| |b| / r^3 max(2 (1/I_a + 1/I_b), 24 (1/M_a + 1/M_b) / r^2), the stiffest its
/// energy can be, has all of force and torques divided by (h omega)^2 where h omega > 1: what the substep
/// cannot follow is weaker, and nothing is infinite. So is the torque of a field where h^2 |m| |B| / I > 1.
void add_dipole_forces(parallel::Range range, std::span<const Dipole> dipoles,
                       const std::vector<state::Field>& fields, double h, state::Bodies& bodies);

/// Of all dipoles in magnetic fields and in each other's [J]; zero where they are far away and turned across.
double dipole_energy(const std::vector<state::Field>& fields, std::span<const Dipole> dipoles);

}  // namespace hooke::solver
