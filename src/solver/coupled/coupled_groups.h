#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "math/symmetric.h"
#include "solver/joint_rows/hook_rows.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/linear/block_matrix.h"
#include "solver/rope/rope_rows.h"
#include "solver/rope/rope_systems.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Ropes with what they are tied to. A rope alone is a chain (solver/rope/rope_systems.h); what hooks at
/// points join, or a rope or particle that lies on a moving body, is a bundle and solved as a whole.

namespace hooke::solver {

/// How a body's velocity V = (sqrt(m) v, omega~) moves a place along a direction: row . V; and such a V.
struct BodyRow {
  DVec3 linear, angular;

  [[nodiscard]] double at(int i) const { return component(i < 3 ? linear : angular, i % 3); }
  BodyRow& operator+=(const BodyRow& other) {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
  friend BodyRow operator*(double s, const BodyRow& row) { return {s * row.linear, s * row.angular}; }
  friend double dot(const BodyRow& a, const BodyRow& b) {
    return hooke::dot(a.linear, b.linear) + hooke::dot(a.angular, b.angular);
  }
};

/// A body of a bundle while it is solved.
struct CoupledBody {
  JointBody body;                      ///< Before the solution.
  math::Symmetric3<double> stiffness;  ///< h^2 S K S of the hooks' forces.
  math::Symmetric3<double> excess;     ///< What of it is implicit.
  math::Symmetric3<double> found;      ///< The stiffness of the forces found last.
  DVec3 v = {};                        ///< The result.
  DVec3 omega_scaled = {};
};

/// A contact between points of a rope or a cloth, of a rope with a rope, or of a body that is borne, while it
/// is solved.
struct CoupledContact {
  static constexpr int kRows = 3;  ///< Along the normal and two across.

  std::array<std::uint32_t, 4> node = {};  ///< As `particle` of its row; none of what is borne.
  std::array<double, 4> weight = {};
  std::uint32_t count = 0;
  double separation = 0, friction = 0;
  double mobility = 0;    ///< 1 / the mass that resists at the place, roughly [1/kg].
  double push_out = 0;    ///< Largest speed at which an overlap leaves [m/s].
  double resistance = 0;  ///< The same for what slides; a first guess [1/kg].
  DVec3 surface;          ///< Velocity of the surface against its body; the whole if that is given [m/s].
  DVec3 lever;            ///< From the body's center [m].
  DVec3 lever_b;          ///< Of what is borne, from the center of that body [m].
  double normal = 0;      ///< Impulse [N s].
  DVec3 f;                ///< Of friction [N s].
  double drag = 0;        ///< Of what slides: mu N over its speed [kg].
  bool near = false;      ///< It may act within this substep.
  bool active = false, slides = false;
  bool let_go = false;  ///< For the rest of the substep: it pulled too often.
  bool firm = false;    ///< Of ropes and of what is borne: pushes apart by speed, and is solved to the end.
};

/// Unknown are the impulses of rope segments q and of hook rows lambda, and the velocities V = (sqrt(m) v,
/// omega~) of bodies. With B the Jacobians at particles, C those at bodies, W the particles' inverse masses
/// with what touches them, P the grip of contacts on bodies and R = P J:
///
///   particles   u = v* + W (B^T l + R V)
///   rows        B u + C V + E l = target,          l = (q, lambda), E by chains.h and joint_rows.h
///   bodies      (1 + G) (V - V0) + 0.2 G V0 = C^T l - J^T (k + P (J V - u)),   G by articulations.h
///
/// where k is the part of a contact's impulse that does not depend on velocities. Particles are eliminated by
/// hand; what is left in (l, V) is quasi-definite and is factored in an order of little fill: ropes between
/// hooks first, in time proportional to their length, as a chain would be. Newton steps, contacts inside the
/// solution and their repetition are those of a chain. Rows with bounds join and leave as in an articulation.
///
/// A rope that resists bending has a vector row at each inner node, the change of direction there, with the
/// compliance of a spring of EI over the length between the middles of the two segments.
///
/// Particles of cloths, solids and groups that touch a body which gives way are points without rows, held by
/// their contacts and tethers alone: docs/decisions/0011-ties.md.
///
/// A contact between points (state::InnerContact) has the rows of a hook at its place: along the normal,
/// which only pushes, and two across for friction. What sticks is held; what slides is dragged with mu N over
/// its speed, N and the speed of the solution before: however wrong they are, that takes energy. Along the
/// normal those of ropes are as soft as contacts of nodes are, and carry their force over like these.
///
/// A share of 1e-6 of each hook row's diagonal is added as compliance, 1e-10 of a motor's: it decides what
/// loops of rigid ropes leave undetermined. A hook that slides along a rope (HookKind::kRopeSlide) holds b
/// across the rope, whose direction at b is that of its points blended along the segment.
struct CoupledGroup {
  std::vector<std::uint32_t> rope_systems;      ///< In order.
  std::vector<std::uint32_t> points;            ///< Particles of no rope, in order of rows.
  std::vector<std::uint32_t> hooks;             ///< Rows, in order.
  std::vector<std::uint32_t> element_contacts;  ///< Contacts between points: rows, in order.
  std::vector<std::uint32_t> rope_contacts;     ///< Rows, in order.
  std::uint32_t refused = 0;                    ///< Contacts of ropes that kBundleBudget left out.
  std::vector<std::uint32_t> load_bearing;  ///< Contacts between bodies: of state::Pairs::borne, in order.
  std::vector<std::uint32_t> bodies;        ///< Rows, in order.
  /// Of each hook, inner contact, contact of ropes and borne contact, a and b: index into `bodies`, or -1.
  std::vector<std::array<int, 2>> ends;
  std::vector<std::uint32_t> tethers;       ///< Springs that hold points, in order of points.
  std::vector<std::uint32_t> first_tether;  ///< Of each point; one more at the end.

  [[nodiscard]] std::uint32_t element_contact_count() const {
    return static_cast<std::uint32_t>(element_contacts.size());
  }
  /// Of the borne contacts among all touches.
  [[nodiscard]] std::uint32_t first_load_bearing() const {
    return element_contact_count() + static_cast<std::uint32_t>(rope_contacts.size());
  }
  [[nodiscard]] std::uint32_t contact_count() const {
    return first_load_bearing() + static_cast<std::uint32_t>(load_bearing.size());
  }
  /// Index of a body's row in `bodies`, or -1.
  [[nodiscard]] int body_of(std::uint32_t row) const;

  // The matrix. Blocks are segments, bends, hooks, inner contacts, those of ropes, borne ones, bodies.
  BlockPattern pattern;
  std::vector<std::uint32_t> slot;  ///< Of each block in the order of elimination.
  /// A row block at a node, with the weight of its Jacobian there.
  struct Incident {
    std::uint32_t block = 0;
    double weight = 0;
  };
  std::vector<Incident> incidents;            ///< By node.
  std::vector<std::uint32_t> first_incident;  ///< Of each node; one more at the end.
  std::vector<std::uint32_t> pair_block;      ///< For each two incidents of a node (j <= i), by node, i, j.
  std::vector<std::uint32_t> first_pair;      ///< Of each node.

  // Lives for one step.
  bool cut_short = false;  ///< Its solution ended by kBundleBudget in some substep.

  // Lives for one substep.
  int factored = 0;                             ///< How often its matrix was factored.
  RopeScratch ropes;                            ///< Nodes of chains, then points.
  std::vector<RopeSetting> settings;            ///< Of chains.
  std::vector<std::uint32_t> rope_node_counts;  ///< Of chains: how many.
  std::vector<CoupledBody> moving;              ///< As `bodies`.
  std::vector<CoupledContact> contact_rows;     ///< As `inner`, then as `rope_contacts`, then as `borne`.
  std::vector<JointRow> rows;                   ///< Of hooks, then of touches.
  std::vector<std::uint32_t> first_row;         ///< Of each of these; one more at the end.
  std::vector<std::int8_t> bound;               ///< Of rows, as Articulation::bound.
  std::vector<double> lambda;                   ///< Of rows.
  std::vector<double> speed;                    ///< Of rows: of opening.
  std::vector<int> sizes;                       ///< Of blocks, in the order of elimination.
  std::vector<double> numbers;
  std::vector<double> factor_scratch;
  std::vector<double> right_side;        ///< Then the solution.
  std::vector<BodyRow> start;            ///< Of bodies.
  std::vector<std::uint32_t> breakable;  ///< Rows of hooks that can break.

  /// No members, no matrix; keeps its memory.
  void clear();
};

/// Multiplications of all factorizations of one bundle in a substep, some 20 ms; it is factored four times
/// whatever that takes. Contacts of ropes that let go and come back could ask for 256. Where contacts of
/// ropes ask for more in one, as of segments that each touch all others, every second one is left out until
/// it is enough: a choice that knows only who touches whom.
inline constexpr double kCoupledGroupBudget = 2e7;
inline constexpr int kFewestFactorizations = 4;

/// The share of a motor row's diagonal that it has as compliance: it asks for a speed and does not take back
/// what it has yielded.
inline constexpr double kMotorCompliance = 1e-10;

/// Memory to lay out bundles in.
struct CoupledGroupScratch {
  std::vector<std::uint32_t> signature;
  base::DisjointSets sets;              ///< Bodies, then particles.
  std::vector<std::uint8_t> coupled;    ///< Of each set: whether it is a bundle.
  std::vector<std::uint32_t> group_of;  ///< Of each set.
  std::vector<std::uint32_t> anchors;   ///< Hooks.
  std::vector<std::vector<CoupledGroup::Incident>> at_node;
  std::vector<std::uint32_t> first_node;              ///< Of each chain, then of the points.
  std::vector<std::vector<std::uint32_t>> bodies_at;  ///< Blocks of bodies that touch a node.
  BlockGraph matrix;
  std::vector<int> sizes;          ///< Of blocks.
  std::vector<std::int8_t> signs;  ///< Of blocks.
  std::vector<int> counts;         ///< Of a bundle's hooks or bodies.
};

struct CoupledGroups {
  std::vector<CoupledGroup> groups;  ///< The first `count` are those of now.
  std::size_t count = 0;
  std::vector<RopeAnchor> anchors;       ///< Of ropes outside bundles, by chain and node.
  std::vector<std::uint32_t> signature;  ///< Of what they were made from.
  std::vector<std::uint32_t> tethers;    ///< All there are, in order of the particles that they hold.
  std::uint64_t tethers_revision = 0;    ///< Of the tables that they are of.
  CoupledGroupScratch scratch;

  [[nodiscard]] std::span<CoupledGroup> live() { return {groups.data(), count}; }
};

/// Sorts ropes, hooks at points and bodies into bundles, if anything about who holds or touches whom has
/// changed since they were made. Marks the chains that belong to one. A rope that hangs by ball hooks on what
/// does not give way, and on nothing else, needs none: those are its anchors.
void build_coupled_groups(const state::Tables& tables, std::vector<RopeSystem>& rope_systems,
                          CoupledGroups& groups);

/// Puts the ends of hooks that slide along a rope where the other ends are nearest to them, searching from
/// where they were.
void slide_hooks(state::Tables& tables);

/// The rotation whose x axis is the direction of the rope where a hook slides along it.
[[nodiscard]] Quaternion<double> slide_rotation(const state::Tables& tables, const state::Hook& hook);

/// While elastic rows are solved, a hooked point of a cloth, solid or group of particles has the mass of what
/// it is tied to as well: it is as hard to move as that. `weigh_points` notes the points' own state and gives
/// them that mass; `release_points` takes it away again and leaves to each point what the impulses it has got
/// make of it alone, which solve_bundle then shares out.
struct HookedPoint {
  std::uint32_t particle = 0;
  Real inverse_mass = Real(0);
  Vec3 velocity = {};
};
void apply_mass_shares(CoupledGroups& groups, state::Tables& tables, std::vector<HookedPoint>& points);
void remove_mass_shares(const std::vector<HookedPoint>& points, state::Particles& particles);

/// Velocities of everything in a bundle for a substep of length h [s]. `before` holds velocities of particles
/// from before the forces.
void solve_coupled_group(const std::vector<state::VelocityRecord>& before, Real h, CoupledGroup& group,
                         std::vector<RopeSystem>& rope_systems, state::Tables& tables);

}  // namespace hooke::solver
