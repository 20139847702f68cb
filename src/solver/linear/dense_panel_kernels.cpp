/// Dense panels in vectors of double, then the dispatch. The arithmetic stands in
/// solver/linear/dense_panel_sweep.h.

#include "solver/linear/dense_panel.h"
#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/linear/dense_panel_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Included after Highway, which includes this file again for each instruction set. Numbers come before what
// uses them.
// clang-format off
#include "solver/simd/double_vectors.h"
#include "solver/linear/dense_panel_sweep.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using PanelNumber = double;
#else
using PanelNumber = WideDouble;
#endif

void eliminate_columns_here(const FactoredBlock& block, const DensePanel& panel) {
  eliminate_panel_columns<PanelNumber>(block, panel);
}

void subtract_products_here(const DensePanel& panel, double* scaled, const DenseTriangle& triangle) {
  subtract_panel_products<PanelNumber>(panel, scaled, triangle);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(eliminate_columns_here);
HWY_EXPORT(subtract_products_here);

void eliminate_columns(const FactoredBlock& block, const DensePanel& panel) {
  if (is_scalar()) return eliminate_columns_scalar(block, panel);
  HWY_DYNAMIC_DISPATCH(eliminate_columns_here)(block, panel);
}

void subtract_products(const DensePanel& panel, double* scaled, const DenseTriangle& triangle) {
  if (is_scalar()) return subtract_products_scalar(panel, scaled, triangle);
  HWY_DYNAMIC_DISPATCH(subtract_products_here)(panel, scaled, triangle);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void eliminate_columns(const FactoredBlock& block, const DensePanel& panel) {
  eliminate_columns_scalar(block, panel);
}

void subtract_products(const DensePanel& panel, double* scaled, const DenseTriangle& triangle) {
  subtract_products_scalar(panel, scaled, triangle);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
