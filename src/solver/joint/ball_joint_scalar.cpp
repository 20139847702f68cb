#include "solver/joint/ball_joint_rows.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void solve_balls_scalar(std::span<BallBlock> blocks, const BallPass& pass, state::MotionRecord* motion) {
  auto* records = reinterpret_cast<Real*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::solve_ball_lanes<Real, true>(block, lane, pass, records);
      } else {
        HWY_NAMESPACE::solve_ball_lanes<Real, false>(block, lane, pass, records);
      }
    }
  }
}

void warm_start_balls_scalar(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  auto* records = reinterpret_cast<Real*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::warm_start_ball_lanes<Real, true>(block, lane, records);
      } else {
        HWY_NAMESPACE::warm_start_ball_lanes<Real, false>(block, lane, records);
      }
    }
  }
}

void relax_balls_scalar(std::span<BallBlock> blocks, state::MotionRecord* motion) {
  auto* records = reinterpret_cast<Real*>(motion);
  for (BallBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::relax_ball_lanes<Real, true>(block, lane, records);
      } else {
        HWY_NAMESPACE::relax_ball_lanes<Real, false>(block, lane, records);
      }
    }
  }
}

}  // namespace hooke::solver::wide
