#pragma once

#include "hooke/math.h"

#include "solver/simd/lanes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// The solution of a Newton step for ropes of equally many nodes side by side, one in each lane. The numbers
/// are double in both precisions of the engine. Equations: solver/rope/rope_systems.h.

namespace hooke::solver::wide {

inline constexpr int kRopeLanes = kDoubleLanes;  ///< Each lane holds one rope.

/// The constants of a segment, with the quotients that its equation takes.
template <class Number>
struct SegmentTraits {
  Number rest, per_rest;          ///< L [m]; 1 / L
  Number limit;                   ///< Largest length [m].
  Number damping, per_stiffness;  ///< c; 1 / k, which is 0 if it is rigid.
  Number bias, resistance;        ///< b; 1 / gamma = h (c + h k), infinite if it is rigid.
  Number lighter, per_lighter;    ///< m, mass of the lighter end that moves [kg]; 1 / m
};

/// Node i and the segment behind it, as RopeNode and SegmentTraits have them. The last node has no segment.
template <int kCount>
struct alignas(kCount * sizeof(double)) RopeTraitLanes {
  double mass[kCount], w[kCount];
  double rest[kCount], per_rest[kCount], limit[kCount], damping[kCount], per_stiffness[kCount];
  double bias[kCount], resistance[kCount], lighter[kCount], per_lighter[kCount];
};

/// Bending at node i + 1, as RopeBend has it, with compliance and target in one. The bend gives `pull` for
/// each unit of the change of direction and `resistance` for each unit of its rate. The change is the one
/// `back` seconds before the start [s].
template <int kCount>
struct alignas(kCount * sizeof(double)) RopeBendLanes {
  double before[kCount], behind[kCount];
  double pull[kCount], resistance[kCount], back[kCount], whipping_resistance[kCount];
};

/// The constants of ropes, which stay from substep to substep.
template <int kCount>
struct RopeTraits {
  std::vector<RopeTraitLanes<kCount>> rows;
  std::vector<RopeBendLanes<kCount>> bends;  ///< Bends of the inner nodes; none if no rope resists bending.
  std::vector<char> pinned;                  ///< By node: whether it is held in any lane.
  bool limits = false;                       ///< Whether any segment has a largest length.
  double length[kCount];                     ///< Length of each rope at rest [m].
};

template <int kCount>
struct alignas(kCount * sizeof(double)) RopeNodeLanes {
  double v_free[3][kCount];  ///< As RopeNode has it.
  double u[3][kCount];       ///< The result.

  double inverse[6][kCount], impulse[3][kCount], along[3][kCount],
      tau[kCount];  ///< P, f, r and tau of solver/rope/rope_sweep.h.
};

/// What the elimination adds for nodes with bends: F and c of solver/rope/rope_sweep.h.
template <int kCount>
struct alignas(kCount * sizeof(double)) RopeFillLanes {
  double next_block[3][3][kCount], outer[kCount];
};

/// What contacts and anchors do to a node: the mass that they add, and an impulse.
template <int kCount>
struct alignas(kCount * sizeof(double)) NodeConstraintLanes {
  double mass[6][kCount], impulse[3][kCount];
};

/// The segment from node i to node i + 1, as SegmentState has it.
template <int kCount>
struct alignas(kCount * sizeof(double)) RopeSegmentLanes {
  double line[3][kCount], before[3][kCount];
  double tension_bound[kCount];                                              ///< T+
  double limited[kCount];                                                    ///< 1 if it is at its limit.
  double n[3][kCount], offset[3][kCount], n_offset[kCount], across[kCount];  ///< As SegmentRow has them.
  double pull[kCount];                                                       ///< n.q
};

template <int kCount>
struct RopeLanes {
  std::vector<RopeNodeLanes<kCount>> nodes;
  std::vector<RopeSegmentLanes<kCount>> segments;
  std::vector<RopeFillLanes<kCount>> fills;              ///< None if no rope resists bending.
  std::vector<NodeConstraintLanes<kCount>> constraints;  ///< Only for nodes that `constrained` marks.
  std::vector<char> constrained;  ///< By node: whether a contact or an anchor acts on it in any lane.
  // As RopeSetting has them; `first` is 1 or 0.
  double compliance[kCount], turning[3][kCount], first[kCount];

  // Results.
  double error[kCount];           ///< Largest relative length error left.
  double limits_changed[kCount];  ///< 1 if a segment went onto or off its limit.
  double finite[kCount];          ///< 0 if every velocity is finite, else not a number.
};

/// Where ropes are in the tables. Positions and velocities are records of four numbers, three of which are a
/// vector.
template <int kCount>
struct RopeLocations {
  std::uint32_t first_particle[kCount], first_segment[kCount];
  const Real* position;
  const Real* before;  ///< Velocities before this substep's forces.
  Real* velocity;      ///< Velocities after these forces; the fourth number is the inverse mass.
  Real* tension;
  Real* mean_tension;
};

/// Reads free velocities, vectors of segments and their rates before the forces, and T+. No segment is at
/// its limit.
void load_ropes(const RopeLocations<kRopeLanes>& locations, RopeLanes<kRopeLanes>& ropes);
void load_ropes(const RopeLocations<1>& locations, RopeLanes<1>& rope);

/// Solves a Newton step of substep length h [s]: linearizes all segments, finds velocities and impulses,
/// raises T+, and moves segments onto or off their limits.
void solve_ropes(double h, const RopeTraits<kRopeLanes>& traits, RopeLanes<kRopeLanes>& ropes);
void solve_ropes(double h, const RopeTraits<1>& traits, RopeLanes<1>& rope);

/// Writes velocities and tensions of the lanes that `chosen` names, after a substep of length h [s], and adds
/// tensions to their sums.
void store_ropes(double h, const RopeLocations<kRopeLanes>& locations, const RopeTraits<kRopeLanes>& traits,
                 const bool (&chosen)[kRopeLanes], const RopeLanes<kRopeLanes>& ropes);
void store_ropes(double h, const RopeLocations<1>& locations, const RopeTraits<1>& traits,
                 const bool (&chosen)[1], const RopeLanes<1>& rope);

// The scalar twins, lane after lane.
void load_ropes_scalar(const RopeLocations<kRopeLanes>& locations, RopeLanes<kRopeLanes>& ropes);
void solve_ropes_scalar(double h, const RopeTraits<kRopeLanes>& traits, RopeLanes<kRopeLanes>& ropes);
void store_ropes_scalar(double h, const RopeLocations<kRopeLanes>& locations,
                        const RopeTraits<kRopeLanes>& traits, const bool (&chosen)[kRopeLanes],
                        const RopeLanes<kRopeLanes>& ropes);

}  // namespace hooke::solver::wide
