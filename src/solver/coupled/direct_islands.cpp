#include "solver/coupled/direct_islands.h"

#include "base/assert.h"
#include "base/sort_unique.h"
#include "solver/coupled/coupled_manifolds.h"
#include "solver/coupled/coupled_tuning.h"

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

constexpr std::uint32_t kNoIsland = DirectIslands::kNoIsland;

/// The direct_state of an island after a step in which it asked for `excess` of what soft contacts may do.
std::int8_t next_direct_state(std::int8_t most, Real excess) {
  if (most >= kDirect) {
    if (excess > (most > kDirect ? kReleasedShare : Real(1))) return kDirect + kStaysDirectSteps;
    return most > kDirect ? static_cast<std::int8_t>(most - 1) : std::int8_t{0};
  }
  if (!(excess > Real(1))) return 0;
  if (excess > kGrossExcess) return kDirect + kStaysDirectSteps;
  return most + 1 < kDirect ? static_cast<std::int8_t>(most + 1) : std::int8_t{kDirect + kStaysDirectSteps};
}

/// The direct_state of an island that waits for `steps`, a number below 0, until it is evaluated again.
constexpr std::int8_t waiting(std::int8_t steps, bool refused) {
  return refused && steps < 0 ? static_cast<std::int8_t>(steps + kNotEvaluatedSteps) : steps;
}

constexpr std::int8_t kRefusedSteps = waiting(kNotEvaluatedSteps, true);

/// Minus the steps that the body's island waits, or its direct_state if it does not wait.
std::int8_t steps_of(const Bodies& bodies, std::uint32_t body) {
  const std::int8_t state = bodies.direct_state[body];
  return is_refused(bodies, body) ? static_cast<std::int8_t>(state - kNotEvaluatedSteps) : state;
}

/// Twice the radius of a sphere within the smaller body.
Real size_of(const ContactBlock& block, int lane, const Bodies& bodies) {
  const std::uint32_t a = block.record_a[lane] / 16;
  const std::uint32_t b = block.anchored ? a : block.record_b[lane] / 16;
  return Real(2) * state::thinner_radius(bodies, a, b);
}

/// Impulse in a substep that would let a soft contact sink by 1 m, over its effective mass [1/m].
Real stiffness_of(const ContactStep& step, bool anchored) {
  const ContactSoftness soft = contact_softness(step, anchored);
  return soft.rate / soft.impulse_scale;
}

/// Finds the overlap that each lane of a soft contact needs for its load, and the effective mass of those
/// points that carry something.
void find_sags(const ContactBlock& block, Real stiffness, ContactBlock::Lane& sag,
               ContactBlock::Lane& support_stiffness) {
  for (int lane = 0; lane < kContactLanes; ++lane) sag[lane] = support_stiffness[lane] = Real(0);
  for (int k = 0; k < block.point_count; ++k) {
    const ContactBlock::Point& p = block.point[k];
    for (int lane = 0; lane < kContactLanes; ++lane) {
      const bool bears_load = p.mass[lane] > Real(0) && p.impulse[lane] > Real(0);
      const Real needed = p.impulse[lane] / (stiffness * (bears_load ? p.mass[lane] : Real(1)));
      sag[lane] = bears_load && needed > sag[lane] ? needed : sag[lane];
      support_stiffness[lane] += bears_load ? p.mass[lane] : Real(0);
    }
  }
}

/// Islands that were refused, or are too large, cost nothing until they are evaluated again. That happens in
/// their last such step, so that those that still are too large never count as others in between.
bool is_evaluated(const ContactBlock& block, const Bodies& bodies) {
  for (int lane = 0; lane < block.count; ++lane) {
    if (steps_of(bodies, block.record_a[lane] / 16) >= -1) return true;
  }
  return false;
}

void evaluate_contacts(const ContactStep& step, const BodyContacts& contacts, IslandMembers members,
                       const Bodies& bodies, base::DisjointSets& sets, std::vector<IslandDemand>& demands) {
  for (const ContactBlock& block : contacts.blocks) {
    if (!is_evaluated(block, bodies)) continue;
    const Real stiffness = stiffness_of(step, block.anchored);
    ContactBlock::Lane sag;
    ContactBlock::Lane support_stiffness;
    find_sags(block, stiffness, sag, support_stiffness);
    for (int lane = 0; lane < block.count; ++lane) {
      const std::uint32_t a = block.record_a[lane] / 16;
      const std::uint32_t b = block.record_b[lane] / 16;
      if (members[a] == Footing::kHangs || (!block.anchored && members[b] == Footing::kHangs)) continue;
      if (!block.anchored) sets.merge(a, b);
      if (!(sag[lane] > Real(0))) continue;
      const Real size = size_of(block, lane, bodies);
      if (!(size > Real(0))) continue;
      demands[a].sag = std::max(demands[a].sag, sag[lane] / size);
      demands[a].buckling = std::max(demands[a].buckling, sag[lane] / (size * size * size));
      const Real down = dot(step.gravity, vector_of(block.normal, lane));
      if (block.anchored && !(down > Real(0))) continue;
      IslandDemand& upper = demands[down > Real(0) ? a : b];
      upper.support_stiffness += stiffness * support_stiffness[lane] * std::abs(down);
      upper.thinnest = std::min(upper.thinnest, size);
    }
  }
}

/// The weight of a body that has just arrived does not show in impulses yet, and the body falls meanwhile.
/// What it rests on must carry at least the body itself. With bearing = sum of stiffness mass |g.n|, the
/// contacts of a body of mass M sink by (M h g / bearing) g.
void add_own_weight(Real inverse_mass, const ContactStep& step, IslandDemand& own) {
  if (!(own.support_stiffness > Real(0))) return;
  HOOKE_ASSERT(inverse_mass > Real(0));
  const Real sag = step.h * length_squared(step.gravity) / (inverse_mass * own.support_stiffness);
  own.sag = std::max(own.sag, sag / own.thinnest);
  own.buckling = std::max(own.buckling, sag / (own.thinnest * own.thinnest * own.thinnest));
}

void add_demand(const IslandDemand& of, IslandDemand& to) {
  to.sag = std::max(to.sag, of.sag);
  to.buckling = std::max(to.buckling, of.buckling);
  to.low = std::min(to.low, of.low);
  to.high = std::max(to.high, of.high);
  to.count += of.count;
  to.stays_soft = to.stays_soft || of.stays_soft;
  to.refused = to.refused || of.refused;
  to.least = std::min(to.least, of.least);
  to.most = std::max(to.most, of.most);
}

/// How much more an island asks for than soft contacts may do: above 1 it needs a direct solution.
Real excess_of(const IslandDemand& island) {
  const Real height = island.high - island.low;
  return std::max(island.sag / kLargestSag, height * height * island.buckling / kLargestBuckling);
}

std::int8_t evaluate(const IslandDemand& island) {
  if (island.count > kMaxDirectBodies)
    return waiting(kNotEvaluatedSteps, !island.stays_soft && excess_of(island) > Real(1));
  // A wave of falling dominoes joins resting heaps one after the other: direct ones become soft with it.
  if (island.least < 0) {
    if (island.most >= kDirect) return 0;
    return waiting(static_cast<std::int8_t>(island.least + 1), island.refused);
  }
  if (island.count < 2) return 0;
  return next_direct_state(island.most, excess_of(island));
}

/// New bodies become direct where they stand on each other. Otherwise they are evaluated like others from now
/// on.
void evaluate_new_bodies(std::span<const std::uint32_t> awake, const ContactStep& step, IslandMembers members,
                         DirectIslands& direct, Bodies& bodies) {
  const auto is_new = [&](std::uint32_t body) { return bodies.direct_state[body] == Bodies::kNew; };
  if (std::none_of(awake.begin(), awake.end(), is_new)) return;
  direct.demands.assign(bodies.motion.size(), {});
  for (const std::uint32_t body : awake) {
    if (!is_moved(bodies, body)) continue;
    const bool stands =
        members[body] == Footing::kStands && length(bodies.motion[body].v) <= kDirectIslandSpeed;
    const std::int8_t as = is_new(body) && !stands ? std::int8_t{0} : bodies.direct_state[body];
    IslandDemand& island = direct.demands[direct.sets.root(body)];
    ++island.count;
    island.least = std::min(island.least, as);
  }
  for (const std::uint32_t body : awake) {
    if (!is_new(body)) continue;
    const IslandDemand& island = direct.demands[direct.sets.root(body)];
    const bool together = island.count > 1 && island.least == Bodies::kNew;
    bodies.direct_state[body] = together && !(step.gravity == Vec3{}) ? kDirect : std::int8_t{0};
  }
}

/// Whether the contact joins two bodies to one island.
bool joins(const Manifold& m, IslandMembers members, const Bodies& bodies) {
  return !m.is_coupled() && has_contact_rows(m, bodies) && is_moved(bodies, m.body_a) &&
         is_moved(bodies, m.body_b) && members[m.body_a] != Footing::kHangs &&
         members[m.body_b] != Footing::kHangs;
}

/// How fast the bodies of a contact come together at one of its points [m/s]; 0 where they part.
Real closing_speed(const Manifold& m, const Bodies& bodies) {
  Real closing = Real(0);
  for (std::int32_t k = 0; k < m.point_count; ++k) {
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
    closing = std::max(closing, dot(m.normal, state::velocity_at(bodies, m.body_a, p.anchor_a) -
                                                  state::velocity_at(bodies, m.body_b, p.anchor_b)));
  }
  return closing;
}

/// Notes how fast each body arrives on what does not give way: what lies on it arrives on it in turn.
void note_landings(const std::vector<Manifold>& manifolds, const Bodies& bodies, std::vector<Real>& landing) {
  landing.assign(bodies.motion.size(), Real(0));
  for (const Manifold& m : manifolds) {
    const bool a_moves = is_moved(bodies, m.body_a);
    if (a_moves == is_moved(bodies, m.body_b) || !has_contact_rows(m, bodies)) continue;
    Real& of_body = landing[a_moves ? m.body_a : m.body_b];
    of_body = std::max(of_body, closing_speed(m, bodies));
  }
}

/// An island in which something heavy arrives on something light becomes direct before it has sunk in. A soft
/// contact would give way like a spring of the lighter mass, since rows know no more.
void expect_arrivals(const std::vector<Manifold>& manifolds, const ContactStep& step, IslandMembers members,
                     DirectIslands& direct, Bodies& bodies) {
  const Real omega = std::sqrt(stiffness_of(step, false) / step.h);
  note_landings(manifolds, bodies, direct.landing);
  for (const Manifold& m : manifolds) {
    if (!joins(m, members, bodies)) continue;
    if (members[m.body_a] == Footing::kRagdoll || members[m.body_b] == Footing::kRagdoll) continue;
    if (bodies.direct_state[m.body_a] < 0 || bodies.direct_state[m.body_b] < 0) continue;  // refused
    const Real w_a = bodies.motion[m.body_a].inverse_mass;
    const Real w_b = bodies.motion[m.body_b].inverse_mass;
    const Real ratio = std::max(w_a, w_b) / std::min(w_a, w_b);
    const Real closing =
        std::max(ratio >= kArrivingMassRatio ? closing_speed(m, bodies) : Real(0),
                 ratio >= kLandingMassRatio ? direct.landing[w_a > w_b ? m.body_a : m.body_b] : Real(0));
    const Real size = Real(2) * state::thinner_radius(bodies, m.body_a, m.body_b);
    if (!(closing * std::sqrt(ratio) > kGrossExcess * kLargestSag * size * omega)) continue;
    for (const std::uint32_t body : {m.body_a, m.body_b}) {
      std::int8_t& state = bodies.direct_state[body];
      if (state < kDirect) state = kDirect + kStaysDirectSteps;
    }
  }
}

/// Numbers the islands with direct bodies by their lowest body, and lists their bodies.
void number_islands(std::span<const std::uint32_t> awake, const Bodies& bodies, DirectIslands& direct) {
  std::vector<std::uint32_t>& island_of = direct.island_of;
  island_of.assign(bodies.motion.size(), kNoIsland);
  for (const std::uint32_t body : awake) {
    if (bodies.direct_state[body] >= kDirect) island_of[direct.sets.root(body)] = 0;
  }
  direct.count = 0;
  for (const std::uint32_t body : awake) {
    const std::uint32_t root = direct.sets.root(body);
    if (!is_moved(bodies, body) || island_of[root] == kNoIsland) continue;
    if (root == body) {
      island_of[body] = static_cast<std::uint32_t>(direct.count++);
      if (static_cast<int>(direct.found.size()) < direct.count) direct.found.emplace_back();
      direct.found[direct.count - 1].bodies.clear();
      direct.found[direct.count - 1].edges.clear();
    }
    island_of[body] = island_of[root];
    direct.found[island_of[body]].bodies.push_back(body);
  }
}

void list_edges(const std::vector<Manifold>& manifolds, IslandMembers members, const Bodies& bodies,
                DirectIslands& direct) {
  for (const Manifold& m : manifolds) {
    if (!joins(m, members, bodies)) continue;
    const std::uint32_t island = direct.island_of[m.body_a];
    if (island == kNoIsland) continue;
    HOOKE_ASSERT(island < direct.found.size() && direct.island_of[m.body_b] == island);
    const std::uint32_t a = node_of(direct.found[island].bodies, m.body_a);
    const std::uint32_t b = node_of(direct.found[island].bodies, m.body_b);
    direct.found[island].edges.push_back({std::min(a, b), std::max(a, b)});
  }
  for (int i = 0; i < direct.count; ++i) {
    auto& edges = direct.found[i].edges;
    base::sort_unique(edges);
  }
}

/// Largest ratio of masses of a body and one below it that it touches.
Real heaviest_on_light(const DirectGraph& graph, Vec3 gravity, const Bodies& bodies) {
  Real most = Real(0);
  for (const auto& [a, b] : graph.edges) {
    const std::uint32_t body_a = graph.bodies[a];
    const std::uint32_t body_b = graph.bodies[b];
    const bool a_is_lower =
        dot(bodies.center[body_a] - bodies.center[body_b], vector_cast<double>(gravity)) > 0;
    const Real ratio = bodies.motion[body_a].inverse_mass / bodies.motion[body_b].inverse_mass;
    most = std::max(most, a_is_lower ? ratio : Real(1) / ratio);
  }
  return most;
}

/// Makes the pattern of an island's matrix. False if it costs too much; then no bodies own the island.
bool make_pattern(const DirectGraph& graph, double budget, DirectIslands& direct, DirectIsland& island) {
  HOOKE_ASSERT(std::is_sorted(graph.bodies.begin(), graph.bodies.end()));
  direct.matrix.reset(graph.bodies.size());
  for (const auto& [a, b] : graph.edges) direct.matrix.join(a, b);
  direct.sizes.assign(graph.bodies.size(), 6);
  if (!make_block_pattern(direct.matrix, direct.sizes, budget, island.pattern)) {
    island.graph.bodies.clear();
    return false;
  }
  island.graph = graph;
  island.slot.resize(graph.bodies.size());
  for (std::uint32_t i = 0; i < island.slot.size(); ++i) island.slot[island.pattern.order[i]] = i;
  return true;
}

/// Finds whether an island is within its budget, which is larger where something lies on what is much
/// lighter: soft contacts would not hold that even roughly. Bodies may have moved since the matrix was made.
bool is_within_budget(const DirectGraph& graph, Vec3 gravity, const Bodies& bodies, DirectIslands& direct,
                      DirectIsland& island) {
  if (graph.bodies.size() > kMaxDirectBodies) return false;
  const Real ratio = heaviest_on_light(graph, gravity, bodies) / kHeavyOnLightRatio;
  const double budget =
      std::clamp(static_cast<double>(ratio) * kDirectIslandBudget, kDirectIslandBudget, kDirectBudget);
  // What moves fast changes its contacts before a long search for them ends.
  const bool rests = std::none_of(graph.bodies.begin(), graph.bodies.end(), [&](std::uint32_t body) {
    return length(bodies.motion[body].v) > kDirectIslandSpeed;
  });
  island.newton_steps = ratio > Real(1) && rests ? kDirectHeavyNewtonSteps : kDirectNewtonSteps;
  island.most_work = (rests ? kDirectRestingBudget : 1) * kDirectStepBudget;
  return island.graph == graph ? island.pattern.operations <= budget
                               : make_pattern(graph, budget, direct, island);
}

/// For each island that was found: the largest speed at which its lighter bodies would leave their contacts
/// without their load of the last substep [m/s].
void find_loads(const std::vector<Manifold>& manifolds, IslandMembers members, const Bodies& bodies,
                DirectIslands& direct) {
  direct.loads.assign(static_cast<std::size_t>(direct.count), Real(0));
  for (const Manifold& m : manifolds) {
    if (!joins(m, members, bodies) || direct.island_of[m.body_a] == kNoIsland) continue;
    const Real w = std::max(bodies.motion[m.body_a].inverse_mass, bodies.motion[m.body_b].inverse_mass);
    Real& load = direct.loads[direct.island_of[m.body_a]];
    load = std::max(load, w * normal_impulse(m));
  }
}

/// Chooses islands within the budget: those with the largest loads come first.
void spend_budget(const std::vector<Manifold>& manifolds, IslandMembers members, const Bodies& bodies,
                  DirectIslands& direct) {
  find_loads(manifolds, members, bodies, direct);
  std::vector<int>& order = direct.order;
  order.resize(static_cast<std::size_t>(direct.count));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return direct.loads[a] > direct.loads[b]; });
  double cost = 0;
  for (const int i : order) {
    if (direct.fits[i] == 0) continue;
    const double operations = direct.islands[i].pattern.operations;
    direct.fits[i] = cost + operations <= kDirectBudget ? 1 : 0;
    if (direct.fits[i] != 0) cost += operations;
  }
}

/// Finds which islands are within the budget and not too large. An island whose bodies and contacts are those
/// of the step before keeps its matrix.
void find_islands_within_budget(const std::vector<Manifold>& manifolds, IslandMembers members, Vec3 gravity,
                                const Bodies& bodies, DirectIslands& direct) {
  const auto found = static_cast<std::size_t>(direct.count);
  if (direct.islands.size() < found) direct.islands.resize(found);
  direct.fits.assign(found, 0);
  direct.coupled.clear();
  double cost = 0;
  for (std::size_t i = 0; i < found; ++i) {
    const DirectGraph& graph = direct.found[i];
    HOOKE_ASSERT(!graph.bodies.empty());
    DirectIsland& island = direct.islands[i];
    const bool fits = is_within_budget(graph, gravity, bodies, direct, island);
    direct.fits[i] = fits ? 1 : 0;
    if (fits) cost += island.pattern.operations;
  }
  if (cost > kDirectBudget) spend_budget(manifolds, members, bodies, direct);
}

/// Whether the island has a body that is joined to something else.
bool is_joined(const DirectGraph& island, std::span<const std::uint8_t> joined) {
  return std::any_of(island.bodies.begin(), island.bodies.end(),
                     [&](std::uint32_t body) { return joined[body] != 0; });
}

/// Gives the contacts of coupled islands their way.
void couple_islands(const Joints& joints, const DirectIslands& direct, state::Tables& tables) {
  if (!direct.has_coupled()) return;
  const auto in_coupled = [&](std::uint32_t body) {
    return is_moved(tables.bodies, body) && direct.holds(body) && direct.coupled[direct.island_of[body]] != 0;
  };
  for (Manifold& m : tables.pairs.manifold) {
    if ((in_coupled(m.body_a) || in_coupled(m.body_b)) && may_be_coupled(m, tables.bodies, joints))
      m.route = state::ContactRoute::kCoupled;
  }
}

/// Keeps the islands that are within the budget and not solved in coupled groups.
void take_islands(Bodies& bodies, DirectIslands& direct) {
  const auto found = static_cast<std::size_t>(direct.count);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < found; ++i) {
    const bool fits = direct.fits[i] != 0;
    const bool taken_here = fits && direct.coupled[i] == 0;
    for (const std::uint32_t body : direct.found[i].bodies) {
      direct.island_of[body] = taken_here ? static_cast<std::uint32_t>(taken) : kNoIsland;
      if (fits) continue;
      // What would be direct for this step only, as new bodies are, is evaluated at its end like others.
      std::int8_t& state = bodies.direct_state[body];
      state = state == kDirect ? std::int8_t{0} : kRefusedSteps;
    }
    if (taken_here && taken != i) std::swap(direct.islands[taken], direct.islands[i]);
    taken += taken_here ? 1 : 0;
  }
  direct.count = static_cast<int>(taken);
}

/// Counts a costly step of an island, and refuses it after several of them on end.
void note_costly_step(const DirectIsland& island, DirectIslands& direct, Bodies& bodies) {
  // The steps that are left count down above kDirect, as in an island that asks for less.
  constexpr std::int8_t kFresh = kDirect + kMostCostlySteps;
  const std::int8_t before = direct.demands[direct.sets.root(island.graph.bodies.front())].most;
  const bool was_costly = before > kDirect && before <= kFresh;
  const std::int8_t left = was_costly ? static_cast<std::int8_t>(before - 1) : kFresh;
  for (const std::uint32_t body : island.graph.bodies)
    bodies.direct_state[body] = left == kDirect ? kRefusedSteps : left;
}

/// Islands share one budget of work. Those that cost least get it first, so that it serves most of them.
void share_step_budget(DirectIslands& direct, Bodies& bodies) {
  double sum = 0;
  for (const DirectIsland& island : direct.live()) sum += island.work;
  if (sum <= kDirectStepBudget) return;
  direct.order.resize(static_cast<std::size_t>(direct.count));
  std::iota(direct.order.begin(), direct.order.end(), 0);
  std::sort(direct.order.begin(), direct.order.end(), [&](int a, int b) {
    return std::pair(direct.islands[a].work, a) < std::pair(direct.islands[b].work, b);
  });
  double spent = 0;
  for (const int i : direct.order) {
    spent += direct.islands[i].work;
    if (spent > kDirectStepBudget) note_costly_step(direct.islands[i], direct, bodies);
  }
}

}  // namespace

void find_direct_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                         const IslandInputs& inputs, state::Tables& tables, DirectIslands& direct) {
  const std::vector<Manifold>& manifolds = tables.pairs.manifold;
  const IslandMembers members = inputs.members;
  Bodies& bodies = tables.bodies;
  direct.count = 0;
  direct.coupled.clear();
  HOOKE_ASSERT(std::is_sorted(awake.begin(), awake.end()) && members.size() == bodies.motion.size());
  expect_arrivals(manifolds, step, members, direct, bodies);
  const bool any = std::any_of(awake.begin(), awake.end(),
                               [&](std::uint32_t body) { return bodies.direct_state[body] >= kDirect; });
  if (!any) return;
  direct.sets.reset(bodies.motion.size());
  for (const Manifold& m : manifolds) {
    if (joins(m, members, bodies)) direct.sets.merge(m.body_a, m.body_b);
  }
  evaluate_new_bodies(awake, step, members, direct, bodies);
  for (const std::uint32_t body : awake) {
    if (members[body] == Footing::kHangs && bodies.direct_state[body] >= kDirect)
      bodies.direct_state[body] = 0;
  }
  number_islands(awake, bodies, direct);
  list_edges(manifolds, members, bodies, direct);
  find_islands_within_budget(manifolds, members, step.gravity, bodies, direct);
  for (std::size_t i = 0; i < direct.fits.size(); ++i)
    direct.coupled.push_back(direct.fits[i] != 0 && is_joined(direct.found[i], inputs.joined) ? 1 : 0);
  couple_islands(inputs.joints, direct, tables);
  take_islands(bodies, direct);
}

void prepare_direct_islands(parallel::ThreadPool& pool, const BodyContacts& contacts, const Bodies& bodies,
                            DirectIslands& direct) {
  if (direct.count == 0) return;
  for (DirectIsland& island : direct.live()) island.lanes.clear();
  for (int i = 0; i < static_cast<int>(contacts.blocks.size()); ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (block.route != state::ContactRoute::kDirect) continue;
    for (int lane = 0; lane < block.count; ++lane) {
      const std::uint32_t body = block.record_a[lane] / 16;
      HOOKE_ASSERT(direct.holds(body));
      DirectIsland& island = direct.islands[direct.island_of[body]];
      const std::size_t at = kContactLanes * static_cast<std::size_t>(i) + static_cast<std::size_t>(lane);
      island.lanes.push_back({.block = i, .lane = lane, .manifold = contacts.manifold_of[at]});
    }
  }
  parallel::for_ranges(pool, direct.count, 1, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) prepare_direct_rows(contacts, bodies, direct.islands[i]);
  });
}

void solve_direct_islands(parallel::ThreadPool& pool, const BodyStep& step, DirectIslands& direct,
                          BodyContacts& contacts, Bodies& bodies) {
  parallel::for_ranges(pool, direct.count, 1, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i)
      solve_direct_island(step, direct.islands[i], contacts, bodies);
  });
}

void evaluate_direct_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                             const BodyContacts& contacts, IslandMembers members, DirectIslands& direct,
                             Bodies& bodies) {
  // Without weight there are impacts, but no loads.
  if (step.gravity == Vec3{}) {
    for (const std::uint32_t body : awake) bodies.direct_state[body] = 0;
    return;
  }
  direct.demands.assign(bodies.motion.size(), {});
  direct.sets.reset(bodies.motion.size());
  evaluate_contacts(step, contacts, members, bodies, direct.sets, direct.demands);
  const Vec3 down = normalize(step.gravity);
  for (const std::uint32_t body : awake) {
    if (!is_moved(bodies, body)) continue;
    IslandDemand own = direct.demands[body];
    add_own_weight(bodies.motion[body].inverse_mass, step, own);
    own.low = own.high = dot(down, vector_cast<Real>(bodies.center[body]));
    own.refused = is_refused(bodies, body);
    own.least = own.most = steps_of(bodies, body);
    // Ragdolls are solved in turn with soft contacts only, and soft islands that are fast fall anyway.
    const bool falls = own.most < kDirect && length(bodies.motion[body].v) > kDirectIslandSpeed;
    own.stays_soft = members[body] != Footing::kStands || falls;
    if (own.stays_soft) own.least = std::min(own.least, std::int8_t{-1});
    own.count = 1;
    const std::uint32_t root = direct.sets.root(body);
    if (root == body) direct.demands[body] = {.sag = own.sag, .buckling = own.buckling};
    add_demand(own, direct.demands[root]);
  }
  for (const std::uint32_t body : awake) {
    if (!is_moved(bodies, body)) continue;
    const std::uint32_t root = direct.sets.root(body);
    const IslandDemand& island = direct.demands[root];
    bodies.direct_state[body] = evaluate(island);
  }
  share_step_budget(direct, bodies);
}

}  // namespace hooke::solver
