#include "solver/articulations.h"

#include "solver/articulation_links.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace hooke::solver {

namespace {

using state::Hook;

constexpr int kMostHooks = 8;  ///< Of a body that is not divided.
constexpr int kHooksOfPart = 4;

std::uint32_t link_of(const std::vector<std::uint32_t>& bodies, std::uint32_t body) {
  return static_cast<std::uint32_t>(std::lower_bound(bodies.begin(), bodies.end(), body) - bodies.begin());
}

/// What is to be joined by rows: links, and the two of each joint.
struct Frame {
  std::vector<std::uint32_t> bodies;
  std::vector<double> parts;
  std::vector<Articulation::Joint> joints;  ///< Hooks as they come, then welds.
};

/// Links of all bodies of the hooks, of which those of more than `most_hooks` are divided.
Frame make_frame(const std::vector<std::uint32_t>& hook_rows, const std::vector<Hook>& hooks,
                 const state::Bodies& bodies, int most_hooks) {
  std::vector<std::uint32_t> body_of;
  for (const std::uint32_t i : hook_rows) body_of.insert(body_of.end(), {hooks[i].a.body, hooks[i].b.body});
  std::sort(body_of.begin(), body_of.end());
  Frame frame;
  for (auto at = body_of.begin(); at != body_of.end();) {
    const auto next = std::upper_bound(at, body_of.end(), *at);
    const auto count = static_cast<int>(next - at);
    const bool divided = is_dynamic(bodies, *at) && count > most_hooks;
    const int parts = divided ? (count + kHooksOfPart - 1) / kHooksOfPart : 1;
    frame.bodies.insert(frame.bodies.end(), static_cast<std::size_t>(parts), *at);
    frame.parts.insert(frame.parts.end(), static_cast<std::size_t>(parts), parts);
    at = next;
  }
  std::vector<int> taken(frame.bodies.size(), 0);
  const auto next_link = [&](std::uint32_t body) {
    const std::uint32_t first = link_of(frame.bodies, body);
    if (frame.parts[first] == 1) return first;
    return first + static_cast<std::uint32_t>(taken[first]++ / kHooksOfPart);
  };
  for (const std::uint32_t i : hook_rows) {
    const std::uint32_t a = next_link(hooks[i].a.body);
    frame.joints.push_back({.hook = i, .a = a, .b = next_link(hooks[i].b.body)});
  }
  for (std::uint32_t link = 1; link < frame.bodies.size(); ++link) {
    if (frame.bodies[link] == frame.bodies[link - 1])
      frame.joints.push_back({.hook = Articulation::kWeld, .a = link - 1, .b = link});
  }
  return frame;
}

/// Joints of each link that moves.
std::vector<std::vector<std::uint32_t>> joints_of_links(const Frame& frame, const state::Bodies& bodies) {
  std::vector<std::vector<std::uint32_t>> of(frame.bodies.size());
  for (std::uint32_t i = 0; i < frame.joints.size(); ++i) {
    for (const std::uint32_t link : {frame.joints[i].a, frame.joints[i].b}) {
      if (is_dynamic(bodies, frame.bodies[link])) of[link].push_back(i);
    }
  }
  return of;
}

/// More joints than a tree of these links can have.
bool has_loops(const Frame& frame, const state::Bodies& bodies) {
  const auto moves = [&](std::uint32_t link) { return is_dynamic(bodies, frame.bodies[link]); };
  std::ptrdiff_t moving = 0;
  for (std::uint32_t link = 0; link < frame.bodies.size(); ++link) moving += moves(link) ? 1 : 0;
  const bool grounded = std::any_of(frame.joints.begin(), frame.joints.end(),
                                    [&](const auto& joint) { return !moves(joint.a) || !moves(joint.b); });
  return static_cast<std::ptrdiff_t>(frame.joints.size()) > moving - (grounded ? 0 : 1);
}

void list_couplings(const state::Bodies& bodies, Articulation& art) {
  for (std::uint32_t k = 0; k < art.blocks.pattern.block.size(); ++k) {
    const Articulation::Joint& left = art.joints[art.blocks.pattern.block[k].row];
    const Articulation::Joint& right = art.joints[art.blocks.pattern.block[k].column];
    for (const std::uint32_t link : {left.a, left.b}) {
      if (link != right.a && link != right.b) continue;
      if (is_dynamic(bodies, art.bodies[link])) art.blocks.couplings.push_back({k, link});
    }
  }
}

/// Blocks of the joints' rows; false if they take more than the budget.
bool make_blocks(Frame frame, const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget,
                 Articulation& art) {
  std::vector<int> sizes;
  for (const Articulation::Joint& joint : frame.joints)
    sizes.push_back(joint.is_weld() ? kWeldRows : count_joint_rows(hooks[joint.hook]));
  BlockGraph graph;
  graph.reset(frame.joints.size());
  for (const std::vector<std::uint32_t>& group : joints_of_links(frame, bodies)) {
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (group[j] != group[k]) graph.join(group[j], group[k]);
      }
    }
  }
  Articulation::Blocks& blocks = art.blocks;
  if (!make_block_pattern(graph, sizes, budget, blocks.pattern)) return false;
  for (int i = 0; i < blocks.pattern.node_count(); ++i) {
    Articulation::Joint joint = frame.joints[blocks.pattern.order[i]];
    joint.first = blocks.pattern.first[i];
    joint.count = blocks.pattern.size[i];
    art.joints.push_back(joint);
  }
  art.bodies = std::move(frame.bodies);
  art.parts = std::move(frame.parts);
  list_couplings(bodies, art);
  art.links.resize(art.bodies.size());
  const auto row_count = static_cast<std::size_t>(blocks.pattern.first.back());
  art.rows.resize(row_count);
  art.lambda.resize(row_count);
  art.bound.resize(row_count);
  blocks.free.reserve(row_count);
  blocks.columns.reserve(9 * row_count);
  blocks.right_side.reserve(row_count);
  blocks.factors.reserve(blocks.pattern.number_count);
  blocks.factor_scratch.reserve(blocks.pattern.number_count);
  return true;
}

/// What nothing moves, or else the heaviest link.
std::uint32_t find_root(const Frame& frame, const state::Bodies& bodies) {
  const auto inverse_mass = [&](std::uint32_t link) {
    const std::uint32_t body = frame.bodies[link];
    return is_dynamic(bodies, body) ? bodies.motion[body].inverse_mass : Real(0);
  };
  std::uint32_t root = 0;
  for (std::uint32_t link = 1; link < frame.bodies.size(); ++link) {
    if (inverse_mass(link) < inverse_mass(root)) root = link;
  }
  return root;
}

/// The joint to the next link towards the root, and that link's neighbor there.
struct Branch {
  std::uint32_t joint = 0;
  std::uint32_t child = 0;
};

/// From the root on: a joint comes after the one that its parent hangs on.
std::vector<Branch> list_branches(const Frame& frame, std::uint32_t root) {
  std::vector<std::vector<std::uint32_t>> of(frame.bodies.size());
  for (std::uint32_t i = 0; i < frame.joints.size(); ++i) {
    of[frame.joints[i].a].push_back(i);
    of[frame.joints[i].b].push_back(i);
  }
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<Branch> branches = {{kNone, root}};
  for (std::size_t at = 0; at < branches.size(); ++at) {
    const Branch branch = branches[at];
    for (const std::uint32_t i : of[branch.child]) {
      const Articulation::Joint& joint = frame.joints[i];
      if (i != branch.joint) branches.push_back({i, joint.a == branch.child ? joint.b : joint.a});
    }
  }
  branches.erase(branches.begin());
  return branches;
}

/// Rows of a joint, for the lanes: a spring and the motor beside it are one.
void list_tree_rows(const Hook& hook, Articulation::Tree& tree) {
  std::array<RowKind, Hook::kMaxRows> kinds;
  const int count = list_joint_rows(hook, kinds);
  const auto is_motor_of = [&](int k, int freedom) {
    return k < count && kinds[k].role == RowRole::kMotor && kinds[k].freedom == freedom;
  };
  for (int i = 0; i < count; ++i) {
    const bool sprung = kinds[i].role == RowRole::kSpring && is_motor_of(i + 1, kinds[i].freedom);
    if (sprung) ++i;
    tree.form.rows.push_back({kinds[i].freedom, kinds[i].role, sprung});
    tree.rows.push_back(i);
  }
}

/// Multiplications that eliminate a joint of n rows.
double cost_of(double n) {
  return 91 + n * (60 + n * (6 + n / 6));
}

/// Links and joints in order of elimination; false if that takes more than the budget.
bool make_tree(const Frame& frame, const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget,
               Articulation& art) {
  const std::uint32_t root = find_root(frame, bodies);
  std::vector<Branch> branches = list_branches(frame, root);
  std::reverse(branches.begin(), branches.end());
  std::vector<std::uint32_t> place(frame.bodies.size(), static_cast<std::uint32_t>(branches.size()));
  for (std::uint32_t i = 0; i < branches.size(); ++i) place[branches[i].child] = i;

  wide::TreeForm& form = art.tree.form;
  int first = 0;
  for (const Branch& branch : branches) {
    Articulation::Joint joint = frame.joints[branch.joint];
    const std::uint32_t parent = joint.a == branch.child ? joint.b : joint.a;
    joint.a = place[joint.a];
    joint.b = place[joint.b];
    joint.first = first;
    const Hook& hook = hooks[joint.hook];
    joint.count = count_joint_rows(hook);
    first += joint.count;
    const auto first_of_form = static_cast<int>(form.rows.size());
    list_tree_rows(hook, art.tree);
    const int count = static_cast<int>(form.rows.size()) - first_of_form;
    form.joints.push_back({.parent = static_cast<int>(place[parent]),
                           .parent_moves = is_dynamic(bodies, frame.bodies[parent]),
                           .child_is_b = joint.b == place[branch.child],
                           .kind = hook.kind,
                           .turns = rows_turn(hook),
                           .first = first_of_form,
                           .count = count});
    budget -= cost_of(count);
    art.joints.push_back(joint);
    art.bodies.push_back(frame.bodies[branch.child]);
  }
  art.bodies.push_back(frame.bodies[root]);
  return budget >= 0;
}

}  // namespace

std::optional<Articulation> make_articulation(const std::vector<std::uint32_t>& hook_rows,
                                              const std::vector<Hook>& hooks, const state::Bodies& bodies,
                                              double budget) {
  Articulation art;
  const Frame whole = make_frame(hook_rows, hooks, bodies, std::numeric_limits<int>::max());
  const bool made = has_loops(whole, bodies) ? make_blocks(make_frame(hook_rows, hooks, bodies, kMostHooks),
                                                           hooks, bodies, budget, art)
                                             : make_tree(whole, hooks, bodies, kTreesMayTake * budget, art);
  if (!made) return std::nullopt;
  return art;
}

}  // namespace hooke::solver
