#pragma once

#include <compare>
#include <vector>

/// \file
/// Trees of bodies and joints, of one form, side by side: one in each lane, and one solution of all of them
/// for given bounds. The numbers are double in both precisions of the engine. Equations:
/// solver/articulations.h.

namespace hooke::solver::wide {

inline constexpr int kTreeLanes = 8;  ///< One vector of the widest set, several of others.
inline constexpr int kMostTreeRows =
    13;  ///< Of a joint: each freedom a limit and something else, and a cone.

/// What is the same for a row in all lanes.
struct TreeRowForm {
  bool turns = false;    ///< An angle: n = 0. Those of a joint come after its ways.
  bool bounded = false;  ///< A motor or limit.
  bool sprung = false;   ///< A motor with a spring beside it, which acts while the motor is at a bound.

  auto operator<=>(const TreeRowForm&) const = default;
};

/// Joint i joins link i to a link that is eliminated later.
struct TreeJoint {
  int parent = 0;
  bool parent_moves = true;
  int first = 0;  ///< Of its rows.
  int count = 0;

  auto operator<=>(const TreeJoint&) const = default;
};

/// In order of elimination; the root is one link more than there are joints.
struct TreeForm {
  std::vector<TreeJoint> joints;
  std::vector<TreeRowForm> rows;

  auto operator<=>(const TreeForm&) const = default;
};

/// A body. Lower triangles of 6 x 6 matrices stand row by row.
template <int kCount>
struct alignas(8 * kCount) TreeLinkLanes {
  double mass[kCount];
  double turning[6][kCount];              ///< 1 + 1.2 G: inertia in scaled coordinates.
  double v[3][kCount], omega[3][kCount];  ///< Without the joints.

  double v_now[3][kCount], omega_now[3][kCount];  ///< The result.
  double a[21][kCount], g[6][kCount];             ///< Of the elimination, as tree_sweep.h has it.
  double u[6][kCount];                            ///< What the joints change.
};

/// A row. Its direction is that of the child's motion: `child` and `parent` have opposite signs.
template <int kCount>
struct alignas(8 * kCount) TreeRowLanes {
  double n[3][kCount];  ///< On the child; minus that on the parent.
  double child[3][kCount], parent[3][kCount];
  double gamma[kCount], target[kCount];                ///< Where it is at no bound.
  double low[kCount], high[kCount], bound[kCount];     ///< -1, 0 or 1; read if it is bounded.
  double spring_gamma[kCount], spring_target[kCount];  ///< Of the spring beside it.
  double held_spring[kCount];                          ///< The spring's impulse while the motor holds.

  double lambda[kCount], spring_lambda[kCount];  ///< The result: impulses with the bounds of before.

  // Of the elimination: D^-1 W, V, z, 1 / d, L.
  double w[6][kCount], v[6][kCount], z[kCount], inverse[kCount], l[kMostTreeRows][kCount];
  double change[kCount];
};

template <int kCount>
struct TreeLanes {
  std::vector<TreeLinkLanes<kCount>> links;
  std::vector<TreeRowLanes<kCount>> rows;
  double release[kCount];  ///< 1 where rows may leave their bounds, otherwise 0.
  double changed[kCount];  ///< Result: 1 where a row came to a bound or left it.
};

/// Impulses and velocities with the rows' bounds, then the bounds that they ask for.
void solve_trees(const TreeForm& form, TreeLanes<kTreeLanes>& trees);
/// The same for a single tree.
void solve_trees(const TreeForm& form, TreeLanes<1>& tree);

/// The scalar twin, lane after lane.
void solve_trees_scalar(const TreeForm& form, TreeLanes<kTreeLanes>& trees);

}  // namespace hooke::solver::wide
