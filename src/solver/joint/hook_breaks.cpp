#include "solver/joint/hook_breaks.h"

#include "base/assert.h"
#include "solver/body/body_motion.h"

#include <algorithm>

namespace hooke::solver {

using state::Hook;

double need_of(const Hook& hook, const HookLoad& load, double h) {
  if (hook.broken || hook.giving != Hook::Giving::kHolds) return 0;
  return std::max(load.impulse / (h * static_cast<double>(hook.break_force)),
                  load.angular_impulse / (h * static_cast<double>(hook.break_torque)));
}

void let_go(double h, double need, const HookLoad& load, Hook& hook) {
  HOOKE_ASSERT(need > 1 && hook.can_break());
  hook.giving = Hook::Giving::kNothing;
  hook.compliance = {kNoHold, kNoHold};
  hook.most = {load.impulse / need, load.angular_impulse / need};
  hook.needed_force = static_cast<Real>(load.impulse / h);
  hook.needed_torque = static_cast<Real>(load.angular_impulse / h);
}

bool set_dashpot(const HookLoad& load, Hook& hook) {
  if (hook.giving == Hook::Giving::kHolds || hook.giving == Hook::Giving::kMost) return false;
  hook.giving = hook.giving == Hook::Giving::kNothing ? Hook::Giving::kSome : Hook::Giving::kMost;
  const auto set = [](double took, double most, double& compliance) {
    const double speed = compliance * took;
    compliance = most > 0 && speed < kNoHold * most ? speed / most : kNoHold;
  };
  set(load.impulse, hook.most[0], hook.compliance[0]);
  set(load.angular_impulse, hook.most[1], hook.compliance[1]);
  return true;
}

void BreakScratch::clear() {
  groups_.clear();
  bodies_.clear();
  hooks_.clear();
  rows_.clear();
}

void BreakScratch::note(std::uint32_t index, const Articulation& art, const JointTables& tables) {
  Group group = {.articulation = index, .first_body = bodies_.size(), .first_hook = hooks_.size()};
  for (const std::uint32_t row : art.bodies) {
    if (!is_dynamic(tables.bodies, row)) continue;
    bodies_.push_back({row, tables.bodies.motion[row], tables.bodies.free_motion[row],
                       tables.bodies.angular_momentum[row]});
  }
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    const Hook& hook = tables.hooks[joint.hook];
    rows_.push_back(joint.hook);
    hooks_.push_back({joint.hook, hook.impulse, hook.angular_impulse, hook.row_impulse, hook.value,
                      hook.energy_debt, hook.spring_energy});
  }
  group.end_body = bodies_.size();
  group.end_hook = hooks_.size();
  HOOKE_ASSERT(rows_.size() == hooks_.size() && group.first_hook < group.end_hook);
  groups_.push_back(group);
}

void BreakScratch::put_back(const Group& group, const JointTables& tables) const {
  HOOKE_ASSERT(group.end_body <= bodies_.size() && group.end_hook <= hooks_.size());
  for (std::size_t i = group.first_body; i < group.end_body; ++i) {
    const SavedBody& body = bodies_[i];
    tables.bodies.motion[body.row] = body.motion;
    tables.bodies.free_motion[body.row] = body.free_motion;
    tables.bodies.angular_momentum[body.row] = body.angular_momentum;
  }
  for (std::size_t i = group.first_hook; i < group.end_hook; ++i) {
    const SavedHook& saved = hooks_[i];
    Hook& hook = tables.hooks[saved.row];
    hook.impulse = saved.impulse;
    hook.angular_impulse = saved.angular_impulse;
    hook.row_impulse = saved.row_impulse;
    hook.value = saved.value;
    hook.energy_debt = saved.energy_debt;
    hook.spring_energy = saved.spring_energy;
  }
}

std::span<const std::uint32_t> BreakScratch::give_way(double h, const JointTables& tables) {
  again_.clear();
  const auto load_of = [&](std::uint32_t row) -> HookLoad {
    const Hook& hook = tables.hooks[row];
    return {length(vector_cast<double>(hook.impulse)), length(vector_cast<double>(hook.angular_impulse))};
  };
  for (Group& group : groups_) {
    const auto rows = std::span(rows_).subspan(group.first_hook, group.end_hook - group.first_hook);
    if (group.converged) continue;
    group.converged = !solver::give_way(h, rows, group.round++, tables.hooks, load_of);
    if (group.converged) continue;
    put_back(group, tables);
    again_.push_back(group.articulation);
  }
  return again_;
}

}  // namespace hooke::solver
