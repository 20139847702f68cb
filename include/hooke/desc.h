#pragma once

#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/shape.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Descriptions of everything a World can hold. Plain aggregates with defaults; name what differs:
///
///     world.add_rope({.hook_point = {0, 3, 0}, .total_mass = 0.4f, .masses = 32, .length_at_rest = 2})
///
/// Units are SI: meters, kilograms, seconds, newtons, radians. +Y is up. A stiffness may be `kRigid`.
/// Bounds are checked when a description is added; what is wrong comes back as an Error that names the field.

namespace hooke {

/// Stiffness of what does not stretch.
inline constexpr Real kRigid = std::numeric_limits<Real>::infinity();

/// Wind, a function of time and place and never of the step:
/// W = |velocity| [ (1 + gust r1(t, x)) e_main + side_gust r2(t, x) e_side ], r1 and r2 independent in [-1,
/// 1], smooth over `correlation_time` and `correlation_length`. e_side is horizontal and across e_main.
struct WindDesc {
  /// How the wind varies. kPaper draws one factor per step, as the paper's eq. 9 does: it depends on the
  /// step.
  enum class Gusts : std::uint8_t { kSmooth, kPaper };

  Vec3 velocity = {};                 ///< Mean wind [m/s].
  Real gust = Real(0);                ///< Relative size of the gusts along the wind. [0, 10]
  Real side_gust = Real(0);           ///< Relative size of the gusts across it. [0, 10]
  Real correlation_time = Real(0.5);  ///< [s], positive.
  Real correlation_length = Real(2);  ///< [m], positive.
  std::uint32_t seed = 1;
  Gusts gusts = Gusts::kSmooth;
  Real air_density = Real(1.225);  ///< [kg/m^3]; 0 switches aerodynamic drag and lift off.

  friend bool operator==(const WindDesc&, const WindDesc&) = default;
};

/// What two materials do to each other, in place of the rule at ContactDesc.
struct MaterialPairDesc {
  std::uint16_t a = 0;
  std::uint16_t b = 0;
  Real friction = Real(0.5);  ///< [0, 100]
  std::optional<Real> static_friction = {};
  Real restitution = Real(0);  ///< [0, 1]
};

struct WorldDesc {
  Vec3 gravity = {Real(0), Real(-9.81), Real(0)};  ///< [m/s^2]
  int substeps = 8;                                ///< Solver passes per step; more is stiffer. [1, 64]
  int particle_substeps = 1;                       ///< Passes over deformables in each substep. [1, 64]
  int workers = 1;  ///< Threads used by step(). The result does not depend on it. [1, 64]
  WindDesc wind = {};
  std::vector<MaterialPairDesc> materials = {};
  Real contact_hz = Real(60);            ///< Stiffness of contacts between bodies, as a frequency. (0, 1000]
  Real contact_damping_ratio = Real(5);  ///< Of the same. (0, 100]
  int bias_sweeps =
      1;  ///< Passes over contacts in each substep; 2 is cheaper than twice the substeps. [1, 8]
  bool sleeping = true;  ///< Bodies that have come to rest are skipped until something wakes them.
};

/// A displacement as a function of time; zero at time zero.
struct MotionDesc {
  enum class Kind : std::uint8_t { kStill, kConstantVelocity, kSine, kKeyframes };
  struct Keyframe {
    double time = 0;   ///< [s], increasing.
    Vec3 offset = {};  ///< [m] from the start; straight lines between keyframes, still before the first and
                       ///< after the last.

    friend bool operator==(const Keyframe&, const Keyframe&) = default;
  };

  Kind kind = Kind::kStill;
  Vec3 velocity = {};                    ///< kConstantVelocity [m/s].
  Vec3 amplitude = {};                   ///< kSine [m]: amplitude (sin(2 pi f t + phase) - sin(phase)).
  Real frequency_hz = Real(1);           ///< kSine.
  Real phase = Real(0);                  ///< kSine [rad].
  std::vector<Keyframe> keyframes = {};  ///< kKeyframes, at least one.

  friend bool operator==(const MotionDesc&, const MotionDesc&) = default;
};

/// A point that is held: still, or moved by a given motion.
struct PinDesc {
  std::uint32_t point = 0;
  MotionDesc motion = {};
};

/// Mass added to one point.
struct LoadDesc {
  std::uint32_t point = 0;
  Real mass = Real(1);  ///< [kg], not negative.
};

/// A place of an object that hooks may name (HookEnd::connection_point). Every object has those of its kind
/// too, unless one of its own has the same name:
///
/// - bodies: `center` (of mass) and `origin` (of the frame). Boxes: `left` (-x), `right`, `bottom` (-y),
/// `top`,
///   `back` (-z) and `front`, the centers of faces, and the corners, from `bottom_left_back` to
///   `top_right_front`. Spheres, capsules and cylinders: the six that lie on the axes. Cones: `top`,
///   `bottom`;
/// - ropes: `start`, `middle`, `end`;
/// - cloths on a grid, seen with columns to the right and rows downward: `top_left`, `top_right`,
/// `bottom_left`,
///   `bottom_right`, the middles of edges `left`, `right`, `top`, `bottom`, and `center`;
/// - boxes of solid: what boxes have, without `origin`;
/// - particles: where there are springs, `start` of the first and `end` of the last; a single one, `center`.
struct ConnectionPointDesc {
  std::string name = {};  ///< 1 to 64 bytes; no two of an object are the same.
  /// [m]: in the frame of a body, of a cloth's mesh, of a solid; in the world of what has no frame: ropes,
  /// grids, particles. Of all but bodies the nearest place is meant, as by PointRef::kNearest.
  DVec3 position = {};
  std::optional<std::uint32_t> point = {};  ///< A point of the object instead; not of a body.
};

/// How a surface or a point answers a contact. Of two surfaces: friction sqrt(a b), the larger restitution,
/// the larger rolling and spinning friction, the sum of the surface velocities; unless the world's table of
/// materials lists the pair.
struct ContactDesc {
  Real friction = Real(0.5);  ///< Coulomb coefficient while sliding. [0, 100]
  std::optional<Real> static_friction =
      {};                      ///< Coefficient while at rest, not below `friction`, which it is by default.
  Real restitution = Real(0);  ///< Speed after over speed before, of bodies. [0, 1]
  Real rolling_friction = Real(0);   ///< Lever of the rolling resistance [m]. Not negative.
  Real spinning_friction = Real(0);  ///< Lever of the resistance to spin about the normal [m]. Not negative.
  Vec3 surface_velocity = {};        ///< Of a conveyor belt, in the body's frame [m/s].
  std::uint16_t material = 0;        ///< The row of WorldDesc::materials it is listed under; any number.
};

enum class BodyKind : std::uint8_t {
  kStatic,     ///< Never moves.
  kKinematic,  ///< Moves as told and is not moved by what it touches.
  kDynamic,
};

/// Two bodies collide when each is in a category that the other's mask has, and they do not share a negative
/// group; a shared positive group always collides.
struct FilterDesc {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xFFFFFFFF;
  std::int32_t group = 0;
};

/// One shape of a body that has several.
struct PartDesc {
  Shape shape = {};
  Vec3 position = {};         ///< Of the shape's frame in the body's [m].
  Quat rotation = {};         ///< Of the shape's frame in the body's. Normalized on entry.
  Real density = Real(1000);  ///< [kg/m^3], positive.
  ContactDesc contact = {};
};

/// A rigid body. Its mass, its center and its inertia come from the volume of its shapes.
struct BodyDesc {
  BodyKind kind = BodyKind::kStatic;
  Shape shape = {};
  std::vector<PartDesc> parts = {};  ///< Of a compound: replace `density` and `contact`.
  DVec3 position = {};               ///< Origin of the body's frame [m].
  Quat rotation = {};                ///< Normalized on entry.
  Vec3 velocity = {};                ///< Of the center of mass [m/s].
  Vec3 angular_velocity = {};        ///< [rad/s], in the world's axes.
  Real density = Real(1000);         ///< [kg/m^3], positive.
  std::optional<Real> mass = {};     ///< [kg]: scales the density to give this mass.
  Real linear_damping = Real(0);     ///< Rate at which the velocity decays [1/s].
  Real angular_damping = Real(0);    ///< [1/s]
  Real gravity_scale = Real(1);
  Real drag_coefficient = Real(0);    ///< C_d of the area it shows to the flow of air (WindDesc), 0 to 1e6.
  Real magnus_coefficient = Real(0);  ///< C of the lift C rho V omega x v of a body that spins in air, V its
                                      ///< volume; within 1e6. A smooth ball at low speed: 0.75.
  Vec3 dipole_moment = {};  ///< Magnetic, at the center of mass, in the body's frame [A m^2]; at most 1e9
                            ///< long. A body that has one never sleeps. Magnetic fields turn and pull it, and
                            ///< all others that have one, whatever their kind.
  ContactDesc contact = {};
  FilterDesc filter = {};
  bool collides = true;  ///< False: only drawn.
  bool sensor = false;   ///< Pushes nothing; lists who comes and goes (Events, World::visitors).
  bool bullet = false;   ///< Swept against moving bodies too, not only against those that stand.
  bool can_sleep = true;
  bool reports_contacts = false;  ///< Begins and ends of its contacts are listed (Events).
  Real hit_speed = kRigid;        ///< What meets it faster than this [m/s] is listed (Events). Not negative;
                                  ///< infinite: nothing. Of two bodies the lower one counts.
  MotionDesc motion = {};         ///< kKinematic: its path from the start; rotation by `angular_velocity`.
  std::vector<ConnectionPointDesc> connection_points = {};
};

/// What a hook holds on one side: a body, a point of a rope, cloth, solid or group of particles, or, where
/// neither is given, the world itself.
struct HookEnd {
  BodyId body = {};
  PointRef point = {};  ///< Of a deformable object; its index may be PointRef::kNearest.
  /// The name of a place of either (ConnectionPointDesc): the hook is there, whatever its anchor and the
  /// point's index. Not of the world.
  std::string connection_point = {};
};

enum class HookKind : std::uint8_t {
  kBall,      ///< One point in common; turns freely within `cone` about its axis and `limits` of twist.
  kHinge,     ///< Turns about `axis`.
  kSlider,    ///< Slides along `axis` and does not turn.
  kFixed,     ///< Moves as one.
  kDistance,  ///< The distance of two points stays within `limits`, or what it was where there are none.
  kWheel,     ///< B slides along `axis` (suspension), steers about it, and rolls about `second_axis` (axle).
  kSixDegrees,  ///< Each of the six `freedoms` on its own.
  kRopeSlide,   ///< B slides along rope a, between its ends: a bead on a string. `anchor` says where it is.
};

/// Bounds of a freedom [m] or [rad]; infinite where there is none.
struct HookLimits {
  Real lower = -kRigid;
  Real upper = kRigid;

  friend bool operator==(const HookLimits&, const HookLimits&) = default;
};

/// F = -stiffness (value - target) - damping speed, whatever the stiffness without instability.
struct HookSpring {
  Real stiffness = Real(0);  ///< [N/m] or [N m/rad], not negative.
  Real damping = Real(0);    ///< [N s/m] or [N m s/rad], not negative.
  Real target = Real(0);     ///< Value at rest [m] or [rad], relative to how things stood when hooked.

  friend bool operator==(const HookSpring&, const HookSpring&) = default;
};

/// Drives a freedom at a speed with a force that is limited. Speed zero: friction.
struct HookMotor {
  Real speed = Real(0);      ///< [m/s] or [rad/s]
  Real max_force = Real(0);  ///< [N] or [N m], not negative; 0 switches the motor off.

  friend bool operator==(const HookMotor&, const HookMotor&) = default;
};

/// One of the ways in which b may move relative to a. Zero is how they stood when hooked.
struct HookFreedom {
  bool locked = false;  ///< Held at `spring.target`.
  HookLimits limits = {};
  HookSpring spring = {};
  HookMotor motor = {};

  friend bool operator==(const HookFreedom&, const HookFreedom&) = default;
};

/// Holds two ends together. Anchor and axes are given in the world, as things stand when the hook is made.
///
/// An end that names a connection point is held there, and an end that says nothing at the same place as the
/// other one; two that are named are drawn together, as two points are.
///
/// Points have no rotation: between a point and anything, kBall, kDistance, kRopeSlide, and kSlider with a
/// body or the world as a. A point is held where it is, whatever `anchor` says, and what it is hooked to at
/// the same place; two points are drawn together.
///
/// Freedoms are those of b relative to a, in a's axes: x along `axis`, y along the part of `second_axis` that
/// is across it, z across both (kWheel: z along the axle). A rotation is taken apart as one about a's x, then
/// y, then b's z; the second is meant to stay within 90 degrees.
struct HookDesc {
  HookKind kind = HookKind::kBall;
  HookEnd a = {};
  HookEnd b = {};
  DVec3 anchor = {};                         ///< Of both ends [m]; of a for kDistance.
  std::optional<DVec3> anchor_b = {};        ///< kDistance: of b [m]; `anchor` by default.
  Vec3 axis = {Real(0), Real(1), Real(0)};   ///< Any length but zero.
  std::optional<Vec3> second_axis = {};      ///< Not along `axis`; any direction across it by default.
  HookLimits limits = {};                    ///< Of what moves: angle, way, distance, twist, suspension.
  std::optional<Real> cone = {};             ///< kBall: largest angle between the axes [rad], (0, pi].
  HookSpring spring = {};                    ///< Of what moves. kBall: towards how things stood.
  HookMotor motor = {};                      ///< Of what moves. kWheel: about the axle. kBall: the speed
                                             ///< about `axis`, friction about every axis.
  HookFreedom steering = {.locked = true};   ///< kWheel: about the suspension's axis.
  std::array<HookFreedom, 6> freedoms = {};  ///< kSixDegrees: ways along x, y, z, then angles.
  Real break_force = kRigid;                 ///< [N], positive: takes no more, and breaks if it needs more.
  Real break_torque = kRigid;                ///< [N m], positive.
  /// Whether the two bodies may touch each other; of a body and a point, the point and what of its object was
  /// inside the body when it was hooked.
  bool collide = false;
};

/// A line of points of a cloth or solid, to be sewn: an edge by its name, or points.
struct SeamEdge {
  PointRef object = {};  ///< Of a cloth or solid; its index does not count.
  /// Of a cloth: on a grid `left`, `right`, `top`, `bottom` (ConnectionPointDesc); where there is one border,
  /// `border`, else `border_0`, ... by their lowest points: all around, as triangles run.
  std::string edge = {};
  std::vector<std::uint32_t> points = {};  ///< Instead: at least 2, one after the other along the line; the
                                           ///< first once more at the end if it is closed.
};

/// Sews two lines together from end to end: each point of the one that has more of them is hooked to the
/// place of the other line that is at the same share of its length. Open lines begin with the ends that are
/// nearer to each other; closed ones with the first point of `a` and the point of `b` that is nearest to it.
struct SeamDesc {
  SeamEdge a = {};
  SeamEdge b = {};
  Real strength = kRigid;  ///< [N/m], positive: a stitch lets go above this times its share of the length.
};

/// A chain of point masses solved as one: it does not stretch more than its stiffness says, whatever hangs on
/// it. The paper's builder: `masses` points laid from `hook_point` along `direction`.
struct RopeDesc {
  enum class StiffnessOf : std::uint8_t {
    kRope,  ///< Of the whole rope, whatever the number of points: each of the n segments is n times as stiff.
    kSegment,  ///< Of each segment, as in the paper: more points make a softer rope.
  };

  DVec3 hook_point = {};                          ///< Position of the first point [m].
  Vec3 direction = {Real(-1), Real(0), Real(0)};  ///< Any length but zero.
  Real total_mass = Real(1);                      ///< [kg], positive. Half a segment's share on each end.
  int masses = 16;                                ///< Number of points. [2, 65536]
  Real length_at_rest = Real(1);                  ///< [m], positive.
  Real stiffness = kRigid;                        ///< [N/m], positive or kRigid.
  Real inner_friction = Real(0);                  ///< [N s/m], not negative.
  Real air_friction = Real(0);  ///< Viscous drag of the whole rope [N s/m], shared out by length.
  Real extension_max = kRigid;  ///< Largest relative extension of a segment, e.g. 0.05. Positive.
  StiffnessOf stiffness_of = StiffnessOf::kRope;
  std::optional<Real> axial_stiffness = {};  ///< EA [N]: replaces `stiffness` by EA / length_at_rest.
  /// EI [N m^2], not negative: the rope resists bending and is straight at rest, a cable, a rod, a hair.
  /// Where its first or last two points are pinned it is clamped.
  Real bend_stiffness = Real(0);
  Real bend_damping = Real(0);  ///< Of bending, over EI [s], not negative.
  /// GJ [N m^2], not negative: resists twist between places that hold it against twist, where two neighboring
  /// points or more are pinned, or hooked by balls to the world or to one body. Needs a bend_stiffness.
  Real twist_stiffness = Real(0);
  Real twist = Real(0);  ///< Of the whole rope at the start, even over its length [rad].
  /// E [Pa], positive: replaces the stiffness, of the rope, and those against bending and twist by EA, E pi
  /// r^4 / 4 and G pi r^4 / 2 of a round rod of `radius` r, G = E / 2 (1 + poisson_ratio).
  std::optional<Real> youngs_modulus = {};
  Real poisson_ratio = Real(0.3);  ///< [-0.99, 0.5]
  std::vector<DVec3> points =
      {};  ///< Replaces hook_point, direction, masses, length_at_rest; taken as at rest.
  std::vector<PinDesc> pins = {{}};  ///< The first point by default; `{}` for none.
  std::vector<LoadDesc> loads = {};
  std::vector<ConnectionPointDesc> connection_points = {};
  Real radius = Real(0.005);          ///< Of the strand [m]: for contact, wind and drawing. Positive.
  Real drag_coefficient = Real(1.1);  ///< Of a cylinder across the flow. Not negative.
  Real charge = Real(0);              ///< [C], shared out by mass.
  Vec3 velocity = {};                 ///< Of all points at the start [m/s].
  /// Touches other ropes that say so too, and itself, all along, as a tube of `radius`, with the friction of
  /// `contact`. Segments less than half a turn of the tightest bend, pi x radius, apart along the rope do
  /// not touch each other. Off, ropes pass through each other at no cost.
  bool touches_ropes = false;
  /// s [N m^2], not negative: points of ropes with a repulsion that are nearer than r = `repulsion_range`
  /// push each other away with the force s (1 / d^2 - 1 / r^2): with the geometric mean of s of two ropes and
  /// the mean of r. Points less than pi / 2 r apart along one rope do not. It gives hair its thickness at
  /// little cost; strands still slip between points that are farther apart than r. 0: none.
  Real repulsion_strength = Real(0);
  Real repulsion_range = Real(0.01);  ///< [m], positive.
  ContactDesc contact = {};
};

/// A surface of point masses: a grid of `columns` x `rows` points, or the triangles of a mesh.
struct ClothDesc {
  enum class Bend : std::uint8_t {
    kAngle,   ///< By the dihedral angle at each inner edge; `bend_stiffness` in N m.
    kSpring,  ///< The paper's springs to the second neighbor; `bend_stiffness` in N/m.
    kNone,
    kIsometric,  ///< By the curvature at each inner edge, for cloth that is flat at rest and hardly
                 ///< stretches: needs no angle, and half the time of kAngle. `bend_stiffness` in N m.
  };

  int columns = 2;    ///< Points along `column_direction`. [2, 4096]
  int rows = 2;       ///< Points along `row_direction`. [2, 4096]
  DVec3 corner = {};  ///< Position of point 0 [m]. Point (column, row) is row * columns + column.
  Vec3 column_direction = {Real(1), Real(0), Real(0)};
  Vec3 row_direction = {Real(0), Real(-1), Real(0)};
  Real width = Real(1);   ///< Between the first and last column [m].
  Real height = Real(1);  ///< Between the first and last row [m].
  MeshId mesh = {};       ///< Replaces the grid: point i is vertex i.
  DVec3 position = {};    ///< Of the mesh's frame [m].
  Quat rotation = {};     ///< Of the mesh's frame.

  Real areal_density = Real(0.2);       ///< [kg/m^2], positive; mass goes to points by their share of area.
  std::optional<Real> total_mass = {};  ///< [kg]: replaces areal_density.
  Real thickness = Real(0.004);         ///< [m]: points keep half of it from what they touch. Positive.
  /// Of each spring along an edge [N/m], or kRigid. A substep h carries about 1.4 m / h^2 of it, m the mass
  /// of a point: cloth that is to stretch less needs more substeps, larger cells or more mass.
  Real stretch_stiffness = Real(1e4);
  Real shear_stiffness = Real(2e3);  ///< Of each spring across a cell or a pair of triangles [N/m].
  /// See Bend; in N m the flexural rigidity of a sheet that bends about lines across it. Diagonals fold, too:
  /// a strip with free sides bends by up to a quarter more (hooke check I23).
  Real bend_stiffness = Real(1e-4);
  /// Of each stretch and shear spring [N s/m]. Beyond ten times the spring's stiffness times a substep, and
  /// beyond half the mass of a point over a substep, it counts as that much.
  Real damping = Real(0);
  Real bend_damping = Real(0);  ///< Of each bend row, in units of bend_stiffness times s.
  Real yield_angle = kRigid;    ///< A pair of triangles bent farther than this [rad] from its form at rest
                                ///< keeps the rest of it: a fold. Bend::kAngle only; positive, or kRigid.
  Bend bend = Bend::kAngle;
  Real extension_max = kRigid;  ///< Largest relative extension of a stretch spring.
  bool tethers = false;  ///< Hold every point within its rest distance of the pins: inextensible cloth.
  /// Of a closed mesh: fills it with gas, so many pascals above the air around it (101325 Pa) at the volume
  /// it has when added; from then on (p + 101325 Pa) V stays the same. [-1e5, 1e8]
  std::optional<Real> pressure = {};
  Real drag_coefficient = Real(1.2);  ///< Of a triangle across the flow.
  Real lift_coefficient = Real(0.6);
  Real air_friction = Real(0);  ///< Viscous drag of the whole cloth [N s/m], shared out by area.
  std::vector<PinDesc> pins = {};
  std::vector<LoadDesc> loads = {};
  std::vector<ConnectionPointDesc> connection_points = {};
  Real charge = Real(0);  ///< [C], shared out by mass.
  Vec3 velocity = {};     ///< Of all points at the start [m/s].
  ContactDesc contact = {};
};

/// A soft solid: a box of cells, the inside of a closed mesh, or tetrahedra as given. Of tetrahedra, its
/// material keeps its law at any deformation: psi = mu / 2 tr(F^T F) + lambda / 2 (det F - 1 - mu / lambda)^2
/// (stable neo-Hookean, Smith, de Goes and Kim 2018), and comes back from being turned inside out; not from a
/// point: below (1 - 2 nu) / (2 - 2 nu) of its size it shrinks.
///
/// A substep of h seconds carries a wave through a cell, not farther: where mu is above about
/// density (edge / 4 h)^2, edge that of a cell, it acts as that. More substeps or larger cells carry more.
struct SolidDesc {
  enum class Elasticity : std::uint8_t {
    kTetrahedra,
    /// The cheap one: every point is drawn to its place in the form at rest, which lies where it fits all
    /// points best (Mueller, Heidelberger, Teschner and Gross 2005). Keeps momentum and spin, comes back from
    /// any deformation, and is as stiff whatever the substeps and the cells. Not a material: a point feels
    /// the whole but not its neighbors, and stiffness is by mass, so that few points yield more than many.
    /// Of a mesh its vertices are the points, and nothing is filled; `points` need no tetrahedra.
    kShapeMatching,
  };

  Elasticity elasticity = Elasticity::kTetrahedra;
  Real match_hz = Real(10);  ///< kShapeMatching: at which any deformation swings [Hz], positive; or
                             ///< kRigid: a body as rigid as one substep makes it.
  Real match_damping_ratio = Real(0.1);           ///< The same: 1 is critical. [0, 100]
  std::array<std::int32_t, 3> cells = {4, 4, 4};  ///< Of the box along x, y, z. Each [1, 256], 2^20 in all.
  Vec3 size = {Real(1), Real(1), Real(1)};        ///< Of the box about `position` [m], each positive.
  MeshId mesh = {};       ///< Replaces the box: the inside of a closed surface, as a lattice of cells whose
                          ///< outer points lie on the mesh. The mesh is carried along (World::surface).
  Real cell = Real(0.1);  ///< About the size of the lattice's cells [m], positive. Thinner parts are lost.
  std::vector<Vec3> points = {};  ///< With `tetrahedra`: replace the box [m]. Point i is points[i].
  std::vector<std::array<std::uint32_t, 4>> tetrahedra = {};  ///< Corners in any order, none without volume.
  DVec3 position = {};  ///< Of the box's center, of the mesh's frame, of the frame of `points` [m].
  Quat rotation = {};   ///< Of the same.

  Real density = Real(1000);            ///< [kg/m^3], positive. Of a mesh: of the volume inside it.
  std::optional<Real> total_mass = {};  ///< [kg]: replaces density.
  Real young_modulus = Real(1e5);       ///< E [Pa], positive.
  Real poisson_ratio = Real(0.45);      ///< nu. [0, 0.499]
  /// Viscosity over stiffness [s]: a wave of angular frequency w is damped by w damping / 2 of critical.
  /// [0, 0.1]
  Real damping = Real(0.002);
  /// sigma_y [Pa], positive, or kRigid: von Mises' stress, sqrt(3/2) |dev tau|, above which the solid flows,
  /// at constant volume and without hardening. A bar pulled by its end yields at sigma_y / E. The stress
  /// of `damping` comes on top. No part is stretched for good beyond 5 times or below a fifth.
  Real yield_stress = kRigid;
  Real thickness = Real(0.004);  ///< [m]: points keep half of it from what they touch. Positive.
  Real air_friction = Real(0);   ///< Viscous drag of the whole solid [N s/m], shared out by volume.
  std::vector<PinDesc> pins = {};
  std::vector<LoadDesc> loads = {};
  std::vector<ConnectionPointDesc> connection_points = {};
  Real charge = Real(0);  ///< [C], shared out by volume.
  Vec3 velocity = {};     ///< Of all points at the start [m/s].
  ContactDesc contact = {};
};

/// A damped Hooke spring between two points of one object. On the first: F = -[k (|x| - L) + c v.u] u, x =
/// x_a - x_b.
struct SpringDesc {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  Real stiffness = Real(100);            ///< k [N/m], not negative, or kRigid.
  Real damping = Real(0);                ///< c [N s/m], not negative.
  std::optional<Real> rest_length = {};  ///< L [m]; the distance at the start by default.
};

struct ParticleDesc {
  DVec3 position = {};       ///< [m]
  Vec3 velocity = {};        ///< [m/s]
  Real mass = Real(1);       ///< [kg], positive.
  Real charge = Real(0);     ///< [C]
  Real radius = Real(0.01);  ///< [m], positive.
};

/// Loose point masses and the springs between them.
struct ParticlesDesc {
  /// Where a spring's direction is taken: at the start of the substep (keeps energy), or where the points are
  /// about to be (quieter on very stiff lattices).
  enum class Direction : std::uint8_t { kExplicit, kPredicted };
  enum class Damping : std::uint8_t {
    kCentral,    ///< Along the spring: keeps angular momentum.
    kIsotropic,  ///< On the whole relative velocity, as in the paper: brakes rotation.
  };

  std::vector<ParticleDesc> particles = {};  ///< At least one.
  std::vector<SpringDesc> springs = {};
  Direction direction = Direction::kExplicit;
  Damping damping = Damping::kCentral;
  Real air_friction = Real(0);      ///< Viscous drag of each particle [N s/m].
  Real drag_coefficient = Real(0);  ///< Quadratic drag of each particle as a sphere of its radius.
  std::vector<PinDesc> pins = {};
  std::vector<ConnectionPointDesc> connection_points = {};
  ContactDesc contact = {};
};

/// A force on every particle and every body that forces move. On bodies it acts at the center of mass.
struct FieldDesc {
  enum class Kind : std::uint8_t {
    kUniform,        ///< Acceleration `vector` [m/s^2].
    kInverseSquare,  ///< Acceleration -strength (x - center) / |x - center|^3; none at the center itself.
    kMagnetic,  ///< Flux density B [T]: `vector` at `center`, and along it more by `strength` [T/m], across
                ///< it less by half of that: B = vector + strength (3 (a.d) a - d) / 2, d = x - center, a the
                ///< direction of `vector`. Force q v x B on charged particles; on bodies with a dipole
                ///< moment m torque m x B and force grad (m.B).
    kLiquid,    ///< At rest, or flowing with `vector` [m/s], below `height`: its surface lies across gravity,
                ///< that far above the origin; across y without gravity. Lifts by the weight of what is
                ///< displaced, at its center, and drags: velocity and spin of what displaces its own mass
                ///< decay at the rate `drag`. The liquid itself does not move. Bodies and solids displace
                ///< their volume, closed cloths with gas what they enclose; ropes and other cloths are as
                ///< thick as they collide, and loose particles balls.
    kSuction,   ///< Acceleration `strength` (1 - r / reach)^falloff towards `center`, r the distance from it.
    kVortex,    ///< The same about the axis `vector` through `center`, r the distance from the axis:
                ///< across it, counter-clockwise seen from its tip.
    kExplosion,  ///< At `time` the velocity changes by `strength` (1 - r / reach)^falloff away from `center`,
                 ///< at the start of the step in which that falls. Once; never if the time is over.
    kDipole,     ///< A magnetic dipole of moment `vector` [A m^2], at most 1e9 long, at rest at `center`: its
                 ///< flux density acts as that of kMagnetic does. None closer than 1e-6 m.
  };

  Kind kind = Kind::kUniform;
  Vec3 vector = {};
  DVec3 center = {};        ///< [m]
  double strength = 0.0;    ///< kInverseSquare: [m^3/s^2]; positive attracts. kSuction, kVortex: [m/s^2].
                            ///< kExplosion: [m/s]. kMagnetic: [T/m], within 1e9; not zero only with a
                            ///< direction to go by.
  double reach = 1.0;       ///< [m], 1e-6 to 1e9: from there on nothing is felt.
  int falloff = 1;          ///< 0 to 8; 0: as strong everywhere within reach.
  double height = 0.0;      ///< kLiquid: of the surface above the origin, against gravity [m].
  double density = 1000.0;  ///< kLiquid [kg/m^3], 0 to 1e6.
  double drag = 0.0;        ///< kLiquid [1/s], 0 to 1e6.
  double time = 0.0;        ///< kExplosion [s].
};

/// One object's particles as a force law sees them, in the order the maker gave them.
class ForceView;

/// Called once per particle substep for each object, in order of creation, on the thread that called step().
using ForceLaw = std::function<void(ForceView&)>;

/// The bodies that forces move and that are awake, as a force law sees them, in the same order in every run.
class BodyForceView;

/// Called once per substep, on the thread that called step().
using BodyForceLaw = std::function<void(BodyForceView&)>;

}  // namespace hooke
