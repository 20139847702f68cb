/// Yarns over lanes, then the dispatch. The arithmetic stands in solver/soft/yarn_rows.h.

#include "solver/soft/yarn_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/soft/yarn_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/soft/yarn_bend_rows.h"
#include "solver/soft/yarn_rows.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void solve_yarns_here(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                      const state::PositionRecord* position, state::VelocityRecord* velocity) {
#if HWY_TARGET == HWY_SCALAR
  solve_yarns_scalar(block, rows, material, h, position, velocity);
#else
  solve_yarn_block<Wide>(block, rows, material, h, position, velocity);
#endif
}

void bend_yarns_here(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends,
                     const YarnBendTime& time, const state::PositionRecord* position,
                     state::VelocityRecord* velocity) {
#if HWY_TARGET == HWY_SCALAR
  bend_yarns_scalar(block, rows, bends, time, position, velocity);
#else
  bend_yarn_block<WideDouble>(block, rows, bends, time, position, velocity);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_yarns_here);
HWY_EXPORT(bend_yarns_here);

void solve_yarns(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                 const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (is_scalar()) return solve_yarns_scalar(block, rows, material, h, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_yarns_here)(block, rows, material, h, position, velocity);
}

void bend_yarns(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends, const YarnBendTime& time,
                const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (is_scalar()) return bend_yarns_scalar(block, rows, bends, time, position, velocity);
  HWY_DYNAMIC_DISPATCH(bend_yarns_here)(block, rows, bends, time, position, velocity);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_yarns(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                 const state::PositionRecord* position, state::VelocityRecord* velocity) {
  solve_yarns_scalar(block, rows, material, h, position, velocity);
}

void bend_yarns(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends, const YarnBendTime& time,
                const state::PositionRecord* position, state::VelocityRecord* velocity) {
  bend_yarns_scalar(block, rows, bends, time, position, velocity);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
