#pragma once

#include "parallel/range.h"
#include "state/contacts.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// One rope as the solver sees it. Its nodes are particles [first_particle, first_particle + node_count), its
/// segments rows [first_segment, first_segment + node_count - 1), its contacts rows [first_contact,
/// end_contact).
struct Chain {
  std::uint32_t first_particle = 0;
  std::uint32_t node_count = 0;
  std::uint32_t first_segment = 0;
  double bend_stiffness = 0;  ///< EI [N m^2]; with it the rope is a bundle (solver/bundles.h).
  double bend_damping = 0;    ///< Over EI [s].
  std::uint32_t first_contact = 0;
  std::uint32_t end_contact = 0;
  std::uint32_t solves = 0;  ///< Newton steps since the frame began; written by solve_chains.
  bool in_bundle = false;    ///< Solved with what it is tied to; written by build_bundles (solver/bundles.h).
  bool unconverged = false;  ///< A length error above 1 % was left in this frame; written by solve_chains.
};

/// The whole rope at once: velocities such that every segment carries the force of its stiffness at the end
/// of the substep, with static contacts and friction inside the system.
///
/// Unknown are node velocities u and segment impulses q. For a segment from a to b, n its direction,
/// r = u_b - u_a, r0 = v_b - v_a before this substep's forces, C = l - L, m the lighter end's mass:
///
///   axial        n.r = -b C + gamma n.q,  b = k / (c + h k),  gamma = 1 / (h (c + h k)) >= chi / m
///   transverse   q_t = (g + f) (r - r0)_t + d g (r - omega x L n)_t,  g = h^2 T+ / L,  f = 1e-5 m
///
/// g is the geometric stiffness of a segment under tension T+ = max(0, last tension, largest of this
/// substep): it acts on the change of velocity, so that a swing keeps its energy; without it stiff ropes
/// explode. The share d = 0.2 of it damps what moves unlike the line between the rope's ends, which turns at
/// omega: waves, not swings. chi is 1e-7 in the air and 1e-5 in contact.
///
/// A sweep from the first node condenses everything behind it to u = s + X q (compliance form: exact for
/// k = infinity), a sweep back gives q and u. The solve repeats, linearized anew, while a length error
/// exceeds 0.1 %, at most 8 times; more than 1 % left is reported.
///
/// A contact holds its node with N = max(0, N0 - rho (n.u + s/h)), rho = 1000 m, u relative to the surface,
/// N0 carried over substeps; friction holds likewise up to mu N and is mu N against the motion beyond.
///
/// Sources: docs/decisions/0002-ropes.md; geometric stiffness after Tournier et al. 2015, "Stable constrained
/// dynamics". A segment of no length is taken to point down. Sweeps are in double: the directions of a rope's
/// segments differ in compliance by a factor of 1e10. `before` holds velocities from before the forces.
void solve_chains(std::span<Chain> chains, const std::vector<Vec3>& before, Real h,
                  state::Particles& particles, state::Segments& segments, state::Contacts& contacts);

}  // namespace hooke::solver
