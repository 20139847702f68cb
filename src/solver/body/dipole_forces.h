#pragma once

#include "hooke/desc.h"

#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/objects.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// A magnetic dipole of a body or a field, in the middle of a step.
struct Dipole {
  static constexpr std::uint32_t kFixed = 0xffffffff;

  std::uint32_t row = kFixed;  ///< Row of the body; kFixed for a field.
  DVec3 center = {};           ///< Center [m]; for a body its center of mass.
  DVec3 moment = {};           ///< Moment in the world's axes [A m^2].
  double size = 0;             ///< Size of the moment [A m^2].
  double inverse_mass = 0;     ///< Inverse mass [1/kg]; 0: forces do not move it.
  double inverse_inertia = 0;  ///< Inverse inertia, mean across the moment [1/(kg m^2)].
};

/// Replaces `rows` by those of all bodies with a dipole moment, in ascending order, also those that forces
/// do not move.
void list_bodies_with_dipoles(const state::Bodies& bodies, std::vector<std::uint32_t>& rows);

/// Lists all dipoles: those of fields, then those of the bodies in `rows`.
void gather_dipoles(const std::vector<state::Field>& fields, std::span<const std::uint32_t> rows,
                    const state::Bodies& bodies, std::vector<Dipole>& dipoles);

/// Adds the effect of magnetic fields and of all other dipoles on the dipoles of dynamic bodies in `range`
/// to `bodies.force` and `bodies.torque`, in a substep of length h (elements/dipoles.h):
///
///     torque = m x B,   force = grad (m.B)
///
/// Two dipoles a and b act on each other with forces that are opposite to the last bit, and with moments
/// that are opposite up to rounding: each pair keeps momentum and angular momentum.
///
/// Dipoles that come close pull and turn ever harder. Let omega^2 = mu_0 / 4 pi |a| |b| / r^3
/// max(2 (1/I_a + 1/I_b), 24 (1/M_a + 1/M_b) / r^2) be the rate of a pair, the stiffest its energy can be.
/// Where h omega > 1, force and torques of the pair are divided by (h omega)^2: what the substep cannot
/// follow is weaker, and nothing is infinite. So is the torque of a field where h^2 |m| |B| / I > 1.
void add_dipole_forces(parallel::Range range, std::span<const Dipole> dipoles,
                       const std::vector<state::Field>& fields, double h, state::Bodies& bodies);

/// Energy of all dipoles in magnetic fields and in each other's [J]. It is zero where they are far away and
/// turned across.
double dipole_energy(const std::vector<state::Field>& fields, std::span<const Dipole> dipoles);

}  // namespace hooke::solver
