#include "solver/wide/tree_sweep.h"

// One lane at a time.

namespace hooke::solver::wide {

void solve_trees_scalar(const TreeForm& form, TreeLanes<kTreeLanes>& trees) {
  HWY_NAMESPACE::solve_tree_lanes<double>(form, trees);
}

void solve_trees(const TreeForm& form, TreeLanes<1>& tree) {
  HWY_NAMESPACE::solve_tree_lanes<double>(form, tree);
}

}  // namespace hooke::solver::wide
