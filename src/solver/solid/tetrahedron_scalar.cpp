#include "solver/solid/tetrahedron_rows.h"

// Solves one lane at a time, in either precision of the state.

namespace hooke::solver::wide {

void solve_free_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                                  state::VelocityRecord* velocity) {
  HWY_NAMESPACE::solve_free_tetrahedron_blocks<double>(run, position, velocity);
}

void solve_pressed_tetrahedra_scalar(double inverse_h, PressedTetrahedra& rows,
                                     const state::PositionRecord* position, state::VelocityRecord* velocity) {
  HWY_NAMESPACE::solve_pressed_tetrahedron_rows<double>(inverse_h, rows, position, velocity);
}

void damp_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                            state::VelocityRecord* velocity) {
  HWY_NAMESPACE::damp_tetrahedron_blocks<double>(run, position, velocity);
}

}  // namespace hooke::solver::wide
