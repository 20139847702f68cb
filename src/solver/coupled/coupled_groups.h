#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "math/symmetric.h"
#include "solver/contact/direct_rows.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/joint_rows/hook_rows.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/linear/block_matrix.h"
#include "solver/rope/rope_rows.h"
#include "solver/rope/rope_systems.h"
#include "solver/rope/segment_breaks.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Ropes together with what they are hooked to. A rope alone is a rope system (solver/rope/rope_systems.h).
/// What hooks at points join, or a rope or particle that lies on a moving body, is a coupled group and is
/// solved as a whole.

namespace hooke::solver {

/// Row that gives the speed of a point of a body along a direction as row . V, with the body's velocity V =
/// (sqrt(m) v, omega~). The same type also holds such a V.
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

/// A body of a coupled group during the solution.
struct CoupledBody {
  JointBody body;                      ///< State before the solution.
  math::Symmetric3<double> stiffness;  ///< h^2 S K S of the forces of hooks.
  math::Symmetric3<double> excess;     ///< Implicit part of the stiffness.
  math::Symmetric3<double> found;      ///< Stiffness of the forces found last.
  DVec3 v = {};                        ///< Resulting velocity; until it is solved for, that before.
  DVec3 omega_scaled = {};

  /// Velocity v + omega x lever at an offset from the center [m/s].
  [[nodiscard]] DVec3 velocity_at(DVec3 lever) const { return v + cross(body.scale * omega_scaled, lever); }
};

/// A contact during the solution: an element contact of a rope or a cloth, or a rope contact.
struct CoupledContact {
  static constexpr int kRows = 3;  ///< One row along the normal and two across it.

  std::array<std::uint32_t, 4> node = {};  ///< As `particle` of the contact.
  std::array<double, 4> weight = {};
  std::uint32_t count = 0;
  double separation = 0, friction = 0;
  double mobility = 0;  ///< 1 / the mass that resists at the contact, roughly [1/kg].
  double push_out = 0;  ///< Largest speed at which an overlap is removed [m/s].
  /// Velocity of the surface relative to its body; the whole velocity if the body does not give way [m/s].
  DVec3 surface;
  DVec3 lever;        ///< Offset from the body's center [m].
  double normal = 0;  ///< Normal impulse [N s].
  DVec3 f;            ///< Friction impulse [N s].
  double drag = 0;    ///< While the contact slides: mu N over its speed [kg].
  bool near = false;  ///< The contact may act within this substep.
  bool active = false, slides = false;
  bool let_go = false;  ///< Off for the rest of the substep, because it pulled too often.
  /// Of ropes: it separates by speed and is solved until it converges.
  bool firm = false;
};

/// The unknowns are the impulses of rope segments q and of hook rows lambda, and the velocities V = (sqrt(m)
/// v, omega~) of bodies. With B the Jacobians at particles, C those at bodies, W the inverse masses of
/// particles including their contacts, P the stiffness of contacts on bodies and R = P J:
///
///   particles   u = v* + W (B^T l + R V)
///   rows        B u + C V + E l = target,   l = (q, lambda)
///   bodies      (1 + G) (V - V0) + 0.2 G V0 = C^T l - J^T (k + P (J V - u))
///
/// where E is that of solver/rope/rope_systems.h and solver/joint_rows/joint_rows.h, G that of
/// solver/joint/articulations.h, and k the part of a contact's impulse that does not depend on velocities.
/// Particles are eliminated by hand. The rest, in (l, V), is quasi-definite and is factored in an order of
/// little fill: ropes between hooks first, in time proportional to their length, as in a rope system. Newton
/// steps, contacts inside the solution and their repetition are those of a rope system. Rows with bounds join
/// and leave as in an articulation.
///
/// A rope that resists bending has a vector row at each inner node: the change of direction there. Its
/// compliance is that of a spring of EI over the length between the middles of the two segments.
///
/// Particles of cloths, solids and groups that touch a body which gives way are points without rows. Only
/// their contacts and tethers hold them: docs/decisions/0011-ties.md.
///
/// Contacts of two bodies are the rows of a direct island (solver/contact/direct_rows.h). In the matrix they
/// are stiffness, - J^T D J in the blocks of their bodies, with the impulses of the last substep on the right
/// side. Newton steps with exact search find which rows hold, with all else linear. Once a step the same
/// matrix moves everything to where overlaps are half as deep.
/// docs/decisions/0032-contacts-in-coupled-groups.md
///
/// An element contact (state::ElementContact) has the rows of a hook at its position: one along the normal,
/// which only pushes, and two across it for friction. A sticking contact is held. A sliding contact is
/// dragged with mu N over its speed, both from the solution before: however wrong they are, that takes
/// energy. Along the normal, element contacts of ropes are as soft as contacts of nodes, and carry their
/// force over like these.
///
/// A share of 1e-6 of each hook row's diagonal, 1e-7 of a joint's and 1e-10 of a motor's, is added as
/// compliance. It decides what loops of rigid ropes leave undetermined. A hook that slides along a rope
/// (HookKind::kRopeSlide) holds b across the rope. The direction of the rope at b is that of its points,
/// blended along the segment.
struct CoupledGroup {
  std::vector<std::uint32_t> rope_systems;      ///< Rope systems, in order.
  std::vector<std::uint32_t> points;            ///< Particles of no rope, in order of rows.
  std::vector<std::uint32_t> hooks;             ///< Rows of hooks, in order.
  std::vector<std::uint32_t> element_contacts;  ///< Rows of element contacts, in order.
  std::vector<std::uint32_t> rope_contacts;     ///< Rows of rope contacts, in order.
  std::uint32_t refused = 0;             ///< Number of rope contacts that kCoupledGroupBudget left out.
  std::vector<std::uint32_t> manifolds;  ///< Indices into state::Pairs::coupled, in order.
  std::vector<std::uint32_t> bodies;     ///< Body rows, in order.
  /// Ends a and b of each hook, element contact and rope contact: index into `bodies`, or -1.
  std::vector<std::array<int, 2>> ends;
  std::vector<std::uint32_t> tethers;       ///< Springs that hold points, in order of points.
  std::vector<std::uint32_t> first_tether;  ///< For each point, where its tethers begin; one more at the end.

  [[nodiscard]] std::uint32_t element_contact_count() const {
    return static_cast<std::uint32_t>(element_contacts.size());
  }
  /// Number of contacts with rows of their own in the matrix: all but those of two bodies.
  [[nodiscard]] std::uint32_t contact_count() const {
    return element_contact_count() + static_cast<std::uint32_t>(rope_contacts.size());
  }
  /// Index of a body's row in `bodies`, or -1.
  [[nodiscard]] int body_of(std::uint32_t row) const;

  // The matrix. Blocks are segments, bends, hooks, element and rope contacts, and bodies.
  BlockPattern pattern;
  std::vector<std::uint32_t> slot;  ///< Position of each block in the order of elimination.
  /// A row block at a node, with the weight of its Jacobian there.
  struct Incident {
    std::uint32_t block = 0;
    double weight = 0;
  };
  std::vector<Incident> incidents;            ///< Incidents, node by node.
  std::vector<std::uint32_t> first_incident;  ///< Where those of each node begin; one more at the end.
  std::vector<std::uint32_t> pair_block;      ///< For each two incidents of a node (j <= i), by node, i, j.
  std::vector<std::uint32_t> first_pair;      ///< Where the pairs of each node begin.

  // Lives for one step.
  /// In some substep kCoupledGroupBudget ended its solution, or none was found for its contacts of two
  /// bodies.
  bool cut_short = false;

  // Lives for one substep.
  int factored = 0;                             ///< How often its matrix was factored.
  RopeScratch ropes;                            ///< Nodes of rope systems, then points.
  std::vector<RopeSetting> settings;            ///< Settings of each rope system.
  std::vector<std::uint32_t> rope_node_counts;  ///< Number of nodes of each rope system.
  std::vector<CoupledBody> moving;              ///< One for each of `bodies`.
  /// In the order of `element_contacts`, then `rope_contacts`.
  std::vector<CoupledContact> contact_rows;
  std::vector<JointRow> rows;            ///< Rows of hooks, then of contacts.
  std::vector<std::uint32_t> first_row;  ///< Where the rows of each of these begin; one more at the end.
  std::vector<std::int8_t> bound;        ///< Bound of each row, as Articulation::bound.
  std::vector<double> lambda;            ///< Impulse of each row.
  std::vector<double> speed;             ///< Speed at which each row opens.
  std::vector<int> sizes;                ///< Sizes of blocks, in the order of elimination.
  std::vector<double> numbers;
  std::vector<double> factor_scratch;
  std::vector<double> right_side;        ///< Right side, then the solution.
  std::vector<double> compliance;        ///< Of hooks' rows, at their places in it; 0 elsewhere.
  std::vector<double> unfelt;            ///< What was taken out of it because no body feels it.
  std::vector<BodyRow> start;            ///< (1 + G) V0 of each body.
  std::vector<std::uint32_t> breakable;  ///< Rows of hooks that can break.
  std::vector<GivingSegment> giving;     ///< Segments that give way in this substep.
  // Contacts of two bodies. Velocities are six numbers V for each of `bodies`.
  DirectRows direct;
  std::vector<double> free;       ///< Velocities without these contacts, hooks and ropes.
  std::vector<double> velocity;   ///< At which the rows were last evaluated.
  std::vector<double> direction;  ///< Search direction; gradient before that.
  std::vector<double> last;       ///< Solution of the whole group at `velocity`.
  std::vector<double> kept;       ///< For each row: its impulse of the last substep [N s].
  std::vector<double> felt;  ///< Impulse of each row that the rest of the group has felt at `velocity` [N s].
  std::vector<double> felt_then;    ///< The same at the end of the search direction [N s].
  std::vector<SlidingRow> sliding;  ///< For each contact, in the last linear system.

  /// Removes members and matrix, but keeps memory.
  void clear();
};

/// Memory for building coupled groups.
struct CoupledGroupScratch {
  std::vector<std::uint32_t> signature;
  base::DisjointSets sets;              ///< Bodies, then particles.
  std::vector<std::uint8_t> coupled;    ///< For each set: whether it is a coupled group.
  std::vector<std::uint32_t> group_of;  ///< Coupled group of each set.
  std::vector<std::uint32_t> anchors;   ///< Rows of hooks that are anchors.
  std::vector<std::vector<CoupledGroup::Incident>> at_node;
  std::vector<std::uint32_t> first_node;              ///< First node of each rope system, then of the points.
  std::vector<std::vector<std::uint32_t>> bodies_at;  ///< Blocks of bodies that touch a node.
  BlockGraph matrix;
  std::vector<int> sizes;          ///< Sizes of blocks.
  std::vector<std::int8_t> signs;  ///< Signs of blocks.
  std::vector<int> counts;         ///< For each hook or body of a coupled group.
};

struct CoupledGroups {
  std::vector<CoupledGroup> groups;  ///< The first `count` are in use.
  std::size_t count = 0;
  std::vector<RopeAnchor> anchors;  ///< Anchors of ropes outside coupled groups, by rope system and node.
  std::vector<std::uint32_t> signature;  ///< What the groups were built from.
  std::vector<std::uint32_t> tethers;    ///< All tethers, in order of the particles that they hold.
  std::uint64_t tethers_revision = 0;    ///< Revision of the tables that `tethers` was built from.
  CoupledGroupScratch scratch;

  [[nodiscard]] std::span<CoupledGroup> live() { return {groups.data(), count}; }
  [[nodiscard]] std::span<const CoupledGroup> live() const { return {groups.data(), count}; }
};

/// Sorts ropes, hooks at points and bodies into coupled groups, if anything about who holds or touches whom
/// has changed since they were built. Marks the rope systems that belong to one. A rope that hangs only on
/// ball hooks, on what does not give way, needs no group: those hooks are its anchors.
void build_coupled_groups(const state::Tables& tables, std::vector<RopeSystem>& rope_systems,
                          CoupledGroups& groups);

/// Whether the contact of a point joins its rope, or its particle, to a body that gives way.
[[nodiscard]] bool joins_body(const state::Tables& tables, std::size_t contact);

/// Moves the ends of hooks that slide along a rope to where the rope is nearest to the other end. The search
/// begins where they were.
void slide_hooks(state::Tables& tables);

/// The rotation whose x axis is the direction of the rope where a hook slides along it.
[[nodiscard]] Quaternion<double> slide_rotation(const state::Tables& tables, const state::Hook& hook);

/// While elastic rows are solved, a hooked point of a cloth, solid or group of particles also has the mass of
/// what it is hooked to, because it is as hard to move. `apply_mass_shares` notes the points' own state and
/// gives them that mass. `remove_mass_shares` takes it away again and gives each point the velocity that its
/// impulses alone cause. solve_coupled_group then shares these impulses out.
struct HookedPoint {
  std::uint32_t particle = 0;
  Real inverse_mass = Real(0);
  Vec3 velocity = {};
};
void apply_mass_shares(CoupledGroups& groups, const std::vector<std::uint8_t>& stiff, state::Tables& tables,
                       std::vector<HookedPoint>& points);
void remove_mass_shares(const std::vector<HookedPoint>& points, state::Particles& particles);

/// A particle substep.
struct ParticleSubstep {
  Real h = Real(0);     ///< Its length [s].
  double end_time = 0;  ///< Time of the world at its end [s].
  bool first = false;   ///< It is the first of its step.
  /// By object, not 0 for cloths that are solved as a whole with loads at single points
  /// (solver/cloth/loaded_cloths.h).
  std::span<const std::uint8_t> loaded_at_points = {};
  SurfaceContacts& surfaces;  ///< Holds what presses on ropes.
};

/// Solves for the velocities of everything in a coupled group in a particle substep. `before` holds the
/// velocities of particles before the forces. The first of a step also removes overlaps of bodies, at most 5
/// cm.
void solve_coupled_group(const std::vector<state::VelocityRecord>& before, const ParticleSubstep& substep,
                         CoupledGroup& group, std::vector<RopeSystem>& rope_systems, BodyContacts& contacts,
                         state::Tables& tables);

}  // namespace hooke::solver
