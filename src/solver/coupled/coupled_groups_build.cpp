/// Finds which ropes, points and bodies belong together, and the pattern of their matrix.

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "base/reset_lists.h"
#include "base/sort_unique.h"
#include "base/take_turns.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/soft/element_contact_solve.h"
#include "state/rope_chains.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace hooke::solver {

namespace {

using state::Hook;
using state::HookPlace;
using state::Tables;

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr double kNoBudget = std::numeric_limits<double>::infinity();

bool is_of_rope(const Tables& t, std::size_t contact) {
  return t.objects[t.contacts.object[contact]].kind == PointRef::Kind::kRope;
}

void write_signature(const Tables& t, std::vector<std::uint32_t>& s) {
  s.clear();
  for (const std::uint64_t revision : {t.revision, t.hook_revision}) {
    s.push_back(static_cast<std::uint32_t>(revision));
    s.push_back(static_cast<std::uint32_t>(revision >> 32U));
  }
  for (std::uint32_t row = 0; row < t.hooks.size(); ++row) {
    const Hook& hook = t.hooks[row];
    if (!hook.is_in_coupled_group()) continue;
    s.insert(s.end(), {row, hook.a.particle[0]});  // the point changes where the hook slides
    for (const std::uint32_t body : {hook.a.body, hook.b.body})
      s.push_back(gives_way(t.bodies, body) ? 1 : 0);
  }
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (joins_body(t, row)) s.insert(s.end(), {t.contacts.particle[row], t.contacts.body[row]});
  }
  for (std::uint32_t row = 0; row < t.element_contacts.size(); ++row) {
    const state::ElementContact& element_contact = t.element_contacts[row];
    if (is_coupled(t, element_contact)) {
      s.insert(s.end(), {row, element_contact.element, element_contact.object, element_contact.body,
                         gives_way(t.bodies, element_contact.body)});
    }
  }
  for (const state::CoupledManifold& coupled : t.pairs.coupled) {
    for (const std::uint32_t body : {coupled.body_a, coupled.body_b})
      s.insert(s.end(), {body, gives_way(t.bodies, body) ? 1U : 0U});
  }
  for (std::uint32_t row = 0; row < t.rope_contacts.size(); ++row) {
    const state::RopeContact& contact = t.rope_contacts[row];
    if (contact.joined) s.insert(s.end(), {row, contact.segment_a, contact.segment_b});
  }
}

/// Disjoint sets of bodies, then particles. A chain of a rope is represented by its first particle.
class Membership {
 public:
  Membership(const Tables& t, base::DisjointSets& sets) : tables_(t), sets_(sets) {
    sets_.reset(t.bodies.motion.size() + static_cast<std::size_t>(t.particles.count()));
    for (const Hook& hook : t.hooks) {
      if (hook.is_in_coupled_group()) join(hook);
    }
    for (const state::CoupledManifold& coupled : t.pairs.coupled) {
      if (gives_way(t.bodies, coupled.body_a) && gives_way(t.bodies, coupled.body_b))
        sets_.merge(coupled.body_a, coupled.body_b);
    }
    for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
      if (joins_body(t, row)) sets_.merge(of_contact(row), t.contacts.body[row]);
    }
    for (const state::ElementContact& element_contact : t.element_contacts) {
      if (!is_coupled(t, element_contact)) continue;
      for (std::uint32_t i = 1; i < element_contact.count; ++i) {
        sets_.merge(of_element_contact(element_contact),
                    of_particle(element_contact.object, element_contact.particle[i]));
      }
      if (gives_way(t.bodies, element_contact.body))
        sets_.merge(of_element_contact(element_contact), element_contact.body);
    }
    for (const state::RopeContact& contact : t.rope_contacts) {
      if (contact.joined)
        sets_.merge(of_rope_contact(contact), of_particle(contact.object_b, contact.particle[2]));
    }
  }

  std::uint32_t of_hook(const Hook& hook) {
    std::uint32_t end = of_end(hook.point_end());
    if (end == kNone) end = of_end(hook.other_end());
    HOOKE_ASSERT(end != kNone);
    return sets_.root(end);
  }
  std::uint32_t of_manifold(const state::CoupledManifold& coupled) {
    const bool a_moves = gives_way(tables_.bodies, coupled.body_a);
    HOOKE_ASSERT(a_moves || gives_way(tables_.bodies, coupled.body_b));
    return sets_.root(a_moves ? coupled.body_a : coupled.body_b);
  }
  std::uint32_t of_contact(std::size_t row) {
    return sets_.root(of_particle(tables_.contacts.object[row], tables_.contacts.particle[row]));
  }
  std::uint32_t of_element_contact(const state::ElementContact& element_contact) {
    return of_particle(element_contact.object, element_contact.particle[0]);
  }
  std::uint32_t of_rope_contact(const state::RopeContact& contact) {
    return of_particle(contact.object_a, contact.particle[0]);
  }
  std::uint32_t of_particle(std::uint32_t object, std::uint32_t particle) {
    const state::Deformable& owner = tables_.objects[object];
    const bool is_rope = owner.kind == PointRef::Kind::kRope;
    const std::uint32_t first = is_rope ? state::first_of_chain(owner, tables_.segments, particle) : particle;
    return sets_.root(static_cast<std::uint32_t>(tables_.bodies.motion.size()) + first);
  }

 private:
  std::uint32_t of_end(const HookPlace& end) {
    if (end.is_point()) return of_particle(end.object, end.particle[0]);
    return gives_way(tables_.bodies, end.body) ? sets_.root(end.body) : kNone;
  }

  void join(const Hook& hook) {
    for (const HookPlace& end : {hook.a, hook.b}) {
      for (std::uint32_t i = 1; i < end.particle_count; ++i)
        sets_.merge(of_particle(end.object, end.particle[0]), of_particle(end.object, end.particle[i]));
    }
    const std::uint32_t a = of_end(hook.a);
    const std::uint32_t b = of_end(hook.b);
    if (a != kNone && b != kNone) sets_.merge(a, b);
  }

  const Tables& tables_;
  base::DisjointSets& sets_;
};

void add_points(const Tables& t, const HookPlace& end, std::vector<std::uint32_t>& points) {
  if (!end.is_point() || t.objects[end.object].kind == PointRef::Kind::kRope) return;
  points.insert(points.end(), end.particle.begin(), end.particle.begin() + end.particle_count);
}

/// Whether a hook can be an anchor of a rope that has no other hooks.
bool may_be_anchor(const Tables& t, const Hook& hook) {
  const HookPlace& point = hook.point_end();
  const HookPlace& other = hook.other_end();
  return hook.kind == HookKind::kBall && count_joint_rows(hook) == 3 && !hook.can_break() &&
         point.particle_count == 1 && t.objects[point.object].kind == PointRef::Kind::kRope &&
         !other.is_point() && !gives_way(t.bodies, other.body);
}

/// Lists the anchors of rope systems, which are in order of their particles as ropes are.
void list_anchors(const Tables& t, const std::vector<std::uint32_t>& hooks,
                  std::vector<RopeSystem>& rope_systems, std::vector<RopeAnchor>& anchors) {
  anchors.clear();
  for (const std::uint32_t row : hooks) {
    const Hook& hook = t.hooks[row];
    HOOKE_ASSERT(may_be_anchor(t, hook));
    const std::uint32_t particle = hook.point_end().particle[0];
    const auto behind = std::upper_bound(
        rope_systems.begin(), rope_systems.end(), particle,
        [](std::uint32_t p, const RopeSystem& rope_system) { return p < rope_system.first_particle; });
    HOOKE_ASSERT(behind != rope_systems.begin());
    const auto rope_system = static_cast<std::uint32_t>(behind - rope_systems.begin()) - 1;
    anchors.push_back(
        {rope_system, particle - rope_systems[rope_system].first_particle, row, hook.b.is_point()});
  }
  std::sort(anchors.begin(), anchors.end(), [](const RopeAnchor& a, const RopeAnchor& b) {
    return std::tie(a.rope_system, a.node, a.hook) < std::tie(b.rope_system, b.node, b.hook);
  });
  std::uint32_t next = 0;
  for (std::uint32_t c = 0; c < rope_systems.size(); ++c) {
    rope_systems[c].first_anchor = next;
    while (next < anchors.size() && anchors[next].rope_system == c) ++next;
    rope_systems[c].end_anchor = next;
  }
}

/// Marks the sets that are coupled groups. Ropes that can snap are: only there do segments give way.
void mark_coupled(const Tables& t, const std::vector<RopeSystem>& rope_systems, Membership& membership,
                  std::vector<std::uint8_t>& coupled) {
  coupled.assign(t.bodies.motion.size() + t.particles.position.size(), 0);
  for (const Hook& hook : t.hooks) {
    if (hook.holds_point() ? !may_be_anchor(t, hook) : hook.route == state::JointRoute::kCoupled)
      coupled[membership.of_hook(hook)] = 1;
  }
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (joins_body(t, row)) coupled[membership.of_contact(row)] = 1;
  }
  for (const state::ElementContact& element_contact : t.element_contacts) {
    if (is_coupled(t, element_contact)) coupled[membership.of_element_contact(element_contact)] = 1;
  }
  for (const state::CoupledManifold& manifold : t.pairs.coupled)
    coupled[membership.of_manifold(manifold)] = 1;
  for (const state::RopeContact& contact : t.rope_contacts) {
    if (contact.joined) coupled[membership.of_rope_contact(contact)] = 1;
  }
  for (const RopeSystem& rope_system : rope_systems) {
    const bool can_snap = t.objects[rope_system.object].strength < kRigid && rope_system.node_count > 1;
    if (can_snap) coupled[membership.of_particle(rope_system.object, rope_system.first_particle)] = 1;
  }
}

/// Gives each coupled group its members. A group begins with the first member that is added to it.
class MemberSort {
 public:
  MemberSort(const Tables& t, Membership& membership, CoupledGroups& groups)
      : tables_(t), membership_(membership), groups_(groups) {
    group_of().assign(t.bodies.motion.size() + t.particles.position.size(), kNone);
    groups_.count = 0;
    groups_.scratch.anchors.clear();
  }

  void add_hooks() {
    for (std::uint32_t i = 0; i < tables_.hooks.size(); ++i) {
      const Hook& hook = tables_.hooks[i];
      if (!hook.is_in_coupled_group()) continue;
      if (groups_.scratch.coupled[membership_.of_hook(hook)] == 0) {
        groups_.scratch.anchors.push_back(i);
        continue;
      }
      CoupledGroup& group = group_at(membership_.of_hook(hook));
      group.hooks.push_back(i);
      for (const HookPlace& end : {hook.a, hook.b}) {
        add_points(tables_, end, group.points);
        add_body(end.body, group);
      }
    }
  }

  void add_contacts() {
    for (std::size_t row = 0; row < tables_.contacts.particle.size(); ++row) {
      if (!joins_body(tables_, row)) continue;
      CoupledGroup& group = group_at(membership_.of_contact(row));
      group.bodies.push_back(tables_.contacts.body[row]);
      if (!is_of_rope(tables_, row)) group.points.push_back(tables_.contacts.particle[row]);
    }
  }

  void add_element_contacts() {
    for (std::uint32_t row = 0; row < tables_.element_contacts.size(); ++row) {
      const state::ElementContact& element_contact = tables_.element_contacts[row];
      if (!is_coupled(tables_, element_contact)) continue;
      CoupledGroup& group = group_at(membership_.of_element_contact(element_contact));
      group.element_contacts.push_back(row);
      add_body(element_contact.body, group);
      if (tables_.objects[element_contact.object].kind == PointRef::Kind::kRope) continue;
      group.points.insert(group.points.end(), element_contact.particle.begin(),
                          element_contact.particle.begin() + element_contact.count);
    }
  }

  void add_rope_contacts() {
    for (std::uint32_t row = 0; row < tables_.rope_contacts.size(); ++row) {
      const state::RopeContact& contact = tables_.rope_contacts[row];
      if (contact.joined) group_at(membership_.of_rope_contact(contact)).rope_contacts.push_back(row);
    }
  }

  void add_manifolds() {
    for (std::uint32_t row = 0; row < tables_.pairs.coupled.size(); ++row) {
      const state::CoupledManifold& coupled = tables_.pairs.coupled[row];
      CoupledGroup& group = group_at(membership_.of_manifold(coupled));
      group.manifolds.push_back(row);
      for (const std::uint32_t body : {coupled.body_a, coupled.body_b}) add_body(body, group);
    }
  }

  /// Adds the rope systems to the groups that hooks and contacts have made, or to groups of their own if they
  /// can snap, and marks those that have one.
  void add_rope_systems(std::vector<RopeSystem>& rope_systems) {
    for (std::uint32_t i = 0; i < rope_systems.size(); ++i) {
      RopeSystem& rope_system = rope_systems[i];
      const std::uint32_t set_root = membership_.of_particle(rope_system.object, rope_system.first_particle);
      rope_system.in_coupled_group = groups_.scratch.coupled[set_root] != 0;
      if (rope_system.in_coupled_group) group_at(set_root).rope_systems.push_back(i);
    }
  }

 private:
  std::vector<std::uint32_t>& group_of() { return groups_.scratch.group_of; }

  CoupledGroup& group_at(std::uint32_t set_root) {
    std::uint32_t& group = group_of()[set_root];
    if (group == kNone) {
      group = static_cast<std::uint32_t>(groups_.count++);
      if (groups_.groups.size() < groups_.count) groups_.groups.emplace_back();
      groups_.groups[group].clear();
    }
    return groups_.groups[group];
  }

  void add_body(std::uint32_t body, CoupledGroup& group) const {
    if (gives_way(tables_.bodies, body)) group.bodies.push_back(body);
  }

  const Tables& tables_;
  Membership& membership_;
  CoupledGroups& groups_;
};

/// Lists the members of all coupled groups, in order of the first hook, then of the first contact that makes
/// one. Contacts of points come before those between bodies. Hooks that are anchors go to `scratch.anchors`.
void sort_members(const Tables& t, std::vector<RopeSystem>& rope_systems, CoupledGroups& groups) {
  Membership membership(t, groups.scratch.sets);
  mark_coupled(t, rope_systems, membership, groups.scratch.coupled);
  MemberSort members(t, membership, groups);
  members.add_hooks();
  members.add_contacts();
  members.add_element_contacts();
  members.add_rope_contacts();
  members.add_manifolds();
  members.add_rope_systems(rope_systems);
  for (CoupledGroup& group : groups.live()) {
    base::sort_unique(group.points);
    base::sort_unique(group.bodies);
  }
}

/// Finds the nodes of a coupled group, and the blocks at them.
struct Layout {
  const Tables& tables;
  const std::vector<RopeSystem>& rope_systems;
  CoupledGroup& group;
  CoupledGroupScratch& scratch;
  std::vector<std::vector<CoupledGroup::Incident>>& at_node = scratch.at_node;
  std::vector<std::uint32_t>& first_node = scratch.first_node;
  std::size_t node_count = 0;
  std::uint32_t vector_count = 0;  ///< Segments, then bends.

  [[nodiscard]] std::uint32_t node_of(std::uint32_t particle) const {
    for (std::size_t k = 0; k < group.rope_systems.size(); ++k) {
      const RopeSystem& rope_system = rope_systems[group.rope_systems[k]];
      if (particle >= rope_system.first_particle &&
          particle < rope_system.first_particle + rope_system.node_count)
        return first_node[k] + particle - rope_system.first_particle;
    }
    const auto at = std::lower_bound(group.points.begin(), group.points.end(), particle);
    HOOKE_ASSERT(at != group.points.end() && *at == particle);
    return first_node.back() + static_cast<std::uint32_t>(at - group.points.begin());
  }

  void number_nodes() {
    std::uint32_t nodes = 0;
    first_node.clear();
    for (const std::uint32_t c : group.rope_systems) {
      first_node.push_back(nodes);
      nodes += rope_systems[c].node_count;
    }
    first_node.push_back(nodes);
    node_count = nodes + group.points.size();
  }

  void list_incidents() {
    number_nodes();
    base::reset_lists(node_count, at_node);
    vector_count = 0;
    for (std::size_t k = 0; k < group.rope_systems.size(); ++k)
      list_segments(rope_systems[group.rope_systems[k]], first_node[k]);
    for (std::size_t k = 0; k < group.rope_systems.size(); ++k)
      list_bends(rope_systems[group.rope_systems[k]], first_node[k]);
    for (std::uint32_t i = 0; i < group.hooks.size(); ++i) {
      add_end(vector_count + i, -1, tables.hooks[group.hooks[i]].a);
      add_end(vector_count + i, 1, tables.hooks[group.hooks[i]].b);
    }
    for (std::uint32_t i = 0; i < group.element_contacts.size(); ++i) {
      const state::ElementContact& element_contact = tables.element_contacts[group.element_contacts[i]];
      for (std::uint32_t k = 0; k < element_contact.count; ++k)  // weights: load_coupled_contacts
        at_node[node_of(element_contact.particle[k])].push_back({contact_block(i), 0});
    }
    for (std::uint32_t i = 0; i < group.rope_contacts.size(); ++i) {
      for (const std::uint32_t particle : tables.rope_contacts[group.rope_contacts[i]].particle)
        at_node[node_of(particle)].push_back({contact_block(group.element_contact_count() + i), 0});
    }
  }

  void list_segments(const RopeSystem& rope_system, std::uint32_t first) {
    for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i) {
      at_node[first + i].push_back({vector_count, 1});
      at_node[first + i + 1].push_back({vector_count, -1});
      ++vector_count;
    }
  }

  void list_bends(const RopeSystem& rope_system, std::uint32_t first) {
    if (!(rope_system.bend_stiffness > 0)) return;
    for (std::uint32_t i = 1; i + 1 < rope_system.node_count; ++i) {
      const double before =
          1 / static_cast<double>(tables.segments.rest_length[rope_system.first_segment + i - 1]);
      const double behind =
          1 / static_cast<double>(tables.segments.rest_length[rope_system.first_segment + i]);
      at_node[first + i - 1].push_back({vector_count, before});
      at_node[first + i].push_back({vector_count, -before - behind});
      at_node[first + i + 1].push_back({vector_count, behind});
      ++vector_count;
    }
  }

  /// Weights of ends that slide change from substep to substep: see set_slide_weights.
  void add_end(std::uint32_t block, double sign, const HookPlace& end) {
    for (std::uint32_t i = 0; i < end.particle_count; ++i)
      at_node[node_of(end.particle[i])].push_back({block, sign * static_cast<double>(end.weight[i])});
  }

  [[nodiscard]] std::uint32_t contact_block(std::uint32_t index) const {
    return vector_count + static_cast<std::uint32_t>(group.hooks.size()) + index;
  }
  [[nodiscard]] std::uint32_t body_block(std::uint32_t body) const {
    const int index = group.body_of(body);
    if (index < 0) return kNone;
    return contact_block(group.contact_count()) + static_cast<std::uint32_t>(index);
  }

  void connect(std::uint32_t a, std::uint32_t b) {
    if (a != b && a != kNone && b != kNone) scratch.matrix.join(a, b);
  }

  /// Joins blocks that share a node or a body, or that a contact of a node with a body connects.
  void join_blocks() {
    scratch.matrix.reset(vector_count + group.hooks.size() + group.contact_count() + group.bodies.size());
    list_bodies_at_nodes();
    for (std::size_t node = 0; node < node_count; ++node) join_blocks_at(node);
    join_with_bodies();
  }

  /// Lists the blocks of the bodies that touch each node.
  void list_bodies_at_nodes() {
    std::vector<std::vector<std::uint32_t>>& bodies_at = scratch.bodies_at;
    base::reset_lists(node_count, bodies_at);
    for (std::size_t row = 0; row < tables.contacts.particle.size(); ++row) {
      if (!joins_body(tables, row)) continue;
      const std::uint32_t block = body_block(tables.contacts.body[row]);
      if (block != kNone) bodies_at[node_of(tables.contacts.particle[row])].push_back(block);
    }
  }

  void join_blocks_at(std::size_t node) {
    const std::vector<std::uint32_t>& bodies = scratch.bodies_at[node];
    for (const CoupledGroup::Incident& a : at_node[node]) {
      for (const CoupledGroup::Incident& b : at_node[node]) connect(a.block, b.block);
      for (const std::uint32_t body : bodies) connect(a.block, body);
    }
    for (const std::uint32_t a : bodies) {
      for (const std::uint32_t b : bodies) connect(a, b);
    }
  }

  /// Joins hooks and contacts with the bodies that they hold or touch.
  void join_with_bodies() {
    for (std::uint32_t i = 0; i < group.hooks.size(); ++i) {
      for (const HookPlace& end : {tables.hooks[group.hooks[i]].a, tables.hooks[group.hooks[i]].b})
        connect(vector_count + i, body_block(end.body));
    }
    for (std::uint32_t i = 0; i < group.element_contacts.size(); ++i)
      connect(contact_block(i), body_block(tables.element_contacts[group.element_contacts[i]].body));
    for (const std::uint32_t row : group.manifolds) {
      const state::CoupledManifold& coupled = tables.pairs.coupled[row];
      connect(body_block(coupled.body_a), body_block(coupled.body_b));
    }
  }
};

void list_pairs(const Layout& layout, CoupledGroup& group) {
  for (std::size_t node = 0; node < layout.node_count; ++node) {
    const std::vector<CoupledGroup::Incident>& at = layout.at_node[node];
    group.first_incident.push_back(static_cast<std::uint32_t>(group.incidents.size()));
    group.first_pair.push_back(static_cast<std::uint32_t>(group.pair_block.size()));
    group.incidents.insert(group.incidents.end(), at.begin(), at.end());
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const auto [low, high] = std::minmax({group.slot[at[i].block], group.slot[at[j].block]});
        group.pair_block.push_back(find_block(group.pattern, high, low));
      }
    }
  }
  group.first_incident.push_back(static_cast<std::uint32_t>(group.incidents.size()));
}

/// False if a factorization takes more than `budget` multiplications.
bool try_pattern(const Tables& t, double budget, Layout& layout, CoupledGroupScratch& scratch,
                 CoupledGroup& group) {
  layout.list_incidents();
  layout.join_blocks();
  std::vector<int>& sizes = scratch.sizes;
  sizes.assign(layout.vector_count, 3);
  group.first_row.assign(1, 0);
  for (const std::uint32_t hook : group.hooks) {
    sizes.push_back(count_joint_rows(t.hooks[hook]));
    group.first_row.push_back(group.first_row.back() + static_cast<std::uint32_t>(sizes.back()));
  }
  for (std::size_t i = 0; i < group.contact_count(); ++i) {
    sizes.push_back(CoupledContact::kRows);
    group.first_row.push_back(group.first_row.back() + CoupledContact::kRows);
  }
  HOOKE_ASSERT(sizes.size() == layout.vector_count + group.hooks.size() + group.contact_count());
  scratch.signs.assign(sizes.size(), 1);
  sizes.resize(sizes.size() + group.bodies.size(), 6);
  scratch.signs.resize(sizes.size(), -1);
  return make_block_pattern(scratch.matrix, sizes, budget, group.pattern);
}

void leave_out_every_second(std::vector<std::uint32_t>& rows) {
  for (std::size_t i = 0; 2 * i < rows.size(); ++i) rows[i] = rows[2 * i];
  rows.resize((rows.size() + 1) / 2);
}

void make_pattern(const Tables& t, const std::vector<RopeSystem>& rope_systems, CoupledGroupScratch& scratch,
                  CoupledGroup& group) {
  Layout layout = {t, rope_systems, group, scratch};
  const std::size_t asked = group.rope_contacts.size();
  std::size_t nodes = 0;
  for (const std::uint32_t c : group.rope_systems) nodes += rope_systems[c].node_count;
  while (group.rope_contacts.size() > kMostRopeContacts * nodes) leave_out_every_second(group.rope_contacts);
  double budget = kCoupledGroupBudget;
  while (!try_pattern(t, budget, layout, scratch, group)) {
    if (group.rope_contacts.size() <= 1) budget = kNoBudget;
    leave_out_every_second(group.rope_contacts);
  }
  group.refused = static_cast<std::uint32_t>(asked - group.rope_contacts.size());
  set_signs(scratch.signs, group.pattern);
  group.slot.resize(scratch.sizes.size());
  for (std::uint32_t i = 0; i < scratch.sizes.size(); ++i) group.slot[group.pattern.order[i]] = i;
  list_pairs(layout, group);
  group.rows.resize(group.first_row.back());
  group.bound.resize(group.first_row.back());
  group.lambda.resize(group.first_row.back());
  group.moving.resize(group.bodies.size());
  HOOKE_ASSERT(group.ends.empty());
  for (const std::uint32_t hook : group.hooks)
    group.ends.push_back({group.body_of(t.hooks[hook].a.body), group.body_of(t.hooks[hook].b.body)});
  for (const std::uint32_t row : group.element_contacts)
    group.ends.push_back({group.body_of(t.element_contacts[row].body), -1});
  group.ends.insert(group.ends.end(), group.rope_contacts.size(), {-1, -1});
}

/// Lists the tethers of a group's points. `by_particle` has all tethers in order of their particles.
void list_tethers(const Tables& t, const std::vector<std::uint32_t>& by_particle, CoupledGroup& group) {
  HOOKE_ASSERT(std::is_sorted(group.points.begin(), group.points.end()));
  auto at = by_particle.begin();
  for (const std::uint32_t p : group.points) {
    group.first_tether.push_back(static_cast<std::uint32_t>(group.tethers.size()));
    const auto before = [&](std::uint32_t row, std::uint32_t of) { return t.springs.particle_a[row] < of; };
    at = std::lower_bound(at, by_particle.end(), p, before);
    for (; at != by_particle.end() && t.springs.particle_a[*at] == p; ++at) group.tethers.push_back(*at);
  }
  group.first_tether.push_back(static_cast<std::uint32_t>(group.tethers.size()));
}

std::vector<std::uint32_t> tethers_by_particle(const Tables& t) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < t.springs.kind.size(); ++row) {
    if (t.springs.kind[row] == state::SpringClass::kTether) rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
    return t.springs.particle_a[a] < t.springs.particle_a[b];
  });
  return rows;
}

/// Where a hook slides along its rope, the two nodes there get the hook's weights.
void set_slide_weights(const Tables& t, std::vector<int>& seen, CoupledGroup& group) {
  const auto vectors =
      static_cast<std::uint32_t>(group.slot.size() - group.ends.size() - group.bodies.size());
  const auto slides = [&](const CoupledGroup::Incident& at) {
    return at.block >= vectors && at.block < vectors + group.hooks.size() && at.weight <= 0 &&
           t.hooks[group.hooks[at.block - vectors]].kind == HookKind::kRopeSlide;
  };
  seen.assign(group.hooks.size(), 0);
  for (CoupledGroup::Incident& at : group.incidents) {
    if (!slides(at)) continue;
    HOOKE_ASSERT(seen[at.block - vectors] < 2);  // points of a segment
    const std::uint32_t hook = at.block - vectors;
    at.weight = -static_cast<double>(t.hooks[group.hooks[hook]].a.weight[seen[hook]++]);
  }
}

}  // namespace

bool joins_body(const Tables& t, std::size_t contact) {
  if (!gives_way(t.bodies, t.contacts.body[contact])) return false;
  return is_of_rope(t, contact) || t.particles.velocity[t.contacts.particle[contact]].inverse_mass > Real(0);
}

int CoupledGroup::body_of(std::uint32_t row) const {
  const auto at = std::lower_bound(bodies.begin(), bodies.end(), row);
  return at != bodies.end() && *at == row ? static_cast<int>(at - bodies.begin()) : -1;
}

void CoupledGroup::clear() {
  for (std::vector<std::uint32_t>* list :
       {&rope_systems, &points, &hooks, &element_contacts, &rope_contacts, &manifolds, &bodies, &tethers,
        &first_tether, &first_incident, &pair_block, &first_pair})
    list->clear();
  ends.clear();
  incidents.clear();
}

void build_coupled_groups(const Tables& tables, std::vector<RopeSystem>& rope_systems,
                          CoupledGroups& groups) {
  write_signature(tables, groups.scratch.signature);
  if (groups.scratch.signature != groups.signature) {
    base::take_turns(groups.signature, groups.scratch.signature);
    sort_members(tables, rope_systems, groups);
    list_anchors(tables, groups.scratch.anchors, rope_systems, groups.anchors);
    if (groups.count > 0 && groups.tethers_revision != tables.revision) {
      groups.tethers = tethers_by_particle(tables);
      groups.tethers_revision = tables.revision;
    }
    for (CoupledGroup& group : groups.live()) {
      make_pattern(tables, rope_systems, groups.scratch, group);
      list_tethers(tables, groups.tethers, group);
    }
  }
  for (CoupledGroup& group : groups.live()) set_slide_weights(tables, groups.scratch.counts, group);
}

}  // namespace hooke::solver
