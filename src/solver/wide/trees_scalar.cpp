#include "solver/wide/tree_rows.h"
#include "solver/wide/tree_sweep.h"

// One lane at a time.

namespace hooke::solver::wide {

using HWY_NAMESPACE::TreeRows;

void make_tree_rows_scalar(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  HWY_NAMESPACE::make_tree_row_lanes<double>(h, form, trees);
}
void make_tree_rows(double h, const TreeForm& form, TreeLanes<1>& tree) {
  HWY_NAMESPACE::make_tree_row_lanes<double>(h, form, tree);
}

void solve_trees_scalar(double h, const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  HWY_NAMESPACE::solve_tree_lanes<double>(h, form, trees);
}
void solve_trees(double h, const TreeForm& form, TreeLanes<1>& tree) {
  HWY_NAMESPACE::solve_tree_lanes<double>(h, form, tree);
}

double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<kTreeLanes>& trees) {
  return TreeRows<double, kTreeLanes>(h, form, trees, lane).make_ahead();
}
double make_tree_rows_ahead(double h, const TreeForm& form, int lane, TreeLanes<1>& tree) {
  return TreeRows<double, 1>(h, form, tree, lane).make_ahead();
}

void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<kTreeLanes>& trees) {
  TreeRows<double, kTreeLanes>(h, form, trees, lane).clamp();
}
void clamp_tree_impulses(double h, const TreeForm& form, int lane, TreeLanes<1>& tree) {
  TreeRows<double, 1>(h, form, tree, lane).clamp();
}

}  // namespace hooke::solver::wide
