#include "solver/soft/isometric_bending_rows.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void solve_hinges_scalar(const HingeRun& run, const HingeMaterials& materials, state::Particles& particles) {
  HWY_NAMESPACE::solve_hinge_run<Real>(run, materials, particles);
}

}  // namespace hooke::solver::wide
