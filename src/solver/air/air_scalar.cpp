#include "solver/air/air_segments.h"
#include "solver/air/air_triangles.h"

// Works on one lane at a time, in either precision.

namespace hooke::solver::wide {

void load_triangles_scalar(const TriangleAir& air, parallel::Range rows) {
  for (int row = rows.begin; row < rows.end; ++row)
    HWY_NAMESPACE::load_triangle_lanes<Real>(air, static_cast<std::uint32_t>(row));
}

void push_segments_scalar(const SegmentAir& air) {
  HWY_NAMESPACE::push_segments_with<Real>(air);
}

}  // namespace hooke::solver::wide
