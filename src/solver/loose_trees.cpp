#include "solver/loose_trees.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using state::Hook;

bool has_like_masses(const Articulation& tree, const state::Bodies& bodies) {
  Real least = std::numeric_limits<Real>::infinity();
  Real most = Real(0);
  for (const std::uint32_t body : tree.bodies) {
    const Real mass = bodies.mass[body].mass;
    least = std::min(least, mass);
    most = std::max(most, mass);
  }
  return most <= static_cast<Real>(kLooseMasses) * least;
}

/// It rubs, is not driven, and its locks held in the last substep.
bool is_loose_joint(const Hook& hook, const wide::TreeForm& form, const wide::TreeJoint& joint) {
  bool rubs = false;
  for (int r = joint.first; r < joint.first + joint.count; ++r) {
    const wide::TreeRowForm& row = form.rows[r];
    if (row.role == RowRole::kMotor) {
      if (hook.freedom[row.freedom].motor.speed != Real(0)) return false;
      rubs = true;
    }
    if (row.role == RowRole::kLock) {
      const double off =
          hook.value[row.freedom] - static_cast<double>(hook.freedom[row.freedom].spring.target);
      if (!(std::abs(off) < kLooseError)) return false;
    }
  }
  return rubs;
}

}  // namespace

bool is_loose(const Articulation& tree, const std::vector<Hook>& hooks, const state::Bodies& bodies) {
  const wide::TreeForm& form = tree.tree.form;
  if (!form.joints.back().parent_moves || !has_like_masses(tree, bodies)) return false;
  for (std::size_t i = 0; i < tree.joints.size(); ++i) {
    if (!is_loose_joint(hooks[tree.joints[i].hook], form, form.joints[i])) return false;
  }
  return true;
}

}  // namespace hooke::solver
