#include "solver/joints.h"

#include "base/disjoint_sets.h"

#include <algorithm>
#include <map>
#include <span>

namespace hooke::solver {

namespace {

using parallel::Range;
using state::Hook;
using state::HookPlace;

constexpr int kArticulationGrain = 1;
constexpr int kHookGrain = 256;

template <class Change>
void for_hooks(parallel::ThreadPool& pool, std::vector<Hook>& hooks, Change&& change) {
  parallel::for_ranges(pool, static_cast<int>(hooks.size()), kHookGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) change(hooks[i]);
  });
}

/// Hooks that share bodies which forces move, directly or through others; groups in order of their first.
std::vector<std::vector<std::uint32_t>> find_groups(const std::vector<Hook>& hooks,
                                                    const state::Bodies& bodies) {
  base::DisjointSets sets(bodies.motion.size());
  for (const Hook& hook : hooks) {
    if (is_dynamic(bodies, hook.a.body) && is_dynamic(bodies, hook.b.body))
      sets.merge(hook.a.body, hook.b.body);
  }
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::uint32_t> group_of(bodies.motion.size(), kNone);
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::uint32_t i = 0; i < hooks.size(); ++i) {
    const std::uint32_t body = is_dynamic(bodies, hooks[i].a.body) ? hooks[i].a.body : hooks[i].b.body;
    if (!is_dynamic(bodies, body) || hooks[i].holds_point()) continue;
    std::uint32_t& group = group_of[sets.root(body)];
    if (group == kNone) {
      group = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
    }
    groups[group].push_back(i);
  }
  return groups;
}

bool any_awake(const Articulation& articulation, const state::Bodies& bodies) {
  return std::any_of(articulation.bodies.begin(), articulation.bodies.end(),
                     [&](std::uint32_t body) { return gives_way(bodies, body); });
}

/// Those awake; trees of a kind together.
void solve_articulations(double h, std::span<Articulation> articulations, ArticulationScratch& scratch,
                         JointTables tables) {
  scratch.trees.clear();
  const auto solve = [&] {
    solve_trees(h, scratch.trees, scratch.side_by_side, tables);
    scratch.trees.clear();
  };
  for (Articulation& art : articulations) {
    if (!any_awake(art, tables.bodies)) continue;
    if (art.has_loops()) {
      solve_loops(h, art, tables);
      continue;
    }
    if (!scratch.trees.empty() && scratch.trees.front()->tree.kind != art.tree.kind) solve();
    scratch.trees.push_back(&art);
  }
  solve();
}

/// A form as numbers: equal where forms are.
std::vector<int> numbers_of(const wide::TreeForm& form) {
  std::vector<int> numbers;
  for (const wide::TreeJoint& joint : form.joints) {
    numbers.insert(numbers.end(), {joint.parent, joint.parent_moves, joint.child_is_b,
                                   static_cast<int>(joint.kind), joint.turns, joint.count});
  }
  for (const wide::TreeRowForm& row : form.rows)
    numbers.insert(numbers.end(), {row.freedom, static_cast<int>(row.role), row.sprung});
  return numbers;
}

/// Brings trees of one form together.
void sort_articulations(std::vector<Articulation>& articulations) {
  std::map<std::vector<int>, int> kinds;
  for (Articulation& art : articulations)
    art.tree.kind = kinds.emplace(numbers_of(art.tree.form), static_cast<int>(kinds.size())).first->second;
  std::stable_sort(articulations.begin(), articulations.end(),
                   [](const Articulation& a, const Articulation& b) {
                     return a.has_loops() != b.has_loops() ? a.has_loops() : a.tree.kind < b.tree.kind;
                   });
}

}  // namespace

void build_joints(const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget,
                  Joints& joints) {
  joints.articulations.clear();
  std::vector<std::uint32_t> rest;
  for (const std::vector<std::uint32_t>& group : find_groups(hooks, bodies)) {
    std::optional<Articulation> art = make_articulation(group, hooks, bodies, budget);
    if (art) {
      joints.articulations.push_back(std::move(*art));
    } else {
      rest.insert(rest.end(), group.begin(), group.end());
    }
  }
  sort_articulations(joints.articulations);
  const std::vector<int> degree = count_hooks(rest, hooks, bodies);
  // Blocks know no crowds.
  const auto is_crowded = [&](std::uint32_t body) {
    return is_dynamic(bodies, body) && degree[body] > kMostFreeHooks;
  };
  const auto others = std::stable_partition(rest.begin(), rest.end(), [&](std::uint32_t row) {
    return is_plain_ball(hooks[row], bodies) && !is_crowded(hooks[row].a.body) &&
           !is_crowded(hooks[row].b.body);
  });
  build_ball_joints({rest.begin(), others}, hooks, bodies, joints.balls);
  build_net({others, rest.end()}, hooks, bodies, degree, joints.net);
}

void prepare_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, const state::Bodies& bodies,
                    Joints& joints) {
  prepare_net(joints.net);
  prepare_ball_joints(pool, h, hooks, bodies, joints.balls);
  for_hooks(pool, hooks, [](Hook& hook) {
    hook.impulse_sum = {};
    hook.angular_impulse_sum = {};
  });
}

void solve_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, state::Bodies& bodies,
                  Joints& joints) {
  joints.scratch.resize(static_cast<std::size_t>(pool.workers()));
  const auto count = static_cast<int>(joints.articulations.size());
  parallel::for_ranges(pool, count, kArticulationGrain, [&](Range range, int part) {
    const auto first = static_cast<std::size_t>(range.begin);
    const auto some = std::span(joints.articulations).subspan(first, static_cast<std::size_t>(range.count()));
    solve_articulations(static_cast<double>(h), some, joints.scratch[part], {hooks, bodies});
    for (const Articulation& art : some) {
      for (const Articulation::Joint& joint : art.joints) {
        if (!joint.is_weld()) add_up_impulses(h, hooks[joint.hook]);
      }
    }
  });
  solve_ball_joints(pool, h, bodies, joints.balls);
  solve_net(pool, static_cast<double>(h), hooks, bodies, joints.net);
}

void relax_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, state::Bodies& bodies,
                  Joints& joints) {
  relax_ball_joints(pool, bodies, joints.balls);
  relax_net(pool, static_cast<double>(h), hooks, bodies, joints.net);
  for (const std::uint32_t row : joints.net.hooks) add_up_impulses(h, hooks[row]);
}

void finish_joints(parallel::ThreadPool& pool, Real dt, int substeps, const state::Bodies& bodies,
                   const Joints& joints, std::vector<Hook>& hooks) {
  store_ball_joints(pool, substeps, bodies, joints.balls, hooks);
  for_hooks(pool, hooks, [dt](Hook& hook) {
    hook.force = (Real(1) / dt) * hook.impulse_sum;
    hook.torque = (Real(1) / dt) * hook.angular_impulse_sum;
  });
}

}  // namespace hooke::solver
