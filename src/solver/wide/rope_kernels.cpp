/// Ropes over lanes, then the dispatch. The arithmetic stands in rope_sweep.h.

#include "solver/wide/ropes.h"
#include "solver/wide/wide.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/wide/rope_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set.
#include "solver/wide/double_vectors.h"
#include "solver/wide/rope_sweep.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void solve_ropes_here(double h, RopeLanes<kRopeLanes>& ropes) {
#if HWY_TARGET == HWY_SCALAR
  solve_rope_lanes<double>(h, ropes);
#else
  solve_rope_lanes<WideDouble>(h, ropes);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_ropes_here);

void solve_ropes(double h, RopeLanes<kRopeLanes>& ropes) {
  if (is_scalar()) return solve_ropes_scalar(h, ropes);
  HWY_DYNAMIC_DISPATCH(solve_ropes_here)(h, ropes);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_ropes(double h, RopeLanes<kRopeLanes>& ropes) {
  solve_ropes_scalar(h, ropes);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
