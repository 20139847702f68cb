#include "solver/check_routes.h"

#include "solver/soft/element_contact_solve.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

namespace hooke::solver {

namespace {

using state::ContactRoute;
using state::Hook;
using state::JointRoute;
using state::Manifold;
using state::Tables;
using Marks = std::vector<std::uint32_t>;

// Each function returns what is wrong, or null.

/// Grows by doubling: rows come and go.
void reset(std::size_t count, Marks& marks) {
  if (count > marks.capacity()) marks.reserve(2 * count);
  marks.assign(count, 0);
}

bool ascends(const std::vector<std::uint32_t>& rows) {
  return std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()) == rows.end();
}

const char* find_in_lane(const Tables& t, const ContactBlock& block, int lane, std::uint32_t row) {
  if (row >= t.pairs.manifold.size()) return "manifold of a lane";
  const Manifold& m = t.pairs.manifold[row];
  const std::uint32_t a = block.record_a[lane] / 16;
  const std::uint32_t b = block.record_b[lane] / 16;
  if ((a != m.body_a || b != m.body_b) && (a != m.body_b || b != m.body_a)) return "bodies of a lane";
  if (!is_moved(t.bodies, a) || is_moved(t.bodies, b) == block.anchored) return "who moves in a lane";
  if (m.route == ContactRoute::kNone || block.route != m.route) return "way of a lane";
  return m.point_count > block.point_count ? "points of a lane" : nullptr;
}

const char* find_in_blocks(const Tables& t, const BodyContacts& contacts) {
  if (contacts.manifold_of.size() != kContactLanes * contacts.blocks.size()) return "lanes of blocks";
  for (std::size_t i = 0; i < contacts.blocks.size(); ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (block.count < 1 || block.count > kContactLanes) return "lanes of a block";
    if (block.first_rolling < 0 || block.rolling_count < 0 ||
        block.first_rolling + block.rolling_count > static_cast<int>(contacts.rolling.size()))
      return "rolling rows of a block";
    for (int lane = 0; lane < kContactLanes; ++lane) {
      const std::uint32_t row = contacts.manifold_of[kContactLanes * i + static_cast<std::size_t>(lane)];
      if ((row == BodyContacts::kNoManifold) != (lane >= block.count)) return "lane without a manifold";
      if (lane >= block.count) continue;
      if (const char* what = find_in_lane(t, block, lane, row)) return what;
    }
  }
  return nullptr;
}

/// Marks bodies by the last color in which they were.
const char* find_in_colors(const Tables& t, const BodyContacts& contacts, Marks& marks) {
  reset(t.bodies.motion.size(), marks);
  const auto is_second = [&](std::uint32_t record, std::uint32_t color) {
    return std::exchange(marks[record / 16], color + 1) == color + 1;
  };
  if (contacts.color_begin.front() != 0) return "first color";
  for (int color = 0; color < contacts.color_count(); ++color) {
    const auto number = static_cast<std::uint32_t>(color);
    if (contacts.color_begin[number] >= contacts.color_begin[number + 1]) return "an empty color";
    for (int i = contacts.color_begin[number]; i < contacts.color_begin[number + 1]; ++i) {
      const ContactBlock& block = contacts.blocks[static_cast<std::size_t>(i)];
      for (int lane = 0; lane < block.count; ++lane) {
        if (is_second(block.record_a[lane], number) ||
            (!block.anchored && is_second(block.record_b[lane], number)))
          return "a body that is twice in a color";
      }
    }
  }
  return nullptr;
}

const char* find_in_coupled_manifolds(const Tables& t, const BodyContacts& contacts) {
  std::size_t coupled = 0;
  for (const Manifold& m : t.pairs.manifold) coupled += m.is_coupled() ? 1 : 0;
  if (coupled != t.pairs.coupled.size()) return "number of coupled manifolds";
  for (std::size_t i = 0; i < coupled; ++i) {
    const state::CoupledManifold& of = t.pairs.coupled[i];
    if (of.manifold >= t.pairs.manifold.size() || (i > 0 && of.manifold <= t.pairs.coupled[i - 1].manifold))
      return "order of coupled manifolds";
    const Manifold& m = t.pairs.manifold[of.manifold];
    if (!m.is_coupled()) return "way of a coupled manifold";
    if (of.body_a != m.body_a || of.body_b != m.body_b) return "bodies of a coupled manifold";
    const std::size_t lane =
        kContactLanes * static_cast<std::size_t>(of.block) + static_cast<std::size_t>(of.lane);
    if (of.block < 0 || lane >= contacts.manifold_of.size() || contacts.manifold_of[lane] != of.manifold)
      return "lane of a coupled manifold";
  }
  return nullptr;
}

/// Marks manifolds by the number of their lanes.
const char* find_in_ways(const Tables& t, const BodyContacts& contacts, Marks& marks) {
  reset(t.pairs.manifold.size(), marks);
  for (const std::uint32_t row : contacts.manifold_of) {
    if (row != BodyContacts::kNoManifold) ++marks[row];
  }
  for (std::size_t row = 0; row < marks.size(); ++row) {
    if (marks[row] != (t.pairs.manifold[row].route == ContactRoute::kNone ? 0U : 1U))
      return "lanes of a manifold";
  }
  if (const char* what = find_in_coupled_manifolds(t, contacts)) return what;
  for (const ContactLane& at : contacts.refreshed) {
    const std::size_t lane =
        kContactLanes * static_cast<std::size_t>(at.block) + static_cast<std::size_t>(at.lane);
    if (lane >= contacts.manifold_of.size() || contacts.manifold_of[lane] != at.manifold ||
        !t.pairs.manifold[at.manifold].is_refreshed())
      return "a refreshed lane";
  }
  return nullptr;
}

const char* find_in_island(const BodyContacts& contacts, const DirectIslands& direct, std::uint32_t number) {
  const DirectIsland& island = direct.islands[number];
  const std::size_t nodes = island.graph.bodies.size();
  if (island.slot.size() != nodes || island.pattern.order.size() != nodes) return "nodes of a direct island";
  for (std::size_t i = 0; i < island.contacts.size(); ++i) {
    const DirectContact& c = island.contacts[i];
    if (static_cast<std::size_t>(c.block) >= contacts.blocks.size()) return "block of a direct contact";
    const ContactBlock& block = contacts.blocks[static_cast<std::size_t>(c.block)];
    if (block.route != ContactRoute::kDirect || c.lane >= block.count) return "lane of a direct contact";
    if (direct.island_of[block.record_a[c.lane] / 16] != number ||
        (!block.anchored && direct.island_of[block.record_b[c.lane] / 16] != number))
      return "island of a direct contact";
    if (c.a >= nodes || (c.b != DirectContact::kNone && c.b >= nodes)) return "nodes of a direct contact";
    if (c.end() > static_cast<int>(island.rows.size())) return "rows of a direct contact";
    if (i == 0) continue;
    const DirectContact& before = island.contacts[i - 1];
    if (before.block > c.block || (before.block == c.block && before.lane >= c.lane))
      return "order of direct contacts";
  }
  return nullptr;
}

const char* find_in_islands(const Tables& t, const BodyContacts& contacts, const DirectIslands& direct,
                            Marks& marks) {
  reset(t.bodies.motion.size(), marks);
  std::size_t lanes = 0;
  for (const ContactBlock& block : contacts.blocks) {
    lanes += block.route == ContactRoute::kDirect ? static_cast<std::size_t>(block.count) : 0;
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(direct.count); ++i) {
    const DirectIsland& island = direct.islands[i];
    if (!ascends(island.graph.bodies)) return "order of a direct island";
    for (const std::uint32_t body : island.graph.bodies) {
      if (body >= marks.size() || !is_moved(t.bodies, body)) return "body of a direct island";
      if (direct.island_of[body] != i || marks[body]++ != 0) return "a body of two direct islands";
    }
    if (const char* what = find_in_island(contacts, direct, i)) return what;
    lanes -= island.contacts.size();
  }
  return lanes == 0 ? nullptr : "a direct contact of no island";
}

JointRoute way_of(const Articulation& art) {
  if (art.has_loops()) return JointRoute::kLoop;
  return art.tree.approximate ? JointRoute::kApproximateTree : JointRoute::kTree;
}

/// Marks its hooks. An articulation is solved as a whole or not at all, and its first hook decides.
const char* find_in_articulation(const Tables& t, const Articulation& art, Marks& marks) {
  bool first = true;
  bool is_coupled = false;
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.a >= art.bodies.size() || joint.b >= art.bodies.size() || joint.a == joint.b)
      return "links of a joint";
    if (joint.is_weld()) continue;
    if (joint.hook >= t.hooks.size()) return "hook of an articulation";
    const Hook& hook = t.hooks[joint.hook];
    const bool coupled = hook.route == JointRoute::kCoupled;
    if (hook.holds_point() || (!coupled && hook.route != way_of(art))) return "way of a hook";
    if (coupled && !first && !is_coupled) return "way of an articulation";
    is_coupled = first ? coupled : is_coupled;
    first = false;
    ++marks[joint.hook];
  }
  if (!art.has_loops() && art.bodies.size() != art.joints.size() + 1) return "links of a tree";
  return first ? "an articulation without hooks" : nullptr;
}

const char* find_in_rows_of_hooks(const Tables& t, const std::vector<std::uint32_t>& rows, JointRoute route,
                                  Marks& marks) {
  for (const std::uint32_t row : rows) {
    if (row >= t.hooks.size()) return "hook of an iterative joint";
    if (t.hooks[row].route != route) return "way of an iterative joint";
    ++marks[row];
  }
  return nullptr;
}

/// Marks bodies by the number of their articulation.
const char* find_in_bodies_of_joints(const Tables& t, const Joints& joints, Marks& marks) {
  reset(t.bodies.motion.size(), marks);
  std::uint32_t number = 0;
  for (const std::uint32_t i : joints.order) {
    ++number;
    for (const std::uint32_t body : joints.articulations[i].bodies) {
      if (!is_dynamic(t.bodies, body)) continue;
      if (marks[body] != 0 && marks[body] != number) return "a body of two articulations";
      marks[body] = number;
    }
  }
  for (const std::vector<std::uint32_t>* rows : {&joints.balls.hooks, &joints.iterative.hooks}) {
    for (const std::uint32_t row : *rows) {
      for (const std::uint32_t body : {t.hooks[row].a.body, t.hooks[row].b.body}) {
        if (is_dynamic(t.bodies, body) && marks[body] != 0) return "an iterated body of an articulation";
      }
    }
  }
  return nullptr;
}

/// Whether the lists that `rows_of(group)` gives are in order, below `count`, and have no row in common.
/// Marks their rows.
template <class RowsOf>
bool are_disjoint(const CoupledGroups& groups, std::size_t count, Marks& marks, RowsOf&& rows_of) {
  reset(count, marks);
  for (std::size_t i = 0; i < groups.count; ++i) {
    const std::vector<std::uint32_t>& rows = rows_of(groups.groups[i]);
    if (!ascends(rows)) return false;
    for (const std::uint32_t row : rows) {
      if (row >= count || marks[row]++ != 0) return false;
    }
  }
  return true;
}

const char* find_in_hooks_of_groups(const Tables& t, const CoupledGroups& groups, Marks& marks) {
  const auto hooks = [](const CoupledGroup& group) -> const auto& {
    return group.hooks;
  };
  if (!are_disjoint(groups, t.hooks.size(), marks, hooks)) return "hooks of coupled groups";
  for (const RopeAnchor& anchor : groups.anchors) {
    if (anchor.hook >= t.hooks.size() || marks[anchor.hook]++ != 0) return "hook of an anchor";
  }
  for (std::size_t row = 0; row < t.hooks.size(); ++row) {
    if ((marks[row] != 0) != t.hooks[row].is_in_coupled_group()) return "a hook that is coupled to nothing";
  }
  return nullptr;
}

const char* find_in_contacts_of_groups(const Tables& t, const CoupledGroups& groups, Marks& marks) {
  const auto elements = [](const CoupledGroup& group) -> const auto& {
    return group.element_contacts;
  };
  if (!are_disjoint(groups, t.element_contacts.size(), marks, elements))
    return "element contacts of coupled groups";
  for (std::size_t row = 0; row < t.element_contacts.size(); ++row) {
    if ((marks[row] != 0) != is_coupled(t, t.element_contacts[row]))
      return "an element contact that is coupled to nothing";
  }
  const auto ropes = [](const CoupledGroup& group) -> const auto& {
    return group.rope_contacts;
  };
  if (!are_disjoint(groups, t.rope_contacts.size(), marks, ropes)) return "rope contacts of coupled groups";
  const auto manifolds = [](const CoupledGroup& group) -> const auto& {
    return group.manifolds;
  };
  if (!are_disjoint(groups, t.pairs.coupled.size(), marks, manifolds)) return "manifolds of coupled groups";
  if (std::find(marks.begin(), marks.end(), 0U) != marks.end())
    return "a manifold that is coupled to nothing";
  return nullptr;
}

const char* find_in_group(const Tables& t, const CoupledGroup& group) {
  for (const std::uint32_t body : group.bodies) {
    if (!gives_way(t.bodies, body)) return "body of a coupled group";
  }
  const std::size_t members = group.hooks.size() + group.contact_count();
  if (group.ends.size() != members || group.first_row.size() != members + 1) return "rows of a coupled group";
  for (const std::array<int, 2>& ends : group.ends) {
    for (const int end : ends) {
      if (end < -1 || end >= static_cast<int>(group.bodies.size())) return "ends in a coupled group";
    }
  }
  if (group.rows.size() != group.first_row.back() || group.moving.size() != group.bodies.size())
    return "memory of a coupled group";
  return group.first_tether.size() == group.points.size() + 1 ? nullptr : "tethers of a coupled group";
}

}  // namespace

const char* find_in_contact_routes(const Tables& t, const BodyContacts& contacts, const DirectIslands& direct,
                                   std::vector<std::uint32_t>& marks) {
  if (contacts.color_begin.empty() ||
      static_cast<std::size_t>(contacts.color_begin.back()) != contacts.blocks.size())
    return "blocks of no color";
  if (const char* what = find_in_blocks(t, contacts)) return what;
  if (const char* what = find_in_colors(t, contacts, marks)) return what;
  if (const char* what = find_in_ways(t, contacts, marks)) return what;
  return find_in_islands(t, contacts, direct, marks);
}

const char* find_in_joint_routes(const Tables& t, const Joints& joints, std::vector<std::uint32_t>& marks) {
  reset(t.hooks.size(), marks);
  for (const std::uint32_t i : joints.order) {
    if (i >= joints.articulations.size()) return "an articulation";
    if (const char* what = find_in_articulation(t, joints.articulations[i], marks)) return what;
  }
  if (const char* what = find_in_rows_of_hooks(t, joints.balls.hooks, JointRoute::kBlock, marks)) return what;
  if (const char* what = find_in_rows_of_hooks(t, joints.iterative.hooks, JointRoute::kIterative, marks))
    return what;
  for (std::size_t row = 0; row < t.hooks.size(); ++row) {
    if (marks[row] > 1) return "a hook that is solved twice";
    const Hook& hook = t.hooks[row];
    const JointRoute alone = hook.holds_point() ? JointRoute::kCoupled : JointRoute::kNone;
    if (marks[row] == 0 && hook.route != alone) return "a hook that nothing solves";
  }
  return find_in_bodies_of_joints(t, joints, marks);
}

const char* find_in_coupled_groups(const Tables& t, std::span<const RopeSystem> rope_systems,
                                   const CoupledGroups& groups, std::vector<std::uint32_t>& marks) {
  if (groups.count > groups.groups.size()) return "number of coupled groups";
  if (const char* what = find_in_hooks_of_groups(t, groups, marks)) return what;
  if (const char* what = find_in_contacts_of_groups(t, groups, marks)) return what;
  const auto points = [](const CoupledGroup& group) -> const auto& {
    return group.points;
  };
  if (!are_disjoint(groups, t.particles.position.size(), marks, points)) return "points of coupled groups";
  const auto bodies = [](const CoupledGroup& group) -> const auto& {
    return group.bodies;
  };
  if (!are_disjoint(groups, t.bodies.motion.size(), marks, bodies)) return "bodies of coupled groups";
  const auto ropes = [](const CoupledGroup& group) -> const auto& {
    return group.rope_systems;
  };
  if (!are_disjoint(groups, rope_systems.size(), marks, ropes)) return "ropes of coupled groups";
  for (std::size_t i = 0; i < rope_systems.size(); ++i) {
    if (rope_systems[i].in_coupled_group != (marks[i] != 0))
      return "a rope that is solved twice, or not at all";
  }
  for (std::size_t i = 0; i < groups.count; ++i) {
    if (const char* what = find_in_group(t, groups.groups[i])) return what;
  }
  return nullptr;
}

}  // namespace hooke::solver
