#include "solver/joint/approximate_trees.h"

#include "base/assert.h"

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
  return most <= static_cast<Real>(kApproximateMasses) * least;
}

/// Whether the joint has friction and is not driven.
bool rubs(const Hook& hook, const wide::TreeForm& form, const wide::TreeJoint& joint) {
  bool found = false;
  for (int r = joint.first; r < joint.first + joint.count; ++r) {
    const wide::TreeRowForm& row = form.rows[r];
    if (row.role != RowRole::kMotor) continue;
    if (hook.freedom[row.freedom].motor.speed != Real(0)) return false;
    found = true;
  }
  return found;
}

/// Whether its locks held in the last substep.
bool held(const Hook& hook, const wide::TreeForm& form, const wide::TreeJoint& joint) {
  for (int r = joint.first; r < joint.first + joint.count; ++r) {
    const wide::TreeRowForm& row = form.rows[r];
    if (row.role != RowRole::kLock) continue;
    const double off = hook.value[row.freedom] - static_cast<double>(hook.freedom[row.freedom].spring.target);
    if (!(std::abs(off) < kApproximateError)) return false;
  }
  return true;
}

/// Whether `holds(hook, form, joint)` for each joint.
template <class Holds>
bool all_joints(const Articulation& tree, const std::vector<Hook>& hooks, Holds&& holds) {
  const wide::TreeForm& form = tree.tree.form;
  HOOKE_ASSERT(form.joints.size() == tree.joints.size());
  for (std::size_t i = 0; i < tree.joints.size(); ++i) {
    if (!holds(hooks[tree.joints[i].hook], form, form.joints[i])) return false;
  }
  return true;
}

}  // namespace

bool is_ragdoll(const Articulation& tree, const std::vector<Hook>& hooks, const state::Bodies& bodies) {
  HOOKE_ASSERT(!tree.has_loops());
  return tree.tree.form.joints.back().parent_moves && has_like_masses(tree, bodies) &&
         all_joints(tree, hooks, rubs);
}

bool is_approximate(const Articulation& ragdoll, const std::vector<Hook>& hooks) {
  return all_joints(ragdoll, hooks, held);
}

}  // namespace hooke::solver
