/// Isometric bending elements over lanes, then the dispatch. The arithmetic stands in
/// solver/soft/isometric_bending_rows.h.

#include "solver/soft/isometric_bending_kernels.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/soft/isometric_bending_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/soft/isometric_bending_rows.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void solve_isometric_bends_here(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                                const state::PositionRecord* position, state::VelocityRecord* velocity) {
#if HWY_TARGET == HWY_SCALAR
  solve_isometric_bends_scalar(run, materials, position, velocity);
#else
  solve_isometric_bend_run<Wide>(run, materials, position, velocity);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_isometric_bends_here);

void solve_isometric_bends(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                           const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (run.blocks.empty()) return;
  if (is_scalar()) return solve_isometric_bends_scalar(run, materials, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_isometric_bends_here)(run, materials, position, velocity);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_isometric_bends(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                           const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (!run.blocks.empty()) solve_isometric_bends_scalar(run, materials, position, velocity);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
