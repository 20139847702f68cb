/// Ropes over lanes, then the dispatch. The arithmetic stands in solver/rope/rope_sweep.h and
/// solver/rope/rope_records.h.

#include "solver/rope/rope_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/rope/rope_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/double_vectors.h"
#include "solver/rope/rope_sweep.h"
#include "solver/rope/rope_vectors.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using Number = double;
#else
using Number = WideDouble;
#endif

void load_ropes_here(const RopeLocations<kRopeLanes>& locations, RopeLanes<kRopeLanes>& ropes) {
  load_rope_lanes<Number>(locations, ropes);
}

void solve_ropes_here(double h, const RopeTraits<kRopeLanes>& traits, RopeLanes<kRopeLanes>& ropes) {
  solve_rope_lanes<Number>(h, traits, ropes);
}

void store_ropes_here(double h, const RopeLocations<kRopeLanes>& locations,
                      const RopeTraits<kRopeLanes>& traits, const bool (&chosen)[kRopeLanes],
                      const RopeLanes<kRopeLanes>& ropes) {
  store_rope_lanes<Number>(h, locations, traits, chosen, ropes);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(load_ropes_here);
HWY_EXPORT(solve_ropes_here);
HWY_EXPORT(store_ropes_here);

void load_ropes(const RopeLocations<kRopeLanes>& locations, RopeLanes<kRopeLanes>& ropes) {
  if (is_scalar()) return load_ropes_scalar(locations, ropes);
  HWY_DYNAMIC_DISPATCH(load_ropes_here)(locations, ropes);
}

void solve_ropes(double h, const RopeTraits<kRopeLanes>& traits, RopeLanes<kRopeLanes>& ropes) {
  if (is_scalar()) return solve_ropes_scalar(h, traits, ropes);
  HWY_DYNAMIC_DISPATCH(solve_ropes_here)(h, traits, ropes);
}

void store_ropes(double h, const RopeLocations<kRopeLanes>& locations, const RopeTraits<kRopeLanes>& traits,
                 const bool (&chosen)[kRopeLanes], const RopeLanes<kRopeLanes>& ropes) {
  if (is_scalar()) return store_ropes_scalar(h, locations, traits, chosen, ropes);
  HWY_DYNAMIC_DISPATCH(store_ropes_here)(h, locations, traits, chosen, ropes);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void load_ropes(const RopeLocations<kRopeLanes>& locations, RopeLanes<kRopeLanes>& ropes) {
  load_ropes_scalar(locations, ropes);
}

void solve_ropes(double h, const RopeTraits<kRopeLanes>& traits, RopeLanes<kRopeLanes>& ropes) {
  solve_ropes_scalar(h, traits, ropes);
}

void store_ropes(double h, const RopeLocations<kRopeLanes>& locations, const RopeTraits<kRopeLanes>& traits,
                 const bool (&chosen)[kRopeLanes], const RopeLanes<kRopeLanes>& ropes) {
  store_ropes_scalar(h, locations, traits, chosen, ropes);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
