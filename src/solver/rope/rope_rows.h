#pragma once

#include "math/symmetric.h"
#include "solver/rope/rope_kernels.h"
#include "solver/rope/rope_systems.h"
#include "solver/rope/rope_tuning.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// Ropes in solver form: what is common to solving them alone (solver/rope/rope_systems.cpp) and in coupled
/// groups (solver/coupled/coupled_groups.cpp). Equations: solver/rope/rope_systems.h.

namespace hooke::solver {

struct RopeNode {
  DVec3 x, v_free, v_before;         ///< Position, velocity with forces, velocity before forces.
  double mass = 0, w = 0;            ///< The node is held where w = 0.
  DVec3 u;                           ///< Velocity, the result.
  DVec3 target;                      ///< v*: free velocity with what contacts do to it.
  math::Symmetric3<double> inverse;  ///< W
};

struct RopeSegment {
  std::uint32_t a = 0;  ///< First node; b is the next one.
  DVec3 n, offset;
  math::Symmetric3<double> compliance;  ///< E
  DVec3 q;                              ///< Impulse of the segment.
  wide::SegmentTraits<double> traits = {};
  double tension_bound = 0;      ///< T+
  double along = 0, across = 0;  ///< Stiffness along n and across it, E^-1.
  bool limited = false;
};

/// Resistance to bending at an inner node. The moment follows from the change c of direction at the substep's
/// start, from the growth of its rate r since before the substep, and from a little of r itself:
/// B (c + h beta (r - r0) + h delta r), with beta and delta of solver/rope/rope_tuning.h (Newmark 1959, "A
/// method of computation for structural dynamics"). A rope that whips has its segments linearized anew. Its
/// bends then use c of the substep's end, which takes more energy. The change of direction there is m_e -
/// m_d, with the two segments' vectors over their lengths; its size is 2 sin(angle / 2).
struct RopeBend {
  std::uint32_t node = 0;
  double before = 0, behind = 0;  ///< 1 / length of the segments [1/m].
  double stiffness = 0;           ///< EI over the length that bends here [N m].
  double damping = 0;             ///< [N m s]
  double gamma = 0;
  DVec3 target;   ///< Target of the rate at which the change of direction grows.
  DVec3 impulse;  ///< [N m s]

  /// Moment per rate in a substep of length h [s]: [N m s].
  [[nodiscard]] double resistance(double h, bool whips) const {
    return damping + (whips ? 1 : kBendNewmark + kBendDamping) * h * stiffness;
  }
};

/// A contact of a node, or a tether. A tether holds a point within a distance of its pin: it acts like a
/// plane across the line to the pin, without friction.
struct RopeContactRow {
  static constexpr std::uint32_t kTether = 0xFFFFFFFF;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::uint32_t row = 0, node = 0;
  double rho = 0, rho_across = 0;  ///< Stiffness along the normal and of friction [kg].
  DVec3 n, f0, f;
  DVec3 against;     ///< Direction of friction on a node that slides.
  double trial = 0;  ///< Size of the impulse that would have held a sliding node [N s].
  DVec3 surface;     ///< Velocity of the touched surface at the contact [m/s].
  int body = -1;     ///< A body of a coupled group whose velocity is solved for; -1: `surface` is given.
  DVec3 lever;       ///< Offset of the contact from that body's center [m].
  DVec3 belt;        ///< Velocity of the surface relative to that body [m/s].
  double separation = 0, friction = 0, n0 = 0, normal = 0;
  bool active = false, slides = false;
  bool let_go = false;         ///< No contact for the rest of the substep: it pulled too often.
  bool dragged = false;        ///< Friction acts as drag for the rest of the substep: it drove.
  bool of_point = false;       ///< Whether the particle belongs to no rope.
  std::uint32_t load = kNone;  ///< Row of SurfaceContacts::loads, if it is one: `row` is kTether then.
  double w = 0;                ///< Of a point: its inverse mass [1/kg].
  double drag = 0;  ///< Friction over speed of a point or dragged contact: rho, or mu N over speed [kg].

  [[nodiscard]] bool is_load() const { return load != kNone; }
};

/// How a rope's segments are linearized.
struct RopeSetting {
  double compliance = kComplianceInAir;
  DVec3 turning = {};  ///< Angular velocity of the line between the rope's ends [rad/s].
  bool first = true;   ///< At the start of the substep; later rows are linearized about the last result.
};

/// Several ropes in sequence: the nodes and segments of one, then of the next.
struct RopeScratch {
  std::vector<RopeNode> nodes;
  std::vector<RopeSegment> segments;
  std::vector<RopeBend> bends;
  std::vector<RopeContactRow> contact_rows;  ///< In order of nodes.

  void clear() {
    nodes.clear();
    segments.clear();
    bends.clear();
    contact_rows.clear();
  }
};

/// Appends a rope's nodes, segments and contacts to `s`. `before` holds velocities from before the forces.
void load_rope(const RopeSystem& rope_system, const std::vector<state::VelocityRecord>& before, double h,
               const state::Tables& tables, RopeScratch& s);

/// The constants of a segment; `lighter` is the mass of its lighter end [kg].
[[nodiscard]] wide::SegmentTraits<double> segment_traits(std::size_t row, double lighter, double h,
                                                         const state::Segments& segments);

/// Appends the contacts of a rope whose nodes begin at `first_node`, except those of held nodes.
void load_contact_rows(const RopeSystem& rope_system, std::uint32_t first_node, double h,
                       const state::Tables& tables, std::vector<RopeContactRow>& contact_rows);

/// Adds what presses on a rope whose nodes begin at `first_node` through surfaces (SurfaceContacts::loads),
/// in the order of nodes.
void load_loads(const RopeSystem& rope_system, std::uint32_t first_node, double h,
                const SurfaceContacts& surfaces, const state::Tables& tables,
                std::vector<RopeContactRow>& contact_rows);

/// Updates a row of load_loads. Returns whether it switched on or off.
bool update_load(double h, DVec3 u, RopeContactRow& t);

/// Writes the impulses of such rows.
void store_loads(std::span<const RopeContactRow> contact_rows, SurfaceContacts& surfaces);

/// One particle outside of ropes, and what it may be held by.
struct PointInContact {
  const RopeNode& node;
  std::uint32_t index = 0;                 ///< Number of the node.
  std::size_t first = 0, end = 0;          ///< Its contacts are [first, end).
  std::span<const std::uint32_t> tethers;  ///< The tethers that hold it, rows of springs.
  double heaviest = 0;                     ///< Mass of the heaviest of what else presses on it [kg].
};

/// Appends the contacts of a point and its tethers. Overlap does not become speed
/// (solver/soft/particle_contact_solve.h).
void load_point_contact_rows(const PointInContact& point, double h, const state::Tables& tables,
                             std::vector<RopeContactRow>& contact_rows);

/// Loads the bend between the segments of `row` and the next. At a clamp (solver/rope/rope_clamps.h) only
/// half a segment bends, and beside a segment that has broken nothing does.
[[nodiscard]] RopeBend load_bend(const RopeSystem& rope_system, std::size_t row,
                                 const state::Segments& segments);

/// Mass of the lighter of two nodes that move; 1 if neither does [kg]. The inverse mass of a held node is 0.
[[nodiscard]] inline double lighter_end(double mass_a, double inverse_a, double mass_b, double inverse_b) {
  constexpr double kHeld = std::numeric_limits<double>::infinity();
  const double m = std::min(inverse_a > 0 ? mass_a : kHeld, inverse_b > 0 ? mass_b : kHeld);
  return m < kHeld ? m : 1.0;
}

/// T+ at the start of a substep [N].
[[nodiscard]] inline double first_tension_bound(std::size_t row, const state::Segments& segments) {
  return std::max(0.0, static_cast<double>(segments.tension[row]));
}

/// Loads one node, as load_rope does.
[[nodiscard]] inline RopeNode load_node(std::uint32_t particle, Vec3 before,
                                        const state::Particles& particles) {
  return {.x = vector_cast<double>(particles.position[particle].x),
          .v_free = vector_cast<double>(particles.velocity[particle].v),
          .v_before = vector_cast<double>(before),
          .mass = static_cast<double>(particles.mass[particle]),
          .w = static_cast<double>(particles.velocity[particle].inverse_mass),
          .u = {},
          .target = {},
          .inverse = {}};
}

/// How a rope of length `rest` [m] is linearized at the start of a substep. `line` and `speed` go from its
/// first node to its last.
[[nodiscard]] RopeSetting first_setting(std::span<const RopeContactRow> contact_rows, double rest, DVec3 line,
                                        DVec3 speed);
/// The same for the rope that was loaded last.
[[nodiscard]] RopeSetting first_setting(std::size_t first_node, std::size_t first_segment,
                                        std::size_t first_contact_row, const RopeScratch& s);

/// Sets up the segment's equation u_b - u_a = offset + compliance q.
void linearize(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes,
               RopeSegment& segment);

/// Appends the bends of a rope whose nodes begin at `first_node`.
void load_bends(const RopeSystem& rope_system, std::size_t first_node, const state::Segments& segments,
                RopeScratch& s);
/// Sets up the bend's equation r = target - gamma * impulse in a substep of length h [s].
void linearize(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes, RopeBend& bend);

/// Finds W and v* of every node, with its contacts.
void constrain_nodes(double h, RopeScratch& s);

/// Calls visit(rows) with the contact rows of each node that has any; rows are in order of nodes.
template <class Visit>
void for_each_node_in_contact(std::span<RopeContactRow> contact_rows, Visit&& visit) {
  for (std::size_t first = 0; first < contact_rows.size();) {
    std::size_t end = first;
    while (end < contact_rows.size() && contact_rows[end].node == contact_rows[first].node) ++end;
    visit(contact_rows.subspan(first, end - first));
    first = end;
  }
}

/// What the contacts make of a node: its mass with their stiffness, and the impulse that gives it v*.
struct NodeConstraint {
  math::Symmetric3<double> mass;
  DVec3 impulse;
};
[[nodiscard]] NodeConstraint node_constraint(std::span<const RopeContactRow> at_node, const RopeNode& node,
                                             double h);

/// The mass that a contact adds to its node: the change of the impulse on it per velocity.
[[nodiscard]] math::Symmetric3<double> contact_stiffness(const RopeContactRow& contact_row);

/// The impulse of a contact on its node, without the part of contact_stiffness, which depends on velocities.
[[nodiscard]] DVec3 push_of(const RopeContactRow& contact_row, double h);

/// What contacts still lack after a solution. Rope contacts that switched on or off, or slide otherwise, are
/// corrected in the next substep if they must be. Fast impacts and contacts that drive a rope do not wait
/// for it.
struct Unconverged {
  bool ropes = false, points = false;
  bool impacts = false;  ///< A rope meets something faster than kRopeImpactSpeed.
  bool pulls = false;    ///< A rope contact pulls across a gap, or its friction drives: it makes energy.

  void add(const Unconverged& other) {
    ropes = ropes || other.ropes;
    points = points || other.points;
    impacts = impacts || other.impacts;
    pulls = pulls || other.pulls;
  }
};

/// Whether the energy that a contact gives to a mass counts: more than that of 1 cm/s. A pull where there is
/// no gap gives none.
[[nodiscard]] inline bool is_work(double energy, double mass) {
  return energy > kRopeLeastWork * mass;
}

/// Updates a rope contact's force by u. Where contacts may only `let_go`, none comes into effect any more,
/// so that none pulls in the last solution.
Unconverged update_contact_row(double h, bool let_go, const RopeNode& node, RopeContactRow& contact_row);

/// Updates all contacts likewise, also those of points.
[[nodiscard]] Unconverged update_contact_rows(double h, bool let_go, RopeScratch& s);

/// Returns the largest relative length error left in a rope; raises T+ and moves segments onto or off their
/// limits.
double check_segments(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes,
                      std::span<RopeSegment> segments, bool& limits_changed);

/// How many solutions a substep takes at least, by what update_contact_rows returned.
[[nodiscard]] int least_solves(std::span<const RopeContactRow> contact_rows, const Unconverged& unconverged);

/// Whether contacts that pull are let go for good.
[[nodiscard]] inline bool lets_go(int solves) {
  return solves >= kMostRopeSolves;
}

/// Whether to solve once more after `solves`. A rope jammed between floor and wall may not come to its
/// length because friction pushes nodes that no longer move against it, which makes energy. After
/// kMostRopeSolves friction is let go for this substep, and the rope gets as many solutions without it.
[[nodiscard]] bool solve_again(int solves, double error, bool pulls, std::span<RopeContactRow> contact_rows);

[[nodiscard]] bool is_finite(const RopeScratch& s);

/// Writes back the tension of a segment [N]; its mean is summed over the step.
void store_tension(std::size_t row, double tension, bool limited, state::Segments& segments);

/// Writes back one rope, which begins at node `first_node` and segment `first_segment`.
void store_rope(const RopeSystem& rope_system, std::size_t first_node, std::size_t first_segment, double h,
                const RopeScratch& s, state::Tables& tables);

void store_contact_rows(double h, std::span<const RopeContactRow> contact_rows, state::Contacts& contacts);

}  // namespace hooke::solver
