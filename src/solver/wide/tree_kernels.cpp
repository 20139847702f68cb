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
#include "solver/wide/vectors.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using ExactNumber = double;
using LooseNumber = float;
#else
using ExactNumber = WideDouble;
using LooseNumber = Wide;
#endif

void make_exact_rows_here(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  make_tree_row_lanes<ExactNumber>(h, form, trees);
}
void make_loose_rows_here(double h, const TreeForm& form, TreeLanes<LooseTrees>& trees) {
  make_tree_row_lanes<LooseNumber>(h, form, trees);
}

void solve_exact_here(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  solve_tree_lanes<ExactNumber>(h, form, trees);
}
void solve_loose_here(double h, const TreeForm& form, TreeLanes<LooseTrees>& trees) {
  solve_tree_lanes<LooseNumber>(h, form, trees);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(make_exact_rows_here);
HWY_EXPORT(make_loose_rows_here);
HWY_EXPORT(solve_exact_here);
HWY_EXPORT(solve_loose_here);

void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  if (is_scalar()) return make_tree_rows_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(make_exact_rows_here)(h, form, trees);
}
void make_tree_rows(double h, const TreeForm& form, TreeLanes<LooseTrees>& trees) {
  if (is_scalar()) return make_tree_rows_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(make_loose_rows_here)(h, form, trees);
}

void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  if (is_scalar()) return solve_trees_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(solve_exact_here)(h, form, trees);
}
void solve_trees(double h, const TreeForm& form, TreeLanes<LooseTrees>& trees) {
  if (is_scalar()) return solve_trees_scalar(h, form, trees);
  HWY_DYNAMIC_DISPATCH(solve_loose_here)(h, form, trees);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  make_tree_rows_scalar(h, form, trees);
}
void make_tree_rows(double h, const TreeForm& form, TreeLanes<LooseTrees>& trees) {
  make_tree_rows_scalar(h, form, trees);
}

void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  solve_trees_scalar(h, form, trees);
}
void solve_trees(double h, const TreeForm& form, TreeLanes<LooseTrees>& trees) {
  solve_trees_scalar(h, form, trees);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
