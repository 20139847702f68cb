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
/// Descriptions of everything that a World can hold. They are plain aggregates with defaults; name what
/// differs:
///
///     world.add_rope({.hook_point = {0, 3, 0}, .total_mass = 0.4f, .masses = 32, .length_at_rest = 2})
///
/// Units are SI: meters, kilograms, seconds, newtons, radians. +Y is up. A stiffness may be `kRigid`.
/// Brackets give the range of a number. The World checks ranges when a description is added, and returns an
/// Error that names the field; what has no range here has the limits of hooke/limits.h.

namespace hooke {

/// Infinite stiffness: what has it does not stretch. As a limit it means "none".
inline constexpr Real kRigid = std::numeric_limits<Real>::infinity();

/// Wind, a function of time and place and never of the step. With r1 and r2 independent random numbers in
/// [-1, 1] that vary smoothly over `correlation_time` and `correlation_length`, e_main the direction of
/// `velocity`, and e_side the horizontal direction across it:
///
///     W(t, x) = |velocity| [(1 + gust r1(t, x)) e_main + side_gust r2(t, x) e_side]
struct WindDesc {
  /// How the wind varies.
  enum class Gusts : std::uint8_t {
    kSmooth,  ///< Smoothly in time and place.
    kPaper    ///< By one factor per step, as in the paper's eq. 9: it depends on the length of the step.
  };

  Vec3 velocity = {};                 ///< Mean velocity of the air [m/s].
  Real gust = Real(0);                ///< Relative size of the gusts along the wind. [0, 10]
  Real side_gust = Real(0);           ///< Relative size of the gusts across it. [0, 10]
  Real correlation_time = Real(0.5);  ///< Time over which gusts change [s]. [1e-6, 1e9]
  Real correlation_length = Real(2);  ///< Distance over which gusts change [m]. [1e-6, 1e9]
  std::uint32_t seed = 1;             ///< Seed of the random numbers; any value.
  Gusts gusts = Gusts::kSmooth;       ///< How the wind varies.
  /// Density of the air [kg/m^3]. [0, 1e6] 0 switches aerodynamic drag and lift off.
  Real air_density = Real(1.225);

  friend bool operator==(const WindDesc&, const WindDesc&) = default;
};

/// What two materials do to each other, in place of the rule at ContactDesc. The order of the two does not
/// matter; the first pair in the list counts.
struct MaterialPairDesc {
  std::uint16_t a = 0;        ///< ContactDesc::material of the one surface.
  std::uint16_t b = 0;        ///< ContactDesc::material of the other surface; may be the same.
  Real friction = Real(0.5);  ///< Coulomb coefficient while sliding. [0, 100]
  /// Coefficient while at rest; `friction` by default, and where it is below `friction`. [0, 100]
  std::optional<Real> static_friction = {};
  Real restitution = Real(0);  ///< Speed after over speed before. [0, 1]
};

/// Describes a World: what holds everywhere, and how exactly steps are solved.
struct WorldDesc {
  Vec3 gravity = {Real(0), Real(-9.81), Real(0)};  ///< Acceleration of everything [m/s^2].
  int substeps = 8;                                ///< Solver passes per step; more is stiffer. [1, 64]
  int particle_substeps = 1;                       ///< Passes over deformables in each substep. [1, 64]
  int workers = 1;     ///< Threads that step() uses; results do not change. [1, 64]
  WindDesc wind = {};  ///< Moving air.
  /// Pairs of materials that have a friction and restitution of their own.
  std::vector<MaterialPairDesc> materials = {};
  Real contact_hz = Real(60);  ///< Stiffness of contacts between bodies, as a frequency. [0.1, 1000]
  Real contact_damping_ratio = Real(5);  ///< Damping of these contacts; 1 is critical. [0.01, 100]
  /// Passes over contacts in each substep. [1, 8] 2 is cheaper than twice the substeps.
  int bias_sweeps = 1;
  bool sleeping = true;  ///< Whether bodies that have come to rest are skipped until something wakes them.
};

/// A displacement as a function of the time t since its start. It is zero at the start, unless keyframes say
/// otherwise. Only the fields of its kind count.
struct MotionDesc {
  /// The form of the function.
  enum class Kind : std::uint8_t {
    kStill,             ///< No displacement.
    kConstantVelocity,  ///< `velocity` t.
    kSine,              ///< `amplitude` (sin(2 pi `frequency_hz` t + `phase`) - sin(`phase`)).
    kKeyframes          ///< Straight lines between `keyframes`; the first and the last one hold beyond them.
  };
  /// A displacement at a time.
  struct Keyframe {
    double time = 0;   ///< Time since the start [s]; larger than that of the keyframe before.
    Vec3 offset = {};  ///< Displacement from the start [m].

    friend bool operator==(const Keyframe&, const Keyframe&) = default;
  };

  Kind kind = Kind::kStill;              ///< The form of the function.
  Vec3 velocity = {};                    ///< Velocity of kConstantVelocity [m/s].
  Vec3 amplitude = {};                   ///< Amplitude of kSine [m].
  Real frequency_hz = Real(1);           ///< Frequency of kSine [Hz]. [0, 1e6]
  Real phase = Real(0);                  ///< Phase of kSine at the start [rad]. [-1e6, 1e6]
  std::vector<Keyframe> keyframes = {};  ///< Keyframes of kKeyframes; at least one.

  friend bool operator==(const MotionDesc&, const MotionDesc&) = default;
};

/// A point that is held: still, or moved along a path.
struct PinDesc {
  std::uint32_t point = 0;  ///< Index of the point in its object.
  MotionDesc motion = {};   ///< Path of the point from where it is; still by default.
};

/// A mass that is added to a point.
struct LoadDesc {
  std::uint32_t point = 0;  ///< Index of the point in its object.
  Real mass = Real(1);      ///< Mass in addition to the point's own [kg], not negative.
};

/// A named place of an object, which hooks may use (HookEnd::connection_point). Every object has the names of
/// its kind as well, except those that it declares itself:
///
/// - bodies: `center` (of mass) and `origin` (of the frame);
/// - boxes: `left` (-x), `right`, `bottom` (-y), `top`, `back` (-z) and `front`, the centers of faces, and
///   the corners, from `bottom_left_back` to `top_right_front`;
/// - spheres, capsules and cylinders: the same six places, on the axes; cones: `top` and `bottom`;
/// - ropes: `start`, `middle` and `end`;
/// - cloths on a grid, seen with columns to the right and rows downward: `top_left`, `top_right`,
///   `bottom_left`, `bottom_right`, the middles of edges `left`, `right`, `top` and `bottom`, and `center`;
/// - boxes of solid: the names of boxes, without `origin`;
/// - particles: `start` of the first spring and `end` of the last; of a single particle, `center`.
struct ConnectionPointDesc {
  std::string name = {};  ///< The name, 1 to 64 bytes; no two of an object are the same.
  /// The place [m], in the frame of a body, of a cloth's mesh or of a solid. Ropes, grids and particles have
  /// no frame: the place is in the world. Except for bodies, the name means the nearest place of the object,
  /// as PointRef::kNearest does.
  DVec3 position = {};
  std::optional<std::uint32_t> point = {};  ///< Index of a point, in place of `position`; not of a body.
};

/// How a surface answers a contact. Two surfaces a and b act together with friction sqrt(a b), the larger
/// restitution, the larger rolling and spinning friction, and the sum of the surface velocities, unless
/// WorldDesc::materials lists the pair. Of ropes, cloths, solids and particles only `friction` counts.
struct ContactDesc {
  Real friction = Real(0.5);  ///< Coulomb coefficient while sliding. [0, 100]
  /// Coefficient while at rest; `friction` by default. [friction, 100]
  std::optional<Real> static_friction = {};
  Real restitution = Real(0);        ///< Speed after over speed before. [0, 1]
  Real rolling_friction = Real(0);   ///< Lever of the resistance to rolling [m]. [0, 1e6]
  Real spinning_friction = Real(0);  ///< Lever of the resistance to spin about the normal [m]. [0, 1e6]
  Vec3 surface_velocity = {};  ///< Velocity of the surface, as of a conveyor belt, in the body's frame [m/s].
  std::uint16_t material = 0;  ///< Number under which WorldDesc::materials lists the surface; any number.
};

/// What moves a body.
enum class BodyKind : std::uint8_t {
  kStatic,     ///< Nothing: the body never moves.
  kKinematic,  ///< Its path: the body moves as told, and what it touches does not move it.
  kDynamic,    ///< Forces and contacts.
};

/// Says which bodies collide, or which deformables. Two objects of one group collide always if the group is
/// positive, never if it is negative. All others collide if each is in a category that the other's mask has.
/// Bodies do not ask deformables, nor deformables bodies.
struct FilterDesc {
  std::uint32_t category = 1;       ///< Categories of the object, one per bit.
  std::uint32_t mask = 0xFFFFFFFF;  ///< Categories that it collides with, one per bit; all by default.
  std::int32_t group = 0;           ///< Its group; 0 for none.
};

/// One shape of a body that has several.
struct PartDesc {
  Shape shape = {};           ///< The shape; not a compound.
  Vec3 position = {};         ///< Origin of the shape's frame in the body's frame [m].
  Quat rotation = {};         ///< Rotation of the shape's frame in the body's. The World normalizes it.
  Real density = Real(1000);  ///< Density of the part [kg/m^3], positive.
  ContactDesc contact = {};   ///< Surface of the part.
};

/// What a rigid body becomes where it is hit hard: a soft solid in the same place, with the same mass,
/// momentum and angular momentum, that dents for good, and a rigid body again, of its new shape, once it has
/// come to rest in itself. docs/decisions/0050-rigid-to-soft-and-back.md says how.
///
/// Such a body is dynamic, collides, is no sensor, has one shape that is neither a compound nor a half-space,
/// a `gravity_scale` of 1 and no `dipole_moment`. Hooks hold it by kBall, kHinge, kFixed, kDistance or
/// kRopeSlide. While it is soft, hinges and fixed hooks hold it by two and three balls: limits, springs,
/// motors and break_torque rest, and break_force is judged by the ball at the hook's place alone. So do its
/// damping, drag and lift rest. It stays soft while a point of its solid is pinned, and for good once that
/// has been cut. A dented body whose tetrahedra have become too flat for a solid stays rigid for good.
/// Errors of add_body also: a shape that cannot be filled with tetrahedra.
struct YieldsDesc {
  /// Impulse along contact normals [N s], positive: the body yields in the step in which one other object
  /// gives it more. What merely lies on it gives it its weight times the length of a step.
  Real impulse = Real(100);
  /// Size of the cells of the solid, about [m], not negative; a tenth of the longest side with 0. A box has a
  /// whole number of cells along each side.
  Real cell = Real(0);
  Real young_modulus = Real(1e7);  ///< SolidDesc::young_modulus of the solid [Pa].
  Real poisson_ratio = Real(0.3);  ///< SolidDesc::poisson_ratio of the solid.
  Real damping = Real(0.005);      ///< SolidDesc::damping of the solid [s].
  Real yield_stress = Real(1e5);   ///< SolidDesc::yield_stress of the solid [Pa]; with kRigid no dent stays.
  Real thickness = Real(0.002);    ///< SolidDesc::thickness of the solid [m].
  /// Speed of its fastest point, relative to the motion of the whole as a rigid body, below which it counts
  /// as at rest in itself [m/s]. Positive.
  Real freeze_below = Real(0.05);
  Real freeze_after = Real(0.25);  ///< Time at rest in itself after which it is rigid again [s]. [0, 1e6]
};

/// A rigid body. The volume of its shapes gives its mass, its center and its inertia.
struct BodyDesc {
  BodyKind kind = BodyKind::kStatic;  ///< What moves the body.
  Shape shape = {};                   ///< The shape. Of a compound, `parts` have the shapes.
  std::vector<PartDesc> parts = {};  ///< Shapes of a compound; their density and contact replace those below.
  DVec3 position = {};               ///< Origin of the body's frame [m].
  Quat rotation = {};                ///< Rotation of the body's frame. The World normalizes it.
  Vec3 velocity = {};                ///< Velocity of the center of mass at the start [m/s].
  Vec3 angular_velocity = {};        ///< Angular velocity at the start, in the world's axes [rad/s].
  Real density = Real(1000);         ///< Density [kg/m^3], positive.
  std::optional<Real> mass = {};     ///< Mass [kg]: scales the density to give it.
  Real linear_damping = Real(0);     ///< Rate at which the velocity decays [1/s]. [0, 1e6]
  Real angular_damping = Real(0);    ///< Rate at which the angular velocity decays [1/s]. [0, 1e6]
  Real gravity_scale = Real(1);      ///< Factor on WorldDesc::gravity. [-1e6, 1e6]
  /// Coefficient C_d of the drag of air, on the area that the body shows to the flow (WindDesc). [0, 1e6]
  Real drag_coefficient = Real(0);
  /// Coefficient C of the lift C rho V omega x v of a body that spins in air, V its volume. [-1e6, 1e6] A
  /// smooth ball at low speed has 0.75 (Rubinow and Keller 1961).
  Real magnus_coefficient = Real(0);
  /// Magnetic dipole moment at the center of mass, in the body's frame [A m^2]; at most 1e9 long. Magnetic
  /// fields turn and pull it, and so do all other bodies that have one, whatever their kind. Such a body
  /// never sleeps.
  Vec3 dipole_moment = {};
  ContactDesc contact = {};  ///< Surface of the body.
  FilterDesc filter = {};    ///< Which bodies it collides with.
  bool collides = true;      ///< Whether it touches anything; if not, it is only drawn.
  bool sensor = false;       ///< Whether it pushes nothing, and lists who comes and goes (World::visitors).
  bool bullet = false;       ///< Whether it is swept against moving bodies too, and not only against others.
  bool can_sleep = true;     ///< Whether it may rest, and be skipped until something wakes it.
  bool reports_contacts = false;  ///< Whether Events lists the begins and ends of its contacts.
  /// Speed above which Events lists what meets it [m/s], not negative; nothing by default. Of two bodies the
  /// lower speed counts.
  Real hit_speed = kRigid;
  /// Path of the body's center from where it starts, for kKinematic. The body turns by `angular_velocity`.
  MotionDesc motion = {};
  std::vector<ConnectionPointDesc> connection_points = {};  ///< Names for places in the body's frame.
  /// What it becomes where it is hit hard; it stays rigid by default.
  std::optional<YieldsDesc> yields = {};
};

/// What a hook holds on one side: a body, or a point of a rope, cloth, solid or group of particles, or the
/// world itself if neither is given.
struct HookEnd {
  BodyId body = {};     ///< The body; null for a point or the world.
  PointRef point = {};  ///< The point of a deformable object; its index may be PointRef::kNearest.
  /// The name of a place of either (ConnectionPointDesc). The hook is there, whatever its anchor and the
  /// point's index are. The world has no names.
  std::string connection_point = {};
};

/// In which ways a hook lets b move relative to a.
enum class HookKind : std::uint8_t {
  kBall,      ///< One point in common. b turns freely within `cone` about the axis and `limits` of twist.
  kHinge,     ///< b turns about `axis`.
  kSlider,    ///< b slides along `axis` and does not turn.
  kFixed,     ///< b moves as one with a.
  kDistance,  ///< The distance of two points stays within `limits`, or as it was if there are none.
  kWheel,     ///< b slides along `axis` (suspension), steers about it, and rolls about `second_axis` (axle).
  kSixDegrees,  ///< Each of the six `freedoms` has its own limits, spring and motor.
  /// b slides along rope a, between its ends: a bead on a string. `anchor` says where it is, within a tenth
  /// of a segment of the rope or its thickness; what is farther off is refused. If the rope breaks so that b
  /// is left on a single point, the hook is gone, and no event tells it.
  kRopeSlide,
};

/// Bounds of a freedom [m] or [rad]: finite ones within 1e9, infinite ones for none.
struct HookLimits {
  Real lower = -kRigid;  ///< Smallest value.
  Real upper = kRigid;   ///< Largest value, not below `lower`.

  friend bool operator==(const HookLimits&, const HookLimits&) = default;
};

/// A damped spring on a freedom: F = -stiffness (value - target) - damping speed. It is stable at any
/// stiffness.
struct HookSpring {
  Real stiffness = Real(0);  ///< Stiffness [N/m] or [N m/rad], not negative.
  Real damping = Real(0);    ///< Damping [N s/m] or [N m s/rad], not negative.
  Real target = Real(0);     ///< Value at rest [m] or [rad], from how things stood when hooked.

  friend bool operator==(const HookSpring&, const HookSpring&) = default;
};

/// A motor drives a freedom at a speed, with a force that is limited. With speed zero it is friction.
struct HookMotor {
  Real speed = Real(0);      ///< Speed of b relative to a [m/s] or [rad/s].
  Real max_force = Real(0);  ///< Largest force [N] or torque [N m], not negative; 0 switches the motor off.

  friend bool operator==(const HookMotor&, const HookMotor&) = default;
};

/// One of the ways in which b may move relative to a. Its value is zero where they stood when hooked.
struct HookFreedom {
  bool locked = false;     ///< Whether it is held at `spring.target`.
  HookLimits limits = {};  ///< Bounds of its value.
  HookSpring spring = {};  ///< Spring that pulls it towards a value.
  HookMotor motor = {};    ///< Motor that drives it.

  friend bool operator==(const HookFreedom&, const HookFreedom&) = default;
};

/// A hook holds two ends together. Anchor and axes are given in the world, as things stand when the hook is
/// made.
///
/// An end that names a connection point is held there. An end that says nothing is held at the same place as
/// the other. Two named ends are drawn together, as two points are.
///
/// Points have no rotation. Between a point and anything there may be kBall, kDistance and kRopeSlide, and
/// kSlider if a is a body or the world. A point is held where it is, whatever `anchor` says, and what it is
/// hooked to is held at the same place; two points are drawn together.
///
/// Freedoms are those of b relative to a, in a's axes: x along `axis`, y along the part of `second_axis` that
/// is across it, z across both (kWheel: z along the axle). A rotation is taken apart into one about a's x,
/// then y, then b's z; the second should stay within 90 degrees.
///
/// "The main freedom" is the angle of a hinge, the way of a slider, the length of a distance, the suspension
/// of a wheel and the rotation of a ball.
struct HookDesc {
  HookKind kind = HookKind::kBall;  ///< In which ways b may move.
  HookEnd a = {};                   ///< The end that axes are fixed to; the world by default.
  HookEnd b = {};                   ///< The end that moves relative to a; the world by default.
  DVec3 anchor = {};                ///< Place at which both ends are held [m]; of kDistance, the place on a.
  std::optional<DVec3> anchor_b = {};       ///< Place on b of kDistance [m]; `anchor` by default.
  Vec3 axis = {Real(0), Real(1), Real(0)};  ///< The axis; any length but zero.
  std::optional<Vec3> second_axis = {};     ///< An axis not along `axis`; any direction across it by default.
  HookLimits limits = {};         ///< Bounds of the main freedom; of kBall, of the twist about `axis`.
  std::optional<Real> cone = {};  ///< kBall: largest angle between the axes of a and b [rad]. (0, pi]
  HookSpring spring = {};         ///< Spring on the main freedom; of kBall, towards how things stood.
  /// Motor on the main freedom; of kWheel, about the axle. Of kBall `speed` is about `axis`, and `max_force`
  /// acts as friction about the other axes.
  HookMotor motor = {};
  HookFreedom steering = {.locked = true};   ///< kWheel: the angle about the suspension's axis.
  std::array<HookFreedom, 6> freedoms = {};  ///< kSixDegrees: ways along x, y and z, then angles about them.
  /// Force [N], positive, as a mean over a substep: what needs more passes on about this much in that
  /// substep, and the hook is gone at the end of the step (Events::breaks). Force and torque are judged each
  /// by itself. Where hooks are solved row by row (RouteCounts::hooks_block, hooks_iterative) it breaks when
  /// two substeps in a row need more.
  Real break_force = kRigid;
  Real break_torque = kRigid;  ///< Torque [N m], positive, likewise.
  /// Whether the two bodies may touch each other. Of a body and a point, it says so for the point and for
  /// what of its object was inside the body when it was hooked.
  bool collide = false;
};

/// A line of points of a cloth or solid that is to be sewn: an edge by its name, or points one by one.
struct SeamEdge {
  PointRef object = {};  ///< Any point of the cloth or solid; its index does not count.
  /// Name of an edge of a cloth. A grid has `left`, `right`, `top` and `bottom` (ConnectionPointDesc). Every
  /// cloth with one border has `border`; with several it has `border_0`, `border_1`, ... in the order of
  /// their lowest points. Borders run all around, as their triangles do.
  std::string edge = {};
  /// Points in place of `edge`: at least 2, in their order along the line. A closed line ends with its first
  /// point.
  std::vector<std::uint32_t> points = {};
};

/// Sews two lines together from end to end. Each point of the line that has more points is hooked to the
/// place of the other line at the same share of its length. Open lines begin with the ends that are nearer to
/// each other; closed ones with the first point of `a` and the point of `b` that is nearest to it.
struct SeamDesc {
  SeamEdge a = {};  ///< The first line.
  SeamEdge b = {};  ///< The second line; it may belong to the same object.
  /// Strength [N/m], positive: a stitch breaks above this force per length of its share of the line.
  Real strength = kRigid;
};

/// A chain of point masses that is solved as one: it does not stretch more than its stiffness says, whatever
/// hangs on it. `masses` points lie from `hook_point` along `direction`, as in the paper's builder.
struct RopeDesc {
  /// What `stiffness` is the stiffness of.
  enum class StiffnessOf : std::uint8_t {
    kRope,     ///< The whole rope, whatever its points: each of the n segments is n times as stiff.
    kSegment,  ///< Each segment, as in the paper: more points make a softer rope.
  };

  DVec3 hook_point = {};                          ///< Position of the first point [m].
  Vec3 direction = {Real(-1), Real(0), Real(0)};  ///< Direction to the last point; any length but zero.
  Real total_mass = Real(1);      ///< Mass of the rope [kg], positive. Each end has half of an inner point's.
  int masses = 16;                ///< Number of points. [2, 65536]
  Real length_at_rest = Real(1);  ///< Length without tension [m], positive.
  Real stiffness = kRigid;        ///< Force over extension [N/m], positive or kRigid; see `stiffness_of`.
  Real inner_friction = Real(0);  ///< Damping along each segment [N s/m], not negative.
  Real air_friction = Real(0);    ///< Viscous drag of the whole rope [N s/m], shared out by length.
  Real extension_max = kRigid;    ///< Largest relative extension of a segment, such as 0.05. Positive.
  StiffnessOf stiffness_of = StiffnessOf::kRope;  ///< What `stiffness` belongs to.
  std::optional<Real> axial_stiffness = {};       ///< EA [N]: replaces `stiffness` by EA / length_at_rest.
  /// Stiffness against bending EI [N m^2], not negative. With it the rope is straight at rest: a cable, a
  /// rod, a hair. Where its first or last two points are pinned it is clamped.
  Real bend_stiffness = Real(0);
  Real bend_damping = Real(0);  ///< Damping of bending over EI [s], not negative.
  /// Stiffness against twist GJ [N m^2], not negative; it needs a bend_stiffness. The rope resists twist
  /// between places that hold it against twist: where two neighboring points or more are pinned, or are
  /// hooked by balls to the world or to one body.
  Real twist_stiffness = Real(0);
  Real twist = Real(0);  ///< Twist of the whole rope at the start, even over its length [rad].
  /// Young's modulus E [Pa], positive. It replaces the three stiffnesses by those of a round rod of `radius`
  /// r: EA, EI = E pi r^4 / 4 and GJ = G pi r^4 / 2, with G = E / (2 (1 + poisson_ratio)).
  std::optional<Real> young_modulus = {};
  Real poisson_ratio = Real(0.3);  ///< Poisson's ratio, for `young_modulus`. [-0.99, 0.5]
  /// Positions of all points, at rest [m]: replaces hook_point, direction, masses and length_at_rest.
  std::vector<DVec3> points = {};
  std::vector<PinDesc> pins = {{}};  ///< Points that are held: the first by default, `{}` for none.
  std::vector<LoadDesc> loads = {};  ///< Masses that are added to points.
  std::vector<ConnectionPointDesc> connection_points = {};  ///< Names for points or places.
  Real radius = Real(0.005);  ///< Radius of the strand, for contact, wind and drawing [m]. Positive.
  /// Tension that the rope can take [N], positive; any by default. A segment that would need more takes this
  /// for one substep and is broken then: the rope goes on as two. Where several need too much, the one that
  /// needs most goes first, of equals the first along the rope, and the others only if they still need too
  /// much. Events::rope_breaks says what broke.
  std::optional<Real> strength = {};
  Real drag_coefficient = Real(1.1);  ///< Coefficient of drag of a cylinder across the flow. [0, 1e6]
  Real charge = Real(0);              ///< Electric charge of the rope [C], shared out by mass. [-1e9, 1e9]
  Vec3 velocity = {};                 ///< Velocity of all points at the start [m/s].
  /// Whether it touches itself and other ropes that say so too, in a way that knots hold: contact, friction
  /// and stretch are solved together, all along, as a tube of `radius` with the friction of `contact`.
  /// Segments that are less than pi x radius apart along the rope, half a turn of the tightest bend, do not
  /// touch each other.
  bool touches_ropes = false;
  /// Whether it touches cloths, solids and other ropes that say so too, with friction, all along. It costs
  /// less than `touches_ropes`, and two ropes that have both use that. It suits what lies or falls: a rope
  /// that is taut or carries a load is stretched by some per cent where something presses on it, since
  /// contacts come after the rope has been solved. A rope does not touch what three hooks or more sew it to,
  /// nor what slides along it on a hook. Ropes that both have a `repulsion_strength` do not touch each other.
  bool touches_surfaces = false;
  FilterDesc filter = {};  ///< Which of these it touches.
  /// Repulsion s [N m^2], not negative; 0 for none. Points of ropes that are nearer than r =
  /// `repulsion_range` push each other away with the force s (1 / d^2 - 1 / r^2), d their distance; of two
  /// ropes the geometric mean of s counts and the mean of r. Points less than pi r / 2 apart along one rope
  /// do not. It gives hair its thickness at little cost; strands still slip between points that are farther
  /// apart than r.
  Real repulsion_strength = Real(0);
  Real repulsion_range = Real(0.01);  ///< Range r of the repulsion [m], positive.
  ContactDesc contact = {};           ///< Surface of the rope; only its friction counts.
  /// Whether Events lists the begins and ends of its contacts with bodies, deformables and itself.
  bool reports_contacts = false;
  /// Speed above which Events lists what meets it [m/s], not negative; nothing by default. Of two the lower
  /// speed counts.
  Real hit_speed = kRigid;
};

/// A surface of point masses: a grid of `columns` x `rows` points, or the triangles of a mesh.
struct ClothDesc {
  /// By what the cloth resists bending.
  enum class Bend : std::uint8_t {
    kAngle,   ///< The dihedral angle at each inner edge; `bend_stiffness` is in N m.
    kSpring,  ///< The paper's springs to the second neighbor; `bend_stiffness` is in N/m.
    kNone,    ///< Nothing.
    /// The curvature at each inner edge; `bend_stiffness` is in N m. It suits cloth that is flat at rest and
    /// hardly stretches: it needs no angle, and half the time of kAngle.
    kIsometric,
    /// The curvature along rows and columns of a grid, and its twist; `bend_stiffness` is in N m, the
    /// flexural rigidity of a plate whose Poisson's ratio is 0, in any direction. Each row and each column is
    /// bent as a whole, so that however stiff it is, and however light its points are, it has the stiffness
    /// it is given. A mesh has no rows: it resists bending as by kAngle, as does a grid with a `yield_angle`.
    kYarn,
  };

  int columns = 2;    ///< Number of points along `column_direction`. [2, 4096]
  int rows = 2;       ///< Number of points along `row_direction`. [2, 4096]
  DVec3 corner = {};  ///< Position of point 0 [m]. Point (column, row) has the index row * columns + column.
  Vec3 column_direction = {Real(1), Real(0), Real(0)};  ///< Direction in which columns count; not zero.
  Vec3 row_direction = {Real(0), Real(-1), Real(0)};  ///< Direction in which rows count; not along the other.
  Real width = Real(1);                               ///< Distance of the first and last column [m].
  Real height = Real(1);                              ///< Distance of the first and last row [m].
  MeshId mesh = {};     ///< Replaces the grid: point i is vertex i. Of equal triangles the first one counts.
  DVec3 position = {};  ///< Origin of the mesh's frame [m].
  Quat rotation = {};   ///< Rotation of the mesh's frame.

  Real areal_density = Real(0.2);  ///< Mass per area [kg/m^2], positive; points have their share of area.
  std::optional<Real> total_mass = {};  ///< Mass of the cloth [kg]: replaces areal_density.
  /// Points keep half of it from what they touch [m]. Positive. Of a surface that touches another, half of
  /// the mean edge counts at most.
  Real thickness = Real(0.004);
  /// Stiffness of each spring along an edge [N/m], or kRigid. A substep of h seconds carries about 0.8 m /
  /// h^2 of it in a sheet that hangs, and 1.4 m / h^2 in one that is pulled at an edge, m being the mass of a
  /// point: cloth that is to stretch less needs more substeps, larger cells or more mass.
  Real stretch_stiffness = Real(1e4);
  /// Stiffness of each spring across a cell or a pair of triangles [N/m]; a square of cells resists shear by
  /// as much. Woven cloth has 20 to 280 (Kawabata), heavy denim 110. Stiffer than light points carry, a
  /// draped sheet keeps what it cannot shear as strain.
  Real shear_stiffness = Real(100);
  /// Resistance to bending, in the unit that `bend` says; in N m, the flexural rigidity of a sheet that bends
  /// about lines across it. By kAngle and kIsometric diagonals fold, too: a strip with free sides bends by up
  /// to a quarter more (hooke check I23), and one pass over light points that are much stiffer does not hold
  /// them.
  Real bend_stiffness = Real(1e-4);
  /// Damping of each stretch and shear spring [N s/m]. It counts as at most ten times the spring's stiffness
  /// times a substep, and at most half the mass of a point over a substep.
  Real damping = Real(0);
  Real bend_damping = Real(0);  ///< Damping of each bend, over `bend_stiffness` [s].
  /// Angle [rad], positive, or kRigid, for Bend::kAngle, and for kYarn, which is kAngle then: what a pair of
  /// triangles is bent beyond it from its form at rest, it keeps as a fold.
  Real yield_angle = kRigid;
  /// Force per width that the cloth can take [N/m], positive; any by default. It tears where the strain of
  /// its triangles times `stretch_stiffness`, as a mean at a point, exceeds this: the point splits, across
  /// the direction of the largest strain. Beside a crack 60 % of it are enough, so that tears run. At most 8
  /// points of it split in a step, and with them what a cut has scored and what hangs by a point alone;
  /// World::splits says which. A closed cloth with gas bursts: the gas is gone at once. Tethers across a
  /// crack go. It needs a finite `stretch_stiffness`, and is strain times that of one spring: a force per
  /// width in a grid of square cells pulled along its yarns, and in other cells different by the ratio of
  /// their sides.
  std::optional<Real> strength = {};
  /// The strain that it can take, positive, in place of `strength`, or besides; the smaller one counts.
  std::optional<Real> tear_strain = {};
  Bend bend = Bend::kYarn;      ///< By what the cloth resists bending.
  Real extension_max = kRigid;  ///< Largest relative extension of a stretch spring.
  /// Whether points stay within their rest distance of the pins, whatever pulls at them (tethers). If it is
  /// not set, they do in cloth that can neither burst nor tear and has an `extension_max`, or would stretch
  /// by less than 0.1 % if it hung by one side: its springs are to hold, and one pass over them in a substep
  /// cannot. They may then be 0.2 % farther away, or `extension_max` if that is less or springs are softer.
  /// Hooks are no pins. Of more than 256 pins, or 32 of a mesh, those that lie far apart have tethers.
  std::optional<bool> tethers = {};
  /// Pressure of the gas in a closed mesh when it is added, above the 101325 Pa of the air around it [Pa].
  /// [-1e5, 1e8] The product of absolute pressure and volume then stays the same. There is no gas by default.
  std::optional<Real> pressure = {};
  Real drag_coefficient = Real(1.2);  ///< Coefficient C_d of drag of a triangle across the flow. [0, 1e6]
  Real lift_coefficient = Real(0.6);  ///< Coefficient C_l of lift of a slanted triangle. [0, 1e6]
  Real air_friction = Real(0);        ///< Viscous drag of the whole cloth [N s/m], shared out by area.
  std::vector<PinDesc> pins = {};     ///< Points that are held.
  std::vector<LoadDesc> loads = {};   ///< Masses that are added to points.
  std::vector<ConnectionPointDesc> connection_points = {};  ///< Names for points or places.
  Real charge = Real(0);     ///< Electric charge of the cloth [C], shared out by mass. [-1e9, 1e9]
  Vec3 velocity = {};        ///< Velocity of all points at the start [m/s].
  ContactDesc contact = {};  ///< Surface of the cloth; only its friction counts.
  /// Whether the cloth touches itself. It needs a thickness of at most half of the mean edge.
  bool self_contact = false;
  /// Which other cloths and solids it touches; all by default. Bodies are not asked.
  FilterDesc filter = {};
  /// Whether Events lists the begins and ends of its contacts with bodies, deformables and itself.
  bool reports_contacts = false;
  /// Speed above which Events lists what meets it [m/s], not negative; nothing by default. Of two the lower
  /// speed counts.
  Real hit_speed = kRigid;
};

/// A soft solid: a box of cells, the inside of a closed mesh, or tetrahedra as given.
///
/// The material of tetrahedra keeps its law at any deformation F (stable neo-Hookean, Smith, de Goes and Kim
/// 2018), with mu and lambda Lame's constants of `young_modulus` and `poisson_ratio`:
///
///     psi = mu / 2 tr(F^T F) + lambda / 2 (det F - 1 - mu / lambda)^2
///
/// It comes back from being turned inside out, but not from a point: below (1 - 2 nu) / (2 - 2 nu) of its
/// size it shrinks.
///
/// A substep of h seconds carries a wave through one cell, not farther. Where mu is above about density (edge
/// / (4 h))^2, edge that of a cell, the solid is solved as a whole, implicitly: it is as stiff as it says, at
/// a higher cost, but swings that are too fast for the substep die away.
struct SolidDesc {
  /// By what the solid resists deformation.
  enum class Elasticity : std::uint8_t {
    kTetrahedra,  ///< The material of its tetrahedra.
    /// Every point is drawn to its place in the form at rest, which lies where it fits all points best
    /// (Mueller, Heidelberger, Teschner and Gross 2005). It is the cheap one: it keeps momentum and spin,
    /// comes back from any deformation, and is as stiff whatever the substeps and the cells are. It is no
    /// material: a point feels the whole but not its neighbors, and stiffness goes by mass, so that few
    /// points yield more than many. Of a mesh its vertices are the points, and nothing is filled; `points`
    /// need no tetrahedra.
    kShapeMatching,
  };

  Elasticity elasticity = Elasticity::kTetrahedra;  ///< By what the solid resists deformation.
  /// Frequency at which a deformation swings, for kShapeMatching [Hz], positive. kRigid makes a body as rigid
  /// as one substep can.
  Real match_hz = Real(10);
  Real match_damping_ratio = Real(0.1);  ///< Damping of that swing; 1 is critical. [0, 100]
  /// Number of cells of the box along x, y and z. Each [1, 256], 2^20 in all.
  std::array<std::int32_t, 3> cells = {4, 4, 4};
  Vec3 size = {Real(1), Real(1), Real(1)};  ///< Lengths of the box about `position` [m], each positive.
  /// Replaces the box by the inside of a closed surface: a lattice of cells whose outer points lie on the
  /// mesh. The mesh is carried along (World::surface).
  MeshId mesh = {};
  /// Size of the lattice's cells, about [m], positive. Parts thinner than a cell become as thick as one, and
  /// parts that do not touch are joined by cells, so that the solid is one piece.
  Real cell = Real(0.1);
  /// Another mesh, which may be open, to be carried along and drawn in place of `mesh` or of the outer faces.
  /// Shape matching of the vertices of `mesh` has none.
  MeshId visual = {};
  std::vector<Vec3> points = {};  ///< Replace the box, with `tetrahedra`, in the solid's frame [m].
  /// Four indices into `points` for each tetrahedron, in any order; none may be flat.
  std::vector<std::array<std::uint32_t, 4>> tetrahedra = {};
  DVec3 position = {};  ///< Center of the box, or origin of the frame of the mesh or of `points` [m].
  Quat rotation = {};   ///< Rotation of the same.

  Real density = Real(1000);            ///< Density [kg/m^3], positive; of a mesh, of the volume inside it.
  std::optional<Real> total_mass = {};  ///< Mass of the solid [kg]: replaces density.
  Real young_modulus = Real(1e5);       ///< Young's modulus E [Pa]. [1e-6, 1e12]
  Real poisson_ratio = Real(0.45);      ///< Poisson's ratio nu; near 0.5 the volume stays. [0, 0.499]
  /// Viscosity over stiffness [s]. [0, 0.1] A wave of angular frequency w is damped by w damping / 2 of
  /// critical.
  Real damping = Real(0.002);
  /// Yield stress sigma_y [Pa], positive, or kRigid. Above it, by von Mises' stress sqrt(3/2) |dev tau|, the
  /// solid flows at constant volume and without hardening. A bar pulled by its end yields at the strain
  /// sigma_y / E. The stress of `damping` comes on top. No part is stretched for good beyond 5 times or below
  /// a fifth.
  Real yield_stress = kRigid;
  /// Largest principal stress that the solid takes [Pa], positive; any by default. Where the mean stress of
  /// the tetrahedra at a point exceeds it, the point splits, across the direction of that stress: they part
  /// along the faces nearest to that plane. Beside a crack 60 % of it are enough, so that tears run. At most
  /// 8 points a step split; Events::solid_tears says which. It needs tetrahedra. What has come apart goes
  /// through the other part unless `self_contact` is set.
  std::optional<Real> strength = {};
  /// Points keep half of it from what they touch [m]. Positive. Of a surface that touches another, half of
  /// the mean edge counts at most.
  Real thickness = Real(0.004);
  Real air_friction = Real(0);       ///< Viscous drag of the whole solid [N s/m], shared out by volume.
  std::vector<PinDesc> pins = {};    ///< Points that are held.
  std::vector<LoadDesc> loads = {};  ///< Masses that are added to points.
  std::vector<ConnectionPointDesc> connection_points = {};  ///< Names for points or places.
  Real charge = Real(0);     ///< Electric charge of the solid [C], shared out by volume. [-1e9, 1e9]
  Vec3 velocity = {};        ///< Velocity of all points at the start [m/s].
  ContactDesc contact = {};  ///< Surface of the solid; only its friction counts.
  /// Whether the solid touches itself. It needs a thickness of at most half of the mean edge of its surface.
  bool self_contact = false;
  /// Which other cloths and solids it touches; all by default. Bodies are not asked.
  FilterDesc filter = {};
  /// Whether Events lists the begins and ends of its contacts with bodies, deformables and itself.
  bool reports_contacts = false;
  /// Speed above which Events lists what meets it [m/s], not negative; nothing by default. Of two the lower
  /// speed counts.
  Real hit_speed = kRigid;
};

/// A damped Hooke spring between two points of one object. With x = x_a - x_b, u = x / |x| and v the velocity
/// of a relative to b, the force on a is
///
///     F = -[k (|x| - L) + c v.u] u
struct SpringDesc {
  std::uint32_t a = 0;                   ///< Index of the one particle.
  std::uint32_t b = 0;                   ///< Index of the other particle.
  Real stiffness = Real(100);            ///< Stiffness k [N/m], not negative, or kRigid.
  Real damping = Real(0);                ///< Damping c [N s/m], not negative.
  std::optional<Real> rest_length = {};  ///< Length at rest L [m]; the distance at the start by default.
};

/// A loose point mass.
struct ParticleDesc {
  DVec3 position = {};       ///< Position at the start [m].
  Vec3 velocity = {};        ///< Velocity at the start [m/s].
  Real mass = Real(1);       ///< Mass [kg], positive.
  Real charge = Real(0);     ///< Electric charge [C]. [-1e9, 1e9]
  Real radius = Real(0.01);  ///< Radius for contact, drag and drawing [m], positive.
};

/// Loose point masses and the springs between them.
struct ParticlesDesc {
  /// Where a spring's direction is taken.
  enum class Direction : std::uint8_t {
    kExplicit,  ///< At the start of the substep: keeps energy.
    kPredicted  ///< Where the points are about to be: quieter on very stiff lattices.
  };
  /// What the damping of a spring acts on.
  enum class Damping : std::uint8_t {
    kCentral,    ///< The relative velocity along the spring: keeps angular momentum.
    kIsotropic,  ///< The whole relative velocity, as in the paper: brakes rotation.
  };

  std::vector<ParticleDesc> particles = {};    ///< The particles; at least one.
  std::vector<SpringDesc> springs = {};        ///< Springs between them.
  Direction direction = Direction::kExplicit;  ///< Where the springs' directions are taken.
  Damping damping = Damping::kCentral;         ///< What the springs' damping acts on.
  Real air_friction = Real(0);                 ///< Viscous drag of each particle [N s/m], not negative.
  /// Coefficient of drag of each particle, as a ball of its radius. [0, 1e6]
  Real drag_coefficient = Real(0);
  std::vector<PinDesc> pins = {};                           ///< Particles that are held.
  std::vector<ConnectionPointDesc> connection_points = {};  ///< Names for particles or places.
  ContactDesc contact = {};  ///< Surface of the particles; only its friction counts.
  /// Whether Events lists the begins and ends of its contacts with bodies, deformables and itself.
  bool reports_contacts = false;
  /// Speed above which Events lists what meets it [m/s], not negative; nothing by default. Of two the lower
  /// speed counts.
  Real hit_speed = kRigid;
};

/// A force on every particle and on every body that forces move. On bodies it acts at the center of mass;
/// only a liquid lifts at the center of what is displaced. Only the fields of its kind count.
struct FieldDesc {
  /// The law of the force.
  enum class Kind : std::uint8_t {
    kUniform,        ///< The acceleration `vector` [m/s^2].
    kInverseSquare,  ///< The acceleration -strength (x - center) / |x - center|^3; none at the center itself.
    /// The flux density B = vector + strength (3 (a.d) a - d) / 2 [T], with d = x - center and a the
    /// direction of `vector`: `vector` at the center, along it more by `strength` [T/m], across it less by
    /// half of that. It pushes charged particles with q v x B, and turns a body of dipole moment m with m x B
    /// and pulls it with grad (m.B).
    kMagnetic,
    /// A liquid at rest, or flowing with `vector` [m/s], below `height`. Its surface lies across gravity,
    /// that far above the origin; across y without gravity. It lifts by the weight of what is displaced, at
    /// its center, and drags: velocity and spin of what displaces its own mass decay at the rate `drag`. The
    /// liquid itself does not move. Bodies and solids displace their volume, and closed cloths with gas what
    /// they enclose; ropes and other cloths are as thick as they collide, and loose particles are balls.
    kLiquid,
    /// The acceleration strength (1 - r / reach)^falloff towards `center`, r the distance from it.
    kSuction,
    /// The same size about the axis `vector` through `center`, r the distance from the axis. It points across
    /// the axis, counter-clockwise seen from its tip.
    kVortex,
    /// At `time` the velocity changes by strength (1 - r / reach)^falloff away from `center`, at the start of
    /// the step in which that falls: once, and never if the time is over.
    kExplosion,
    /// A magnetic dipole of moment `vector` [A m^2], at most 1e9 long, at rest at `center`. Its flux density
    /// acts as that of kMagnetic does. There is none closer than 1e-6 m.
    kDipole,
  };

  Kind kind = Kind::kUniform;  ///< The law of the force.
  Vec3 vector = {};            ///< Acceleration, flux density, flow, axis or moment, as the kind says.
  DVec3 center = {};           ///< Center of the field [m].
  /// Strength: of kInverseSquare [m^3/s^2], where positive attracts; of kSuction and kVortex [m/s^2]; of
  /// kExplosion [m/s]; of kMagnetic [T/m], within 1e9, and zero if `vector` is.
  double strength = 0.0;
  double reach = 1.0;   ///< Distance from which on nothing is felt [m]. [1e-6, 1e9]
  int falloff = 1;      ///< Exponent of the decay within reach; 0: as strong everywhere. [0, 8]
  double height = 0.0;  ///< Height of a liquid's surface above the origin, against gravity [m]. [-1e9, 1e9]
  double density = 1000.0;  ///< Density of a liquid [kg/m^3]. [0, 1e6]
  double drag = 0.0;        ///< Rate at which motion in a liquid decays [1/s]. [0, 1e6]
  double time = 0.0;        ///< Time of an explosion, of the world's clock [s].
};

/// The points of one object as a force law sees them, in the order that their maker gave.
class ForceView;

/// A function that adds forces to the points of objects. It is called once per particle substep for each
/// object, in order of creation, on the thread that called step(). A step in which a body yields
/// (BodyDesc::yields) is taken back and made again: then it is called again for the same time.
using ForceLaw = std::function<void(ForceView&)>;

/// The bodies that forces move and that are awake, as a force law sees them, in the same order in every run.
class BodyForceView;

/// A function that adds forces to bodies. It is called once per substep in which one of its bodies is awake,
/// on the thread that called step().
using BodyForceLaw = std::function<void(BodyForceView&)>;

}  // namespace hooke
