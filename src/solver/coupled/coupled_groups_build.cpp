/// Which ropes, points and bodies hang together, and the pattern of their matrix.

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "base/reset_lists.h"
#include "base/sort_unique.h"
#include "base/take_turns.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/soft/element_contact_solve.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace hooke::solver {

namespace {

using state::Hook;
using state::HookPlace;
using state::Tables;

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr std::size_t kMostRopeContacts = 8;  // for each node of the bundle's ropes, on average
constexpr double kNoBudget = std::numeric_limits<double>::infinity();

bool is_of_rope(const Tables& t, std::size_t contact) {
  return t.objects[t.contacts.object[contact]].kind == PointRef::Kind::kRope;
}

/// A contact that joins its rope, or its particle, to a body.
bool joins(const Tables& t, std::size_t contact) {
  if (!gives_way(t.bodies, t.contacts.body[contact])) return false;
  return is_of_rope(t, contact) || t.particles.velocity[t.contacts.particle[contact]].inverse_mass > Real(0);
}

void write_signature(const Tables& t, std::vector<std::uint32_t>& s) {
  s.clear();
  for (const std::uint64_t revision : {t.revision, t.hook_revision}) {
    s.push_back(static_cast<std::uint32_t>(revision));
    s.push_back(static_cast<std::uint32_t>(revision >> 32U));
  }
  for (std::uint32_t row = 0; row < t.hooks.size(); ++row) {
    const Hook& hook = t.hooks[row];
    if (!hook.is_bundled()) continue;
    s.insert(s.end(), {row, hook.a.particle[0]});  // the point changes where it slides
    for (const std::uint32_t body : {hook.a.body, hook.b.body})
      s.push_back(gives_way(t.bodies, body) ? 1 : 0);
  }
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (joins(t, row)) s.insert(s.end(), {t.contacts.particle[row], t.contacts.body[row]});
  }
  for (std::uint32_t row = 0; row < t.inner_contacts.size(); ++row) {
    const state::InnerContact& inner = t.inner_contacts[row];
    if (is_tied(t, inner))
      s.insert(s.end(), {row, inner.element, inner.object, inner.body, gives_way(t.bodies, inner.body)});
  }
  for (const state::BorneContact& borne : t.pairs.borne) {
    for (const std::uint32_t body : {borne.body_a, borne.body_b})
      s.insert(s.end(), {body, gives_way(t.bodies, body) ? 1U : 0U});
  }
  for (std::uint32_t row = 0; row < t.rope_contacts.size(); ++row) {
    const state::RopeContact& contact = t.rope_contacts[row];
    if (contact.joined) s.insert(s.end(), {row, contact.segment_a, contact.segment_b});
  }
}

/// Bodies, then particles; a rope is its first particle.
class Groups {
 public:
  Groups(const Tables& t, base::DisjointSets& sets) : tables_(t), sets_(sets) {
    sets_.reset(t.bodies.motion.size() + static_cast<std::size_t>(t.particles.count()));
    for (const Hook& hook : t.hooks) {
      if (hook.is_bundled()) join(hook);
    }
    for (const state::BorneContact& borne : t.pairs.borne) {
      if (gives_way(t.bodies, borne.body_a) && gives_way(t.bodies, borne.body_b))
        sets_.merge(borne.body_a, borne.body_b);
    }
    for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
      if (joins(t, row)) sets_.merge(of_contact(row), t.contacts.body[row]);
    }
    for (const state::InnerContact& inner : t.inner_contacts) {
      if (!is_tied(t, inner)) continue;
      for (std::uint32_t i = 1; i < inner.count; ++i)
        sets_.merge(of_inner(inner), of_particle(inner.object, inner.particle[i]));
      if (gives_way(t.bodies, inner.body)) sets_.merge(of_inner(inner), inner.body);
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
  std::uint32_t of_borne(const state::BorneContact& borne) {
    return sets_.root(gives_way(tables_.bodies, borne.body_a) ? borne.body_a : borne.body_b);
  }
  std::uint32_t of_contact(std::size_t row) {
    return sets_.root(of_particle(tables_.contacts.object[row], tables_.contacts.particle[row]));
  }
  std::uint32_t of_inner(const state::InnerContact& inner) {
    return of_particle(inner.object, inner.particle[0]);
  }
  std::uint32_t of_rope_contact(const state::RopeContact& contact) {
    return of_particle(contact.object_a, contact.particle[0]);
  }
  std::uint32_t of_particle(std::uint32_t object, std::uint32_t particle) {
    const state::Deformable& owner = tables_.objects[object];
    const std::uint32_t first = owner.kind == PointRef::Kind::kRope ? owner.particles.first : particle;
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

/// Anchors of the chains, which are in order of their particles as ropes are.
void list_anchors(const Tables& t, const std::vector<std::uint32_t>& hooks, std::vector<Chain>& chains,
                  std::vector<RopeAnchor>& anchors) {
  anchors.clear();
  for (const std::uint32_t row : hooks) {
    const Hook& hook = t.hooks[row];
    HOOKE_ASSERT(may_be_anchor(t, hook));
    const std::uint32_t particle = hook.point_end().particle[0];
    const auto behind =
        std::upper_bound(chains.begin(), chains.end(), particle,
                         [](std::uint32_t p, const Chain& chain) { return p < chain.first_particle; });
    HOOKE_ASSERT(behind != chains.begin());
    const auto chain = static_cast<std::uint32_t>(behind - chains.begin()) - 1;
    anchors.push_back({chain, particle - chains[chain].first_particle, row, hook.b.is_point()});
  }
  std::sort(anchors.begin(), anchors.end(), [](const RopeAnchor& a, const RopeAnchor& b) {
    return std::tie(a.chain, a.node, a.hook) < std::tie(b.chain, b.node, b.hook);
  });
  std::uint32_t next = 0;
  for (std::uint32_t c = 0; c < chains.size(); ++c) {
    chains[c].first_anchor = next;
    while (next < anchors.size() && anchors[next].chain == c) ++next;
    chains[c].end_anchor = next;
  }
}

/// Members of all bundles, in order of the first hook, then of the first contact that makes one; of contacts,
/// those of points come before those between bodies. Hooks that
/// are anchors go to `scratch.anchors`.
void sort_members(const Tables& t, std::vector<Chain>& chains, Bundles& bundles) {
  Groups groups(t, bundles.scratch.sets);
  const std::size_t group_count = t.bodies.motion.size() + t.particles.position.size();
  std::vector<std::uint8_t>& tied = bundles.scratch.tied;
  tied.assign(group_count, 0);
  for (const Hook& hook : t.hooks) {
    if (hook.coupled || (hook.holds_point() && !may_be_anchor(t, hook))) tied[groups.of_hook(hook)] = 1;
  }
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (joins(t, row)) tied[groups.of_contact(row)] = 1;
  }
  for (const state::InnerContact& inner : t.inner_contacts) {
    if (is_tied(t, inner)) tied[groups.of_inner(inner)] = 1;
  }
  for (const state::BorneContact& borne : t.pairs.borne) tied[groups.of_borne(borne)] = 1;
  for (const state::RopeContact& contact : t.rope_contacts) {
    if (contact.joined) tied[groups.of_rope_contact(contact)] = 1;
  }
  std::vector<std::uint32_t>& bundle_of = bundles.scratch.bundle_of;
  bundle_of.assign(group_count, kNone);
  bundles.count = 0;
  bundles.scratch.anchors.clear();
  const auto bundle_at = [&](std::uint32_t group) -> Bundle& {
    if (bundle_of[group] == kNone) {
      bundle_of[group] = static_cast<std::uint32_t>(bundles.count++);
      if (bundles.bundles.size() < bundles.count) bundles.bundles.emplace_back();
      bundles.bundles[bundle_of[group]].clear();
    }
    return bundles.bundles[bundle_of[group]];
  };
  for (std::uint32_t i = 0; i < t.hooks.size(); ++i) {
    const Hook& hook = t.hooks[i];
    if (!hook.is_bundled()) continue;
    if (tied[groups.of_hook(hook)] == 0) {
      bundles.scratch.anchors.push_back(i);
      continue;
    }
    Bundle& bundle = bundle_at(groups.of_hook(hook));
    bundle.hooks.push_back(i);
    for (const HookPlace& end : {hook.a, hook.b}) {
      add_points(t, end, bundle.points);
      if (gives_way(t.bodies, end.body)) bundle.bodies.push_back(end.body);
    }
  }
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (!joins(t, row)) continue;
    Bundle& bundle = bundle_at(groups.of_contact(row));
    bundle.bodies.push_back(t.contacts.body[row]);
    if (!is_of_rope(t, row)) bundle.points.push_back(t.contacts.particle[row]);
  }
  for (std::uint32_t row = 0; row < t.inner_contacts.size(); ++row) {
    const state::InnerContact& inner = t.inner_contacts[row];
    if (!is_tied(t, inner)) continue;
    Bundle& bundle = bundle_at(groups.of_inner(inner));
    bundle.inner.push_back(row);
    if (gives_way(t.bodies, inner.body)) bundle.bodies.push_back(inner.body);
    if (t.objects[inner.object].kind == PointRef::Kind::kRope) continue;
    bundle.points.insert(bundle.points.end(), inner.particle.begin(), inner.particle.begin() + inner.count);
  }
  for (std::uint32_t row = 0; row < t.rope_contacts.size(); ++row) {
    const state::RopeContact& contact = t.rope_contacts[row];
    if (contact.joined) bundle_at(groups.of_rope_contact(contact)).rope_contacts.push_back(row);
  }
  for (std::uint32_t row = 0; row < t.pairs.borne.size(); ++row) {
    const state::BorneContact& borne = t.pairs.borne[row];
    Bundle& bundle = bundle_at(groups.of_borne(borne));
    bundle.borne.push_back(row);
    for (const std::uint32_t body : {borne.body_a, borne.body_b}) {
      if (gives_way(t.bodies, body)) bundle.bodies.push_back(body);
    }
  }
  std::uint32_t chain = 0;
  for (std::uint32_t o = 0; o < t.objects.size(); ++o) {
    if (t.objects[o].kind != PointRef::Kind::kRope) continue;
    const std::uint32_t group = groups.of_particle(o, t.objects[o].particles.first);
    const std::uint32_t bundle = bundle_of[group];
    chains[chain].in_bundle = bundle != kNone;
    if (bundle != kNone) bundles.bundles[bundle].chains.push_back(chain);
    ++chain;
  }
  for (Bundle& bundle : bundles.live()) {
    base::sort_unique(bundle.points);
    base::sort_unique(bundle.bodies);
  }
}

/// Finds the nodes of a bundle, and the blocks at them.
struct Layout {
  const Tables& tables;
  const std::vector<Chain>& chains;
  Bundle& bundle;
  BundleScratch& scratch;
  std::vector<std::vector<Bundle::Incident>>& at_node = scratch.at_node;
  std::vector<std::uint32_t>& first_node = scratch.first_node;
  std::size_t node_count = 0;
  std::uint32_t vector_count = 0;  ///< Segments, then bends.

  [[nodiscard]] std::uint32_t node_of(std::uint32_t particle) const {
    for (std::size_t k = 0; k < bundle.chains.size(); ++k) {
      const Chain& chain = chains[bundle.chains[k]];
      if (particle >= chain.first_particle && particle < chain.first_particle + chain.node_count)
        return first_node[k] + particle - chain.first_particle;
    }
    const auto at = std::lower_bound(bundle.points.begin(), bundle.points.end(), particle);
    return first_node.back() + static_cast<std::uint32_t>(at - bundle.points.begin());
  }

  void list_incidents() {
    std::uint32_t nodes = 0;
    vector_count = 0;
    first_node.clear();
    for (const std::uint32_t c : bundle.chains) {
      first_node.push_back(nodes);
      nodes += chains[c].node_count;
    }
    first_node.push_back(nodes);
    node_count = nodes + bundle.points.size();
    base::reset_lists(node_count, at_node);
    for (std::size_t k = 0; k < bundle.chains.size(); ++k) {
      for (std::uint32_t i = 0; i + 1 < chains[bundle.chains[k]].node_count; ++i) {
        at_node[first_node[k] + i].push_back({vector_count, 1});
        at_node[first_node[k] + i + 1].push_back({vector_count, -1});
        ++vector_count;
      }
    }
    for (std::size_t k = 0; k < bundle.chains.size(); ++k)
      list_bends(chains[bundle.chains[k]], first_node[k]);
    for (std::uint32_t i = 0; i < bundle.hooks.size(); ++i) {
      add_end(vector_count + i, -1, tables.hooks[bundle.hooks[i]].a);
      add_end(vector_count + i, 1, tables.hooks[bundle.hooks[i]].b);
    }
    for (std::uint32_t i = 0; i < bundle.inner.size(); ++i) {
      const state::InnerContact& inner = tables.inner_contacts[bundle.inner[i]];
      for (std::uint32_t k = 0; k < inner.count; ++k)  // weights: BundleSolution::load_inner
        at_node[node_of(inner.particle[k])].push_back({inner_block(i), 0});
    }
    for (std::uint32_t i = 0; i < bundle.rope_contacts.size(); ++i) {
      for (const std::uint32_t particle : tables.rope_contacts[bundle.rope_contacts[i]].particle)
        at_node[node_of(particle)].push_back({inner_block(bundle.inner_count() + i), 0});
    }
  }

  void list_bends(const Chain& chain, std::uint32_t first) {
    if (!(chain.bend_stiffness > 0)) return;
    for (std::uint32_t i = 1; i + 1 < chain.node_count; ++i) {
      const double before = 1 / static_cast<double>(tables.segments.rest_length[chain.first_segment + i - 1]);
      const double behind = 1 / static_cast<double>(tables.segments.rest_length[chain.first_segment + i]);
      at_node[first + i - 1].push_back({vector_count, before});
      at_node[first + i].push_back({vector_count, -before - behind});
      at_node[first + i + 1].push_back({vector_count, behind});
      ++vector_count;
    }
  }

  /// Weights of ends that slide change from substep to substep: set_slide_weights.
  void add_end(std::uint32_t block, double sign, const HookPlace& end) {
    for (std::uint32_t i = 0; i < end.particle_count; ++i)
      at_node[node_of(end.particle[i])].push_back({block, sign * static_cast<double>(end.weight[i])});
  }

  [[nodiscard]] std::uint32_t inner_block(std::uint32_t index) const {
    return vector_count + static_cast<std::uint32_t>(bundle.hooks.size()) + index;
  }
  [[nodiscard]] std::uint32_t body_block(std::uint32_t body) const {
    const int index = bundle.body_of(body);
    if (index < 0) return kNone;
    return inner_block(bundle.touch_count()) + static_cast<std::uint32_t>(index);
  }

  /// Blocks that meet: at a node, at a body, or by a contact of a node with a body.
  void join_blocks() {
    scratch.matrix.reset(vector_count + bundle.hooks.size() + bundle.touch_count() + bundle.bodies.size());
    const auto meet = [&](std::uint32_t a, std::uint32_t b) {
      if (a != b && a != kNone && b != kNone) scratch.matrix.join(a, b);
    };
    std::vector<std::vector<std::uint32_t>>& bodies_at = scratch.bodies_at;
    base::reset_lists(node_count, bodies_at);
    for (std::size_t row = 0; row < tables.contacts.particle.size(); ++row) {
      if (!joins(tables, row)) continue;
      const std::uint32_t block = body_block(tables.contacts.body[row]);
      if (block != kNone) bodies_at[node_of(tables.contacts.particle[row])].push_back(block);
    }
    for (std::size_t node = 0; node < node_count; ++node) {
      for (const Bundle::Incident& a : at_node[node]) {
        for (const Bundle::Incident& b : at_node[node]) meet(a.block, b.block);
        for (const std::uint32_t body : bodies_at[node]) meet(a.block, body);
      }
      for (const std::uint32_t a : bodies_at[node]) {
        for (const std::uint32_t b : bodies_at[node]) meet(a, b);
      }
    }
    for (std::uint32_t i = 0; i < bundle.hooks.size(); ++i) {
      for (const HookPlace& end : {tables.hooks[bundle.hooks[i]].a, tables.hooks[bundle.hooks[i]].b})
        meet(vector_count + i, body_block(end.body));
    }
    for (std::uint32_t i = 0; i < bundle.inner.size(); ++i)
      meet(inner_block(i), body_block(tables.inner_contacts[bundle.inner[i]].body));
    for (std::uint32_t i = 0; i < bundle.borne.size(); ++i) {
      const state::BorneContact& borne = tables.pairs.borne[bundle.borne[i]];
      meet(inner_block(bundle.first_borne() + i), body_block(borne.body_a));
      meet(inner_block(bundle.first_borne() + i), body_block(borne.body_b));
    }
  }
};

void list_pairs(const Layout& layout, Bundle& bundle) {
  for (std::size_t node = 0; node < layout.node_count; ++node) {
    const std::vector<Bundle::Incident>& at = layout.at_node[node];
    bundle.first_incident.push_back(static_cast<std::uint32_t>(bundle.incidents.size()));
    bundle.first_pair.push_back(static_cast<std::uint32_t>(bundle.pair_block.size()));
    bundle.incidents.insert(bundle.incidents.end(), at.begin(), at.end());
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const auto [low, high] = std::minmax({bundle.place[at[i].block], bundle.place[at[j].block]});
        bundle.pair_block.push_back(find_block(bundle.pattern, high, low));
      }
    }
  }
  bundle.first_incident.push_back(static_cast<std::uint32_t>(bundle.incidents.size()));
}

/// False if a factorization takes more than `budget` multiplications.
bool try_pattern(const Tables& t, double budget, Layout& layout, BundleScratch& scratch, Bundle& bundle) {
  layout.list_incidents();
  layout.join_blocks();
  std::vector<int>& sizes = scratch.sizes;
  sizes.assign(layout.vector_count, 3);
  bundle.first_row.assign(1, 0);
  for (const std::uint32_t hook : bundle.hooks) {
    sizes.push_back(count_joint_rows(t.hooks[hook]));
    bundle.first_row.push_back(bundle.first_row.back() + static_cast<std::uint32_t>(sizes.back()));
  }
  for (std::size_t i = 0; i < bundle.touch_count(); ++i) {
    sizes.push_back(InnerTouch::kRows);
    bundle.first_row.push_back(bundle.first_row.back() + InnerTouch::kRows);
  }
  scratch.signs.assign(sizes.size(), 1);
  sizes.resize(sizes.size() + bundle.bodies.size(), 6);
  scratch.signs.resize(sizes.size(), -1);
  return make_block_pattern(scratch.matrix, sizes, budget, bundle.pattern);
}

void leave_out_every_second(std::vector<std::uint32_t>& rows) {
  for (std::size_t i = 0; 2 * i < rows.size(); ++i) rows[i] = rows[2 * i];
  rows.resize((rows.size() + 1) / 2);
}

void make_pattern(const Tables& t, const std::vector<Chain>& chains, BundleScratch& scratch, Bundle& bundle) {
  Layout layout = {t, chains, bundle, scratch};
  const std::size_t asked = bundle.rope_contacts.size();
  std::size_t nodes = 0;
  for (const std::uint32_t c : bundle.chains) nodes += chains[c].node_count;
  while (bundle.rope_contacts.size() > kMostRopeContacts * nodes)
    leave_out_every_second(bundle.rope_contacts);
  double budget = kBundleBudget;
  while (!try_pattern(t, budget, layout, scratch, bundle)) {
    if (bundle.rope_contacts.size() <= 1) budget = kNoBudget;
    leave_out_every_second(bundle.rope_contacts);
  }
  bundle.refused = static_cast<std::uint32_t>(asked - bundle.rope_contacts.size());
  set_signs(scratch.signs, bundle.pattern);
  bundle.place.resize(scratch.sizes.size());
  for (std::uint32_t i = 0; i < scratch.sizes.size(); ++i) bundle.place[bundle.pattern.order[i]] = i;
  list_pairs(layout, bundle);
  bundle.rows.resize(bundle.first_row.back());
  bundle.bound.resize(bundle.first_row.back());
  bundle.lambda.resize(bundle.first_row.back());
  bundle.moving.resize(bundle.bodies.size());
  for (const std::uint32_t hook : bundle.hooks)
    bundle.ends.push_back({bundle.body_of(t.hooks[hook].a.body), bundle.body_of(t.hooks[hook].b.body)});
  for (const std::uint32_t row : bundle.inner)
    bundle.ends.push_back({bundle.body_of(t.inner_contacts[row].body), -1});
  bundle.ends.insert(bundle.ends.end(), bundle.rope_contacts.size(), {-1, -1});
  for (const std::uint32_t row : bundle.borne) {
    const state::BorneContact& borne = t.pairs.borne[row];
    bundle.ends.push_back({bundle.body_of(borne.body_a), bundle.body_of(borne.body_b)});
  }
}

/// Tethers of a bundle's points, of which `by_particle` has all in order of their particles.
void list_tethers(const Tables& t, const std::vector<std::uint32_t>& by_particle, Bundle& bundle) {
  auto at = by_particle.begin();
  for (const std::uint32_t p : bundle.points) {
    bundle.first_tether.push_back(static_cast<std::uint32_t>(bundle.tethers.size()));
    const auto before = [&](std::uint32_t row, std::uint32_t of) { return t.springs.particle_a[row] < of; };
    at = std::lower_bound(at, by_particle.end(), p, before);
    for (; at != by_particle.end() && t.springs.particle_a[*at] == p; ++at) bundle.tethers.push_back(*at);
  }
  bundle.first_tether.push_back(static_cast<std::uint32_t>(bundle.tethers.size()));
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

/// The two nodes at which a hook slides along its rope follow its weights.
void set_slide_weights(const Tables& t, std::vector<int>& seen, Bundle& bundle) {
  const auto vectors =
      static_cast<std::uint32_t>(bundle.place.size() - bundle.ends.size() - bundle.bodies.size());
  const auto slides = [&](const Bundle::Incident& at) {
    return at.block >= vectors && at.block < vectors + bundle.hooks.size() && at.weight <= 0 &&
           t.hooks[bundle.hooks[at.block - vectors]].kind == HookKind::kRopeSlide;
  };
  seen.assign(bundle.hooks.size(), 0);
  for (Bundle::Incident& at : bundle.incidents) {
    if (!slides(at)) continue;
    const std::uint32_t hook = at.block - vectors;
    at.weight = -static_cast<double>(t.hooks[bundle.hooks[hook]].a.weight[seen[hook]++]);
  }
}

}  // namespace

int Bundle::body_of(std::uint32_t row) const {
  const auto at = std::lower_bound(bodies.begin(), bodies.end(), row);
  return at != bodies.end() && *at == row ? static_cast<int>(at - bodies.begin()) : -1;
}

void Bundle::clear() {
  for (std::vector<std::uint32_t>* list :
       {&chains, &points, &hooks, &inner, &rope_contacts, &borne, &bodies, &tethers, &first_tether,
        &first_incident, &pair_block, &first_pair})
    list->clear();
  ends.clear();
  incidents.clear();
}

void build_bundles(const Tables& tables, std::vector<Chain>& chains, Bundles& bundles) {
  write_signature(tables, bundles.scratch.signature);
  if (bundles.scratch.signature != bundles.signature) {
    base::take_turns(bundles.signature, bundles.scratch.signature);
    sort_members(tables, chains, bundles);
    list_anchors(tables, bundles.scratch.anchors, chains, bundles.anchors);
    if (bundles.tethers_revision != tables.revision) bundles.tethers = tethers_by_particle(tables);
    bundles.tethers_revision = tables.revision;
    for (Bundle& bundle : bundles.live()) {
      make_pattern(tables, chains, bundles.scratch, bundle);
      list_tethers(tables, bundles.tethers, bundle);
    }
  }
  for (Bundle& bundle : bundles.live()) set_slide_weights(tables, bundles.scratch.counts, bundle);
}

}  // namespace hooke::solver
