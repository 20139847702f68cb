/// Ball hooks over lanes, then the dispatch. The arithmetic stands in solver/joint/ball_joint_rows.h.

#include "solver/joint/ball_joint_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/joint/ball_joint_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Included after Highway, which includes this file again for each instruction set. Numbers come before what
// uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/joint/ball_joint_rows.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void solve_balls_here(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion) {
  solve_balls_scalar(blocks, pass, motion);
}

void warm_start_balls_here(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  warm_start_balls_scalar(blocks, motion);
}

void relax_balls_here(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  relax_balls_scalar(blocks, motion);
}

#else

void solve_balls_here(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion) {
  auto* records = reinterpret_cast<float*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        solve_ball_lanes<Wide, true>(block, lane, pass, records);
      } else {
        solve_ball_lanes<Wide, false>(block, lane, pass, records);
      }
    }
  }
}

void warm_start_balls_here(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  auto* records = reinterpret_cast<float*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        warm_start_ball_lanes<Wide, true>(block, lane, records);
      } else {
        warm_start_ball_lanes<Wide, false>(block, lane, records);
      }
    }
  }
}

void relax_balls_here(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  auto* records = reinterpret_cast<float*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        relax_ball_lanes<Wide, true>(block, lane, records);
      } else {
        relax_ball_lanes<Wide, false>(block, lane, records);
      }
    }
  }
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_balls_here);
HWY_EXPORT(warm_start_balls_here);
HWY_EXPORT(relax_balls_here);

void solve_balls(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion) {
  if (is_scalar()) return solve_balls_scalar(blocks, pass, motion);
  HWY_DYNAMIC_DISPATCH(solve_balls_here)(blocks, pass, motion);
}

void warm_start_balls(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  if (is_scalar()) return warm_start_balls_scalar(blocks, motion);
  HWY_DYNAMIC_DISPATCH(warm_start_balls_here)(blocks, motion);
}

void relax_balls(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  if (is_scalar()) return relax_balls_scalar(blocks, motion);
  HWY_DYNAMIC_DISPATCH(relax_balls_here)(blocks, motion);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_balls(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion) {
  solve_balls_scalar(blocks, pass, motion);
}

void warm_start_balls(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  warm_start_balls_scalar(blocks, motion);
}

void relax_balls(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  relax_balls_scalar(blocks, motion);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
