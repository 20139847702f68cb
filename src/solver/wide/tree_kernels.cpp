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
#include "solver/wide/tree_sweep.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

void solve_trees_here(const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
#if HWY_TARGET == HWY_SCALAR
  solve_tree_lanes<double>(form, trees);
#else
  solve_tree_lanes<WideDouble>(form, trees);
#endif
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_trees_here);

void solve_trees(const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  if (is_scalar()) return solve_trees_scalar(form, trees);
  HWY_DYNAMIC_DISPATCH(solve_trees_here)(form, trees);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_trees(const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  solve_trees_scalar(form, trees);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
