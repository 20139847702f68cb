#include "solver/cloth/cloth_rows.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void run_scalar(const GridJob& job) {
  HWY_NAMESPACE::run_grid<Real>(job);
}

}  // namespace hooke::solver::wide
