/// Trees over lanes, then the dispatch. The arithmetic stands in tree_sweep.h.

#include "solver/wide/trees.h"
#include "solver/wide/wide.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/wide/tree_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set.
#include "solver/wide/double_vectors.h"
#include "solver/wide/tree_rows.h"
#include "solver/wide/tree_sweep.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using TreeNumber = double;
#else
using TreeNumber = WideDouble;
#endif

void make_tree_rows_here(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  make_tree_row_lanes<TreeNumber>(h, form, trees);
}

void solve_trees_here(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  solve_tree_lanes<TreeNumber>(h, form, trees);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(make_tree_rows_here);
HWY_EXPORT(solve_trees_here);

void make_tree_rows(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  if (is_scalar()) return make_tree_rows_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(make_tree_rows_here)(h, form, trees);
}

void solve_trees(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  if (is_scalar()) return solve_trees_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(solve_trees_here)(h, form, trees);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void make_tree_rows(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  make_tree_rows_scalar(h, form, trees);
}

void solve_trees(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  solve_trees_scalar(h, form, trees);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
