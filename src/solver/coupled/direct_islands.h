#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "parallel/thread_pool.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/direct_contacts.h"
#include "solver/coupled/load_bearing_contacts.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// Which contacts are solved directly: those of islands that soft contacts do not hold.
///
/// The order of calls:
///   find_hard_islands, prepare_body_contacts, prepare_hard_islands    once a step
///   solve_hard_islands, in place of solve_body_contacts               each substep
///   judge_hardness                                                    once, at the end
///
/// A soft contact that carries the impulse lambda overlaps by sag = gamma lambda / (m mu beta)
/// (body_contacts.h). Of an island, a the size of the smaller body of a contact and H the island's height
/// along gravity, two ratios are judged:
///
///   sag / a          what is seen                                              at most 0.5 %
///   sag H^2 / a^3    1.9 where a column of cubes buckles (docs/decisions/0004)  at most 0.3
///
/// An island that exceeds one of them in two steps on end, or five times in one, is hard until it has kept
/// both by 0.6 for 30 steps. One whose bodies are all new (state::Bodies::kNew) is hard in its first step:
/// soft contacts learn in some steps what they carry, and what was placed in balance sinks and sways
/// meanwhile. The sag follows from the impulse, which the direct solution knows too, so an island is judged
/// alike in both. It is at least what a body's own weight needs, shared by what it rests on.

namespace hooke::solver {

/// Multiplications of one factorization, of one island and of all: some milliseconds a step.
inline constexpr double kDirectIslandBudget = 4e4;
inline constexpr double kDirectBudget = 1e6;
inline constexpr std::uint32_t kMaxDirectBodies = 256;

/// hardness of a body: below 0 its island was refused and is not judged for as many steps, then steps in
/// which it has asked for a direct solution, and from kHard on it is hard for as many steps and more.
inline constexpr std::int8_t kDirect = 2;

/// Who may be in a hard island, by body row. What hangs is no member: its contacts stay soft, whatever its
/// neighbors are. Islands with a body of a ragdoll stay soft as a whole.
using IslandMembers = std::span<const Footing>;

/// What an island asks for; of each body at first, then of all at its root.
struct IslandDemand {
  Real sag = Real(0);                                     ///< Over the size.
  Real buckling = Real(0);                                ///< sag / size^3 [1/m^2]
  Real support_stiffness = Real(0);                       ///< Of what it rests on; see add_own_weight.
  Real thinnest = std::numeric_limits<Real>::infinity();  ///< Size at these [m].
  Real low = std::numeric_limits<Real>::infinity();       ///< Along gravity [m].
  Real high = -std::numeric_limits<Real>::infinity();
  std::uint32_t count = 0;
  std::int8_t least = std::numeric_limits<std::int8_t>::max();  ///< Hardness.
  std::int8_t most = std::numeric_limits<std::int8_t>::min();
};

struct DirectIslands {
  static constexpr std::uint32_t kNoIsland = 0xFFFFFFFF;

  std::vector<DirectIsland> islands;  ///< The first `count` are those of this step, by lowest body.
  int count = 0;
  std::uint32_t refused = 0;  ///< Hard, but over the budget.

  // Scratch, to be used again.
  base::DisjointSets sets;
  std::vector<std::uint32_t> island_of;  ///< By body row.
  std::vector<DirectGraph> found;
  std::vector<std::uint8_t> fits;     ///< Of `found`: within the budget.
  std::vector<Real> loads;            ///< Of `found` [m/s].
  std::vector<int> order;             ///< Of `found`, by load.
  BlockGraph matrix;                  ///< Of one island.
  std::vector<int> sizes;             ///< Of its blocks.
  std::vector<IslandDemand> demands;  ///< By body row.

  /// Whether the body is in an island of this step.
  [[nodiscard]] bool holds(std::uint32_t body) const { return count > 0 && island_of[body] != kNoIsland; }
  [[nodiscard]] std::span<DirectIsland> live() { return {islands.data(), static_cast<std::size_t>(count)}; }
};

/// Islands of direct bodies, with all that touches them.
/// `awake` are rows in ascending order. No body is new after it.
void find_direct_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                         const std::vector<state::Manifold>& manifolds, IslandMembers members,
                         state::Bodies& bodies, DirectIslands& direct);

/// The rows of their contacts.
void prepare_direct_islands(parallel::ThreadPool& pool, const BodyContacts& contacts,
                            const state::Bodies& bodies, DirectIslands& direct);

/// One substep.
void solve_direct_islands(parallel::ThreadPool& pool, const BodyStep& step, DirectIslands& direct,
                          BodyContacts& contacts, state::Bodies& bodies);

/// Updates the hardness of bodies by the impulses of the last substep.
void evaluate_direct_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                             const BodyContacts& contacts, IslandMembers members, DirectIslands& direct,
                             state::Bodies& bodies);

}  // namespace hooke::solver
