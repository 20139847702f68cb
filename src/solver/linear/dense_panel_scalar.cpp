#include "solver/linear/dense_panel_sweep.h"

// One number at a time.

namespace hooke::solver::wide {

void eliminate_columns_scalar(const FactoredBlock& block, const DensePanel& panel) {
  HWY_NAMESPACE::eliminate_panel_columns<double>(block, panel);
}

void subtract_products_scalar(const DensePanel& panel, double* scaled, const DenseTriangle& triangle) {
  HWY_NAMESPACE::subtract_panel_products<double>(panel, scaled, triangle);
}

}  // namespace hooke::solver::wide
