#include "solver/surface/surface_lanes.h"
#include "solver/surface/surface_row_lanes.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void search_surfaces_scalar(const SurfaceSearch& search, std::vector<SurfaceFound>& found) {
  HWY_NAMESPACE::SurfaceSearcher<Real>(search, found).run();
}

bool measure_pairs_scalar(std::span<SurfacePairBlock> blocks, bool edges, Real certain,
                          const state::PositionRecord* position) {
  return edges ? HWY_NAMESPACE::measure_pair_blocks<Real, 2>(blocks, certain, position)
               : HWY_NAMESPACE::measure_pair_blocks<Real, 1>(blocks, certain, position);
}

void prepare_surface_rows_scalar(std::span<SurfaceRowBlock> blocks, Real h,
                                 const state::PositionRecord* position,
                                 const state::VelocityRecord* velocity) {
  HWY_NAMESPACE::prepare_surface_row_blocks<Real>(blocks, h, position, velocity);
}

void solve_surface_rows_scalar(std::span<SurfaceRowBlock> blocks, state::VelocityRecord* velocity) {
  HWY_NAMESPACE::solve_surface_row_blocks<Real>(blocks, velocity);
}

}  // namespace hooke::solver::wide
