#include "solver/joint/joints.h"

#include "base/assert.h"
#include "solver/joint/approximate_trees.h"
#include "solver/joint/joint_energy.h"

#include <algorithm>
#include <limits>
#include <span>

namespace hooke::solver {

namespace {

using parallel::Range;
using state::Hook;
using state::HookPlace;

constexpr int kArticulationGrain = 1;
constexpr int kTreeGrain = 16;
constexpr int kHookGrain = 256;

template <class Change>
void for_hooks(parallel::ThreadPool& pool, std::vector<Hook>& hooks, Change&& change) {
  parallel::for_ranges(pool, static_cast<int>(hooks.size()), kHookGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) change(hooks[i]);
  });
}

/// Fills scratch.groups.
void find_groups(const std::vector<Hook>& hooks, const state::Bodies& bodies, BuildScratch& scratch) {
  auto& [hook_rows, begin] = scratch.groups;
  scratch.sets.reset(bodies.motion.size());
  for (const Hook& hook : hooks) {
    if (is_dynamic(bodies, hook.a.body) && is_dynamic(bodies, hook.b.body))
      scratch.sets.merge(hook.a.body, hook.b.body);
  }
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  scratch.group_of.assign(bodies.motion.size(), kNone);
  scratch.grouped.clear();
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < hooks.size(); ++i) {
    const std::uint32_t body = is_dynamic(bodies, hooks[i].a.body) ? hooks[i].a.body : hooks[i].b.body;
    if (!is_dynamic(bodies, body) || hooks[i].holds_point()) continue;
    std::uint32_t& group = scratch.group_of[scratch.sets.root(body)];
    if (group == kNone) group = count++;
    scratch.grouped.emplace_back(group, i);
  }
  std::sort(scratch.grouped.begin(), scratch.grouped.end());
  hook_rows.clear();
  begin.clear();
  for (const auto& [group, hook] : scratch.grouped) {
    HOOKE_ASSERT(group <= begin.size());  // none is left out
    if (group == begin.size()) begin.push_back(hook_rows.size());
    hook_rows.push_back(hook);
  }
  begin.push_back(hook_rows.size());
}

bool any_awake(const Articulation& articulation, const state::Bodies& bodies) {
  return std::any_of(articulation.bodies.begin(), articulation.bodies.end(),
                     [&](std::uint32_t body) { return gives_way(bodies, body); });
}

/// Whether the articulation is solved with what touches it.
bool is_in_coupled_group(const Articulation& articulation, const std::vector<Hook>& hooks) {
  const auto joint = std::find_if(articulation.joints.begin(), articulation.joints.end(),
                                  [](const Articulation::Joint& j) { return !j.is_weld(); });
  return joint != articulation.joints.end() && hooks[joint->hook].route == state::JointRoute::kCoupled;
}

/// Solves the articulations that are awake; trees of a kind together.
void solve_articulations(double h, std::span<const std::uint32_t> order,
                         std::vector<Articulation>& articulations, SolveScratch& scratch,
                         JointTables tables) {
  scratch.trees.clear();
  const auto solve = [&] {
    solve_trees(h, scratch.trees, scratch.side_by_side, tables);
    scratch.trees.clear();
  };
  for (const std::uint32_t i : order) {
    Articulation& art = articulations[i];
    if (!any_awake(art, tables.bodies)) continue;
    if (is_in_coupled_group(art, tables.hooks)) {
      reset_energy(art, tables.hooks);  // others solve it in this step
      continue;
    }
    if (art.has_loops()) {
      solve_loops(h, art, tables);
      continue;
    }
    if (!scratch.trees.empty() && scratch.trees.front()->tree.kind != art.tree.kind) solve();
    scratch.trees.push_back(&art);
  }
  solve();
}

/// Does the same, until no hook needs more than it can take.
void solve_with_breaks(double h, std::span<const std::uint32_t> order,
                       std::vector<Articulation>& articulations, SolveScratch& scratch, JointTables tables) {
  scratch.breaks.clear();
  for (const std::uint32_t i : order) {
    const Articulation& art = articulations[i];
    if (!art.breakable || !any_awake(art, tables.bodies) || is_in_coupled_group(art, tables.hooks)) continue;
    scratch.breaks.note(i, art, tables);
  }
  while (!order.empty()) {
    solve_articulations(h, order, articulations, scratch, tables);
    order = scratch.breaks.give_way(h, tables);
  }
}

/// Brings trees of one form together. An articulation with loops has no form, and comes first.
void sort_articulations(std::vector<Articulation>& articulations, std::vector<std::uint32_t>& order) {
  const auto form = [&](std::uint32_t i) -> const wide::TreeForm& { return articulations[i].tree.form; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
    const auto compared = form(i) <=> form(k);
    return compared != 0 ? compared < 0 : i < k;
  });
  int kind = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && form(order[k]) != form(order[k - 1])) ++kind;
    articulations[order[k]].tree.kind = kind;
  }
}

/// What a group may cost [multiplications]. Iterative joints do worst on bodies of unlike masses.
double budget_of(std::span<const std::uint32_t> rows, const std::vector<Hook>& hooks,
                 const state::Bodies& bodies, double budget) {
  Real least = std::numeric_limits<Real>::infinity();
  Real most = Real(0);
  for (const std::uint32_t row : rows) {
    for (const std::uint32_t body : {hooks[row].a.body, hooks[row].b.body}) {
      if (!is_dynamic(bodies, body)) continue;
      least = std::min(least, bodies.motion[body].inverse_mass);
      most = std::max(most, bodies.motion[body].inverse_mass);
    }
  }
  return most > static_cast<Real>(kUnlikeMasses) * least ? kUnlikeBudgetRatio * budget : budget;
}

/// Makes an articulation of each group that is cheap enough; the hooks of the others are the rest.
void build_articulations(const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget,
                         Joints& joints) {
  BuildScratch& scratch = joints.build;
  find_groups(hooks, bodies, scratch);
  const HookGroups& groups = scratch.groups;
  scratch.rest.clear();
  joints.order.clear();
  for (std::size_t group = 0; group + 1 < groups.begin.size(); ++group) {
    const auto rows =
        std::span(groups.hooks).subspan(groups.begin[group], groups.begin[group + 1] - groups.begin[group]);
    HOOKE_ASSERT(!rows.empty());
    const auto next = static_cast<std::uint32_t>(joints.order.size());
    if (next == joints.articulations.size()) joints.articulations.emplace_back();
    if (make_articulation(rows, hooks, bodies, budget_of(rows, hooks, bodies, budget), scratch.articulation,
                          joints.articulations[next])) {
      joints.order.push_back(next);
    } else {
      scratch.rest.insert(scratch.rest.end(), rows.begin(), rows.end());
    }
  }
  sort_articulations(joints.articulations, joints.order);
}

}  // namespace

void build_joints(const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget,
                  Joints& joints) {
  build_articulations(hooks, bodies, budget, joints);
  joints.articulation_of.assign(bodies.motion.size(), Joints::kNoArticulation);
  for (const std::uint32_t i : joints.order) {
    for (const std::uint32_t body : joints.articulations[i].bodies) {
      if (is_dynamic(bodies, body)) joints.articulation_of[body] = i;
    }
  }
  joints.at_points.clear();
  for (std::uint32_t row = 0; row < hooks.size(); ++row) {
    if (hooks[row].holds_point()) joints.at_points.push_back(row);
  }
  auto& [sets, group_of, grouped, groups, articulation, rest, balls, others, degree, colors] = joints.build;
  count_hooks(rest, hooks, bodies, degree);
  balls.clear();
  others.clear();
  // Blocks cannot solve bodies with many hooks.
  const auto has_many_hooks = [&](std::uint32_t body) {
    return is_dynamic(bodies, body) && joints.build.degree[body] > kMostFreeHooks;
  };
  for (const std::uint32_t row : rest) {
    const Hook& hook = hooks[row];
    const bool plain =
        is_plain_ball(hook, bodies) && !has_many_hooks(hook.a.body) && !has_many_hooks(hook.b.body);
    (plain ? balls : others).push_back(row);
  }
  build_ball_joints(balls, hooks, bodies, colors, joints.balls);
  build_iterative_joints(others, hooks, bodies, degree, colors, joints.iterative);
}

void evaluate_ragdolls(parallel::ThreadPool& pool, const std::vector<Hook>& hooks,
                       const state::Bodies& bodies, Joints& joints) {
  joints.in_ragdoll.assign(bodies.motion.size(), 0);
  parallel::for_ranges(pool, static_cast<int>(joints.order.size()), kTreeGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      Articulation& art = joints.articulations[joints.order[i]];
      const bool ragdoll = !art.has_loops() && is_ragdoll(art, hooks, bodies);
      art.tree.approximate = ragdoll && is_approximate(art, hooks);
      if (!ragdoll) continue;
      for (const std::uint32_t body : art.bodies) joints.in_ragdoll[body] = 1;
    }
  });
}

void prepare_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, const state::Bodies& bodies,
                    Joints& joints) {
  prepare_iterative_joints(joints.iterative);
  prepare_ball_joints(pool, h, hooks, bodies, joints.balls);
  for_hooks(pool, hooks, [](Hook& hook) {
    hook.held = 0;
    hook.impulse_sum = {};
    hook.angular_impulse_sum = {};
  });
}

void solve_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, state::Bodies& bodies,
                  Joints& joints) {
  joints.scratch.resize(static_cast<std::size_t>(pool.workers()));
  HOOKE_ASSERT(joints.order.size() <= joints.articulations.size());
  const auto count = static_cast<int>(joints.order.size());
  parallel::for_ranges(pool, count, kArticulationGrain, [&](Range range, int part) {
    const auto first = static_cast<std::size_t>(range.begin);
    const auto some = std::span(joints.order).subspan(first, static_cast<std::size_t>(range.count()));
    solve_with_breaks(static_cast<double>(h), some, joints.articulations, joints.scratch[part],
                      {hooks, bodies});
    for (const std::uint32_t i : some) {
      for (const Articulation::Joint& joint : joints.articulations[i].joints) {
        if (!joint.is_weld() && hooks[joint.hook].route != state::JointRoute::kCoupled)
          add_up_impulses(h, hooks[joint.hook]);
      }
    }
  });
  solve_ball_joints(pool, h, bodies, joints.balls);
  solve_iterative_joints(pool, static_cast<double>(h), hooks, bodies, joints.iterative);
}

void relax_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, state::Bodies& bodies,
                  Joints& joints) {
  relax_ball_joints(pool, bodies, joints.balls);
  relax_iterative_joints(pool, static_cast<double>(h), hooks, bodies, joints.iterative);
  for (const std::uint32_t row : joints.iterative.hooks) add_up_impulses(h, hooks[row]);
}

void finish_joints(parallel::ThreadPool& pool, Real dt, int substeps, const state::Bodies& bodies,
                   const Joints& joints, std::vector<Hook>& hooks) {
  store_ball_joints(pool, dt, substeps, bodies, joints.balls, hooks);
  for_hooks(pool, hooks, [dt](Hook& hook) {
    hook.force = (Real(1) / dt) * hook.impulse_sum;
    hook.torque = (Real(1) / dt) * hook.angular_impulse_sum;
  });
}

}  // namespace hooke::solver
