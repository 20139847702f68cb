#pragma once

#include "parallel/range.h"
#include "solver/soft/spring_blocks.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// The stretch springs of a woven cloth lie along its yarns, the warp and the weft. A yarn is a chain, and
/// its springs are solved all at once: what one end pulls arrives at the other in the same substep, however
/// many points lie between.

namespace hooke::solver {

/// One link of 16 yarns: from the node of this row to that of the next.
struct alignas(64) YarnRow {
  Real rest_length[kLanes];      ///< L [m]; 0 behind the end of a yarn, where both nodes are the same.
  std::uint32_t record[kLanes];  ///< 4 times the row of the node, counted from Yarns::first_particle.
  // Scratch of a solution.
  Real direction[3][kLanes];  ///< n, from the node to the next.
  Real inverse_length[kLanes];
  Real coupling[kLanes];    ///< Share of the impulse of the next link that this link's takes up.
  Real impulse[kLanes];     ///< The impulse if that of the next link were zero, then the impulse [N s].
  Real is_limited[kLanes];  ///< 1 for a link that is held at its largest length, else 0.
  Real tautness[kLanes];    ///< h^2 T / l of a link so taut that its nodes need it, else 0 [kg].
  Real given[kLanes];       ///< Impulse along the link that the nodes have already got [N s],
  Real pull[3][kLanes];     ///< and all of it.
};

/// How 16 yarns bend at one node, and the link behind it.
struct alignas(64) YarnBendRow {
  double stiffness[kLanes];  ///< k [N m], of the energy k c^2 / 2; 0 at the ends, or where nothing bends.
  double per_rest[kLanes];   ///< 1 / L of the link to the next node [1/m]; 0 if there is none.
  // Scratch of a solution.
  double next[kLanes], second[kLanes];  ///< Shares of the changes of the next node, and of that behind it.
  double change[3][kLanes];             ///< Change of velocity, if theirs were zero [m/s].
};

/// Up to 16 yarns side by side. The last row has only the nodes of their ends.
struct YarnBlock {
  std::uint32_t first_row = 0;
  std::uint32_t row_count = 0;  ///< One more than the links of the longest.
  int count = kLanes;           ///< Yarns; copies of the last one fill the lanes.
  bool bends = false;           ///< Whether any of them resists bending.
  Real bend_damping = Real(0);  ///< tau of their bends [s].
};

/// The law of the links of a yarn.
struct YarnMaterial {
  SpringMaterial spring;
  SpringMaterial limit;          ///< Of the largest length, a rigid spring.
  Real most_extension = kRigid;  ///< Largest length, over L, less 1; kRigid for none.
  /// Impulse over L from which on a link is longer than its limit at the end of the substep [N s / m].
  /// Written by prepare_yarns.
  Real most_impulse = kRigid;

  [[nodiscard]] bool has_limit() const { return most_impulse < kRigid; }

  friend bool operator==(const YarnMaterial&, const YarnMaterial&) = default;
};

/// Blocks [first, end) hold yarns of one direction and one material: no two share a particle.
struct YarnPass {
  std::uint32_t material = 0;
  int first = 0;
  int end = 0;
};

struct Yarns {
  std::uint32_t first_particle = 0;  ///< Row of the particle that records count from.
  std::vector<YarnRow> rows;
  std::vector<YarnBendRow> bend_rows;  ///< By row; none if no yarn resists bending.
  std::vector<YarnBlock> blocks;
  std::vector<YarnMaterial> materials;
  std::vector<YarnPass> passes;  ///< In the order of the solution.
  Real h = Real(0);              ///< Length of a substep [s]; written by prepare_yarns.
};

/// Springs and bends that another part of the solver has, counted from the first of the objects' rows.
struct TakenRows {
  std::vector<std::uint8_t> springs, bends;
};

/// Chains the stretch springs along the columns and rows of woven cloths, those whose points lie in a grid,
/// with the limits of their lengths and their bends, and marks them in `taken`. A chain ends where springs
/// differ.
void build_yarns(std::span<const state::Deformable> objects, const state::Springs& springs,
                 const state::Bends& bends, const state::Particles& particles, TakenRows& taken,
                 Yarns& yarns);

/// Sets the coefficients of all links for a substep of `h` [s].
void prepare_yarns(Yarns& yarns, Real h);

/// Solves the yarns of some blocks of one pass. Each link has the law of solver/soft/spring_solve.h, of a
/// spring whose direction is that at the start of the substep; the impulses of a yarn solve
///
///     (w_i + w_{i+1} + gamma) p_i - w_i (n_{i-1} . n_i) p_{i-1} - w_{i+1} (n_i . n_{i+1}) p_{i+1} = r_i
///
/// where r_i is the rate at which link i grows, and its bias. Elimination goes from the first link to the
/// last, and back. Links that would end longer than their limit are rigid links of that length then, and the
/// yarn is solved again.
///
/// A taut yarn resists turning, too, by its tension T: where h^2 T / l is more than the masses of its nodes,
/// these would swing across it without bound. There the velocities v that the impulses have left become those
/// of an implicit Euler step,
///
///     v_i' + w_i h^2 [(T / l)_{i-1} (v_i' - v_{i-1}') + (T / l)_i (v_i' - v_{i+1}')] = v_i
///
/// and what that changes along the yarn is taken back by solving it again.
void solve_yarns(Yarns& yarns, const YarnPass& pass, parallel::Range blocks, state::Particles& particles);

/// Bends the yarns of some blocks of one pass, each as a whole: an implicit Euler step of the energies k c^2
/// / 2 of its nodes, with the friction k tau dc/dt. c is the change of direction between two links, as
/// vectors over their lengths at rest. With K the matrix of these energies, the velocities v become v + dv,
/// where
///
///     (1 + (h^2 + h tau) W K) dv = -W K (h x + (h^2 + h tau) v)
///
/// Elimination goes from the first node to the last, over five diagonals, and back.
void bend_yarns(Yarns& yarns, const YarnPass& pass, parallel::Range blocks, state::Particles& particles);

}  // namespace hooke::solver
