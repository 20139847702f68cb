/// Trees in double over lanes, then the dispatch. The arithmetic stands in solver/joint/tree_rows.h and
/// solver/joint/tree_sweep.h.

#include "solver/joint/tree_kernels.h"
#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/joint/exact_tree_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Included after Highway, which includes this file again for each instruction set. Numbers come before what
// uses them.
// clang-format off
#include "solver/simd/double_vectors.h"
#include "solver/joint/tree_rows.h"
#include "solver/joint/tree_sweep.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using TreeNumber = double;
#else
using TreeNumber = WideDouble;
#endif

void make_exact_rows_here(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  make_tree_row_lanes<TreeNumber>(h, form, trees);
}

void solve_exact_here(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  solve_tree_lanes<TreeNumber>(h, form, trees);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(make_exact_rows_here);
HWY_EXPORT(solve_exact_here);

void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  if (is_scalar()) return make_tree_rows_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(make_exact_rows_here)(h, form, trees);
}

void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  if (is_scalar()) return solve_trees_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(solve_exact_here)(h, form, trees);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  make_tree_rows_scalar(h, form, trees);
}

void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  solve_trees_scalar(h, form, trees);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
