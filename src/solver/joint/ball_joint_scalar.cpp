#include "solver/joint/ball_joint_rows.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void solve_balls_scalar(std::span<BallBlock> blocks, const BallPass& pass, state::MotionLine* motion) {
  auto* lines = reinterpret_cast<Real*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::solve_ball_lanes<Real, true>(block, lane, pass, lines);
      } else {
        HWY_NAMESPACE::solve_ball_lanes<Real, false>(block, lane, pass, lines);
      }
    }
  }
}

void warm_start_balls_scalar(std::span<BallBlock> blocks, state::MotionLine* motion) {
  auto* lines = reinterpret_cast<Real*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::warm_start_ball_lanes<Real, true>(block, lane, lines);
      } else {
        HWY_NAMESPACE::warm_start_ball_lanes<Real, false>(block, lane, lines);
      }
    }
  }
}

void relax_balls_scalar(std::span<BallBlock> blocks, state::MotionLine* motion) {
  auto* lines = reinterpret_cast<Real*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::relax_ball_lanes<Real, true>(block, lane, lines);
      } else {
        HWY_NAMESPACE::relax_ball_lanes<Real, false>(block, lane, lines);
      }
    }
  }
}

}  // namespace hooke::solver::wide
