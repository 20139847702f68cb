#pragma once

#include "hooke/math.h"

#include "solver/body/body_motion.h"
#include "solver/contact/body_contacts.h"
#include "solver/linear/block_matrix.h"
#include "state/bodies.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

/// \file
/// The contacts of one island of bodies, solved as a whole: rigid, with friction, in double.

namespace hooke::solver {

/// What a row does to the velocities of one body, or to those of a node. Nodes use the scaled coordinates of
/// state/bodies.h with v / sqrt(w) in place of v, so that masses are one.
using DirectLever = std::array<double, 6>;

struct DirectRow {
  DirectLever a = {};      ///< Signed: the rate of the row is a.u_a + b.u_b + drift.
  DirectLever b = {};      ///< If B does not move: for its v and omega as they are.
  double mass = 0;         ///< Effective mass [kg or kg m^2].
  double stiffness = 0;    ///< D: impulse per rate [kg or kg m^2].
  double separation = 0;   ///< Separation of a point, at the start of the step [m].
  double twist_lever = 0;  ///< Largest twist impulse per impulse of a point [m].
  double drift = 0;        ///< Rate by bodies that do not move, conveyors, and gaps that may close [m/s].
  double before = 0;       ///< Impulse that the solution starts from [N s].
  double impulse = 0;      ///< [N s]
  double rate = 0;         ///< Rate at the present velocities.
  double slope = 0;        ///< Change of the rate along the present search direction.
  bool touches = false;    ///< The point has no gap.
  bool holds = false;      ///< Its impulse follows its rate: it is at no bound.
};

/// A manifold of the island: rows of its points, then two of friction, then twist.
struct DirectContact {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  int block = 0, lane = 0;         ///< Its lane of BodyContacts.
  std::uint32_t a = 0, b = kNone;  ///< Nodes; b is kNone where only A moves.
  int first = 0;                   ///< Index of its first row.
  int points = 0;
  double slop = 0;         ///< Overlap, or gap, that counts as none [m].
  double friction = 0;     ///< Coefficient, of rest or of sliding.
  double limit = 0;        ///< Largest friction impulse [N s].
  double twist_limit = 0;  ///< [N m s]
  // Blocks of the matrix, by their first number.
  std::uint32_t diagonal_a = 0, diagonal_b = 0, between = 0;
  bool b_is_row = false;  ///< In the block between: b comes after a in the order of elimination.
};

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
///   |u - u_0|^2 / 2 + sum of phi over all rows,    impulse = -phi'
///   point      impulse = max(0, before - D (rate + s/h if apart, s > slop))
///   friction   impulse = before - D rate, cut to the disc of radius mu N
///   twist      the same, cut to an interval
///
/// It is found by Newton steps with exact search along them. D is large (kDirectStiffness effective masses)
/// and `before` is the impulse of the last substep, so that D is no compliance at rest: what stands, stands
/// still. N is the load of the solution before; where something slides, it is solved again with the new load.
/// The matrix 1 + J^T D J is positive definite whatever touches what.
///
/// Rates alone do not remove errors of position. Once a step the same matrix moves the bodies to where
/// overlaps beyond a tiny slop are half as deep. That adds no velocity.
///
/// Sources: Newton for piecewise quadratic energies of contact, e.g. Todorov 2014, "Convex and analytically
/// invertible dynamics"; multipliers kept from step to step: Hestenes 1969, "Multiplier and gradient
/// methods".
struct DirectIsland {
  DirectGraph graph;
  BlockPattern pattern;
  std::vector<std::uint32_t> slot;  ///< Position of each node in the order of elimination.

  // Lives for one step.
  std::vector<DirectContact> contacts;
  std::vector<DirectRow> rows;
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
