#pragma once

#include "hooke/math.h"

#include "solver/body/body_motion.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/direct_rows.h"
#include "solver/linear/block_matrix.h"
#include "state/bodies.h"

#include <cstdint>
#include <utility>
#include <vector>

/// \file
/// The contacts of one island of bodies, solved as a whole: rigid, with friction, in double.

namespace hooke::solver {

/// Bodies and who touches whom.
struct DirectGraph {
  std::vector<std::uint32_t> bodies;                           ///< Body rows, ascending: the nodes.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< Pairs of nodes, ascending.

  friend bool operator==(const DirectGraph&, const DirectGraph&) = default;
};

/// The node of a body that is among `bodies`.
[[nodiscard]] std::uint32_t node_of(const std::vector<std::uint32_t>& bodies, std::uint32_t body);

/// Bodies that contacts join to each other, and all their contacts.
///
/// With u the velocities of a substep and u_0 those without the contacts, the solution is the least of
///
///   |u - u_0|^2 / 2 + sum of phi over all rows (solver/contact/direct_rows.h)
///
/// It is found by Newton steps with exact search along them. The matrix 1 + J^T D J is positive definite
/// whatever touches what.
///
/// Rates alone do not remove errors of position. Once a step the same matrix moves the bodies to where
/// overlaps beyond a tiny slop are half as deep. That adds no velocity.
struct DirectIsland : DirectRows {
  DirectGraph graph;
  BlockPattern pattern;
  std::vector<std::uint32_t> slot;  ///< Position of each node in the order of elimination.

  // Lives for one step.
  std::vector<ContactLane> lanes;  ///< Its contacts.
  int newton_steps = 0;            ///< Most Newton steps in a round of friction.
  double most_work = 0;            ///< Multiplications of all factorizations that it may take.
  double work = 0;                 ///< Those that it has taken.

  // Lives for one substep. Six numbers a node, in the order of elimination.
  std::vector<double> free;       ///< u_0
  std::vector<double> velocity;   ///< u
  std::vector<double> direction;  ///< Search direction; gradient before that.
  std::vector<double> factors;
  std::vector<double> factor_scratch;
  double stiffness = 0;
  std::vector<std::uint8_t> cached_holds;  ///< Which rows hold in cached_factors.
  std::vector<double> cached_factors;
  double cached_stiffness = 0;
};

/// Called at the start of a step, after prepare_body_contacts: makes the rows of the island's contacts.
void prepare_direct_rows(const BodyContacts& contacts, const state::Bodies& bodies, DirectIsland& island);

/// Solves for the velocities of the island's bodies in a substep, and the impulses of its contacts. In the
/// first substep of a step it also removes overlaps, at most 5 cm.
void solve_direct_island(const BodyStep& step, DirectIsland& island, BodyContacts& contacts,
                         state::Bodies& bodies);

}  // namespace hooke::solver
