#pragma once

#include "solver/joint_rows.h"

#include <compare>
#include <vector>

/// \file
/// Trees of bodies and joints, of one form, side by side: one in each lane. Their rows, and one solution of
/// all of them for given bounds. The numbers are double in both precisions of the engine. Equations:
/// solver/articulations.h and solver/joint_rows.h.

namespace hooke::solver::wide {

inline constexpr int kTreeLanes = 8;  ///< One vector of the widest set, several of others.
inline constexpr int kMostTreeRows =
    13;  ///< Of a joint: each freedom a limit and something else, and a cone.

/// A loose tree is solved once where others go on until every row is within its bounds. Friction that slides
/// is viscous: with the speed |v| of the last substep, at least kLooseSlide and kLooseJolt times that before
/// the joints are solved,
///
///   gamma = |v| / high,   so that lambda = -v / gamma is `high` where the speed stays,
///
/// and it is at its bound only if that asks for more than kLooseFriction times as much, as where a jolt sets
/// it sliding. Limits are met, and let go, in the next substep where that makes kLooseSpeed or less.
inline constexpr double kLooseSlide = 0.05;  ///< [m/s] or [rad/s]
inline constexpr double kLooseJolt = 0.25;
inline constexpr double kLooseFriction = 3;
inline constexpr double kLooseSpeed = 0.2;  ///< [m/s] or [rad/s]

/// What is the same for a row in all lanes.
struct TreeRowForm {
  int freedom = 0;
  RowRole role = RowRole::kLock;
  bool sprung = false;  ///< A motor with a spring beside it, which acts while the motor is at a bound.

  auto operator<=>(const TreeRowForm&) const = default;

  [[nodiscard]] bool turns() const { return freedom >= 3; }
  [[nodiscard]] bool bounded() const { return role == RowRole::kMotor || role == RowRole::kLimit; }
  /// It is not there while it is at a bound.
  [[nodiscard]] bool drops() const { return bounded() && !sprung; }
};

/// Joint i joins link i, its child, to a link that is eliminated later.
struct TreeJoint {
  int parent = 0;
  bool parent_moves = true;
  bool child_is_b = false;
  HookKind kind = HookKind::kBall;
  bool turns = false;  ///< Rows need its angles.
  int first = 0;       ///< Of its rows, those of ways first.
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
  // As JointBody. Of bodies that tumble (`tumbles` is 1) the last three are found from what stands below.
  double center[3][kCount], v[3][kCount];
  double inverse_mass[kCount], mass[kCount];  ///< Both 0 where nothing moves it.
  double rotation[4][kCount], scale[6][kCount], omega_before[3][kCount];
  double scale_inverse[6][kCount], step_scale_inverse[6][kCount], tumbles[kCount];

  double stiffness[6][kCount];  ///< h^2 S K S
  double turning[6][kCount];    ///< 1 + 1.2 G: inertia in scaled coordinates.
  double omega[3][kCount];      ///< Scaled, without the joints.

  double v_now[3][kCount], omega_now[3][kCount];     ///< The result.
  double principal[4][kCount], inertia[3][kCount];   ///< As BodyMass.
  double step_scale[6][kCount];                      ///< S of the start of the step.
  double a[21][kCount], g[6][kCount], u[6][kCount];  ///< Of the elimination, as tree_sweep.h has it.
};

/// A hook.
template <int kCount>
struct alignas(8 * kCount) TreeJointLanes {
  double anchor_a[3][kCount], anchor_b[3][kCount];  ///< As HookPlace.
  double axes_a[4][kCount], axes_b[4][kCount];
  double value[6][kCount];    ///< Of the freedoms: before, then now.
  double impulse[3][kCount];  ///< On b, of the substep before, then of this one [N s].
  double angular[3][kCount];
};

/// A row. Its direction is that of the child's motion: `child` and `parent` have opposite signs.
template <int kCount>
struct alignas(8 * kCount) TreeRowLanes {
  double n[3][kCount];  ///< On the child, minus that on the parent; of an angle its axis, which acts so.
  double child[3][kCount], parent[3][kCount];
  double gamma[kCount], target[kCount];  ///< Where it is at no bound.
  double goal[kCount];                   ///< Setting of locks and springs.
  // If it is bounded.
  double low[kCount], high[kCount], bound[kCount];  ///< Of impulses; -1, 0 or 1.
  double lower[kCount], upper[kCount];              ///< Settings of limits.
  double freed[kCount];  ///< 1 once it was let go: when it comes to a bound again it stays.
  // If it is a motor or a spring.
  double speed[kCount];                                ///< Setting of motors.
  double stiffness[kCount], damping[kCount];           ///< Settings of springs.
  double spring_gamma[kCount], spring_target[kCount];  ///< Of the spring beside a motor.
  double held_spring[kCount];                          ///< The spring's impulse while the motor holds.

  double lambda[kCount], spring_lambda[kCount];  ///< Impulses; before: of the last substep.

  // Of the elimination: D^-1 W, V, z, 1 / d, K.
  double w[6][kCount], v[6][kCount], z[kCount], inverse[kCount], l[kMostTreeRows][kCount];
  double change[kCount];
};

template <int kCount>
struct TreeLanes {
  std::vector<TreeLinkLanes<kCount>> links;
  std::vector<TreeJointLanes<kCount>> joints;
  std::vector<TreeRowLanes<kCount>> rows;
  double release[kCount];  ///< 1 where rows may leave their bounds, otherwise 0.
  double loose[kCount];    ///< 1 where the tree is loose, otherwise 0.
  // Results.
  double changed[kCount];  ///< 1 where a row came to a bound or left it.
  double grew[kCount];     ///< 1 where a stiffness grew, so that the solution is not to be trusted.
  double fast[kCount];     ///< Square of how fast the fastest body turns [(rad/s)^2].
};

/// The rows of a substep of length h [s], with the bounds they begin with, and the stiffness by the last
/// forces.
void make_tree_rows(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees);
void make_tree_rows(double h, const TreeForm& form, TreeLanes<1>& tree);

/// Impulses and velocities with the rows' bounds, then the bounds that they ask for; where none changes, the
/// stiffness by the forces found.
void solve_trees(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees);
void solve_trees(double h, const TreeForm& form, TreeLanes<1>& tree);

/// One lane's rows anew about the end of the substep, as the velocities found say. Returns the largest error
/// of a lock, over the levers or in rad.
double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<kTreeLanes>& trees);
double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<1>& tree);

/// One lane's impulses within their bounds, and the velocities that they give.
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<kTreeLanes>& trees);
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<1>& tree);

// The scalar twins, lane after lane.
void make_tree_rows_scalar(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees);
void solve_trees_scalar(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees);

}  // namespace hooke::solver::wide
