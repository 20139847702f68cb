#include "solver/soft/isometric_bending_rows.h"

// Solves one lane at a time, in either precision.

namespace hooke::solver::wide {

void solve_isometric_bends_scalar(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                                  const state::PositionRecord* position, state::VelocityRecord* velocity) {
  HWY_NAMESPACE::solve_isometric_bend_run<Real>(run, materials, position, velocity);
}

}  // namespace hooke::solver::wide
