#include "solver/surface/surface_lanes.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void search_surfaces_scalar(const SurfaceSearch& search, std::vector<SurfaceFound>& found) {
  HWY_NAMESPACE::SurfaceSearcher<Real>(search, found).run();
}

bool measure_pairs_scalar(std::span<SurfacePairBlock> blocks, bool edges, Real slack,
                          const state::PositionRecord* position) {
  return edges ? HWY_NAMESPACE::measure_pair_blocks<Real, 2>(blocks, slack, position)
               : HWY_NAMESPACE::measure_pair_blocks<Real, 1>(blocks, slack, position);
}

}  // namespace hooke::solver::wide
