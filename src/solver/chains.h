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
  std::uint32_t first_contact = 0;
  std::uint32_t end_contact = 0;
  std::uint32_t solves = 0;  ///< Newton steps since the frame began; written by solve_chains.
  bool unconverged = false;  ///< A length error above 1 % was left in this frame; written by solve_chains.
};

/// The whole rope at once: velocities such that every segment carries the force of its stiffness at the end
/// of the substep, with static contacts and friction inside the system.
///
/// Unknown are node velocities u_i and segment impulses q_i. For a segment from a to b, n its direction, C =
/// l - L:
///   axial        n.(u_b - u_a) = -b C + gamma n.q,   b = k/(c + h k),  gamma = 1/(h (c + h k)) >= chi /
///   min(m_a, m_b) transverse   q_t = (g + f)((u_b - u_a) - (v_b - v_a))_t + d g (u_b - u_a)_t,  g = h^2 T+ /
///   L,  f = 1e-5 min(m_a, m_b)
/// d is 0.02 in the air and 0.1 in contact. g is the geometric stiffness of a segment under tension T+ =
/// max(0, last tension, largest of this substep): it acts on the change of velocity, so that a swing keeps
/// its energy; without it stiff ropes explode. A sweep from the first node condenses everything behind it to
/// u = s + X q (compliance form: exact for k = infinity), a sweep back gives q and u. The solve repeats,
/// linearized anew, while a length error exceeds 0.1 %, at most 8 times. A contact holds its node with N =
/// max(0, N0 - rho (n.u + s/h)), rho = 1000 m, N0 carried over substeps; friction likewise, scaled onto the
/// disc mu N. Sources: docs/decisions/0002-ropes.md; geometric stiffness after Tournier et al. 2015, "Stable
/// constrained dynamics".
///
/// `before` holds velocities from before this substep's forces. Segments of zero length keep their last
/// direction's force out: they are treated as pointing down. Sweeps are in double: a rope is solved exactly
/// or not at all.
void solve_chains(std::span<Chain> chains, const std::vector<Vec3>& before, Real h,
                  state::Particles& particles, state::Segments& segments, state::Contacts& contacts);

}  // namespace hooke::solver
