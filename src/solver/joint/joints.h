#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "parallel/thread_pool.h"
#include "solver/joint/articulations.h"
#include "solver/joint/ball_joints.h"
#include "solver/joint/hook_breaks.h"
#include "solver/joint/hook_colors.h"
#include "solver/joint/iterative_joints.h"
#include "solver/joint/joint_tuning.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// \file
/// Hooks between bodies. Groups that can be solved exactly within a budget are articulations; larger ones are
/// iterative joints, rows in colors.
///
/// The order of calls:
///   build_joints                                            when hooks or bodies came or went
///   evaluate_ragdolls, before contacts are detected         once a step
///   prepare_joints                                          once a step
///   [solve_joints, then bodies move, then relax_joints]     each substep
///   finish_joints                                           once a step

namespace hooke::solver {

/// What one part of a parallel loop over articulations needs.
struct SolveScratch {
  std::vector<Articulation*> trees;
  TreeScratch side_by_side;
  BreakScratch breaks;
};

/// Hooks that share bodies which forces move, directly or through others. Groups are in order of their first
/// hook.
struct HookGroups {
  std::vector<std::uint32_t> hooks;  ///< Rows, group after group; in each, in their order.
  std::vector<std::size_t> begin;    ///< Where each group begins; one more at the end.
};

/// Memory of build_joints, so that a hook that breaks allocates nothing.
struct BuildScratch {
  base::DisjointSets sets;
  std::vector<std::uint32_t> group_of;  ///< Group of each body that is the root of its set.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> grouped;
  HookGroups groups;
  ArticulationScratch articulation;
  std::vector<std::uint32_t> rest;  ///< Rows of hooks of no articulation.
  std::vector<std::uint32_t> balls;
  std::vector<std::uint32_t> others;
  std::vector<int> degree;
  ColorScratch colors;
};

struct Joints {
  /// Those of `order`, then some that only keep their memory.
  std::vector<Articulation> articulations;
  std::vector<std::uint32_t> order;  ///< Articulations: those with loops first, then trees by kind.
  /// Plain balls outside articulations, at no body with more than kMostFreeHooks hooks
  /// (solver/joint/iterative_joints.h).
  BallJoints balls;
  IterativeJoints iterative;  ///< All other hooks outside articulations.
  static constexpr std::uint32_t kNoArticulation = 0xFFFFFFFF;
  /// The articulation of each body that forces move, by body row; kNoArticulation for bodies of none.
  std::vector<std::uint32_t> articulation_of;
  std::vector<std::uint32_t> at_points;  ///< Rows of hooks at points, which coupled groups and ropes solve.
  /// By body row: 1 for members of ragdolls (solver/joint/approximate_trees.h).
  std::vector<std::uint8_t> in_ragdoll;
  std::vector<SolveScratch> scratch;
  BuildScratch build;
};

/// Sorts hooks into groups that share bodies which forces move: static bodies and the world do not connect.
/// Groups that cost more than `budget` multiplications, or kUnlikeBudgetRatio times as many if masses are
/// unlike, become iterative joints.
void build_joints(const std::vector<state::Hook>& hooks, const state::Bodies& bodies, double budget,
                  Joints& joints);

/// Finds which trees are ragdolls, and which of those are approximate in this step
/// (solver/joint/approximate_trees.h).
void evaluate_ragdolls(parallel::ThreadPool& pool, const std::vector<state::Hook>& hooks,
                       const state::Bodies& bodies, Joints& joints);

/// Called at the start of a step of substeps of length h [s]: no hook has an impulse yet.
void prepare_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks,
                    const state::Bodies& bodies, Joints& joints);

/// Solves the rows of a substep of length h [s], with removal of their errors. Sleeping groups are skipped.
void solve_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks, state::Bodies& bodies,
                  Joints& joints);

/// Called after bodies have moved: removes the velocity that removal of errors has added. Only iterative
/// joints need it. Adds up the impulses of the substep and marks hooks that break.
void relax_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks, state::Bodies& bodies,
                  Joints& joints);

/// Computes mean forces, at the end of a step of length dt [s] in `substeps`.
void finish_joints(parallel::ThreadPool& pool, Real dt, int substeps, const state::Bodies& bodies,
                   const Joints& joints, std::vector<state::Hook>& hooks);

}  // namespace hooke::solver
