#pragma once

#include "hooke/math.h"

#include "parallel/thread_pool.h"
#include "solver/joint/hook_colors.h"
#include "solver/joint/joint_tuning.h"
#include "solver/joint_rows/joint_rows.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Iterative joints: networks of hooks that are too large to be solved as a whole are solved row by row, in
/// colors.

namespace hooke::solver {

/// Impulses of a joint in this substep, as its bodies carry them over to the next.
struct JointImpulse {
  DVec3 linear = {};     ///< Impulse on b, and the opposite on a [N s].
  DVec3 angular_a = {};  ///< Change of omega~ [sqrt(J)].
  DVec3 angular_b = {};
};

/// Number of hooks that each end of a hook has beyond kMostFreeHooks.
struct ExtraHooks {
  double a = 0;
  double b = 0;
};

/// Counts the hooks of each body that iterative joints move: replaces `degree`.
void count_hooks(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                 const state::Bodies& bodies, std::vector<int>& degree);

/// Iterative joints in colors: those of one color share no body that forces move.
///
/// Locks are soft, like contacts: with omega = 2 pi 60 Hz (at most 1/(4h)) and zeta = 5,
///
///   lambda -> lambda - mu (v + b C) / K - gamma lambda,   K the row's diagonal of J M^-1 J^T,
///   b = omega / a, mu = h omega a / (1 + h omega a), gamma = 1 - mu, a = 2 zeta + h omega;
///
/// After the bodies have moved, the same with b = gamma = 0 removes the speed that C has added. Impulses
/// carry over: those of the last substep are in the velocities already, like those of contacts, along the
/// directions of then. solve_iterative_joints begins with the difference to those of now.
///
/// K is larger where a body has more than kMostFreeHooks hooks. With a light body in the middle of many
/// hooks, sweeps that begin with the last impulses overshoot more each time (solver/linear/sweep_order.h).
/// With k_a and k_b what the ends add to the diagonal and n_a, n_b the hooks of each beyond kMostFreeHooks,
///
///   K = k_a + k_b + (n_a k_a^2 + n_b k_b^2) / (k_a + k_b).
///
/// A hook that can break takes h times its strength at most. It breaks where it needs more in two consecutive
/// substeps: sweeps that have not converged demand more than there is.
///
/// Source of the soft form: Catto 2023, "Solver2D".
struct IterativeJoints {
  std::vector<std::uint32_t> hooks;  ///< Rows, by color.
  std::vector<int> color_begin = {0};
  std::vector<int> first_row = {0};  ///< First row of each hook; one more at the end.
  std::vector<JointRow> rows;
  std::vector<JointImpulse> done;       ///< For each hook.
  std::vector<ExtraHooks> extra_hooks;  ///< For each hook.
};

/// Colors hooks in the given order. `degree` is from count_hooks, of these and all others that move the
/// bodies.
void build_iterative_joints(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                            const state::Bodies& bodies, const std::vector<int>& degree,
                            ColorScratch& scratch, IterativeJoints& iterative);

/// Called at the start of a step: bodies carry nothing over.
void prepare_iterative_joints(IterativeJoints& iterative);

/// Solves the rows of a substep of length h [s], with removal of their errors. Hooks between sleepers are
/// skipped.
void solve_iterative_joints(parallel::ThreadPool& pool, double h, std::vector<state::Hook>& hooks,
                            state::Bodies& bodies, IterativeJoints& iterative);

/// Does the same without removal of errors, after the bodies have moved.
void relax_iterative_joints(parallel::ThreadPool& pool, double h, std::vector<state::Hook>& hooks,
                            state::Bodies& bodies, IterativeJoints& iterative);

}  // namespace hooke::solver
