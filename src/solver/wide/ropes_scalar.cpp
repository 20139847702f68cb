#include "solver/wide/rope_sweep.h"

// One lane at a time.

namespace hooke::solver::wide {

void solve_ropes_scalar(double h, RopeLanes<kRopeLanes>& ropes) {
  HWY_NAMESPACE::solve_rope_lanes<double>(h, ropes);
}

void solve_ropes(double h, RopeLanes<1>& rope) {
  HWY_NAMESPACE::solve_rope_lanes<double>(h, rope);
}

}  // namespace hooke::solver::wide
