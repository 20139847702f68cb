#include "solver/joint/tree_rows.h"
#include "solver/joint/tree_sweep.h"

// One lane at a time.

namespace hooke::solver::wide {

using HWY_NAMESPACE::make_tree_row_lanes;
using HWY_NAMESPACE::solve_tree_lanes;
using HWY_NAMESPACE::TreeRows;

void make_tree_rows_scalar(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  make_tree_row_lanes<double>(h, form, trees);
}
void make_tree_rows_scalar(double h, const TreeForm& form, TreeLanes<ApproximateTrees>& trees) {
  make_tree_row_lanes<Real>(h, form, trees);
}
void make_tree_rows(double h, const TreeForm& form, TreeLanes<ExactTree>& tree) {
  make_tree_row_lanes<double>(h, form, tree);
}
void make_tree_rows(double h, const TreeForm& form, TreeLanes<ApproximateTree>& tree) {
  make_tree_row_lanes<Real>(h, form, tree);
}

void solve_trees_scalar(double h, const TreeForm& form, TreeLanes<ExactTrees>& trees) {
  solve_tree_lanes<double>(h, form, trees);
}
void solve_trees_scalar(double h, const TreeForm& form, TreeLanes<ApproximateTrees>& trees) {
  solve_tree_lanes<Real>(h, form, trees);
}
void solve_trees(double h, const TreeForm& form, TreeLanes<ExactTree>& tree) {
  solve_tree_lanes<double>(h, form, tree);
}
void solve_trees(double h, const TreeForm& form, TreeLanes<ApproximateTree>& tree) {
  solve_tree_lanes<Real>(h, form, tree);
}

double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<ExactTrees>& trees) {
  return TreeRows<double, ExactTrees>(h, form, trees, lane).make_ahead();
}
double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<ExactTree>& tree) {
  return TreeRows<double, ExactTree>(h, form, tree, lane).make_ahead();
}

void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ExactTrees>& trees) {
  TreeRows<double, ExactTrees>(h, form, trees, lane).clamp();
}
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ExactTree>& tree) {
  TreeRows<double, ExactTree>(h, form, tree, lane).clamp();
}
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ApproximateTrees>& trees) {
  TreeRows<Real, ApproximateTrees>(h, form, trees, lane).clamp();
}
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<ApproximateTree>& tree) {
  TreeRows<Real, ApproximateTree>(h, form, tree, lane).clamp();
}

}  // namespace hooke::solver::wide
