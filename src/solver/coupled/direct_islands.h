#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "parallel/thread_pool.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/direct_contacts.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/coupled/load_bearing_contacts.h"
#include "state/bodies.h"
#include "state/tables.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// Which contacts are solved directly: those of islands that soft contacts do not hold.
///
/// The order of calls:
///   find_direct_islands, prepare_body_contacts, prepare_direct_islands    once a step
///   solve_direct_islands, in place of solve_body_contacts                 each substep
///   evaluate_direct_islands                                               once, at the end
///
/// A soft contact that carries the impulse lambda overlaps by sag = gamma lambda / (m mu beta)
/// (solver/contact/body_contacts.h). With a the size of the smaller body of a contact and H the island's
/// height along gravity, two ratios of an island are evaluated:
///
///   sag / a          what is seen                                              at most 0.5 %
///   sag H^2 / a^3    1.9 where a column of cubes buckles (docs/decisions/0004)  at most 0.3
///
/// An island that exceeds one of them in two consecutive steps, or five times in one step, is solved directly
/// until it has stayed below 0.6 of both for 30 steps. A body that arrives on a lighter one would sink by
/// v sqrt(ratio of masses) / omega, as on a spring of the lighter mass: if that is beyond five times the
/// first ratio, the island is direct at once. An island whose bodies are all new (state::Bodies::kNew) is
/// direct in its first step: soft contacts need some steps to learn what they carry, and meanwhile a balanced
/// structure sinks and sways. The sag follows from the impulse, which the direct solution knows too, so both
/// are evaluated alike. The sag is at least what a body's own weight needs, shared by what the body rests on.

namespace hooke::solver {

/// What carries each body, by body row: it decides who may be in a direct island. What hangs is no member:
/// its contacts stay soft, whatever its neighbors are. Islands with a body of a ragdoll stay soft as a whole.
using IslandMembers = std::span<const Footing>;

/// What islands are found from.
struct IslandInputs {
  IslandMembers members;
  std::span<const std::uint8_t> joined;  ///< By body row; see solver/coupled/coupled_manifolds.h.
  const Joints& joints;
};

/// What an island asks for; first of each body, then of the whole island at its root.
struct IslandDemand {
  Real sag = Real(0);                ///< Largest sag over the size.
  Real buckling = Real(0);           ///< Largest sag / size^3 [1/m^2].
  Real support_stiffness = Real(0);  ///< Stiffness of what the body rests on; see add_own_weight.
  Real thinnest = std::numeric_limits<Real>::infinity();  ///< Smallest size at these contacts [m].
  Real low = std::numeric_limits<Real>::infinity();       ///< Lowest coordinate along gravity [m].
  Real high = -std::numeric_limits<Real>::infinity();
  std::uint32_t count = 0;
  bool stays_soft = false;  ///< Whether it falls, or has bodies that do not stand.
  bool refused = false;     ///< Whether it asked for a direct solution before, and was refused.
  std::int8_t least = std::numeric_limits<std::int8_t>::max();  ///< Smallest direct_state, or steps to wait.
  std::int8_t most = std::numeric_limits<std::int8_t>::min();
};

struct DirectIslands {
  static constexpr std::uint32_t kNoIsland = 0xFFFFFFFF;

  std::vector<DirectIsland> islands;  ///< The first `count` are those of this step, by lowest body.
  int count = 0;

  // Scratch memory.
  base::DisjointSets sets;
  std::vector<std::uint32_t> island_of;  ///< By body row.
  std::vector<DirectGraph> found;
  std::vector<std::uint8_t> fits;     ///< For each of `found`: whether it is within the budget.
  std::vector<std::uint8_t> coupled;  ///< For each of `found`: whether coupled groups solve it.
  std::vector<Real> loads;            ///< For each of `found` [m/s].
  std::vector<int> order;             ///< Indices of `found`, by load.
  BlockGraph matrix;                  ///< Graph of one island's matrix.
  std::vector<int> sizes;             ///< Sizes of its blocks.
  std::vector<IslandDemand> demands;  ///< By body row.
  std::vector<Real> landing;          ///< By body row [m/s].

  /// Whether the body is in an island of this step.
  [[nodiscard]] bool holds(std::uint32_t body) const { return count > 0 && island_of[body] != kNoIsland; }
  /// Whether coupled groups solve some of `found`.
  [[nodiscard]] bool has_coupled() const {
    return std::find(coupled.begin(), coupled.end(), 1) != coupled.end();
  }
  [[nodiscard]] std::span<DirectIsland> live() { return {islands.data(), static_cast<std::size_t>(count)}; }
};

/// Whether the island of the body asked for a direct solution and was refused: its contacts are soft, and
/// sink more than they may.
[[nodiscard]] inline bool is_refused(const state::Bodies& bodies, std::uint32_t body) {
  return bodies.direct_state[body] < kNotEvaluatedSteps;
}

/// Finds the islands of direct bodies, with all that touches them. `awake` are rows in ascending order.
/// Afterwards no body is new. Islands with a body that is `joined` are no direct islands: their contacts get
/// the way "coupled".
void find_direct_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                         const IslandInputs& inputs, state::Tables& tables, DirectIslands& direct);

/// Makes the rows of their contacts.
void prepare_direct_islands(parallel::ThreadPool& pool, const BodyContacts& contacts,
                            const state::Bodies& bodies, DirectIslands& direct);

/// Solves one substep.
void solve_direct_islands(parallel::ThreadPool& pool, const BodyStep& step, DirectIslands& direct,
                          BodyContacts& contacts, state::Bodies& bodies);

/// Updates the direct_state of bodies by the impulses of the last substep.
void evaluate_direct_islands(std::span<const std::uint32_t> awake, const ContactStep& step,
                             const BodyContacts& contacts, IslandMembers members, DirectIslands& direct,
                             state::Bodies& bodies);

}  // namespace hooke::solver
