/// Gyroscopic turns over lanes, then the dispatch. The arithmetic stands in solver/body/free_turn_lanes.h.

#include "solver/body/free_turn_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/body/free_turn_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/body/free_turn_lanes.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void turn_freely_here(Real h, int count, TurnLanes& turns) {
  turn_freely_scalar(h, count, turns);
}

#else

void turn_freely_here(Real h, int count, TurnLanes& turns) {
  for (int lane = 0; lane < count; lane += kStride) turn_lanes_freely<Wide>(h, lane, turns);
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(turn_freely_here);

void turn_freely(Real h, int count, TurnLanes& turns) {
  if (is_scalar()) return turn_freely_scalar(h, count, turns);
  HWY_DYNAMIC_DISPATCH(turn_freely_here)(h, count, turns);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twin is the kernel

namespace hooke::solver::wide {

void turn_freely(Real h, int count, TurnLanes& turns) {
  turn_freely_scalar(h, count, turns);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
