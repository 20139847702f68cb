#pragma once

#include "solver/joint/ball_joints.h"
#include "state/bodies.h"

#include <span>

/// \file
/// Kernels over blocks of ball hooks; the formulas stand in solver/joint/ball_joints.h. Every instruction set
/// gives the bits of the scalar twin, and wide::use_target (solver/simd/dispatch.h) chooses the instruction
/// set.

namespace hooke::solver::wide {

/// How strongly a pass removes errors.
struct BallPass {
  Real rate = Real(0);           ///< beta [1/s]
  Real mass_scale = Real(1);     ///< mu
  Real impulse_scale = Real(0);  ///< gamma
};

/// Applies the impulses carried over from the last step, for blocks of one color.
void warm_start_balls(std::span<BallBlock> blocks, state::MotionRecord* motion);
/// Makes one pass over blocks of one color, before the bodies move.
void solve_balls(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion);
/// Makes one pass after the bodies have moved.
void relax_balls(std::span<BallBlock> blocks, state::MotionRecord* motion);

// The scalar twins.
void warm_start_balls_scalar(std::span<BallBlock> blocks, state::MotionRecord* motion);
void solve_balls_scalar(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion);
void relax_balls_scalar(std::span<BallBlock> blocks, state::MotionRecord* motion);

}  // namespace hooke::solver::wide
