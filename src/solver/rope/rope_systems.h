#pragma once

#include "state/tables.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hooke::solver {

/// A ball hook that holds a node of a rope to what does not give way.
struct RopeAnchor {
  std::uint32_t rope_system = 0, node = 0;
  std::uint32_t hook = 0;  ///< Row.
  bool node_is_b = false;  ///< Else it is the hook's end a.
};

/// One rope as the solver sees it. Its nodes are particles [first_particle, first_particle + node_count), its
/// segments rows [first_segment, first_segment + node_count - 1), its contacts rows [first_contact,
/// end_contact), its anchors [first_anchor, end_anchor).
struct RopeSystem {
  std::uint32_t first_particle = 0;
  std::uint32_t node_count = 0;
  std::uint32_t first_segment = 0;
  double bend_stiffness = 0;  ///< EI [N m^2]
  double bend_damping = 0;    ///< Over EI [s].
  std::uint32_t first_contact = 0;
  std::uint32_t end_contact = 0;
  std::uint32_t first_anchor = 0;  ///< Written by build_bundles.
  std::uint32_t end_anchor = 0;
  std::uint32_t solves = 0;  ///< Newton steps since the frame began; written by solve_chains.
  bool in_coupled_group =
      false;  ///< Solved with what it is tied to; written by build_bundles (solver/coupled/coupled_groups.h).
  bool unconverged = false;  ///< A length error above 1 % was left in this frame; written by solve_chains.
};

/// Memory of solve_chains: it keeps what stays of ropes, until the revision of the tables changes.
class RopeSystemScratch {
 public:
  struct Groups;  // chains.cpp

  RopeSystemScratch();
  ~RopeSystemScratch();
  RopeSystemScratch(RopeSystemScratch&&) noexcept;
  RopeSystemScratch& operator=(RopeSystemScratch&&) noexcept;

  [[nodiscard]] Groups& groups() { return *groups_; }

 private:
  std::unique_ptr<Groups> groups_;
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
/// At an inner node of a rope that resists bending, with the segments' vectors over their lengths m_d, m_e
/// before and behind it, and EI over the length between their middles B:
///
///   bending      M = -B (c / h + beta (r_c - r_c0) + delta r_c + d r_c)
///
/// c = m_e - m_d at the start of the substep, r_c its rate, r_c0 that before this substep's forces, d the
/// damping, beta = 1/4 and delta = 0.03: see RopeBend.
///
/// A sweep from the first node eliminates one after the other (wide/rope_sweep.h; exact for k = infinity), a
/// sweep back gives u and q. The solve repeats, linearized anew, while a length error exceeds 0.1 %, at most
/// 8 times; with more than 1 % left, 8 times more without friction. What is left then is reported. Ropes of
/// equally many nodes are solved together, one in each lane of a vector.
///
/// A contact holds its node with N = max(0, N0 - rho (n.u + s/h)), rho = 1000 m, u relative to the surface,
/// N0 carried over substeps; friction holds likewise up to mu N and is mu N against the motion beyond. An
/// anchor holds its node by the hook's rows (joint_rows.h), with a compliance of 1e-6 of the node's own.
///
/// Sources: docs/decisions/0002-ropes.md; geometric stiffness after Tournier et al. 2015, "Stable constrained
/// dynamics". A segment of no length is taken to point down. Sweeps are in double: the directions of a rope's
/// segments differ in compliance by a factor of 1e10. `before` holds velocities from before the forces.
void solve_rope_systems(std::span<RopeSystem> rope_systems, std::span<const RopeAnchor> anchors,
                        const std::vector<state::VelocityRecord>& before, Real h, RopeSystemScratch& scratch,
                        state::Tables& tables);

}  // namespace hooke::solver
