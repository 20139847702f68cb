#pragma once

#include "hooke/math.h"

#include "parallel/thread_pool.h"
#include "solver/joint/hook_colors.h"
#include "solver/joint_rows/joint_rows.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Nets of hooks that are too large to be solved as a whole: row by row, in colors.

namespace hooke::solver {

/// What a joint has done in this substep, as its bodies carry it over to the next.
struct JointImpulse {
  DVec3 linear = {};     ///< On b, the opposite on a [N s].
  DVec3 angular_a = {};  ///< Change of omega~ [sqrt(J)].
  DVec3 angular_b = {};
};

inline constexpr int kMostFreeHooks = 5;

/// Hooks that each end of a hook has beyond kMostFreeHooks.
struct ExtraHooks {
  double a = 0;
  double b = 0;
};

/// Hooks of each body that a net moves: replaces `degree`.
void count_hooks(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                 const state::Bodies& bodies, std::vector<int>& degree);

/// Hooks in colors: those of one color share no body that forces move.
///
/// Locks are soft, like contacts: with omega = 2 pi 60 Hz (at most 1/(4h)) and zeta = 5,
///
///   lambda -> lambda - mu (v + b C) / K - gamma lambda,   K the row's diagonal of J M^-1 J^T,
///   b = omega / a, mu = h omega a / (1 + h omega a), gamma = 1 - mu, a = 2 zeta + h omega;
///
/// after the bodies have moved, the same with b = gamma = 0 takes back the speed that C has added. Impulses
/// carry over: those of the last substep are in the velocities already, as what contacts did, along the
/// directions of then; solve_joint_net begins with the difference to those of now.
///
/// K is larger where a body has more than kMostFreeHooks hooks. With a light body in the middle of many,
/// sweeps that begin with the impulses of before overshoot more each time (solver/linear/sweep_order.h); with
/// k_a and k_b what the ends add to the diagonal and n_a, n_b the hooks of each beyond kMostFreeHooks,
///
///   K = k_a + k_b + (n_a k_a^2 + n_b k_b^2) / (k_a + k_b).
///
/// A hook that can break takes h times its strength at most. It breaks where it needs more in two substeps in
/// a row: sweeps that have not settled ask for more than there is.
///
/// Source of the soft form: Catto 2023, "Solver2D".
struct IterativeJoints {
  std::vector<std::uint32_t> hooks;  ///< Rows, by color.
  std::vector<int> color_begin = {0};
  std::vector<int> first_row = {0};  ///< Of each hook; one more at the end.
  std::vector<JointRow> rows;
  std::vector<JointImpulse> done;       ///< Of each hook.
  std::vector<ExtraHooks> extra_hooks;  ///< Of each hook.
};

/// Colors hooks in the order they come. `degree` by count_hooks, of these and all others that move the
/// bodies.
void build_iterative_joints(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                            const state::Bodies& bodies, const std::vector<int>& degree,
                            ColorScratch& scratch, IterativeJoints& iterative);

/// Start of a step: bodies carry nothing over.
void prepare_iterative_joints(IterativeJoints& iterative);

/// The rows of a substep of length h [s], with their errors removed. Hooks between sleepers are left alone.
void solve_iterative_joints(parallel::ThreadPool& pool, double h, std::vector<state::Hook>& hooks,
                            state::Bodies& bodies, IterativeJoints& iterative);

/// The same without their errors, after the bodies have moved.
void relax_iterative_joints(parallel::ThreadPool& pool, double h, std::vector<state::Hook>& hooks,
                            state::Bodies& bodies, IterativeJoints& iterative);

}  // namespace hooke::solver
