#pragma once

#include "solver/surface/surface_groups.h"
#include "state/tables.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hooke::solver {

/// A ball hook that holds a node of a rope to something that does not give way (state::gives_way).
struct RopeAnchor {
  std::uint32_t rope_system = 0, node = 0;
  std::uint32_t hook = 0;  ///< Row of the hook.
  bool node_is_b = false;  ///< Whether the node is the hook's end b; else it is end a.
};

/// One chain of a rope (state/rope_chains.h) as the solver sees it: all of the rope, unless it has snapped.
/// Its nodes are particles [first_particle, first_particle + node_count), its
/// segments rows [first_segment, first_segment + node_count - 1), its contacts rows [first_contact,
/// end_contact), its anchors [first_anchor, end_anchor).
struct RopeSystem {
  std::uint32_t first_particle = 0;
  std::uint32_t node_count = 0;
  std::uint32_t first_segment = 0;
  double bend_stiffness = 0;  ///< EI [N m^2]
  double bend_damping = 0;    ///< Damping over EI [s].
  std::uint32_t object = 0;   ///< Row of the rope.
  std::uint32_t first_contact = 0;
  std::uint32_t end_contact = 0;
  std::uint32_t first_anchor = 0;  ///< Written by build_coupled_groups.
  std::uint32_t end_anchor = 0;
  std::uint32_t solves = 0;       ///< Newton steps since the frame began; written by solve_rope_systems.
  bool in_coupled_group = false;  ///< Whether a coupled group solves it; written by build_coupled_groups
                                  ///< (solver/coupled/coupled_groups.h).
  bool unconverged = false;       ///< A length error above 1 % was left in this frame, by solve_rope_systems.
};

/// A particle substep as ropes see it.
struct RopeSubstep {
  Real h = Real(0);                                  ///< Its length [s].
  const std::vector<state::VelocityRecord>& before;  ///< By particle: velocities from before the forces.
  SurfaceContacts& surfaces;                         ///< Holds what presses on ropes.
};

/// Memory of solve_rope_systems. It keeps the constants of ropes until the revision of the tables changes.
class RopeSystemScratch {
 public:
  struct Groups;  // Defined in solver/rope/rope_systems.cpp.

  RopeSystemScratch();
  ~RopeSystemScratch();
  RopeSystemScratch(RopeSystemScratch&&) noexcept;
  RopeSystemScratch& operator=(RopeSystemScratch&&) noexcept;

  [[nodiscard]] Groups& groups() { return *groups_; }

 private:
  std::unique_ptr<Groups> groups_;
};

/// Solves each rope as a whole: finds velocities such that every segment carries the force of its stiffness
/// at the end of the substep. Static contacts and friction are inside the system.
///
/// The unknowns are the node velocities u and the segment impulses q. For a segment from a to b, n is its
/// direction, r = u_b - u_a, r0 = v_b - v_a before this substep's forces, C = l - L, and m the lighter end's
/// mass:
///
///   axial        n.r = -b C + gamma n.q,  b = k / (c + h k),  gamma = 1 / (h (c + h k)) >= chi / m
///   transverse   q_t = (g + f) (r - r0)_t + d g (r - omega x L n)_t,  g = h^2 T+ / L,  f = 1e-5 m
///
/// g is the geometric stiffness of a segment under tension T+ = max(0, last tension, largest of this
/// substep). It acts on the change of velocity, so that a swing keeps its energy; without it stiff ropes
/// explode. Its share d = 0.2 damps motion unlike that of the line between the rope's ends, which turns at
/// omega: it damps waves, not swings. chi is 1e-7 in the air and 1e-5 in contact.
///
/// A rope that resists bending has a moment M at each inner node. m_d and m_e are the vectors of the
/// segments before and behind it over their lengths, and B is EI over the length between their middles:
///
///   bending      M = -B (c + h beta (r_c - r_c0) + h delta r_c + d r_c)
///
/// Here c = m_e - m_d at the start of the substep, r_c is its rate, r_c0 that rate before this substep's
/// forces, d the damping over EI [s], beta = 1/4 and delta = 0.03: see RopeBend.
///
/// A sweep from the first node eliminates one node after the other (solver/rope/rope_sweep.h; exact for k =
/// infinity), and a sweep back gives u and q. The solve repeats, linearized anew, while a length error
/// exceeds 0.1 %, at most 8 times. With more than 1 % left it repeats 8 times more without friction, and
/// what is left then is reported. Ropes of equally many nodes are solved together, one in each lane of a
/// vector.
///
/// A contact holds its node with N = max(0, N0 - rho (n.u + s/h)), where rho is 1000 m or, against a body
/// that gives way, 10 times its mass, u is relative to the surface, and N0 is carried over substeps. Friction
/// holds likewise with 1000 m up to mu N, and beyond that it is mu N against the motion. An anchor holds its
/// node by the hook's rows (solver/joint_rows/joint_rows.h), with a compliance of 1e-6 of the node's own.
///
/// Sources: docs/decisions/0002-ropes.md; geometric stiffness after Tournier et al. 2015, "Stable
/// constrained dynamics". A segment of no length is taken to point down. Sweeps are in double: the
/// directions of a rope's segments differ in compliance by a factor of 1e10.
///
/// What presses on a rope (SurfaceContacts::loads) acts as a contact whose rho is its mass, but at most 1000
/// m: it moves on with the rope like a mass that is thrown on it.
void solve_rope_systems(std::span<RopeSystem> rope_systems, std::span<const RopeAnchor> anchors,
                        const RopeSubstep& substep, RopeSystemScratch& scratch, state::Tables& tables);

}  // namespace hooke::solver
