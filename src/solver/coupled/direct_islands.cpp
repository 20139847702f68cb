#include "solver/coupled/direct_islands.h"

#include "base/sort_unique.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hooke::solver {

namespace {

using parallel::Range;
using state::Bodies;
using state::Manifold;
using state::normal_impulse;

constexpr std::uint32_t kNoIsland = 0xFFFFFFFF;
constexpr Real kLargestSag = Real(0.005);  ///< Of the size of a body.
constexpr Real kLargestLean = Real(0.3);   ///< sag H^2 / a^3
constexpr Real kReleased = Real(0.6);      ///< Of both, below which an island may become soft again.
constexpr Real kGross = Real(5);           ///< Of both: hard at once.
constexpr Real kFast = Real(0.5);          ///< An island with a faster body does not become hard [m/s].
constexpr std::int8_t kStaysHard = 30;     ///< Steps.
constexpr std::int8_t kNotJudged = -60;    ///< Steps after a refusal, or if it is too large.

/// Hardness of an island after a step in which it asked for `excess` of what soft contacts may do.
std::int8_t next_hardness(std::int8_t most, Real excess) {
  if (most >= kHard) {
    if (excess > (most > kHard ? kReleased : Real(1))) return kHard + kStaysHard;
    return most > kHard ? static_cast<std::int8_t>(most - 1) : std::int8_t{0};
  }
  if (!(excess > Real(1))) return 0;
  if (excess > kGross) return kHard + kStaysHard;
  return most + 1 < kHard ? static_cast<std::int8_t>(most + 1) : std::int8_t{kHard + kStaysHard};
}

/// Twice the radius of a sphere within the smaller body.
Real size_of(const ContactBlock& block, int lane, const Bodies& bodies) {
  const Real a = bodies.traits[block.line_a[lane] / 16].inner_radius;
  return Real(2) * (block.anchored ? a : std::min(a, bodies.traits[block.line_b[lane] / 16].inner_radius));
}

/// Impulse in a substep that would sink a soft contact by 1 m, over its effective mass [1/m].
Real stiffness_of(const ContactBlock& block, const ContactStep& step) {
  const ContactSoftness soft = contact_softness(step, block.anchored);
  return soft.rate / soft.impulse_scale;
}

/// Overlap that each lane of a soft contact needs to carry what it carries, and the effective mass of those
/// points that carry something.
void find_sags(const ContactBlock& block, Real stiffness, ContactBlock::Lane& sag,
               ContactBlock::Lane& bearing) {
  for (int lane = 0; lane < kContactLanes; ++lane) sag[lane] = bearing[lane] = Real(0);
  for (int k = 0; k < block.point_count; ++k) {
    const ContactBlock::Point& p = block.point[k];
    for (int lane = 0; lane < kContactLanes; ++lane) {
      const bool bears = p.mass[lane] > Real(0) && p.impulse[lane] > Real(0);
      const Real needed = p.impulse[lane] / (stiffness * (bears ? p.mass[lane] : Real(1)));
      sag[lane] = bears && needed > sag[lane] ? needed : sag[lane];
      bearing[lane] += bears ? p.mass[lane] : Real(0);
    }
  }
}

/// Islands that were refused, or are too large, cost nothing until they are judged again: in their last step,
/// so that those that still are never count as others in between.
bool is_judged(const ContactBlock& block, const Bodies& bodies) {
  for (int lane = 0; lane < block.count; ++lane) {
    if (bodies.hardness[block.line_a[lane] / 16] >= -1) return true;
  }
  return false;
}

void judge_contacts(const ContactStep& step, const BodyContacts& contacts, IslandMembers members,
                    const Bodies& bodies, base::DisjointSets& sets, std::vector<IslandDemand>& demands) {
  for (const ContactBlock& block : contacts.blocks) {
    if (!is_judged(block, bodies)) continue;
    const Real stiffness = stiffness_of(block, step);
    ContactBlock::Lane sag;
    ContactBlock::Lane bearing;
    find_sags(block, stiffness, sag, bearing);
    for (int lane = 0; lane < block.count; ++lane) {
      const std::uint32_t a = block.line_a[lane] / 16;
      const std::uint32_t b = block.line_b[lane] / 16;
      if (members[a] == Footing::kHangs || (!block.anchored && members[b] == Footing::kHangs)) continue;
      if (!block.anchored) sets.merge(a, b);
      if (!(sag[lane] > Real(0))) continue;
      const Real size = size_of(block, lane, bodies);
      if (!(size > Real(0))) continue;
      demands[a].sag = std::max(demands[a].sag, sag[lane] / size);
      demands[a].lean = std::max(demands[a].lean, sag[lane] / (size * size * size));
      const Real down = dot(step.gravity, vector_of(block.normal, lane));
      if (block.anchored && !(down > Real(0))) continue;
      IslandDemand& upper = demands[down > Real(0) ? a : b];
      upper.bearing += stiffness * bearing[lane] * std::abs(down);
      upper.thinnest = std::min(upper.thinnest, size);
    }
  }
}

/// A weight that is only just arriving has yet to show in impulses, and falls meanwhile: what a body rests on
/// must carry at least the body itself. With bearing = sum of stiffness mass |g.n|, the contacts of a body of
/// mass M sink by (M h g / bearing) g.
void add_own_weight(Real inverse_mass, const ContactStep& step, IslandDemand& own) {
  if (!(own.bearing > Real(0))) return;
  const Real sag = step.h * length_squared(step.gravity) / (inverse_mass * own.bearing);
  own.sag = std::max(own.sag, sag / own.thinnest);
  own.lean = std::max(own.lean, sag / (own.thinnest * own.thinnest * own.thinnest));
}

void add_demand(const IslandDemand& of, IslandDemand& to) {
  to.sag = std::max(to.sag, of.sag);
  to.lean = std::max(to.lean, of.lean);
  to.low = std::min(to.low, of.low);
  to.high = std::max(to.high, of.high);
  to.count += of.count;
  to.least = std::min(to.least, of.least);
  to.most = std::max(to.most, of.most);
}

std::int8_t judge(const IslandDemand& island) {
  if (island.count > kMaxHardBodies) return kNotJudged;
  // A wave of falling dominoes takes in calm heaps one after the other: hard ones become soft with it.
  if (island.least < 0)
    return island.most >= kHard ? std::int8_t{0} : static_cast<std::int8_t>(island.least + 1);
  if (island.count < 2) return 0;
  const Real height = island.high - island.low;
  const Real excess = std::max(island.sag / kLargestSag, height * height * island.lean / kLargestLean);
  return next_hardness(island.most, excess);
}

/// New bodies become hard where they stand on each other, or judged like others from now on.
void judge_new_bodies(std::span<const std::uint32_t> awake, const ContactStep& step, IslandMembers members,
                      HardIslands& hard, Bodies& bodies) {
  const auto is_new = [&](std::uint32_t body) { return bodies.hardness[body] == Bodies::kNew; };
  if (std::none_of(awake.begin(), awake.end(), is_new)) return;
  hard.demands.assign(bodies.motion.size(), {});
  for (const std::uint32_t body : awake) {
    if (!is_moved(bodies, body)) continue;
    const bool stands = members[body] == Footing::kStands && length(bodies.motion[body].v) <= kFast;
    const std::int8_t as = is_new(body) && !stands ? std::int8_t{0} : bodies.hardness[body];
    IslandDemand& island = hard.demands[hard.sets.root(body)];
    ++island.count;
    island.least = std::min(island.least, as);
  }
  for (const std::uint32_t body : awake) {
    if (!is_new(body)) continue;
    const IslandDemand& island = hard.demands[hard.sets.root(body)];
    const bool together = island.count > 1 && island.least == Bodies::kNew;
    bodies.hardness[body] = together && !(step.gravity == Vec3{}) ? kHard : std::int8_t{0};
  }
}

/// Whether it joins two bodies to one island.
bool joins(const Manifold& m, IslandMembers members, const Bodies& bodies) {
  return has_contact_rows(m, bodies) && is_moved(bodies, m.body_a) && is_moved(bodies, m.body_b) &&
         members[m.body_a] != Footing::kHangs && members[m.body_b] != Footing::kHangs;
}

/// Numbers the islands with hard bodies by their lowest body, and lists their bodies.
void number_islands(std::span<const std::uint32_t> awake, const Bodies& bodies, HardIslands& hard) {
  std::vector<std::uint32_t>& island_of = hard.island_of;
  island_of.assign(bodies.motion.size(), kNoIsland);
  for (const std::uint32_t body : awake) {
    if (bodies.hardness[body] >= kHard) island_of[hard.sets.root(body)] = 0;
  }
  hard.count = 0;
  for (const std::uint32_t body : awake) {
    const std::uint32_t root = hard.sets.root(body);
    if (!is_moved(bodies, body) || island_of[root] == kNoIsland) continue;
    if (root == body) {
      island_of[body] = static_cast<std::uint32_t>(hard.count++);
      if (static_cast<int>(hard.found.size()) < hard.count) hard.found.emplace_back();
      hard.found[hard.count - 1].bodies.clear();
      hard.found[hard.count - 1].edges.clear();
    }
    island_of[body] = island_of[root];
    hard.found[island_of[body]].bodies.push_back(body);
  }
}

void list_edges(const std::vector<Manifold>& manifolds, IslandMembers members, const Bodies& bodies,
                HardIslands& hard) {
  for (const Manifold& m : manifolds) {
    if (!joins(m, members, bodies)) continue;
    const std::uint32_t island = hard.island_of[m.body_a];
    if (island == kNoIsland) continue;
    const std::uint32_t a = node_of(hard.found[island].bodies, m.body_a);
    const std::uint32_t b = node_of(hard.found[island].bodies, m.body_b);
    hard.found[island].edges.push_back({std::min(a, b), std::max(a, b)});
  }
  for (int i = 0; i < hard.count; ++i) {
    auto& edges = hard.found[i].edges;
    base::sort_unique(edges);
  }
}

/// The pattern of an island's matrix; false if it costs too much, and then the island is of nobody.
bool make_pattern(const HardGraph& graph, HardIslands& hard, HardIsland& island) {
  hard.matrix.reset(graph.bodies.size());
  for (const auto& [a, b] : graph.edges) hard.matrix.join(a, b);
  hard.sizes.assign(graph.bodies.size(), 6);
  if (!make_block_pattern(hard.matrix, hard.sizes, kHardIslandBudget, island.pattern)) {
    island.graph.bodies.clear();
    return false;
  }
  island.graph = graph;
  island.place.resize(graph.bodies.size());
  for (std::uint32_t i = 0; i < island.place.size(); ++i) island.place[island.pattern.order[i]] = i;
  return true;
}

/// Of each island that was found, the largest speed at which its lighter bodies would leave their contacts
/// without what they carried in the last substep [m/s].
void find_loads(const std::vector<Manifold>& manifolds, IslandMembers members, const Bodies& bodies,
                HardIslands& hard) {
  hard.loads.assign(static_cast<std::size_t>(hard.count), Real(0));
  for (const Manifold& m : manifolds) {
    if (!joins(m, members, bodies) || hard.island_of[m.body_a] == kNoIsland) continue;
    const Real w = std::max(bodies.motion[m.body_a].inverse_mass, bodies.motion[m.body_b].inverse_mass);
    Real& load = hard.loads[hard.island_of[m.body_a]];
    load = std::max(load, w * normal_impulse(m));
  }
}

/// Costs nothing more than the budget: the islands with the largest loads come first.
void spend_budget(const std::vector<Manifold>& manifolds, IslandMembers members, const Bodies& bodies,
                  HardIslands& hard) {
  find_loads(manifolds, members, bodies, hard);
  std::vector<int>& order = hard.order;
  order.resize(static_cast<std::size_t>(hard.count));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return hard.loads[a] > hard.loads[b]; });
  double cost = 0;
  for (const int i : order) {
    if (hard.fits[i] == 0) continue;
    const double operations = hard.islands[i].pattern.operations;
    hard.fits[i] = cost + operations <= kHardBudget ? 1 : 0;
    if (hard.fits[i] != 0) cost += operations;
  }
}

/// Keeps what is within the budget and not too large. An island whose bodies and contacts are those of the
/// step before keeps its matrix.
void take_islands(const std::vector<Manifold>& manifolds, IslandMembers members, Bodies& bodies,
                  HardIslands& hard) {
  const auto found = static_cast<std::size_t>(hard.count);
  if (hard.islands.size() < found) hard.islands.resize(found);
  hard.fits.assign(found, 0);
  double cost = 0;
  for (std::size_t i = 0; i < found; ++i) {
    const HardGraph& graph = hard.found[i];
    HardIsland& island = hard.islands[i];
    const bool fits =
        graph.bodies.size() <= kMaxHardBodies && (island.graph == graph || make_pattern(graph, hard, island));
    hard.fits[i] = fits ? 1 : 0;
    if (fits) cost += island.pattern.operations;
  }
  if (cost > kHardBudget) spend_budget(manifolds, members, bodies, hard);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < found; ++i) {
    const bool fits = hard.fits[i] != 0;
    for (const std::uint32_t body : hard.found[i].bodies) {
      hard.island_of[body] = fits ? static_cast<std::uint32_t>(taken) : kNoIsland;
      // What would be hard for this step only, as new bodies are, is judged at its end like others.
      if (!fits) bodies.hardness[body] = bodies.hardness[body] == kHard ? std::int8_t{0} : kNotJudged;
    }
    if (fits && taken != i) std::swap(hard.islands[taken], hard.islands[i]);
    taken += fits ? 1 : 0;
  }
  hard.count = static_cast<int>(taken);
  hard.refused = static_cast<std::uint32_t>(found - taken);
}

}  // namespace

void find_hard_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                       const std::vector<Manifold>& manifolds, IslandMembers members, Bodies& bodies,
                       BodyContacts& contacts, HardIslands& hard) {
  contacts.colors.hard.clear();
  hard.count = 0;
  hard.refused = 0;
  const bool any = std::any_of(awake.begin(), awake.end(),
                               [&](std::uint32_t body) { return bodies.hardness[body] >= kHard; });
  if (!any) return;
  hard.sets.reset(bodies.motion.size());
  for (const Manifold& m : manifolds) {
    if (joins(m, members, bodies)) hard.sets.merge(m.body_a, m.body_b);
  }
  judge_new_bodies(awake, step, members, hard, bodies);
  for (const std::uint32_t body : awake) {
    if (members[body] == Footing::kHangs && bodies.hardness[body] >= kHard) bodies.hardness[body] = 0;
  }
  number_islands(awake, bodies, hard);
  list_edges(manifolds, members, bodies, hard);
  take_islands(manifolds, members, bodies, hard);
  contacts.colors.hard.assign(bodies.motion.size(), 0);
  for (const std::uint32_t body : awake)
    contacts.colors.hard[body] = is_moved(bodies, body) && hard.island_of[body] != kNoIsland ? 1 : 0;
}

void prepare_hard_islands(parallel::ThreadPool& pool, const BodyContacts& contacts, const Bodies& bodies,
                          HardIslands& hard) {
  if (hard.count == 0) return;
  for (HardIsland& island : hard.live()) island.contacts.clear();
  for (int i = 0; i < static_cast<int>(contacts.blocks.size()); ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (!block.hard) continue;
    for (int lane = 0; lane < block.count; ++lane) {
      HardIsland& island = hard.islands[hard.island_of[block.line_a[lane] / 16]];
      int points = 0;
      while (points < block.point_count && block.point[points].mass[lane] > Real(0)) ++points;
      island.contacts.push_back({.block = i, .lane = lane, .points = points});
    }
  }
  parallel::for_ranges(pool, hard.count, 1, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) prepare_hard_rows(contacts, bodies, hard.islands[i]);
  });
}

void solve_hard_islands(parallel::ThreadPool& pool, const BodyStep& step, HardIslands& hard,
                        BodyContacts& contacts, Bodies& bodies) {
  parallel::for_ranges(pool, hard.count, 1, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) solve_hard_island(step, hard.islands[i], contacts, bodies);
  });
}

void judge_hardness(std::span<const std::uint32_t> awake, const ContactStep& step,
                    const BodyContacts& contacts, IslandMembers members, HardIslands& hard, Bodies& bodies) {
  // Without weight there are hits, but no loads.
  if (step.gravity == Vec3{}) {
    for (const std::uint32_t body : awake) bodies.hardness[body] = 0;
    return;
  }
  hard.demands.assign(bodies.motion.size(), {});
  hard.sets.reset(bodies.motion.size());
  judge_contacts(step, contacts, members, bodies, hard.sets, hard.demands);
  const Vec3 down = normalize(step.gravity);
  for (const std::uint32_t body : awake) {
    if (!is_moved(bodies, body)) continue;
    IslandDemand own = hard.demands[body];
    add_own_weight(bodies.motion[body].inverse_mass, step, own);
    own.low = own.high = dot(down, vector_cast<Real>(bodies.center[body]));
    own.least = own.most = bodies.hardness[body];
    // Ragdolls take turns with soft contacts only, and what is soft and fast falls anyway.
    const bool falls = own.most < kHard && length(bodies.motion[body].v) > kFast;
    if (members[body] != Footing::kStands || falls) own.least = std::min(own.least, std::int8_t{-1});
    own.count = 1;
    const std::uint32_t root = hard.sets.root(body);
    if (root == body) hard.demands[body] = {.sag = own.sag, .lean = own.lean};
    add_demand(own, hard.demands[root]);
  }
  for (const std::uint32_t body : awake) {
    if (is_moved(bodies, body)) bodies.hardness[body] = judge(hard.demands[hard.sets.root(body)]);
  }
}

}  // namespace hooke::solver
