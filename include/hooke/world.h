#pragma once

#include "hooke/desc.h"
#include "hooke/event.h"
#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/query.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

/// \file
/// The simulation. Start reading here, then open src/world/step.cpp.
///
/// Units are SI. +Y is up. A name says so when it departs from this: `_hz`, `_ms`, `_deg`.

namespace hooke {

struct WorldData;     // every table of the simulation; src/world/world_data.h
struct SnapshotData;  // a copy of the tables
struct WorldAccess;   // src/world/access.h

/// Columns of one object's points in the order its maker gave them. Reads the engine's own memory, without a
/// copy. Valid until the next call on the World that is not const. Indices beyond size() give zeros.
class PointView {
 public:
  PointView() = default;
  PointView(DVec3 origin, const std::byte* first, std::size_t count, std::size_t stride,
            const std::uint32_t* row_of)
      : origin_(origin), first_(first), count_(count), stride_(stride), row_of_(row_of) {}

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }

  /// Point `i` in the world: origin plus offset. For velocities the origin is zero.
  [[nodiscard]] DVec3 operator[](std::size_t i) const { return origin_ + vector_cast<double>(offset(i)); }
  /// Point `i` relative to origin(), as the engine stores it.
  [[nodiscard]] Vec3 offset(std::size_t i) const;
  [[nodiscard]] DVec3 origin() const { return origin_; }

 private:
  DVec3 origin_;
  const std::byte* first_ = nullptr;
  std::size_t count_ = 0;
  std::size_t stride_ = 0;                 ///< [bytes]
  const std::uint32_t* row_of_ = nullptr;  ///< From the maker's order to rows; null where they are the same.
};

/// Position and rotation of a body's frame.
struct Pose {
  DVec3 position = {};
  Quat rotation = {};
};

/// Where two bodies touched in the last step. Contacts stand in order of the bodies' creation, first of a.
struct BodyContact {
  BodyId a = {};  ///< Created before `b`.
  BodyId b = {};
  std::uint32_t part_a = 0;  ///< Index into BodyDesc::parts.
  std::uint32_t part_b = 0;
  DVec3 point = {};             ///< Midway between the two surfaces [m].
  Vec3 normal = {};             ///< From a to b.
  Real separation = Real(0);    ///< At the start of the step; negative: overlap [m].
  Real normal_force = Real(0);  ///< Mean over the last substep [N].
  Vec3 friction_force = {};     ///< On b; points with one normal share it evenly [N].
};

/// What a hook did to b, and the opposite to a: mean over the last step.
struct HookForce {
  Vec3 force = {};   ///< [N]
  Vec3 torque = {};  ///< About the anchor [N m].
};

/// How many contacts, hooks and ropes a step solved which way: a scene that is slow or soft says why. What
/// each way is, when it is taken and at what cost stands in src/solver/routes.h.
struct RouteCounts {
  std::uint32_t contacts_soft = 0;        ///< Contact manifolds of two bodies that yield a little.
  std::uint32_t contacts_direct = 0;      ///< Manifolds solved with all others of their stack.
  std::uint32_t contacts_coupled = 0;     ///< Manifolds solved with the hooks of what they press on.
  std::uint32_t contacts_bouncing = 0;    ///< Those of all these that have restitution.
  std::uint32_t pairs_at_start = 0;       ///< Pairs of shapes whose contact is that of the step's start.
  std::uint32_t pairs_in_the_middle = 0;  ///< Pairs that spin against each other: that of the step's middle.
  std::uint32_t pairs_at_impact = 0;      ///< Fast pairs: that of the time when they meet.
  std::uint32_t pairs_each_substep = 0;   ///< Pairs that roll or slide far: made again in each substep.
  std::uint32_t hooks_tree = 0;           ///< Hooks of bodies joined without loops.
  std::uint32_t hooks_approximate_tree = 0;  ///< Hooks of ragdolls that are solved once a substep.
  std::uint32_t hooks_loop = 0;              ///< Hooks of bodies joined in loops.
  std::uint32_t hooks_block = 0;             ///< Ball hooks of nets beyond the budget, iterated.
  std::uint32_t hooks_iterative = 0;         ///< All other hooks of such nets.
  std::uint32_t hooks_coupled = 0;  ///< Hooks at points, and of bodies solved with what touches them.
  std::uint32_t ropes_alone = 0;
  std::uint32_t ropes_coupled = 0;  ///< Ropes that hold or touch something that gives way.
  std::uint32_t points_swept = 0;   ///< Contacts of points, edges and faces with bodies, near enough to act.
  std::uint32_t points_in_ropes = 0;  ///< Those solved with their rope.
  std::uint32_t points_coupled = 0;   ///< Those solved with what touches them, and those between ropes.
  std::uint32_t articulations = 0;    ///< Groups of hooked bodies that are solved together.
  std::uint32_t direct_islands = 0;
  std::uint32_t coupled_groups = 0;
};

/// What one step did. Numerical trouble is data, not an exception: read it, log it, stop on it.
struct StepReport {
  bool moved = false;  ///< False: `dt` was not a positive finite number, or there was no world to step, or it
                       ///< was in a step already.
  std::uint32_t contacts = 0;        ///< Points that touched something in the last substep.
  std::uint32_t pairs = 0;           ///< Shapes of bodies that are near each other.
  std::uint32_t pairs_left_out = 0;  ///< Of bodies deep in several others: all but those with the 8 nearest.
  std::uint32_t bodies_awake = 0;
  std::uint32_t rows_quarantined = 0;   ///< Particles reset because their state was NaN or infinite.
  std::uint32_t rope_solves = 0;        ///< Newton steps over ropes.
  std::uint32_t ropes_unconverged = 0;  ///< Ropes whose length error stayed above 1 % in some substep.
  /// Stacks that need a direct solution and are beyond its budget: they sink.
  std::uint32_t islands_refused = 0;
  /// Contacts that need to be solved with the hooks of what they press on and are beyond their number, and
  /// those of ropes that touch each other in more places than can be solved.
  std::uint32_t contacts_refused = 0;
  /// Groups of ropes, of what hangs on them and touches them, whose solution ended by its budget of work.
  std::uint32_t coupled_groups_cut_short = 0;
  RouteCounts routes = {};
  double detect_ms = 0;
  double prepare_ms = 0;
  double substep_ms = 0;
  double finish_ms = 0;

  [[nodiscard]] bool healthy() const { return moved && rows_quarantined == 0; }
};

/// Of the middle of the last substep: positions are half a substep ahead of velocities, so potential and
/// elastic energy are taken where the particles were then. Energy of ropes is by their tension at its end.
struct Energy {
  double kinetic = 0;    ///< [J]
  double potential = 0;  ///< [J] in gravity, uniform and inverse square fields; zero at the origin.
  double elastic = 0;    ///< [J] in springs, bends and ropes of finite stiffness, in solids and in gas.

  [[nodiscard]] double total() const { return kinetic + potential + elastic; }
};

/// Figures over the whole world, summed in a fixed order.
struct Measurement {
  Energy energy = {};
  DVec3 momentum = {};          ///< [kg m/s]
  DVec3 angular_momentum = {};  ///< [kg m^2/s] about the world's origin.
  double largest_stretch = 0;  ///< Largest |length / rest length - 1| over rope segments and stretch springs.
  double mean_stretch = 0;     ///< Mean of the same.
  double largest_penetration = 0;  ///< Deepest overlap of a particle with a shape, or of two bodies [m].
  double largest_gap = 0;          ///< Of any hook, as World::hook_gap has it [m].
};

/// Everything that changes with time, and everything that was added, as it was. Copying is cheap; see
/// World::restore.
class Snapshot {
 public:
  Snapshot() = default;

 private:
  friend class World;
  explicit Snapshot(std::shared_ptr<const SnapshotData> data) : data_(std::move(data)) {}
  std::shared_ptr<const SnapshotData> data_;
};

/// What a force law sees of one object. Valid during the call only.
class ForceView {
 public:
  [[nodiscard]] std::size_t size() const { return positions_.size(); }
  [[nodiscard]] double time() const { return time_; }                                 ///< [s]
  [[nodiscard]] DVec3 position(std::size_t i) const { return positions_[i]; }         ///< [m]
  [[nodiscard]] Vec3 velocity(std::size_t i) const { return velocities_.offset(i); }  ///< [m/s]
  [[nodiscard]] Real mass(std::size_t i) const;  ///< [kg]; 0 for a pinned point.
  [[nodiscard]] PointRef::Kind kind() const { return kind_; }
  [[nodiscard]] std::uint32_t slot() const { return slot_; }  ///< Equals the id's slot.
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

/// What a force law sees of the bodies. Valid during the call only.
class BodyForceView {
 public:
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] double time() const { return time_; }  ///< [s]
  [[nodiscard]] BodyId id(std::size_t i) const;
  [[nodiscard]] Real mass(std::size_t i) const;              ///< [kg]
  [[nodiscard]] DVec3 center_of_mass(std::size_t i) const;   ///< [m]
  [[nodiscard]] Quat rotation(std::size_t i) const;          ///< Of the body's frame.
  [[nodiscard]] Vec3 velocity(std::size_t i) const;          ///< Of the center of mass [m/s].
  [[nodiscard]] Vec3 angular_velocity(std::size_t i) const;  ///< [rad/s], in the world's axes.
  /// Adds a force [N] at the center for this substep. An index beyond size() is ignored.
  void add_force(std::size_t i, Vec3 force);
  /// Adds a torque [N m] for this substep, likewise.
  void add_torque(std::size_t i, Vec3 torque);

 private:
  friend struct ForceViewAccess;
  WorldData* world_ = nullptr;
  std::span<const std::uint32_t> rows_;
  double time_ = 0;
};

/// Owns every object and advances them in time.
///
/// Total: every function accepts every argument. What is out of range comes back as an Error that names it,
/// and the world is then unchanged. One thread uses a World at a time, but for queries. Two Worlds are
/// independent. Two Worlds built by the same calls hold bit-identical state after the same steps, whatever
/// the number of workers.
///
/// During a step, which is where force laws are called, nothing else changes the world: every call that would
/// is an Error, or returns false or 0. A World that was moved from answers in the same way, and reads as one
/// that holds nothing; a force law may move or destroy its World, whose step still ends.
///
/// Exceptions are those of force laws, which pass through step(), and std::bad_alloc. After one of a call
/// that adds something, the world is unchanged; after one of a step, see there.
class World {
 public:
  [[nodiscard]] static Result<World> create(const WorldDesc& desc = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // Objects. An id stays valid until its object is removed; it is never reused.
  /// Errors also of build_bsp, with MeshTree::kPlanes.
  [[nodiscard]] Result<MeshId> add_mesh(const MeshDesc& desc, MeshTree tree = MeshTree::kBoxes);
  [[nodiscard]] Result<BodyId> add_body(const BodyDesc& desc);
  /// Holds two bodies, or a body and the world, together; one end at least is a body that forces move.
  [[nodiscard]] Result<HookId> add_hook(const HookDesc& desc);
  /// The stitches of a seam, ball hooks, in order from the first point of `a`.
  [[nodiscard]] Result<std::vector<HookId>> sew(const SeamDesc& desc);
  [[nodiscard]] Result<RopeId> add_rope(const RopeDesc& desc);
  [[nodiscard]] Result<ClothId> add_cloth(const ClothDesc& desc);
  [[nodiscard]] Result<SolidId> add_solid(const SolidDesc& desc);
  [[nodiscard]] Result<ParticlesId> add_particles(const ParticlesDesc& desc);
  [[nodiscard]] Result<FieldId> add_field(const FieldDesc& desc);
  [[nodiscard]] Result<ForceLawId> add_force_law(ForceLaw law);
  [[nodiscard]] Result<ForceLawId> add_force_law(BodyForceLaw law);

  // A stale or null id is ignored and returns false, as during a step. A mesh in use stays with those that
  // use it; the hooks of a body go with it.
  bool remove(MeshId id);
  bool remove(BodyId id);
  bool remove(HookId id);
  bool remove(RopeId id);
  bool remove(ClothId id);
  bool remove(SolidId id);
  bool remove(ParticlesId id);
  bool remove(FieldId id);
  bool remove(ForceLawId id);

  /// Several at once, in less time than one after the other takes: a heap of ragdolls. Returns how many there
  /// were; ids that are stale, null or there twice are ignored.
  std::size_t remove(std::span<const BodyId> ids);

  // Reading. A stale or null id gives an empty view, an identity pose, an empty list.
  [[nodiscard]] PointView positions(RopeId id) const;
  [[nodiscard]] PointView positions(ClothId id) const;
  /// Points of a solid: of a box, corners of cells, x fastest, then centers of cells.
  [[nodiscard]] PointView positions(SolidId id) const;
  [[nodiscard]] PointView positions(ParticlesId id) const;
  [[nodiscard]] PointView velocities(RopeId id) const;
  [[nodiscard]] PointView velocities(ClothId id) const;
  [[nodiscard]] PointView velocities(SolidId id) const;
  [[nodiscard]] PointView velocities(ParticlesId id) const;
  [[nodiscard]] Pose pose(BodyId id) const;
  [[nodiscard]] Vec3 velocity(BodyId id) const;          ///< Of the center of mass [m/s].
  [[nodiscard]] Vec3 angular_velocity(BodyId id) const;  ///< [rad/s], in the world's axes.
  [[nodiscard]] DVec3 center_of_mass(BodyId id) const;   ///< [m], in the world.
  [[nodiscard]] Real mass(BodyId id) const;              ///< [kg]; 0 for a body that nothing moves.
  [[nodiscard]] bool asleep(BodyId id) const;
  /// Where bodies touched each other in the last step.
  [[nodiscard]] std::vector<BodyContact> body_contacts() const;
  /// The same of one body. Looks at all contacts.
  [[nodiscard]] std::vector<BodyContact> body_contacts(BodyId id) const;
  /// What happened in the last step. Valid until the next one; empty after restore().
  [[nodiscard]] const Events& events() const;
  /// Who is in a sensor, in order of creation, as of the end of the last step.
  [[nodiscard]] std::vector<BodyId> visitors(BodyId sensor) const;
  [[nodiscard]] HookForce hook_force(HookId id) const;
  /// How far b has moved from where it was hooked: the angle of a hinge [rad], also beyond whole turns; the
  /// way of a slider or of a wheel's suspension [m]; the length of a distance [m]; 0 for other kinds.
  [[nodiscard]] Real hook_value(HookId id) const;
  /// Where a hook holds a and b now [m].
  [[nodiscard]] std::array<DVec3, 2> hook_anchors(HookId id) const;
  /// The names that HookEnd::connection_point may have, the object's own first. Empty for the world.
  [[nodiscard]] std::vector<std::string> connection_points(const HookEnd& of) const;
  /// Where an end is now [m]: a connection point, a point, or the origin of a body's frame. Errors: a stale
  /// id, a name or a point that the object has not, PointRef::kNearest without a name, the world.
  [[nodiscard]] Result<DVec3> find_place(const HookEnd& end) const;
  /// How far b is from the nearest place at which the hook holds it [m]; a spring holds nothing.
  [[nodiscard]] Real hook_gap(HookId id) const;
  /// The hooks that broke in the last step, in order of creation. They are gone. Why, and when:
  /// Events::breaks.
  [[nodiscard]] const std::vector<HookId>& broken_hooks() const;
  /// Tension of each segment of a rope, from the first point on [N]; positive pulls. Mean over the last step.
  [[nodiscard]] std::vector<Real> tensions(RopeId id) const;
  /// Twist of each segment of a rope, from the first point on [rad]; right-handed is positive. 0 where
  /// nothing holds it (RopeDesc::twist_stiffness).
  [[nodiscard]] std::vector<Real> twists(RopeId id) const;
  /// Torque of each segment along it [N m], with the sign of its twist. Mean over the last step.
  [[nodiscard]] std::vector<Real> torques(RopeId id) const;
  /// The triangles of a cloth as indices into its points.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles(ClothId id) const;
  /// Pressure of the gas in a closed cloth above that of the air around it [Pa]; 0 for a cloth without.
  [[nodiscard]] Real pressure(ClothId id) const;
  /// The surface of a solid [m]: the vertices of its mesh where the solid has carried them, or its outer
  /// points.
  [[nodiscard]] std::vector<DVec3> surface(SolidId id) const;
  /// The triangles of that surface, as indices into it, counter-clockwise seen from outside.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles(SolidId id) const;
  /// The volume of a solid's tetrahedra, or inside its surface where it has none [m^3]; what is inside out
  /// counts negative.
  [[nodiscard]] double volume(SolidId id) const;

  // Asking where bodies are now; not points of ropes, cloths and particles. Any number of threads may ask at
  // once while none calls anything else. The first query after bodies moved brings the tree of boxes up to
  // date, about 0.1 us per awake body. Of equally near parts the one that was created first counts. A mesh is
  // its surface, met from both sides; meshes with MeshTree::kPlanes and all other shapes are solid.
  //
  // Errors: places beyond 1e9 m or not finite, motions of no length, stale ids, and any query during a step.

  /// What the way from `origin` over `motion` [m] meets first. A ray that begins in a solid meets it at once,
  /// with a normal that leads back.
  [[nodiscard]] Result<std::optional<CastHit>> cast_ray(DVec3 origin, DVec3 motion,
                                                        const QueryFilter& filter = {}) const;
  /// All that the ray meets, each part once where it enters it, in order of distance.
  [[nodiscard]] Result<std::vector<CastHit>> cast_ray_through(DVec3 origin, DVec3 motion,
                                                              const QueryFilter& filter = {}) const;
  /// Whether the ray meets anything: the cheapest of the three.
  [[nodiscard]] Result<bool> is_ray_blocked(DVec3 origin, DVec3 motion, const QueryFilter& filter = {}) const;
  /// What a convex shape (not a half-space, mesh or compound) meets first on its way from `start` over
  /// `motion` [m], without turning. It stops within 1e-5 of its size (at most of 1 m) in front of what it
  /// meets; float may add 2e-6 of the sizes of both. What overlaps at the start is met at once, with the
  /// normal that leads out the shortest way.
  [[nodiscard]] Result<std::optional<CastHit>> cast_shape(const Shape& shape, const Pose& start, DVec3 motion,
                                                          const QueryFilter& filter = {}) const;
  /// All parts that a convex shape overlaps, in order of creation.
  [[nodiscard]] Result<std::vector<BodyPart>> find_overlaps(const Shape& shape, const Pose& pose,
                                                            const QueryFilter& filter = {}) const;
  /// All parts whose boxes along the axes overlap a box, in order of creation: cheaper, and a little too
  /// many.
  [[nodiscard]] Result<std::vector<BodyPart>> find_in_box(DVec3 lower, DVec3 upper,
                                                          const QueryFilter& filter = {}) const;
  /// The nearest point of any surface that is at most `reach` [m] from `point` or whose solid holds it; the
  /// deepest, of several solids that do. `reach` is not negative and may be infinite.
  [[nodiscard]] Result<std::optional<ClosestPoint>> find_closest(DVec3 point, Real reach,
                                                                 const QueryFilter& filter = {}) const;

  // Pushing. Values must be finite.
  Result<void> apply_force(PointRef point, Vec3 force);         ///< [N], during the next step.
  Result<void> apply_impulse(PointRef point, Vec3 impulse);     ///< [N s], now.
  Result<void> set_velocity(PointRef point, Vec3 velocity);     ///< [m/s], now; a pinned point keeps its own.
  Result<void> set_position(PointRef point, DVec3 position);    ///< [m], now.
  Result<void> apply_force(BodyId body, Vec3 force);            ///< [N] at the center, during the next step.
  Result<void> apply_force(BodyId body, Vec3 force, DVec3 at);  ///< [N] at a place [m] in the world.
  Result<void> apply_torque(BodyId body, Vec3 torque);          ///< [N m], during the next step.
  Result<void> apply_impulse(BodyId body, Vec3 impulse);        ///< [N s] at the center, now.
  Result<void> apply_impulse(BodyId body, Vec3 impulse, DVec3 at);  ///< [N s] at a place in the world, now.
  Result<void> set_velocity(BodyId body, Vec3 velocity);  ///< [m/s], now; a static body keeps still.
  Result<void> set_angular_velocity(BodyId body, Vec3 angular_velocity);  ///< [rad/s], now.
  Result<void> set_pose(BodyId body, const Pose& pose);  ///< Of the body's frame, now; keeps its velocity.
  /// Of a kinematic body: its path, from where it is now; kStill stops it. Rotation: set_angular_velocity.
  Result<void> set_motion(BodyId body, const MotionDesc& motion);
  Result<void> set_motor(HookId hook, const HookMotor& motor);     ///< Of what moves; see HookDesc::motor.
  Result<void> set_spring(HookId hook, const HookSpring& spring);  ///< Of what moves; see HookDesc::spring.
  Result<void> set_steering(HookId hook, Real angle);              ///< Of a wheel [rad].
  Result<void> pin(PointRef point,
                   const MotionDesc& motion = {});  ///< Holds the point; its motion starts now.
  Result<void> unpin(PointRef point);
  // Where what acts on sleepers changes, by these or by what is added or removed, they wake; a force law does
  // not see those that sleep (BodyDesc::can_sleep), and its changes with time do not wake them.
  Result<void> set_gravity(Vec3 gravity);
  Result<void> set_wind(const WindDesc& wind);
  Result<void> set_workers(int workers);

  /// Advances time by `dt` [s], usually 1/60. Anything that is not a positive finite number moves nothing.
  /// Allocates only where something came, went or broke since the last step, or where there is more of
  /// something (contacts, islands) than there ever was.
  ///
  /// A step that ends by an exception is taken back: time, places, velocities, pending forces and who sleeps
  /// are as before it, to the bit, and steps that follow are sound. Contacts begin anew, and what ropes,
  /// hooks and folds have of the step that broke off stays: the next step does not have the bits that this
  /// one had.
  StepReport step(Real dt);

  [[nodiscard]] double time() const;               ///< Sum of all dt [s].
  [[nodiscard]] std::uint64_t step_count() const;  ///< Steps that moved.
  [[nodiscard]] const WorldDesc& desc() const;
  [[nodiscard]] Measurement measure() const;

  /// The wind at a place and time [m/s].
  [[nodiscard]] Vec3 wind_at(DVec3 place, double time) const;

  /// Of all that the bits of later steps depend upon: what moves, what it is made of, what acts on it, forces
  /// that wait, and what contacts and hooks remember. Worlds with equal hashes go on alike, whatever their
  /// workers, as far as the same is done to them. Not covered: what functions of force laws hold and do.
  [[nodiscard]] std::uint64_t state_hash() const;

  /// A copy of everything but the workers. Empty during a step.
  [[nodiscard]] Snapshot snapshot() const;
  /// Puts the world back as it was. Ids made since then are stale. Errors: an empty snapshot. After a
  /// std::bad_alloc nothing is in the world; it can be restored again.
  Result<void> restore(const Snapshot& snapshot);

  /// Bytes held for particles and for springs, for reports.
  struct Memory {
    std::size_t particles = 0;
    std::size_t springs = 0;
    std::size_t particle_bytes = 0;
    std::size_t spring_bytes = 0;
  };
  [[nodiscard]] Memory memory() const;

 private:
  friend struct WorldAccess;
  explicit World(std::shared_ptr<WorldData> data);
  std::shared_ptr<WorldData> data_;  ///< Shared with the step that runs, and with none else.
};

}  // namespace hooke
