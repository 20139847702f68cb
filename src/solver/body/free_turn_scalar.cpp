#include "solver/body/free_turn_lanes.h"

// Works on one lane at a time, in either precision.

namespace hooke::solver::wide {

void turn_freely_scalar(Real h, int count, TurnLanes& turns) {
  for (int lane = 0; lane < count; ++lane) HWY_NAMESPACE::turn_lanes_freely<Real>(h, lane, turns);
}

}  // namespace hooke::solver::wide
