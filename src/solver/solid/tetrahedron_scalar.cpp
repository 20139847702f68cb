#include "solver/solid/tetrahedron_rows.h"

// Solves one lane at a time, in either precision of the state.

namespace hooke::solver::wide {

void solve_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                             state::VelocityRecord* velocity) {
  HWY_NAMESPACE::solve_tetrahedron_blocks<double>(run, position, velocity);
}

void linearize_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                                 const state::VelocityRecord* velocity) {
  HWY_NAMESPACE::linearize_tetrahedron_blocks<double>(run, position, velocity);
}

void resist_tetrahedra_scalar(const TetrahedronRun& run) {
  HWY_NAMESPACE::resist_tetrahedron_blocks<double>(run);
}

void damp_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                            state::VelocityRecord* velocity) {
  HWY_NAMESPACE::damp_tetrahedron_blocks<double>(run, position, velocity);
}

}  // namespace hooke::solver::wide
