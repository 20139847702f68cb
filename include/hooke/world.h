#pragma once

#include "hooke/cut.h"
#include "hooke/debug_draw.h"
#include "hooke/desc.h"
#include "hooke/event.h"
#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/query.h"
#include "hooke/result.h"
#include "hooke/settle.h"
#include "hooke/shape.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

/// \file
/// The simulation: a World, what it reports, and what force laws see of it. Start reading here, then open
/// src/world/step.cpp.
///
/// Units are SI. +Y is up. A name says so when it departs from this: `_hz`, `_ms`, `_deg`.

namespace hooke {

struct WorldData;     // every table of the simulation; src/world/world_data.h
struct SnapshotData;  // a copy of the tables
struct WorldAccess;   // src/world/access.h

/// Positions or velocities of one object's points, in the order that its maker gave. It reads the engine's
/// own memory, without a copy, and is valid until the next call on the World that is not const. Indices
/// beyond size() give zeros.
class PointView {
 public:
  /// Makes an empty view.
  PointView() = default;
  /// Makes a view of `count` points. Point i starts at `first` + row `stride` [bytes], row being row_of[i],
  /// or i if `row_of` is null. The World calls it; programs have no use for it.
  PointView(DVec3 origin, const std::byte* first, std::size_t count, std::size_t stride,
            const std::uint32_t* row_of)
      : origin_(origin), first_(first), count_(count), stride_(stride), row_of_(row_of) {}

  /// Number of points.
  [[nodiscard]] std::size_t size() const { return count_; }
  /// Whether there are no points, as for an id that is stale or null.
  [[nodiscard]] bool empty() const { return count_ == 0; }

  /// Position of point `i` in the world [m], origin plus offset; or its velocity [m/s], as the origin is zero
  /// then.
  [[nodiscard]] DVec3 operator[](std::size_t i) const { return origin_ + vector_cast<double>(offset(i)); }
  /// Position of point `i` relative to origin() [m], or its velocity [m/s], as the engine stores it.
  [[nodiscard]] Vec3 offset(std::size_t i) const;
  /// Origin of the object in the world [m]; zero for velocities.
  [[nodiscard]] DVec3 origin() const { return origin_; }

 private:
  DVec3 origin_;
  const std::byte* first_ = nullptr;
  std::size_t count_ = 0;
  std::size_t stride_ = 0;                 ///< [bytes]
  const std::uint32_t* row_of_ = nullptr;  ///< From the maker's order to rows; null where they are the same.
};

/// Place and rotation of a body's frame.
struct Pose {
  DVec3 position = {};  ///< Origin of the frame in the world [m].
  Quat rotation = {};   ///< Rotation of the frame, of unit length.
};

/// A point where two bodies touched in the last step. Lists are in the order of creation, first of a, then of
/// b.
struct BodyContact {
  BodyId a = {};                ///< The body that was created first.
  BodyId b = {};                ///< The other body.
  std::uint32_t part_a = 0;     ///< Part of a: index into BodyDesc::parts; 0 for a body of one shape.
  std::uint32_t part_b = 0;     ///< Part of b, likewise.
  DVec3 point = {};             ///< Place midway between the two surfaces [m].
  Vec3 normal = {};             ///< Direction from a to b, of unit length.
  Real separation = Real(0);    ///< Distance of the surfaces at the start of the step [m]; negative: overlap.
  Real normal_force = Real(0);  ///< Force along the normal, as a mean over the last substep [N].
  Vec3 friction_force = {};     ///< Friction on b [N]; points with one normal share it evenly.
};

/// What a deformable and something that it touched gave each other in the last step, over all points where
/// they touched.
struct DeformableContact {
  PointRef a = {};           ///< The deformable, as its point 0; of two the first in the order of Events.
  PointRef b = {};           ///< The other deformable likewise, or `a` itself; empty if it is a body.
  BodyId body = {};          ///< The body; null if it is a deformable.
  std::uint32_t points = 0;  ///< Points, edges and faces that pressed in the last particle substep.
  DVec3 point = {};          ///< Mean of the places where they pressed, by impulse [m].
  /// Force on a, friction included, as a mean over the step [N]; the other has the opposite. 0 from itself.
  Vec3 force = {};
  Real normal_force = Real(0);  ///< Sum of the forces along the normals, likewise [N].
};

/// Two objects that go through each other, one of them a deformable.
struct Crossing {
  PointRef a = {};   ///< The deformable, as its point 0.
  PointRef b = {};   ///< The other deformable likewise, or `a` itself; empty if it is a body.
  BodyId body = {};  ///< The body; null if it is a deformable.
  /// Edges that go through triangles; of a body, faces and segments that lie more than halfway in it.
  std::uint32_t pairs = 0;
  bool inside = false;  ///< The body lies within the solid without touching its surface; `pairs` is 0.
  DVec3 place = {};     ///< Middle of the crossings, or of the body that lies inside [m].
};

/// What a hook did to b, and the opposite to a, as a mean over the last step.
struct HookForce {
  Vec3 force = {};   ///< Force on b [N].
  Vec3 torque = {};  ///< Torque on b about the anchor [N m].
};

/// How many contacts, hooks and ropes a step solved in which way: it tells why a scene is slow or soft.
/// src/solver/routes.h says what each way is, when it is taken and what it costs.
struct RouteCounts {
  std::uint32_t contacts_soft = 0;           ///< Contact manifolds of two bodies that yield a little.
  std::uint32_t contacts_direct = 0;         ///< Manifolds solved with all others of their stack.
  std::uint32_t contacts_coupled = 0;        ///< Manifolds solved with the hooks of what they press on.
  std::uint32_t contacts_bouncing = 0;       ///< Those of all these that have restitution.
  std::uint32_t pairs_at_start = 0;          ///< Pairs of shapes whose contact is found at the step's start.
  std::uint32_t pairs_in_the_middle = 0;     ///< Pairs that spin on each other: found in the step's middle.
  std::uint32_t pairs_at_impact = 0;         ///< Fast pairs: found at the time when they meet.
  std::uint32_t pairs_each_substep = 0;      ///< Pairs that roll or slide far: found again in each substep.
  std::uint32_t hooks_tree = 0;              ///< Hooks of bodies joined without loops.
  std::uint32_t hooks_approximate_tree = 0;  ///< Hooks of ragdolls that are solved once a substep.
  std::uint32_t hooks_loop = 0;              ///< Hooks of bodies joined in loops.
  std::uint32_t hooks_block = 0;             ///< Ball hooks of nets beyond the budget, which are iterated.
  std::uint32_t hooks_iterative = 0;         ///< All other hooks of such nets.
  std::uint32_t hooks_coupled = 0;    ///< Hooks at points, and of bodies solved with what touches them.
  std::uint32_t ropes_alone = 0;      ///< Ropes that depend on nothing that gives way.
  std::uint32_t ropes_coupled = 0;    ///< Ropes that hold or touch something that gives way.
  std::uint32_t points_swept = 0;     ///< Contacts of points, edges and faces that are solved one by one.
  std::uint32_t points_in_ropes = 0;  ///< Contacts of points that are solved with their rope.
  std::uint32_t points_coupled = 0;   ///< Contacts of points solved with bodies, and of ropes.
  std::uint32_t articulations = 0;    ///< Groups of hooked bodies that are solved together.
  std::uint32_t direct_islands = 0;   ///< Stacks whose contacts are solved as a whole.
  std::uint32_t coupled_groups = 0;   ///< Groups of ropes, hooks and contacts that are solved as a whole.
};

/// What one step did. Numerical trouble is data, not an exception: read it, log it, stop on it.
struct StepReport {
  /// Whether the step was made. It was not if `dt` was no number from limits::kShortestStep to
  /// limits::kLongestStep, if the World was moved from, or if a step was running already.
  bool moved = false;
  std::uint32_t contacts = 0;  ///< Points that pressed on something in the last substep.
  std::uint32_t pairs = 0;     ///< Pairs of shapes of bodies that are near each other.
  /// Pairs that were left out, of bodies deep in several others: all but those with the 8 nearest.
  std::uint32_t pairs_left_out = 0;
  std::uint32_t bodies_awake = 0;  ///< Bodies that move and do not sleep after the step.
  /// Particles and bodies that were put back to where they began the step, at rest, because their state was
  /// NaN or infinite.
  std::uint32_t rows_quarantined = 0;
  std::uint32_t rope_solves = 0;        ///< Newton steps over ropes.
  std::uint32_t ropes_unconverged = 0;  ///< Ropes whose length error stayed above 1 % in some substep.
  /// Groups of rows that were solved as a whole: stacks that soft contacts do not hold, hooked bodies, ropes,
  /// and coupled groups of these and what touches them.
  std::uint32_t clusters = 0;
  /// Rows of all clusters. A row is an equation: a contact has one for each point and three for friction and
  /// twist, a hook one for each freedom that it takes, a segment or bend of a rope three.
  std::uint32_t rows_direct = 0;
  /// Rows that should be solved as a whole and are beyond a budget: those of stacks, of nets of hooks, of
  /// bodies on what hangs, of edges and faces of cloth, and of ropes that touch each other. Weaker ways solve
  /// them, and they sink or open. A stack that was refused counts until it is evaluated again, after a
  /// second.
  std::uint32_t rows_refused = 0;
  /// The worst error left undone in the rows refused: the deepest overlap of such a contact, or the largest
  /// gap of such a hook (World::hook_gap), where the substeps ended [m]. The overlap of two bodies follows to
  /// first order from that at the start of the step.
  double worst_error = 0;
  /// Coupled groups, of ropes and what hangs on them and touches them, that used up their budget of work, or
  /// for which no solution was found: they took one that takes no error back and can only lose energy.
  std::uint32_t coupled_groups_cut_short = 0;
  /// Groups of stiff solids that used up their passes in some substep: they yield more than they should.
  std::uint32_t solids_unconverged = 0;
  /// Times that a cloth under a load used up its work before it was solved to the end: it stretches more than
  /// it should.
  std::uint32_t cloths_unconverged = 0;
  /// Particle substeps in which a body too heavy for the springs of a cloth pressed on its points and was not
  /// solved with it: it moved by more than half a link, or the cloth was tangled or holds gas. Contacts alone
  /// bear it then, and the cloth stretches more than it should. Each cloth counts by itself.
  std::uint32_t cloths_left_to_contacts = 0;
  /// Times that a point of a cloth or a solid was held back for a particle substep, because nothing else kept
  /// surfaces from crossing: they jam there. Points and bodies count, too, that went on as one because
  /// nothing else kept the body from passing.
  std::uint32_t points_held_back = 0;
  /// Those of these points that surfaces held back, over all points of surfaces that were near others, times
  /// particle substeps. [0, 1]
  double held_back_share = 0;
  /// Pairs of parts of surfaces that touched or crossed when they were looked at. Nothing keeps them from
  /// crossing until they are apart.
  std::uint32_t surfaces_touching = 0;
  /// Edges of surfaces that went through triangles when they were looked at last, as where objects were added
  /// or placed so: World::crossings says which. Where the crossings cut a part off a surface, the smaller
  /// part is drawn back through the other one; all else keeps apart.
  std::uint32_t surfaces_crossing = 0;
  std::uint32_t surface_searches = 0;  ///< How often contacts of surfaces were found anew, over all groups.
  /// Pairs of vertices and faces or of edges that might have met after contacts of surfaces were found last.
  std::uint32_t surface_pairs = 0;
  RouteCounts routes = {};  ///< How many contacts, hooks and ropes were solved in which way.
  double detect_ms = 0;     ///< Time to find who is near whom, and where they touch [ms].
  double prepare_ms = 0;  ///< Time to choose how contacts and hooks are solved, and to make their rows [ms].
  double substep_ms = 0;  ///< Time of all substeps: forces, impacts, corrections, motion [ms].
  double finish_ms = 0;   ///< Time to quarantine, to break hooks, to put to sleep and to gather events [ms].

  /// Whether the step was made and nothing was quarantined.
  [[nodiscard]] bool healthy() const { return moved && rows_quarantined == 0; }
};

/// The energy of all that moves, in the middle of the last substep. Positions are half a substep ahead of
/// velocities, so that potential and elastic energy are taken where the particles were then. Ropes count by
/// their tension at the end of the substep.
struct Energy {
  double kinetic = 0;  ///< Kinetic energy of particles and bodies [J].
  /// Potential energy in gravity and in uniform, inverse square and magnetic fields, of magnets in each
  /// other's fields, and of ropes that repel each other [J]. In gravity and uniform fields it is zero at the
  /// origin.
  double potential = 0;
  double elastic = 0;  ///< Energy in springs, bends, twists and ropes that stretch, in solids and in gas [J].

  /// Sum of the three [J].
  [[nodiscard]] double total() const { return kinetic + potential + elastic; }
};

/// Figures over the whole world, summed in a fixed order.
struct Measurement {
  Energy energy = {};           ///< Energy of all that moves.
  DVec3 momentum = {};          ///< Momentum [kg m/s].
  DVec3 angular_momentum = {};  ///< Angular momentum about the world's origin [kg m^2/s].
  double largest_stretch = 0;   ///< Largest |length / rest length - 1| of rope segments and stretch springs.
  /// Where that is: a point at one end of it; empty where nothing stretches.
  PointRef most_stretched = {};
  double mean_stretch = 0;         ///< Mean of |length / rest length - 1|.
  double largest_penetration = 0;  ///< Deepest overlap of a particle with a shape, or of two bodies [m].
  /// Largest amount by which parts of deformables are nearer to each other, or to others of the same one,
  /// than they keep there [m], of contacts found in the last step.
  double largest_surface_overlap = 0;
  double largest_gap = 0;  ///< Largest World::hook_gap [m].
};

/// Everything that changes with time, and everything that was added, as it was: see World::restore. Copies
/// share their content, so that copying is cheap.
class Snapshot {
 public:
  /// Makes an empty snapshot, which cannot be restored.
  Snapshot() = default;

  /// Memory that the content takes [bytes]; 0 for an empty one. What objects share with each other and with
  /// the World does not count: meshes, forms at rest, names.
  [[nodiscard]] std::size_t bytes() const;

 private:
  friend class World;
  explicit Snapshot(std::shared_ptr<const SnapshotData> data) : data_(std::move(data)) {}
  std::shared_ptr<const SnapshotData> data_;
};

/// What a force law sees of one object. It is valid during the call only. Indices beyond size() give zeros.
class ForceView {
 public:
  /// Number of the object's points.
  [[nodiscard]] std::size_t size() const { return positions_.size(); }
  /// Time of the world at the end of this substep [s].
  [[nodiscard]] double time() const { return time_; }
  /// Position of point `i` in the world [m].
  [[nodiscard]] DVec3 position(std::size_t i) const { return positions_[i]; }
  /// Velocity of point `i` [m/s].
  [[nodiscard]] Vec3 velocity(std::size_t i) const { return velocities_.offset(i); }
  /// Mass of point `i` [kg]; 0 for a pinned point.
  [[nodiscard]] Real mass(std::size_t i) const;
  /// Kind of the object.
  [[nodiscard]] PointRef::Kind kind() const { return kind_; }
  /// Slot of the object's id: kind and slot together say which object it is.
  [[nodiscard]] std::uint32_t slot() const { return slot_; }
  /// Adds a force [N] for this substep. An index beyond size() is ignored.
  void add_force(std::size_t i, Vec3 force);

 private:
  friend struct ForceViewAccess;
  PointView positions_;
  PointView velocities_;
  const std::byte* records_ = nullptr;
  Vec3* forces_ = nullptr;
  const std::uint32_t* row_of_ = nullptr;
  PointRef::Kind kind_ = PointRef::Kind::kNone;
  std::uint32_t slot_ = 0;
  double time_ = 0;
};

/// What a force law sees of the bodies that forces move and that are awake. It is valid during the call only.
/// Indices beyond size() give zeros, and a null id.
class BodyForceView {
 public:
  /// Number of the bodies.
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  /// Time of the world at the start of this substep [s].
  [[nodiscard]] double time() const { return time_; }
  /// Id of body `i`.
  [[nodiscard]] BodyId id(std::size_t i) const;
  /// Mass of body `i` [kg].
  [[nodiscard]] Real mass(std::size_t i) const;
  /// Center of mass of body `i` in the world [m].
  [[nodiscard]] DVec3 center_of_mass(std::size_t i) const;
  /// Rotation of body `i`'s frame, of unit length.
  [[nodiscard]] Quat rotation(std::size_t i) const;
  /// Velocity of body `i`'s center of mass [m/s].
  [[nodiscard]] Vec3 velocity(std::size_t i) const;
  /// Angular velocity of body `i`, in the world's axes [rad/s].
  [[nodiscard]] Vec3 angular_velocity(std::size_t i) const;
  /// Adds a force [N] at the center of mass for this substep. An index beyond size() is ignored.
  void add_force(std::size_t i, Vec3 force);
  /// Adds a torque [N m] for this substep, likewise.
  void add_torque(std::size_t i, Vec3 torque);

 private:
  friend struct ForceViewAccess;
  WorldData* world_ = nullptr;
  std::span<const std::uint32_t> rows_;
  double time_ = 0;
};

/// A World owns every object and advances them in time.
///
/// Every function accepts every argument. An argument out of range comes back as an Error that names it, and
/// the world is then unchanged. One thread uses a World at a time, except for queries. Two Worlds are
/// independent: built by the same calls, they hold bit-identical state after the same steps, whatever the
/// number of workers.
///
/// During a step, which is where force laws are called, nothing else changes the world: every call that would
/// is an Error, or returns false or 0. A World that was moved from answers in the same way, and reads as one
/// that holds nothing. A force law may move or destroy its World, whose step still ends.
///
/// Exceptions are those of force laws, which pass through step(), and std::bad_alloc. After an exception of a
/// call that adds something, the world is unchanged; for one of a step, see step().
class World {
 public:
  /// Makes an empty world. Errors: a field of `desc` out of range, a HOOKE_INSTRUCTION_SET that this machine
  /// has not.
  [[nodiscard]] static Result<World> create(const WorldDesc& desc = {});
  /// Destroys the world with all its objects. A step that runs still ends.
  ~World();
  ///@{
  /// Takes everything over; ids stay valid. The World moved from holds nothing, and refuses every change.
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ///@}

  // Objects. An id stays valid until its object is removed; it is never reused. Errors name the field of the
  // description that is out of range, or are kStaleId where it refers to something that is gone.

  /// Copies a mesh, for bodies, cloths and solids to share. Errors: an index or coordinate out of range;
  /// those of build_bsp, with MeshTree::kPlanes.
  [[nodiscard]] Result<MeshId> add_mesh(const MeshDesc& desc, MeshTree tree = MeshTree::kBoxes);
  /// Adds a body. Errors also: a dynamic half-space, a dynamic mesh that is not closed.
  [[nodiscard]] Result<BodyId> add_body(const BodyDesc& desc);
  /// Holds two bodies, two points, a body and a point, or one of them and the world together. One end at
  /// least is a dynamic body or a point. Errors also: a kind that cannot hold these ends, a name that an end
  /// has not.
  [[nodiscard]] Result<HookId> add_hook(const HookDesc& desc);
  /// Sews a seam. Its stitches are ball hooks, in order from the first point of `a`.
  [[nodiscard]] Result<std::vector<HookId>> sew(const SeamDesc& desc);
  ///@{
  /// Adds an object. Its points keep the order that the description gives them.
  [[nodiscard]] Result<RopeId> add_rope(const RopeDesc& desc);
  [[nodiscard]] Result<ClothId> add_cloth(const ClothDesc& desc);
  [[nodiscard]] Result<SolidId> add_solid(const SolidDesc& desc);
  [[nodiscard]] Result<ParticlesId> add_particles(const ParticlesDesc& desc);
  ///@}
  /// Adds a field, and wakes everything.
  [[nodiscard]] Result<FieldId> add_field(const FieldDesc& desc);
  ///@{
  /// Adds a force law over points or over bodies; one over bodies wakes them all. Laws are called in the
  /// order in which they were added. Errors: an empty function.
  [[nodiscard]] Result<ForceLawId> add_force_law(ForceLaw law);
  [[nodiscard]] Result<ForceLawId> add_force_law(BodyForceLaw law);
  ///@}

  ///@{
  /// Removes an object, and returns whether there was one; false for an id that is stale or null, and during
  /// a step. A mesh in use stays with those that use it. The hooks of an object go with it. A solid that is
  /// the soft form of a body goes with the body, and the body with it.
  bool remove(MeshId id);
  bool remove(BodyId id);
  bool remove(HookId id);
  bool remove(RopeId id);
  bool remove(ClothId id);
  bool remove(SolidId id);
  bool remove(ParticlesId id);
  bool remove(FieldId id);
  bool remove(ForceLawId id);
  ///@}

  /// Removes several bodies, such as a heap of ragdolls, in less time than one after the other takes. Returns
  /// how many there were; ids that are stale, null or there twice are ignored.
  std::size_t remove(std::span<const BodyId> ids);

  // Reading. A stale or null id gives an empty view or list, the identity pose, zero or false.

  ///@{
  /// Positions of an object's points [m], in the order that its maker gave; see PointView for how long they
  /// are valid. Points of a box of solid are the corners of cells, x fastest, then the centers of cells.
  [[nodiscard]] PointView positions(RopeId id) const;
  [[nodiscard]] PointView positions(ClothId id) const;
  [[nodiscard]] PointView positions(SolidId id) const;
  [[nodiscard]] PointView positions(ParticlesId id) const;
  ///@}
  ///@{
  /// Velocities of an object's points [m/s], in the order of positions() and valid as long.
  [[nodiscard]] PointView velocities(RopeId id) const;
  [[nodiscard]] PointView velocities(ClothId id) const;
  [[nodiscard]] PointView velocities(SolidId id) const;
  [[nodiscard]] PointView velocities(ParticlesId id) const;
  ///@}
  /// Place and rotation of a body's frame.
  [[nodiscard]] Pose pose(BodyId id) const;
  /// Velocity of a body's center of mass [m/s].
  [[nodiscard]] Vec3 velocity(BodyId id) const;
  /// Angular velocity of a body, in the world's axes [rad/s].
  [[nodiscard]] Vec3 angular_velocity(BodyId id) const;
  /// Center of mass of a body, in the world [m].
  [[nodiscard]] DVec3 center_of_mass(BodyId id) const;
  /// Mass of a body [kg]; 0 for one that is not dynamic.
  [[nodiscard]] Real mass(BodyId id) const;
  ///@{
  /// Mass of all points of an object, pinned ones and loads too [kg].
  [[nodiscard]] Real mass(RopeId id) const;
  [[nodiscard]] Real mass(ClothId id) const;
  [[nodiscard]] Real mass(SolidId id) const;
  [[nodiscard]] Real mass(ParticlesId id) const;
  ///@}
  /// Kinetic energy of a dynamic body, and its potential energy in gravity and in uniform and inverse square
  /// fields, as measure() counts them for all; zeros for a body that is not dynamic.
  [[nodiscard]] Energy energy(BodyId id) const;
  /// Whether a body sleeps: it rests, and steps skip it until something wakes it.
  [[nodiscard]] bool asleep(BodyId id) const;
  /// Lists where bodies touched each other in the last step.
  [[nodiscard]] std::vector<BodyContact> body_contacts() const;
  /// Lists where one body touched others in the last step. It looks at all contacts.
  [[nodiscard]] std::vector<BodyContact> body_contacts(BodyId id) const;
  ///@{
  /// Lists what deformables touched in the last step, of pairs of which one has reports_contacts or a
  /// hit_speed: all, or those of the object of a point, or of a body. In the order of Events; empty after
  /// restore().
  [[nodiscard]] std::vector<DeformableContact> deformable_contacts() const;
  [[nodiscard]] std::vector<DeformableContact> deformable_contacts(PointRef of) const;
  [[nodiscard]] std::vector<DeformableContact> deformable_contacts(BodyId id) const;
  ///@}
  /// Force of these contacts on one point of a deformable, as a mean over the last step [N]; zero after
  /// restore(), and after an object was removed or changed.
  [[nodiscard]] Vec3 contact_force(PointRef point) const;
  /// Lists deformables that go through others, through themselves or through bodies now, by what they touch:
  /// objects that do not touch each other by their filters, or of which one does not touch itself, do not
  /// count. It looks at every object.
  [[nodiscard]] std::vector<Crossing> crossings() const;
  /// The events of the last step, valid until the next one; empty after restore().
  [[nodiscard]] const Events& events() const;
  /// Lists the bodies that were in a sensor at the end of the last step, in order of creation.
  [[nodiscard]] std::vector<BodyId> visitors(BodyId sensor) const;
  /// Force and torque of a hook in the last step.
  [[nodiscard]] HookForce hook_force(HookId id) const;
  /// How far b has moved from where it was hooked: the angle of a hinge [rad], also beyond whole turns; the
  /// way of a slider or of a wheel's suspension [m]; the length of a distance [m]; 0 for other kinds.
  [[nodiscard]] Real hook_value(HookId id) const;
  /// The places on a and on b, in this order, at which a hook holds them now [m].
  [[nodiscard]] std::array<DVec3, 2> hook_anchors(HookId id) const;
  /// Lists the names that HookEnd::connection_point may have for an end, the object's own first; none for the
  /// world.
  [[nodiscard]] std::vector<std::string> connection_points(const HookEnd& of) const;
  /// Whether a point is pinned.
  [[nodiscard]] bool is_pinned(PointRef point) const;
  /// Finds where an end is now [m]: a connection point, a point, or the origin of a body's frame. Errors: a
  /// stale id, a name or a point that the object has not, PointRef::kNearest without a name, the world.
  [[nodiscard]] Result<DVec3> find_place(const HookEnd& end) const;
  /// Distance of b from the nearest place at which the hook holds it [m]; a spring holds nothing.
  [[nodiscard]] Real hook_gap(HookId id) const;
  /// The hooks that broke in the last step, in order of creation, valid until the next one. They are gone.
  /// Events::breaks says why they broke, and when.
  [[nodiscard]] const std::vector<HookId>& broken_hooks() const;
  /// Segments of a rope that have broken (RopeDesc::strength), in ascending order: nothing joins points i and
  /// i + 1 for a segment i in the list. Empty for a stale or null id.
  [[nodiscard]] std::vector<std::uint32_t> broken_segments(RopeId id) const;
  /// Tension of each segment of a rope, from the first point on [N]; positive pulls. It is the mean over the
  /// last step.
  [[nodiscard]] std::vector<Real> tensions(RopeId id) const;
  /// Twist of each segment of a rope, from the first point on [rad]; right-handed is positive. 0 where
  /// nothing holds it (RopeDesc::twist_stiffness).
  [[nodiscard]] std::vector<Real> twists(RopeId id) const;
  /// Torque along each segment of a rope [N m], with the sign of its twist. It is the mean over the last
  /// step.
  [[nodiscard]] std::vector<Real> torques(RopeId id) const;
  ///@{
  /// For each point that an object got by tearing or cutting, in the order of its index, the point that it
  /// split from. They follow the points that the object was made with, which keep their indices.
  [[nodiscard]] std::vector<std::uint32_t> splits(ClothId id) const;
  [[nodiscard]] std::vector<std::uint32_t> splits(SolidId id) const;
  ///@}
  /// Lists the triangles of a cloth, as indices into its points.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles(ClothId id) const;
  /// Pressure of the gas in a closed cloth above that of the air around it [Pa]; 0 for a cloth without.
  [[nodiscard]] Real pressure(ClothId id) const;
  /// The surface of a solid, in the world [m]: the vertices of its mesh where the solid has carried them, or
  /// its outer points.
  [[nodiscard]] std::vector<DVec3> surface(SolidId id) const;
  /// Lists the triangles of a solid's surface(), as indices into it, counter-clockwise seen from outside.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles(SolidId id) const;
  /// The solid that a body is now because it was hit hard (BodyDesc::yields); null for one that is rigid. Its
  /// points can be read, pushed and hooked until the body freezes.
  [[nodiscard]] SolidId soft_form(BodyId id) const;
  /// The body that a solid is the soft form of; null for other solids.
  [[nodiscard]] BodyId body_of(SolidId id) const;
  /// The same for a point of such a solid; null for points of all else.
  [[nodiscard]] BodyId body_of(PointRef point) const;
  ///@{
  /// The surface of a body with BodyDesc::yields as it is now, rigid or soft, in the world [m], and its
  /// triangles, as surface() and triangles() of a solid. The triangles change only if its
  /// soft form is cut (World::cut), and then it stays soft. Empty for other bodies.
  [[nodiscard]] std::vector<DVec3> surface(BodyId id) const;
  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles(BodyId id) const;
  ///@}
  /// Whether a body has a dent, or is soft: its shape is then surface(), and no longer that of its
  /// description.
  [[nodiscard]] bool is_reshaped(BodyId id) const;
  /// Volume of a solid's tetrahedra, or inside its surface if it has none [m^3]. A tetrahedron that is inside
  /// out counts negative.
  [[nodiscard]] double volume(SolidId id) const;

  // Queries: they ask where things are now, first bodies, then deformables. Any number of threads may ask at
  // once while none calls anything else. The first query after bodies moved brings the tree of boxes up to
  // date, about 0.1 us per awake body. Of equally near parts the one that was created first counts. A mesh is
  // its surface, met from both sides; meshes with MeshTree::kPlanes and all other shapes are solid.
  //
  // Errors: places beyond 1e9 m or not finite, motions of no length, stale ids, and any query during a step.

  /// Finds what the ray from `origin` over `motion` [m] meets first; nothing if it meets nothing. A ray that
  /// begins in a solid meets it at once, with a normal that leads back.
  [[nodiscard]] Result<std::optional<CastHit>> cast_ray(DVec3 origin, DVec3 motion,
                                                        const QueryFilter& filter = {}) const;
  /// Finds all that the ray meets, each part once, where the ray enters it, in order of distance.
  [[nodiscard]] Result<std::vector<CastHit>> cast_ray_through(DVec3 origin, DVec3 motion,
                                                              const QueryFilter& filter = {}) const;
  /// Whether the ray meets anything: the cheapest of the three.
  [[nodiscard]] Result<bool> is_ray_blocked(DVec3 origin, DVec3 motion, const QueryFilter& filter = {}) const;
  /// Finds what a convex shape (not a half-space, mesh or compound) meets first on its way from `start` over
  /// `motion` [m], without turning. It stops within 1e-5 of its size (at most 1e-5 m) in front of what it
  /// meets; float may add 2e-6 of the sizes of both. What overlaps at the start is met at once, with the
  /// normal that leads out the shortest way.
  [[nodiscard]] Result<std::optional<CastHit>> cast_shape(const Shape& shape, const Pose& start, DVec3 motion,
                                                          const QueryFilter& filter = {}) const;
  /// Finds all parts that a convex shape overlaps, in order of creation.
  [[nodiscard]] Result<std::vector<BodyPart>> find_overlaps(const Shape& shape, const Pose& pose,
                                                            const QueryFilter& filter = {}) const;
  /// Finds all parts whose boxes along the axes overlap the box from `lower` to `upper` [m], in order of
  /// creation. It is cheaper than find_overlaps, and finds a little too many.
  [[nodiscard]] Result<std::vector<BodyPart>> find_in_box(DVec3 lower, DVec3 upper,
                                                          const QueryFilter& filter = {}) const;
  /// Finds the nearest point of any surface that is at most `reach` [m] from `point`, or whose solid contains
  /// `point`; of several solids that do, the deepest counts. `reach` is not negative and may be infinite.
  [[nodiscard]] Result<std::optional<ClosestPoint>> find_closest(DVec3 point, Real reach,
                                                                 const QueryFilter& filter = {}) const;

  // These queries look at the box around each deformable, and at all parts of those that may be met.

  /// Finds which deformable the ray from `origin` over `motion` [m] meets first, and where; nothing if it
  /// meets none. A ray that begins in a rope or a particle meets it at once, with a normal that leads back; a
  /// solid is its surface. Bodies are not asked.
  [[nodiscard]] Result<std::optional<DeformableHit>> cast_ray_on_deformables(
      DVec3 origin, DVec3 motion, const DeformableFilter& filter = {}) const;
  /// Finds the nearest place of any deformable that is at most `reach` [m] from `point`, or that has `point`
  /// inside; of several that do, the one in which it is deepest counts. `reach` is not negative and may be
  /// infinite.
  [[nodiscard]] Result<std::optional<ClosestDeformable>> find_closest_deformable(
      DVec3 point, Real reach, const DeformableFilter& filter = {}) const;
  /// Finds all deformables that come within `radius` [m] of `center`, in order of creation, each with its
  /// place that is nearest to `center`. `radius` is as `reach` above.
  [[nodiscard]] Result<std::vector<ClosestDeformable>> find_deformables(
      DVec3 center, Real radius, const DeformableFilter& filter = {}) const;

  // Pushing. Errors: kStaleId for an id or a point that is gone, and values beyond hooke/limits.h. Forces and
  // impulses do nothing to a point that is pinned, or to a body that is not dynamic.

  /// Pushes a point with a force [N] during the next step; forces add up.
  Result<void> apply_force(PointRef point, Vec3 force);
  /// Hits a point with an impulse [N s], now.
  Result<void> apply_impulse(PointRef point, Vec3 impulse);
  /// Gives a point a velocity [m/s], now; a pinned point keeps its own.
  Result<void> set_velocity(PointRef point, Vec3 velocity);
  /// Puts a point at a place in the world [m], now; the path of a pinned point goes on from there.
  Result<void> set_position(PointRef point, DVec3 position);
  /// Pushes a body at its center of mass with a force [N] during the next step; forces add up.
  Result<void> apply_force(BodyId body, Vec3 force);
  /// Pushes a body at a place in the world [m] with a force [N] during the next step.
  Result<void> apply_force(BodyId body, Vec3 force, DVec3 at);
  /// Twists a body with a torque [N m] during the next step; torques add up.
  Result<void> apply_torque(BodyId body, Vec3 torque);
  /// Hits a body at its center of mass with an impulse [N s], now.
  Result<void> apply_impulse(BodyId body, Vec3 impulse);
  /// Hits a body at a place in the world [m] with an impulse [N s], now.
  Result<void> apply_impulse(BodyId body, Vec3 impulse, DVec3 at);
  /// Gives a body's center of mass a velocity [m/s], now; a static body keeps still.
  Result<void> set_velocity(BodyId body, Vec3 velocity);
  /// Gives a body an angular velocity in the world's axes [rad/s], now; a static body keeps still.
  Result<void> set_angular_velocity(BodyId body, Vec3 angular_velocity);
  /// Puts a body's frame somewhere else, now. It keeps its velocities; a kinematic body begins its path again
  /// from there. The rotation may have any length but zero.
  Result<void> set_pose(BodyId body, const Pose& pose);
  /// Gives a kinematic body a path, from where it is now; kStill stops it. set_angular_velocity turns it.
  /// Errors also: a body that is not kinematic.
  Result<void> set_motion(BodyId body, const MotionDesc& motion);
  /// Replaces the motor of a hook; see HookDesc::motor. Errors also: kUnsupported for a kind without a main
  /// freedom.
  Result<void> set_motor(HookId hook, const HookMotor& motor);
  /// Replaces the spring of a hook; see HookDesc::spring. Errors also: kUnsupported for a kind without a main
  /// freedom.
  Result<void> set_spring(HookId hook, const HookSpring& spring);
  /// Sets the target of a wheel's steering [rad]. Errors also: kUnsupported for a hook of another kind.
  Result<void> set_steering(HookId hook, Real angle);
  /// Holds a point; its motion starts now, from where it is.
  Result<void> pin(PointRef point, const MotionDesc& motion = {});
  /// Lets a point go; nothing happens to one that is not pinned.
  Result<void> unpin(PointRef point);
  /// Cuts ropes, cloths and solids with a blade that sweeps a surface, now. Ropes lose the segments that it
  /// crosses. Triangles of a cloth and tetrahedra of a solid part at their common edge or face if the way
  /// from the middle of the one to that of the other crosses the surface: a crack follows the blade to within
  /// an element. Points at it become several, with shares of the mass at one place (of what has self_contact
  /// drawn apart by a thousandth of the way to the middles of their elements) and with one velocity, so that
  /// mass and momentum stay; springs along it are shared out, and what leads across it goes. Errors: ends of
  /// the edge beyond limits::kPlace, an id that is stale.
  Result<CutResult> cut(const CutDesc& desc);

  // Sleepers wake where these calls, or objects that come and go, change what acts on them. A force law does
  // not see those that sleep (BodyDesc::can_sleep), and its changes with time do not wake them.

  /// Replaces gravity [m/s^2]. Another value than before wakes everything.
  Result<void> set_gravity(Vec3 gravity);
  /// Replaces the wind. Another wind than before wakes everything.
  Result<void> set_wind(const WindDesc& wind);
  /// Sets the number of threads of a step, which results do not depend on. [1, 64]
  Result<void> set_workers(int workers);

  /// Advances time by `dt` [s], usually 1/60. Any number that is not in [1e-9, 1e3] moves nothing. It
  /// allocates memory only where something came, went or broke since the last step, or where there is more of
  /// something (contacts, islands) than there ever was.
  ///
  /// A step that ends by an exception is taken back: time, places, velocities, pending forces and who sleeps
  /// are as before it, to the bit, and steps that follow are sound. Contacts begin anew, and what ropes,
  /// hooks and folds remember is from the step that broke off: the next step may differ from it in its bits.
  StepReport step(Real dt);

  /// Brings everything to rest under the forces that act: steps by RestWatch, without sleep and damping of
  /// bodies, until unbalanced forces are small, and leaves it without speed. Time and the count of steps are
  /// then as before, and so are paths: what is on a path, or blown by gusts, does not rest. The same world
  /// gives the same rest, bit for bit, with any number of workers. A World that is not converged has gone on
  /// by the steps. Errors: a field of `desc` out of range, no weight and no SettleDesc::force, a call during
  /// a step.
  Result<SettleReport> settle(const SettleDesc& desc = {});
  /// Returns what moves now, but for what `left_out` names; stale ids in it are passed over. `dt` is the
  /// length of the last step [s], by which momenta become forces; all is zero if it is not positive.
  [[nodiscard]] Unrest unrest(double dt, const LeftOut& left_out = {}) const;
  /// Takes all speed from dynamic bodies and free points. Errors: a call during a step.
  Result<void> stop(const LeftOut& left_out = {});

  /// Sum of the lengths of all steps [s].
  [[nodiscard]] double time() const;
  /// Number of steps that moved.
  [[nodiscard]] std::uint64_t step_count() const;
  /// The description of the world, with the gravity, wind and workers of now.
  [[nodiscard]] const WorldDesc& desc() const;
  /// Measures energy, momentum, stretch, overlap and gaps over the whole world. It looks at every object.
  [[nodiscard]] Measurement measure() const;

  /// Velocity of the air at a place [m] and time [s], in [m/s].
  [[nodiscard]] Vec3 wind_at(DVec3 place, double time) const;

  /// Shows what the world knows besides where things are: see hooke/debug_draw.h. Contacts are those of the
  /// last step in which things pressed on each other; what cloths and solids do to each other is not kept
  /// after a step, and not shown. Returns the legend. Errors: a field of `desc` out of range.
  Result<DebugDrawLegend> debug_draw(DebugDraw& draw, const DebugDrawDesc& desc = {}) const;

  /// Hash of all that the bits of later steps depend on: what moves, what it is made of, what acts on it,
  /// forces that wait, and what contacts and hooks remember. Worlds with equal hashes go on alike, whatever
  /// their workers, if the same is done to them. The hash does not cover what functions of force laws hold
  /// and do.
  [[nodiscard]] std::uint64_t state_hash() const;

  /// Copies everything but the workers. The snapshot may outlive the World, and may be restored in another
  /// one. It is empty during a step.
  [[nodiscard]] Snapshot snapshot() const;
  /// Puts the world back as it was. Ids made since then are stale. Errors: an empty snapshot. After a
  /// std::bad_alloc nothing is in the world; it can be restored again.
  Result<void> restore(const Snapshot& snapshot);

  /// How much memory the points and springs of all objects take.
  struct Memory {
    std::size_t particles = 0;       ///< Number of points of ropes, cloths, solids and particles.
    std::size_t springs = 0;         ///< Number of springs.
    std::size_t particle_bytes = 0;  ///< Memory for the points [bytes].
    std::size_t spring_bytes = 0;    ///< Memory for the springs [bytes].
  };
  /// Counts points and springs, and the memory they take, for reports.
  [[nodiscard]] Memory memory() const;

 private:
  friend struct WorldAccess;
  explicit World(std::shared_ptr<WorldData> data);
  std::shared_ptr<WorldData> data_;  ///< Shared with the step that runs, and with none else.
};

}  // namespace hooke
