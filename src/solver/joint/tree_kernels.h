#pragma once

#include "solver/joint/joint_tuning.h"
#include "solver/joint_rows/joint_rows.h"

#include <compare>
#include <vector>

/// \file
/// Trees of bodies and joints of one form, side by side: one in each lane. These kernels make their rows, and
/// solve all of them once for given bounds. Equations: solver/joint/articulations.h and
/// solver/joint_rows/joint_rows.h.

namespace hooke::solver::wide {

/// Rows of a joint: for each freedom a limit and something else, and a cone.
inline constexpr int kMostTreeRows = 13;

/// The properties of a row that are the same in all lanes.
struct TreeRowForm {
  int freedom = 0;
  RowRole role = RowRole::kLock;
  bool sprung = false;  ///< A motor with a spring beside it, which acts while the motor is at a bound.

  auto operator<=>(const TreeRowForm&) const = default;

  [[nodiscard]] bool turns() const { return freedom >= 3; }
  [[nodiscard]] bool bounded() const { return role == RowRole::kMotor || role == RowRole::kLimit; }
  /// Whether the row is absent while it is at a bound.
  [[nodiscard]] bool drops() const { return bounded() && !sprung; }
};

/// Joint i joins link i, its child, to a link that is eliminated later.
struct TreeJoint {
  int parent = 0;
  bool parent_moves = true;
  bool child_is_b = false;
  HookKind kind = HookKind::kBall;
  bool turns = false;  ///< Its rows need the angles.
  int first = 0;       ///< Index of its first row; rows of translations come first.
  int count = 0;

  auto operator<=>(const TreeJoint&) const = default;
};

/// Joints in order of elimination; there is one link more than joints, the root.
struct TreeForm {
  std::vector<TreeJoint> joints;
  std::vector<TreeRowForm> rows;

  auto operator<=>(const TreeForm&) const = default;
};

/// How trees are solved, and how many side by side: one vector of the widest instruction set, several of
/// others. Exact trees use double in both precisions of the engine. `kCompliance` is a share of each
/// diagonal, above rounding.
///
/// An approximate tree is solved once, where others go on until every row is within its bounds. Friction that
/// slides is viscous: with the speed |v| of the last substep, at least kApproximateSlide and kApproximateJolt
/// times that before the joints are solved,
///
///   gamma = |v| / high,   so that lambda = -v / gamma is `high` where the speed stays,
///
/// and it is at its bound only if that demands more than kApproximateFriction times as much, as where a jolt
/// makes it slide. Limits act, and are let go, in the next substep where that causes a speed of
/// kApproximateSpeed or less.
struct ExactTrees {
  using Lane = double;
  static constexpr int kCount = 8;
  static constexpr bool kApproximate = false;
  static constexpr double kCompliance = kExactTreeCompliance;
};
struct ExactTree : ExactTrees {
  static constexpr int kCount = 1;
};
struct ApproximateTrees {
  using Lane = Real;
  static constexpr int kCount = 16;
  static constexpr bool kApproximate = true;
  static constexpr double kCompliance = kApproximateTreeCompliance;
};
struct ApproximateTree : ApproximateTrees {
  static constexpr int kCount = 1;
};

/// A body in lanes. Lower triangles of 6 x 6 matrices are stored row by row.
template <class Kind>
struct alignas(sizeof(typename Kind::Lane) * Kind::kCount) TreeLinkLanes {
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;

  // As JointBody. The last three are found from the columns below.
  Lane center[3][kCount], v[3][kCount];
  Lane inverse_mass[kCount], mass[kCount];  ///< Both 0 where nothing moves it.
  Lane rotation[4][kCount], scale[6][kCount], omega_before[3][kCount];
  Lane scale_inverse[6][kCount], step_scale_inverse[6][kCount], is_gyroscopic[kCount];

  Lane stiffness[6][kCount];  ///< h^2 S K S
  Lane turning[6][kCount];    ///< 1 + 1.2 G: inertia in scaled coordinates.
  Lane omega[3][kCount];      ///< Scaled angular velocity without the joints.

  Lane v_now[3][kCount], omega_now[3][kCount];    ///< Resulting velocities.
  Lane omega_of_step[3][kCount];                  ///< The second of them, scaled by `step_scale`.
  Lane gained[3][kCount];                         ///< Angular momentum that the joints gave.
  Lane principal[4][kCount], inertia[3][kCount];  ///< As BodyMass, if `is_gyroscopic` is 1.
  Lane step_scale[6][kCount];                     ///< S of the start of the step.
  Lane turned[3][kCount];  ///< Turn since the rotation that was loaded, scaled by S; a small one.
  Lane a[21][kCount], g[6][kCount], u[6][kCount];  ///< Elimination: solver/joint/tree_sweep.h.
};

/// A hook in lanes.
template <class Kind>
struct alignas(sizeof(typename Kind::Lane) * Kind::kCount) TreeJointLanes {
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;

  Lane anchor_a[3][kCount], anchor_b[3][kCount];  ///< As HookPlace.
  Lane axes_a[4][kCount], axes_b[4][kCount];
  Lane value[6][kCount];    ///< Value of each freedom: before, then now.
  Lane impulse[3][kCount];  ///< Impulse on b, of the substep before, then of this one [N s].
  Lane angular[3][kCount];
};

/// A row in lanes. Its direction is that of the child's motion: `child` and `parent` have opposite signs.
template <class Kind>
struct alignas(sizeof(typename Kind::Lane) * Kind::kCount) TreeRowLanes {
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;

  /// Direction on the child, minus that on the parent. For an angle it is the axis, with the same signs.
  Lane n[3][kCount];
  Lane child[3][kCount], parent[3][kCount];
  Lane gamma[kCount], target[kCount];  ///< While it is at no bound.
  Lane goal[kCount];                   ///< Setting of locks and springs.
  // Only if the row is bounded.
  Lane low[kCount], high[kCount], bound[kCount];  ///< Bounds of impulses; -1, 0 or 1.
  Lane lower[kCount], upper[kCount];              ///< Settings of limits.
  Lane freed[kCount];  ///< 1 once it was let go: when it comes to a bound again, it stays.
  // Only for a motor or a spring.
  Lane speed[kCount];                                ///< Setting of motors.
  Lane stiffness[kCount], damping[kCount];           ///< Settings of springs.
  Lane start[kCount];                                ///< Spring value minus goal, at present.
  Lane spring_gamma[kCount], spring_target[kCount];  ///< Spring beside a motor.
  Lane held_spring[kCount];                          ///< The spring's impulse while the motor holds.

  Lane lambda[kCount], spring_lambda[kCount];  ///< Impulses; before that, those of the last substep.

  // Numbers of the elimination: D^-1 W, V, z, 1 / d, K.
  Lane w[6][kCount], v[6][kCount], z[kCount], inverse[kCount], l[kMostTreeRows][kCount];
  Lane change[kCount];
};

template <class Kind>
struct TreeLanes {
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;

  alignas(sizeof(Lane) * kCount) Lane release[kCount];  ///< 1 where rows may leave their bounds, otherwise 0.
  // Results.
  Lane changed[kCount];  ///< 1 where a row came to a bound or left it.
  Lane grew[kCount];     ///< 1 where a stiffness grew, so that the solution is not to be trusted.
  Lane fast[kCount];     ///< Square of the speed at which the fastest body turns [(rad/s)^2].

  std::vector<TreeLinkLanes<Kind>> links;
  std::vector<TreeJointLanes<Kind>> joints;
  std::vector<TreeRowLanes<Kind>> rows;
};

// Vectors are loaded from these arrays as from aligned memory.
static_assert(alignof(TreeLanes<ExactTrees>) == sizeof(ExactTrees::Lane) * ExactTrees::kCount);
static_assert(alignof(TreeLanes<ApproximateTrees>) ==
              sizeof(ApproximateTrees::Lane) * ApproximateTrees::kCount);

/// Makes the rows of a substep of length h [s], with the bounds they begin with, and the stiffness by the
/// last forces.
void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees);
void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTree>& tree);
void make_tree_rows(double h, const TreeForm& form, TreeLanes<ApproximateTrees>& trees);
void make_tree_rows(double h, const TreeForm& form, TreeLanes<ApproximateTree>& tree);

/// Finds impulses and velocities with the rows' bounds, then the bounds that they need. Where none changes,
/// also the stiffness by the forces found.
void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees);
void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTree>& tree);
void solve_trees(double h, const TreeForm& form, TreeLanes<ApproximateTrees>& trees);
void solve_trees(double h, const TreeForm& form, TreeLanes<ApproximateTree>& tree);

/// Makes one lane's rows again about the end of the substep, by the velocities found. Returns the largest
/// error of a lock, over the levers or in rad.
double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<ExactTrees>& trees);
double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<ExactTree>& tree);

/// Clamps one lane's impulses to their bounds, and finds the velocities that they give.
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ExactTrees>& trees);
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ExactTree>& tree);
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ApproximateTrees>& trees);
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ApproximateTree>& tree);

// The scalar twins, lane after lane.
void make_tree_rows_scalar(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees);
void make_tree_rows_scalar(double h, const TreeForm& form, TreeLanes<ApproximateTrees>& trees);
void solve_trees_scalar(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees);
void solve_trees_scalar(double h, const TreeForm& form, TreeLanes<ApproximateTrees>& trees);

}  // namespace hooke::solver::wide
