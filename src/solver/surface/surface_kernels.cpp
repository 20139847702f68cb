/// The kernels of surfaces over lanes, then the dispatch. The arithmetic stands in
/// solver/surface/surface_lanes.h.

#include "solver/surface/surface_kernels.h"

#ifndef HOOKE_DOUBLE_PRECISION

#include "solver/simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/surface/surface_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set; numbers before what uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/surface/surface_box_vectors.h"
#include "solver/surface/surface_lanes.h"
#include "solver/surface/surface_row_lanes.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void search_surfaces_here(const SurfaceSearch& search, std::vector<SurfaceFound>& found) {
#if HWY_TARGET == HWY_SCALAR
  search_surfaces_scalar(search, found);
#else
  SurfaceSearcher<Wide>(search, found).run();
#endif
}

bool measure_pairs_here(std::span<SurfacePairBlock> blocks, bool edges, Real certain,
                        const state::PositionRecord* position) {
#if HWY_TARGET == HWY_SCALAR
  return measure_pairs_scalar(blocks, edges, certain, position);
#else
  return edges ? measure_pair_blocks<Wide, 2>(blocks, certain, position)
               : measure_pair_blocks<Wide, 1>(blocks, certain, position);
#endif
}

void prepare_surface_rows_here(std::span<SurfaceRowBlock> blocks, Real h,
                               const state::PositionRecord* position, const state::VelocityRecord* velocity) {
#if HWY_TARGET == HWY_SCALAR
  prepare_surface_rows_scalar(blocks, h, position, velocity);
#else
  prepare_surface_row_blocks<Wide>(blocks, h, position, velocity);
#endif
}

void solve_surface_rows_here(std::span<SurfaceRowBlock> blocks, state::VelocityRecord* velocity) {
#if HWY_TARGET == HWY_SCALAR
  solve_surface_rows_scalar(blocks, velocity);
#else
  solve_surface_row_blocks<Wide>(blocks, velocity);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(search_surfaces_here);
HWY_EXPORT(measure_pairs_here);
HWY_EXPORT(prepare_surface_rows_here);
HWY_EXPORT(solve_surface_rows_here);

void search_surfaces(const SurfaceSearch& search, std::vector<SurfaceFound>& found) {
  if (is_scalar()) return search_surfaces_scalar(search, found);
  HWY_DYNAMIC_DISPATCH(search_surfaces_here)(search, found);
}

bool measure_pairs(std::span<SurfacePairBlock> blocks, bool edges, Real certain,
                   const state::PositionRecord* position) {
  if (is_scalar()) return measure_pairs_scalar(blocks, edges, certain, position);
  return HWY_DYNAMIC_DISPATCH(measure_pairs_here)(blocks, edges, certain, position);
}

void prepare_surface_rows(std::span<SurfaceRowBlock> blocks, Real h, const state::PositionRecord* position,
                          const state::VelocityRecord* velocity) {
  if (is_scalar()) return prepare_surface_rows_scalar(blocks, h, position, velocity);
  HWY_DYNAMIC_DISPATCH(prepare_surface_rows_here)(blocks, h, position, velocity);
}

void solve_surface_rows(std::span<SurfaceRowBlock> blocks, state::VelocityRecord* velocity) {
  if (is_scalar()) return solve_surface_rows_scalar(blocks, velocity);
  HWY_DYNAMIC_DISPATCH(solve_surface_rows_here)(blocks, velocity);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void search_surfaces(const SurfaceSearch& search, std::vector<SurfaceFound>& found) {
  search_surfaces_scalar(search, found);
}

bool measure_pairs(std::span<SurfacePairBlock> blocks, bool edges, Real certain,
                   const state::PositionRecord* position) {
  return measure_pairs_scalar(blocks, edges, certain, position);
}

void prepare_surface_rows(std::span<SurfaceRowBlock> blocks, Real h, const state::PositionRecord* position,
                          const state::VelocityRecord* velocity) {
  prepare_surface_rows_scalar(blocks, h, position, velocity);
}

void solve_surface_rows(std::span<SurfaceRowBlock> blocks, state::VelocityRecord* velocity) {
  solve_surface_rows_scalar(blocks, velocity);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
