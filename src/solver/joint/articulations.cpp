#include "solver/joint/articulations.h"

#include "base/assert.h"
#include "solver/joint/articulation_links.h"
#include "solver/joint/joint_tuning.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>

namespace hooke::solver {

namespace {

using state::Hook;

std::uint32_t link_of(const std::vector<std::uint32_t>& bodies, std::uint32_t body) {
  return static_cast<std::uint32_t>(std::lower_bound(bodies.begin(), bodies.end(), body) - bodies.begin());
}

/// What rows are to join: the links, and the two links of each joint.
struct Frame {
  std::vector<std::uint32_t> bodies;
  std::vector<double> parts;
  std::vector<Articulation::Joint> joints;  ///< Hooks as they come, then welds.

  // Memory of make_frame.
  std::vector<std::uint32_t> body_of;
  std::vector<int> taken;
};

/// Joints of each link, in their order.
struct JointsOfLinks {
  std::vector<std::uint32_t> joints;
  std::vector<std::uint32_t> begin;  ///< Where the joints of each link begin; one more at the end.

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t link) const {
    return std::span(joints).subspan(begin[link], begin[link + 1] - begin[link]);
  }
};

/// A joint between a link and its child, the neighbor away from the root.
struct Branch {
  std::uint32_t joint = 0;
  std::uint32_t child = 0;
};

}  // namespace

struct ArticulationScratch::Lists {
  Frame frame;
  JointsOfLinks joints_of;
  // For loops.
  std::vector<int> sizes;
  BlockGraph graph;
  // For trees.
  std::vector<Branch> branches;
  std::vector<std::uint32_t> place;
};

namespace {

using Lists = ArticulationScratch::Lists;

/// Makes links of all bodies of the hooks. Bodies with more than `most_hooks` hooks are divided.
void make_frame(std::span<const std::uint32_t> hook_rows, const std::vector<Hook>& hooks,
                const state::Bodies& bodies, int most_hooks, Frame& frame) {
  std::vector<std::uint32_t>& body_of = frame.body_of;
  body_of.clear();
  frame.bodies.clear();
  frame.parts.clear();
  frame.joints.clear();
  for (const std::uint32_t i : hook_rows) body_of.insert(body_of.end(), {hooks[i].a.body, hooks[i].b.body});
  std::sort(body_of.begin(), body_of.end());
  for (auto at = body_of.begin(); at != body_of.end();) {
    const auto next = std::upper_bound(at, body_of.end(), *at);
    const auto count = static_cast<int>(next - at);
    const bool divided = is_dynamic(bodies, *at) && count > most_hooks;
    const int parts = divided ? (count + kHooksOfLink - 1) / kHooksOfLink : 1;
    frame.bodies.insert(frame.bodies.end(), static_cast<std::size_t>(parts), *at);
    frame.parts.insert(frame.parts.end(), static_cast<std::size_t>(parts), parts);
    at = next;
  }
  std::vector<int>& taken = frame.taken;
  taken.assign(frame.bodies.size(), 0);
  const auto next_link = [&](std::uint32_t body) {
    const std::uint32_t first = link_of(frame.bodies, body);
    HOOKE_ASSERT(first < frame.bodies.size() && frame.bodies[first] == body);
    if (frame.parts[first] == 1) return first;
    HOOKE_ASSERT(taken[first] / kHooksOfLink < static_cast<int>(frame.parts[first]));
    return first + static_cast<std::uint32_t>(taken[first]++ / kHooksOfLink);
  };
  for (const std::uint32_t i : hook_rows) {
    const std::uint32_t a = next_link(hooks[i].a.body);
    frame.joints.push_back({.hook = i, .a = a, .b = next_link(hooks[i].b.body)});
  }
  for (std::uint32_t link = 1; link < frame.bodies.size(); ++link) {
    if (frame.bodies[link] == frame.bodies[link - 1])
      frame.joints.push_back({.hook = Articulation::kWeld, .a = link - 1, .b = link});
  }
}

void list_joints_of_links(const Frame& frame, JointsOfLinks& of) {
  of.begin.assign(frame.bodies.size() + 1, 0);
  for (const Articulation::Joint& joint : frame.joints) {
    ++of.begin[joint.a];
    ++of.begin[joint.b];
  }
  std::partial_sum(of.begin.begin(), of.begin.end(), of.begin.begin());
  of.joints.resize(2 * frame.joints.size());
  for (auto i = static_cast<std::uint32_t>(frame.joints.size()); i-- > 0;) {
    of.joints[--of.begin[frame.joints[i].a]] = i;
    of.joints[--of.begin[frame.joints[i].b]] = i;
  }
}

/// Whether there are more joints than a tree of these links can have.
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

/// Joins joints that share a link which moves.
void join_joints(const Frame& frame, const JointsOfLinks& joints_of, const state::Bodies& bodies,
                 BlockGraph& graph) {
  graph.reset(frame.joints.size());
  for (std::size_t link = 0; link < frame.bodies.size(); ++link) {
    if (!is_dynamic(bodies, frame.bodies[link])) continue;
    const std::span<const std::uint32_t> joints = joints_of.of(link);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (joints[j] != joints[k]) graph.join(joints[j], joints[k]);
      }
    }
  }
}

/// Makes blocks of the joints' rows. False if they take more than the budget.
bool make_blocks(const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget, Lists& lists,
                 Articulation& art) {
  const Frame& frame = lists.frame;
  lists.sizes.clear();
  for (const Articulation::Joint& joint : frame.joints)
    lists.sizes.push_back(joint.is_weld() ? kWeldRows : count_joint_rows(hooks[joint.hook]));
  list_joints_of_links(frame, lists.joints_of);
  join_joints(frame, lists.joints_of, bodies, lists.graph);
  Articulation::Blocks& blocks = art.blocks;
  if (!make_block_pattern(lists.graph, lists.sizes, budget, blocks.pattern)) return false;
  for (int i = 0; i < blocks.pattern.node_count(); ++i) {
    Articulation::Joint joint = frame.joints[blocks.pattern.order[i]];
    joint.first = blocks.pattern.first[i];
    joint.count = blocks.pattern.size[i];
    art.joints.push_back(joint);
  }
  art.bodies.assign(frame.bodies.begin(), frame.bodies.end());
  art.parts.assign(frame.parts.begin(), frame.parts.end());
  list_couplings(bodies, art);
  art.links.resize(art.bodies.size());
  const auto row_count = static_cast<std::size_t>(blocks.pattern.first.back());
  art.rows.resize(row_count);
  art.lambda.resize(row_count);
  art.bound.resize(row_count);
  blocks.free.reserve(row_count);
  blocks.columns.reserve(9 * row_count);
  blocks.right_side.reserve(row_count);
  blocks.compliance.reserve(row_count);
  blocks.unfelt.reserve(row_count);
  blocks.factors.reserve(blocks.pattern.number_count);
  blocks.factor_scratch.reserve(blocks.pattern.number_count);
  return true;
}

/// The link that nothing moves, or else the heaviest one.
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

/// Lists branches from the root on: a joint comes after the joint that its parent hangs on.
void list_branches(const Frame& frame, const JointsOfLinks& joints_of, std::uint32_t root,
                   std::vector<Branch>& branches) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  branches.assign(1, {kNone, root});
  for (std::size_t at = 0; at < branches.size(); ++at) {
    const Branch branch = branches[at];
    for (const std::uint32_t i : joints_of.of(branch.child)) {
      const Articulation::Joint& joint = frame.joints[i];
      if (i != branch.joint) branches.push_back({i, joint.a == branch.child ? joint.b : joint.a});
    }
  }
  branches.erase(branches.begin());
  HOOKE_ASSERT(branches.size() == frame.joints.size());  // each joint once: there are no loops
}

/// Lists the rows of a joint for the lanes: a spring and the motor beside it are one row.
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

/// Multiplications needed to eliminate a joint of n rows.
double cost_of(double n) {
  return 91 + n * (60 + n * (6 + n / 6));
}

/// Lists links and joints in order of elimination. False if that takes more than the budget.
bool make_tree(const std::vector<Hook>& hooks, const state::Bodies& bodies, double budget, Lists& lists,
               Articulation& art) {
  auto& [frame, joints_of, sizes, graph, branches, place] = lists;
  const std::uint32_t root = find_root(frame, bodies);
  list_joints_of_links(frame, joints_of);
  list_branches(frame, joints_of, root, branches);
  std::reverse(branches.begin(), branches.end());
  place.assign(frame.bodies.size(), static_cast<std::uint32_t>(branches.size()));
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
    HOOKE_ASSERT(place[parent] > place[branch.child] && count <= wide::kMostTreeRows);
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

/// Empties it, but keeps its memory.
void clear(Articulation& art) {
  art.bodies.clear();
  art.joints.clear();
  art.tree.form.joints.clear();
  art.tree.form.rows.clear();
  art.tree.rows.clear();
  art.blocks.couplings.clear();
}

}  // namespace

ArticulationScratch::ArticulationScratch() : lists_(std::make_unique<Lists>()) {}
ArticulationScratch::~ArticulationScratch() = default;
ArticulationScratch::ArticulationScratch(ArticulationScratch&&) noexcept = default;
ArticulationScratch& ArticulationScratch::operator=(ArticulationScratch&&) noexcept = default;

bool make_articulation(std::span<const std::uint32_t> hook_rows, const std::vector<Hook>& hooks,
                       const state::Bodies& bodies, double budget, ArticulationScratch& scratch,
                       Articulation& art) {
  Lists& lists = scratch.lists();
  clear(art);
  HOOKE_ASSERT(!hook_rows.empty());
  art.breakable = std::any_of(hook_rows.begin(), hook_rows.end(),
                              [&](std::uint32_t row) { return hooks[row].can_break(); });
  make_frame(hook_rows, hooks, bodies, std::numeric_limits<int>::max(), lists.frame);
  if (!has_loops(lists.frame, bodies)) return make_tree(hooks, bodies, kTreeBudgetRatio * budget, lists, art);
  make_frame(hook_rows, hooks, bodies, kMostUndividedHooks, lists.frame);
  return make_blocks(hooks, bodies, budget, lists, art);
}

}  // namespace hooke::solver
