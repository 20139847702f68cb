#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

/// \file
/// Ropes of equally many nodes side by side, one in each lane, and the solution of a Newton step for all of
/// them at once. The numbers are double in both precisions of the engine. Equations: solver/chains.h.

namespace hooke::solver::wide {

inline constexpr int kRopeLanes = 8;  ///< One vector of the widest set, several of others.

template <int kCount>
struct RopeNodeLanes {
  double x[3][kCount], v_free[3][kCount], v_before[3][kCount];  ///< As RopeNode.
  double mass[kCount], w[kCount];
  double u[3][kCount];  ///< The result.

  // Of the elimination, as rope_sweep.h has it: P, f, r, tau; with bends, F and c.
  double inverse[6][kCount], impulse[3][kCount], along[3][kCount], tau[kCount];
  double meets[3][3][kCount], outer[kCount];
};

/// What touches a node: mass with grips, and impulse.
template <int kCount>
struct RopeHoldLanes {
  double mass[6][kCount], impulse[3][kCount];
};

/// The segment from node i to node i + 1, as RopeSegment.
template <int kCount>
struct RopeSegmentLanes {
  double rest[kCount], stiffness[kCount], damping[kCount], limit[kCount];
  double lighter[kCount];        ///< Mass of the lighter end that moves [kg].
  double held[kCount];           ///< 1 if neither end moves.
  double tension_bound[kCount];  ///< T+
  double limited[kCount];        ///< 1 if it is at its limit.
  double n[3][kCount], q[3][kCount];
  double offset[3][kCount], along[kCount], across[kCount];
};

/// Bending at node i + 1, as RopeBend. Its compliance and target in one: `pull` is what it gives for each
/// unit of the change of direction, `grip` for each unit of its rate.
template <int kCount>
struct RopeBendLanes {
  double before[kCount], behind[kCount];
  double pull[kCount], grip[kCount];
};

template <int kCount>
struct RopeLanes {
  std::vector<RopeNodeLanes<kCount>> nodes;
  std::vector<RopeSegmentLanes<kCount>> segments;
  std::vector<RopeBendLanes<kCount>> bends;  ///< Of inner nodes; none if no rope resists bending.
  std::vector<RopeHoldLanes<kCount>> holds;  ///< Of nodes that `held` names.
  std::vector<char> held;                    ///< Whether a node is touched in any lane.
  // As RopeSetting; `first` is 1 or 0.
  double compliance[kCount], turning[3][kCount], first[kCount];

  // Results.
  double error[kCount];           ///< Largest relative length error left.
  double limits_changed[kCount];  ///< 1 if a segment went onto or off its limit.
  double finite[kCount];          ///< 0 if every velocity is finite, else not a number.
};

/// A Newton step of substep length h [s]: linearizes all segments, finds velocities and impulses, raises T+,
/// moves segments onto or off their limits.
void solve_ropes(double h, RopeLanes<kRopeLanes>& ropes);
/// The same for a single rope.
void solve_ropes(double h, RopeLanes<1>& rope);

/// The scalar twin, lane after lane.
void solve_ropes_scalar(double h, RopeLanes<kRopeLanes>& ropes);

}  // namespace hooke::solver::wide
