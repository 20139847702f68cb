#pragma once

#include "hooke/math.h"

#include "parallel/thread_pool.h"
#include "solver/joint/hook_colors.h"
#include "solver/simd/lanes.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Iterative joints that are plain ball hooks, 16 to a block: the common part of what
/// solver/joint/iterative_joints.h does row by row.
///
/// Three rows are solved together as one block. With arms r from the centers of mass to the anchors, turned
/// with their bodies in every substep, d = x_b + r_b - x_a - r_a, and for the axes e of the world j_be = S_b
/// (r_b x e), j_ae = S_a ((r_a + d) x e):
///
///   K_ef    = (w_a + w_b) [e = f] + j_ae.j_af + j_be.j_bf
///   v_e     = e.(v_b - v_a) + j_be.omega~_b - j_ae.omega~_a
///   lambda -> lambda - mu K^-1 (v + beta d) - gamma lambda           before the bodies move
///   lambda -> lambda - K^-1 v                                        after
///
/// mu, beta and gamma are as in solver/joint/iterative_joints.h. A step begins with the impulses of the last
/// step. From substep to substep velocities carry them already, along the arms of then. What turned arms
/// change is added.

namespace hooke::solver {

/// Plain ball hooks of one color: no two share a body that moves. A always moves; where only one body does,
/// it is made A. The last lane that holds a hook is repeated up to the end.
struct alignas(64) BallBlock {
  using Lane = Real[kLanes];

  std::uint32_t record_a[kLanes];  ///< 16 times body A's row: where its record begins, in numbers.
  std::uint32_t record_b[kLanes];
  Lane w_a, w_b;
  Lane scale_a[6], scale_b[6];  ///< S, or 1 where nothing moves the body: xx xy xz yy yz zz.
  Lane arm_a[3], arm_b[3];      ///< At the start of the step [m].
  Lane gap[3];                  ///< d at the start of the step [m].
  Lane j_a[3][3], j_b[3][3];    ///< j_x, j_y, j_z of the last substep; zero at the start of a step.
  Lane mass[6];                 ///< K^-1.
  Lane impulse[3];              ///< Impulse on B [N s].
  Lane impulse_sum[3];          ///< Sum of impulses in the step so far [N s].
  Lane size;                    ///< Size of the impulse that was needed [N s].
  Lane strength;                ///< The most that the hook takes; it breaks if two substeps need more [N s].
  Lane broken;                  ///< 1 or 0.
  Lane held;                    ///< Number of substeps that the hook has held in this step.
  Lane needed;                  ///< Impulse needed when it broke [N s].

  /// Index of the first lane's hook in BallJoints::hook_of.
  std::size_t first = 0;
  int count = 0;          ///< Lanes with a hook of their own.
  bool anchored = false;  ///< B is not written: it stands or is moved by hand.
};

struct BallJoints {
  std::vector<std::uint32_t> hooks;    ///< Rows, color after color.
  std::vector<int> color_begin = {0};  ///< Color c is [color_begin[c], color_begin[c + 1]).

  // The hooks that are awake in this step.
  std::vector<BallBlock> blocks;
  std::vector<int> block_begin = {0};  ///< First block of each color; one more at the end.
  std::vector<std::uint32_t> hook_of;  ///< The hook row of each lane.
  std::vector<std::uint32_t> resting;  ///< Rows of hooks that are asleep.
  /// For each block: first lane, number of lanes.
  std::vector<std::pair<std::size_t, std::size_t>> plan;
  bool fresh = true;  ///< No substep has been solved yet.
};

/// Whether blocks can solve the hook: three locked translations and nothing else, between bodies without
/// gyroscopic turns (solver/body/body_motion.h).
[[nodiscard]] bool is_plain_ball(const state::Hook& hook, const state::Bodies& bodies);

/// Colors plain ball hooks in the order they come.
void build_ball_joints(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                       const state::Bodies& bodies, ColorScratch& scratch, BallJoints& joints);

/// Fills the blocks at the start of a step of substeps of length h [s]. Notes the gaps in the hooks.
void prepare_ball_joints(parallel::ThreadPool& pool, Real h, std::vector<state::Hook>& hooks,
                         const state::Bodies& bodies, BallJoints& joints);

/// Solves the rows of a substep of length h [s], with removal of their errors.
void solve_ball_joints(parallel::ThreadPool& pool, Real h, state::Bodies& bodies, BallJoints& joints);

/// Does the same without removal of errors, after the bodies have moved.
void relax_ball_joints(parallel::ThreadPool& pool, state::Bodies& bodies, BallJoints& joints);

/// Stores what the hooks did, at the end of a step of length dt [s] in `substeps`.
void store_ball_joints(parallel::ThreadPool& pool, Real dt, int substeps, const state::Bodies& bodies,
                       const BallJoints& joints, std::vector<state::Hook>& hooks);

}  // namespace hooke::solver
