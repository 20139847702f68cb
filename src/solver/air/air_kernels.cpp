/// The air over lanes, then the dispatch. The arithmetic stands in solver/air/air_triangles.h and
/// solver/air/air_segments.h.

#include "solver/air/air_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/air/air_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/air/air_segments.h"
#include "solver/air/air_triangles.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void load_triangles_here(const TriangleAir& air, parallel::Range rows) {
#if HWY_TARGET == HWY_SCALAR
  load_triangles_scalar(air, rows);
#else
  int row = rows.begin;
  for (; row + kStride <= rows.end; row += kStride)
    load_triangle_lanes<Wide>(air, static_cast<std::uint32_t>(row));
  for (; row < rows.end; ++row) load_triangle_lanes<float>(air, static_cast<std::uint32_t>(row));
#endif
}

void push_segments_here(const SegmentAir& air) {
#if HWY_TARGET == HWY_SCALAR
  push_segments_scalar(air);
#else
  push_segments_with<Wide>(air);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(load_triangles_here);
HWY_EXPORT(push_segments_here);

void load_triangles(const TriangleAir& air, parallel::Range rows) {
  if (is_scalar()) return load_triangles_scalar(air, rows);
  HWY_DYNAMIC_DISPATCH(load_triangles_here)(air, rows);
}

void push_segments(const SegmentAir& air) {
  if (is_scalar()) return push_segments_scalar(air);
  HWY_DYNAMIC_DISPATCH(push_segments_here)(air);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void load_triangles(const TriangleAir& air, parallel::Range rows) {
  load_triangles_scalar(air, rows);
}

void push_segments(const SegmentAir& air) {
  push_segments_scalar(air);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
