/// Rows and grids of cloths under loads over lanes, then the dispatch. The arithmetic stands in
/// solver/cloth/cloth_rows.h.

#include "solver/cloth/cloth_kernels.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cloth/cloth_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/cloth/cloth_rows.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void run_grid_here(const GridJob& job) {
#if HWY_TARGET == HWY_SCALAR
  run_scalar(job);
#else
  run_grid<Wide>(job);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(run_grid_here);

void run(const GridJob& job) {
  if (is_scalar()) return run_scalar(job);
  HWY_DYNAMIC_DISPATCH(run_grid_here)(job);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twin is the kernel

namespace hooke::solver::wide {

void run(const GridJob& job) {
  run_scalar(job);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
