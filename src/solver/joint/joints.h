#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "parallel/thread_pool.h"
#include "solver/joint/articulations.h"
#include "solver/joint/ball_joints.h"
#include "solver/joint/hook_breaks.h"
#include "solver/joint/hook_colors.h"
#include "solver/joint/iterative_joints.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// \file
/// Hooks between bodies. Groups that can be solved exactly within a budget are articulations; larger nets are
/// rows in colors.
///
/// The order of calls:
///   build_joints                                            when hooks or bodies came or went
///   judge_ragdolls, before contacts are looked for          once a step
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

/// Hooks that share bodies which forces move, directly or through others; groups in order of their first.
struct HookGroups {
  std::vector<std::uint32_t> hooks;  ///< Rows, group after group; in each, in their order.
  std::vector<std::size_t> begin;    ///< Of each group; one more at the end.
};

/// Memory of build_joints: a hook that breaks allocates nothing.
struct BuildScratch {
  base::DisjointSets sets;
  std::vector<std::uint32_t> group_of;  ///< Of each body that is the root of its set.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> grouped;
  HookGroups groups;
  ArticulationScratch articulation;
  std::vector<std::uint32_t> rest;  ///< Hooks of no articulation.
  std::vector<std::uint32_t> balls;
  std::vector<std::uint32_t> others;
  std::vector<int> degree;
  ColorScratch colors;
};

struct Joints {
  std::vector<Articulation> articulations;  ///< Those of `order`, then some that only keep their memory.
  std::vector<std::uint32_t> order;         ///< Articulations: those with loops first, then trees by kind.
  BallJoints
      balls;  ///< Plain balls in none of them, and at no crowded body (solver/joint/iterative_joints.h).
  IterativeJoints iterative;  ///< All others that are in none of them.
  std::vector<std::uint8_t>
      in_ragdoll;  ///< By body row: 1 for members of ragdolls (solver/joint/approximate_trees.h).
  std::vector<SolveScratch> scratch;
  BuildScratch build;
};

/// Multiplications for one solution of a group; about a millisecond.
inline constexpr double kArticulationBudget = 2e6;

/// Sorts hooks into groups that share bodies which forces move: static bodies and the world do not connect.
/// Groups that cost more than `budget` multiplications go into the net.
void build_joints(const std::vector<state::Hook>& hooks, const state::Bodies& bodies, double budget,
                  Joints& joints);

/// Which trees are ragdolls, and which of those are loose in this step (solver/joint/approximate_trees.h).
void evaluate_ragdolls(parallel::ThreadPool& pool, const std::vector<state::Hook>& hooks,
                       const state::Bodies& bodies, Joints& joints);

/// Start of a step of substeps of length h [s]: no impulse yet.
void prepare_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks,
                    const state::Bodies& bodies, Joints& joints);

/// The rows of a substep of length h [s], with their errors removed. Groups asleep are left alone.
void solve_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks, state::Bodies& bodies,
                  Joints& joints);

/// After bodies have moved: takes back the velocity that removing errors has added. Only nets need it.
/// Adds up the impulses of the substep and marks hooks that break.
void relax_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks, state::Bodies& bodies,
                  Joints& joints);

/// End of a step of length dt [s] in `substeps`: mean forces.
void finish_joints(parallel::ThreadPool& pool, Real dt, int substeps, const state::Bodies& bodies,
                   const Joints& joints, std::vector<state::Hook>& hooks);

}  // namespace hooke::solver
