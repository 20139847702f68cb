#pragma once

#include "hooke/desc.h"
#include "hooke/fracture.h"
#include "hooke/lab.h"
#include "hooke/model_io.h"
#include "hooke/placement.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Scenes: what a JSON file says, as plain data, and the simulation that runs it. Part of the library
/// `hooke::io`. Read Scene first, then Simulation; docs/scene_format.md describes the file, and gives the
/// range of every key.

namespace hooke {

/// Newest version of the format that this library reads, and the one that it writes.
inline constexpr int kSceneVersion = 1;

/// Largest number of points of all objects together, including those that events add. A body counts as one
/// point, or as many as it has parts; a hook counts as one.
inline constexpr std::size_t kMostScenePoints = 1'000'000;

/// How a surface looks and how it answers a contact.
struct SceneMaterial {
  std::string name = {};                            ///< Name that objects refer to; unique.
  std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  ///< Linear red, green and blue, each in [0, 1].
  std::string texture = {};  ///< Path of an image, relative to the scene file; empty for none.
  float shininess = 16.0f;   ///< Exponent of Blinn and Phong's highlights, without a roughness. [1, 1000]
  float opacity = 1.0f;      ///< Opacity; 1 hides what is behind. [0, 1]
  std::string like = {};     ///< Name of the library's material that gave what a file does not say; or empty.
  float metalness = 0.0f;    ///< 0 for an insulator, 1 for a metal. [0, 1]
  std::optional<Real> roughness = {};     ///< 0 for a mirror, 1 for chalk. [0, 1]
  float transmission = 0.0f;              ///< Share of the light that goes through. [0, 1]
  float sheen = 0.35f;                    ///< Light that the fibers of a cloth throw at its rim. [0, 1]
  std::optional<Real> thread_pitch = {};  ///< Distance of the threads of a cloth [m], positive.
  bool hair = false;                      ///< Whether ropes are drawn as tufts of hair.
  /// Width of the tiles that lines mark on a level half-space [m]; 0 for none. [0, 1000]
  Real tiles = Real(1);
  std::string normal_map = {};     ///< Path of an image of normals, or of heights in grays; empty for none.
  float normal_scale = 1.0f;       ///< How strong its relief is; a negative one turns it inward. [-100, 100]
  std::string roughness_map = {};  ///< Path of an image: green times roughness, blue times metalness.
  // What a file's objects of this material get unless they say it themselves. Objects that are made in C++ do
  // not.
  std::optional<Real> density = {};            ///< Of bodies that move and of solids [kg/m^3], positive.
  std::optional<Real> young_modulus = {};      ///< Of solids [Pa], positive.
  std::optional<Real> poisson_ratio = {};      ///< Of solids. [0, 0.499]
  std::optional<Real> areal_density = {};      ///< Of cloths [kg/m^2], positive.
  std::optional<Real> stretch_stiffness = {};  ///< Of cloths: force per width over strain [N/m], positive.
  std::optional<Real> shear_stiffness = {};    ///< Of cloths: force per width over the angle [N/m], positive.
  std::optional<Real> bend_stiffness = {};  ///< Of cloths: moment per width over curvature [N m], positive.
  std::optional<Real> linear_density = {};  ///< Of ropes [kg/m], positive.
  std::optional<Real> diameter = {};        ///< Of ropes [m], positive.
  std::optional<Real> strength = {};        ///< Tension at which ropes break [N], positive.
  std::optional<YieldsDesc> yields = {};    ///< What bodies that move and are no compounds do when hit hard.
  Real friction = Real(0.5);                ///< Coulomb coefficient while sliding. [0, 100]
  /// Coefficient while at rest; `friction` by default. [friction, 100]
  std::optional<Real> static_friction = {};
  Real restitution = Real(0);        ///< Speed after over speed before. [0, 1]
  Real rolling_friction = Real(0);   ///< Lever of the resistance to rolling [m], not negative.
  Real spinning_friction = Real(0);  ///< Lever of the resistance to spin about the normal [m], not negative.
};

/// Returns the names of the library's materials, in alphabetical order. A scene may use them without saying
/// what they are (docs/materials.md).
[[nodiscard]] std::vector<std::string> library_materials();

/// What two materials do to each other, in place of what their own numbers would give.
struct ScenePair {
  std::string a = {};          ///< Name of the one material in Scene::materials.
  std::string b = {};          ///< Name of the other material.
  MaterialPairDesc desc = {};  ///< What they do to each other. The simulation fills in the numbers a and b.
};

/// Triangles for bodies, cloths and solids: a file, or vertices and triangles in place.
struct SceneMesh {
  std::string name = {};             ///< Name that objects refer to; unique.
  std::string file = {};             ///< Path relative to the scene file; empty if `mesh` has the triangles.
  ImportOptions import = {};         ///< How the file is brought into Hooke's frame.
  MeshTree tree = MeshTree::kBoxes;  ///< Structure for World::add_mesh.
  /// Voxels [m], positive, of which the surface that bodies collide by and that solids fill is made
  /// (remesh_solid). Without it a mesh that is no solid is closed by default_voxel, with a warning.
  std::optional<Real> voxel_size = {};
  MeshDesc mesh = {};  ///< Triangles in place of a file.
  /// Names for places of every object that is made of the mesh, in its frame; point numbers are of vertices.
  std::vector<ConnectionPointDesc> connection_points = {};
};

/// A point of an object: an index, or the last one.
struct ScenePoint {
  std::uint32_t index = 0;  ///< Index of the point; 0 if `last` is set.
  bool last = false;        ///< Whether the object's last point is meant.
  friend bool operator==(const ScenePoint&, const ScenePoint&) = default;
};

/// Points that are held, chosen by their number or by their place.
struct ScenePin {
  /// How the points are chosen.
  enum class Pick : std::uint8_t {
    kPoint,    ///< One point, by its number.
    kColumn,   ///< All points of a column of a cloth's grid.
    kRow,      ///< All points of a row of a cloth's grid.
    kTopmost,  ///< All points not further than `within` below the highest.
  };

  Pick pick = Pick::kPoint;  ///< How the points are chosen.
  ScenePoint point = {};     ///< The point, or the number of the column or row.
  Real within = Real(0.01);  ///< Depth below the highest point, for kTopmost [m], not negative.
  MotionDesc motion = {};    ///< Path of the points; still by default.
};

/// A mass that is added to a point.
struct SceneLoad {
  ScenePoint point = {};  ///< The point.
  Real mass = Real(1);    ///< Mass in addition to the point's own [kg], not negative.
};

/// Copies of one object. Copy i is named `name[i]`. Only the fields of its kind count.
struct SceneArray {
  /// How the copies are arranged.
  enum class Kind : std::uint8_t {
    kSingle,   ///< The object alone, under its own name.
    kGrid,     ///< grid[0] x grid[1] x grid[2] copies, x fastest, `spacing` apart.
    kPyramid,  ///< `pyramid` copies in the lowest row along x, one less in each row above.
    kRandom,   ///< `random` copies, uniform in `box`, by `seed`.
    kList,     ///< One copy for each offset in `list`.
  };

  Kind kind = Kind::kSingle;                             ///< How the copies are arranged.
  std::array<std::int32_t, 3> grid = {1, 1, 1};          ///< Copies along x, y and z. Each [1, 1e6]
  std::int32_t pyramid = 1;                              ///< Copies in the lowest row of a pyramid. [1, 1000]
  std::int32_t random = 1;                               ///< Number of random copies. [1, 1e6]
  DVec3 spacing = {1, 1, 1};                             ///< Distances of neighbors in a grid or pyramid [m].
  std::uint32_t seed = 1;                                ///< Seed of a random array; any value.
  std::array<DVec3, 2> box = {DVec3{}, DVec3{1, 1, 1}};  ///< Smallest and largest random offset [m].
  std::vector<DVec3> list = {};                          ///< Offsets of the copies of a list [m].
  std::vector<Quat> rotations = {};  ///< Rotations of a list of bodies: as many as `list` has, or none.

  /// Number of copies, at most 2^40.
  [[nodiscard]] std::size_t count() const;
  /// Offset of copy `i` from the object as described [m]; zero beyond count().
  [[nodiscard]] DVec3 offset(std::size_t i) const;
  /// Rotation of copy `i` about its own origin, after that of the object as described.
  [[nodiscard]] Quat rotation(std::size_t i) const;
};

/// What bodies, ropes, cloths, solids and particles have in common.
struct SceneTag {
  std::string name = {};      ///< Unique name; an object without is called by its path, as "ropes[0]".
  std::string material = {};  ///< Name in Scene::materials; empty for none.
  std::optional<Real> friction = {};  ///< Friction in place of the material's. [0, 100]
  /// Method by which the laboratory integrates the object: a name of lab::steppers() or "auto"; empty for
  /// what the run chooses. Bodies have none.
  std::string stepper = {};
  SceneArray array = {};  ///< Copies of the object.
};

// Objects hold their descriptions by value. What refers to something by name or by place stands beside the
// description, and is filled into it when the world is built: meshes, pins, loads, friction.

/// One shape of a body that has several.
struct ScenePart {
  PartDesc desc = {};         ///< The part; its mesh and contact come from the names below.
  std::string mesh = {};      ///< Name in Scene::meshes, for a mesh or a hull.
  std::string material = {};  ///< Name in Scene::materials; the body's by default.
};
/// How a body is broken beforehand.
struct SceneFracture {
  FractureDesc desc = {};     ///< How it is divided. Places are in the body's frame.
  Real strength = Real(1e6);  ///< Stress at which the glue between the cells breaks [Pa], or kRigid.
};
/// The sharp edge of a kinematic body: it cuts the ropes, cloths and solids that it sweeps (World::cut).
struct SceneBlade {
  std::array<Vec3, 2> edge = {};       ///< Ends of the edge in the body's frame [m].
  std::vector<std::string> cuts = {};  ///< Names of what it cuts, arrays as a whole; empty for all.
};
/// The cross section of a bar, for `hooke load`. It is told by its area and second moment, or by its shape:
/// round with a radius, a tube if it has a thickness; or a rectangle, a box if it has a thickness.
struct SceneSection {
  std::optional<Real> area = {};           ///< [m^2], positive.
  std::optional<Real> second_moment = {};  ///< The least one, about an axis in the section [m^4], positive.
  std::optional<Real> radius = {};         ///< Outer radius [m], positive.
  std::optional<Real> width = {};          ///< Of a rectangle [m], positive.
  std::optional<Real> height = {};         ///< Of a rectangle [m], positive.
  std::optional<Real> thickness = {};      ///< Of the wall of a tube or box [m], positive.
  std::optional<Real> young_modulus = {};  ///< [Pa]; that of the material by default.
  std::optional<Real> yield_stress = {};   ///< Stress at which it yields [Pa].
  Real length_factor = Real(1);  ///< Length over which it buckles, over its length; 1 for hinged ends.
};
/// A body.
struct SceneBody {
  SceneTag tag = {};                  ///< Name, material, friction and copies.
  BodyDesc desc = {};                 ///< The body; its mesh, contact and parts come from below.
  std::string mesh = {};              ///< Name in Scene::meshes, for a mesh or a hull.
  std::string visual = {};            ///< Name in Scene::meshes of what is drawn in place of the shape.
  std::vector<ScenePart> parts = {};  ///< Shapes of a compound, in place of desc.parts.
  /// Replaces a dynamic box, hull or mesh by its cells, named `name[0]`, ..., of all copies one after the
  /// other, and the hooks between them, `name_glue[0]`, ...
  std::optional<SceneFracture> fracture = {};
  std::optional<SceneBlade> blade = {};      ///< Makes a blade of a kinematic body.
  std::optional<SceneSection> section = {};  ///< Of a bar, by which `hooke load` evaluates it.
};
/// A rope.
struct SceneRope {
  SceneTag tag = {};                  ///< Name, material, friction, stepper and copies.
  RopeDesc desc = {};                 ///< The rope; its pins, loads and friction come from here.
  std::vector<ScenePin> pins = {{}};  ///< Points that are held; the first by default.
  std::vector<SceneLoad> loads = {};  ///< Masses that are added to points.
};
/// A cloth.
struct SceneCloth {
  SceneTag tag = {};                  ///< Name, material, friction, stepper and copies.
  ClothDesc desc = {};                ///< The cloth; its mesh, pins, loads and friction come from here.
  std::string mesh = {};              ///< Name in Scene::meshes; empty for a grid.
  std::vector<ScenePin> pins = {};    ///< Points that are held.
  std::vector<SceneLoad> loads = {};  ///< Masses that are added to points.
};
/// A soft solid.
struct SceneSolid {
  SceneTag tag = {};                ///< Name, material, friction, stepper and copies.
  SolidDesc desc = {};              ///< The solid; its mesh, pins and friction come from here.
  std::string mesh = {};            ///< Name in Scene::meshes; empty for a box of cells.
  std::string visual = {};          ///< Name in Scene::meshes of what is drawn in place of `mesh` or the box.
  std::vector<ScenePin> pins = {};  ///< Points that are held.
};
/// Loose point masses and their springs.
struct SceneParticles {
  SceneTag tag = {};                ///< Name, material, friction, stepper and copies.
  ParticlesDesc desc = {};          ///< The particles; their pins and friction come from here.
  std::vector<ScenePin> pins = {};  ///< Particles that are held.
};
/// A hook. In an array, copy i holds copy i of `a` and of `b` if they are arrays, counted from the copy that
/// is named: with "link[1]", copy i holds link[1 + i]. A hook that is no array and names a fractured body
/// without a number holds the cell in which its anchor lies, or which has the named connection point.
struct SceneHook {
  std::string name = {};             ///< Name as SceneTag::name.
  HookDesc desc = {};                ///< The hook, except for `a`, `b` and `anchor`.
  std::optional<DVec3> anchor = {};  ///< HookDesc::anchor; needed unless a point or a name says where.
  /// Name of what is held on one side, or "name.point" with one of its connection points; empty for the
  /// world.
  std::string a = {};
  std::string b = {};  ///< The same of the other side.
  /// Point of a rope, cloth, solid or particles on side a; without it, the place nearest to the anchor.
  std::optional<ScenePoint> a_point = {};
  std::optional<ScenePoint> b_point = {};    ///< The same of side b.
  std::optional<SceneSection> section = {};  ///< Of a distance hook, by which `hooke load` evaluates it.
  SceneArray array = {};                     ///< Copies of the hook; offsets move their anchors.
};
/// Two lines that are sewn together. The stitches are hooks named `name[0]`, `name[1]`, ... In an array, copy
/// i sews copy i of `a` and of `b`, as a hook holds them, and its stitches follow those of the copy before.
struct SceneSeam {
  std::string name = {};                     ///< Name as SceneTag::name.
  std::string a = {};                        ///< "cloth.edge" as in SeamEdge, or the object of `a_points`.
  std::vector<std::uint32_t> a_points = {};  ///< SeamEdge::points of the first line.
  std::string b = {};                        ///< "cloth.edge" as in SeamEdge, or the object of `b_points`.
  std::vector<std::uint32_t> b_points = {};  ///< SeamEdge::points of the second line.
  Real strength = kRigid;                    ///< SeamDesc::strength [N/m].
  SceneArray array = {};                     ///< Copies of the seam.
};
/// A field of force.
struct SceneField {
  std::string name = {};  ///< Name as SceneTag::name.
  FieldDesc desc = {};    ///< The field.
};

/// Objects of a scene or of an event, in the order in which they are added: kind after kind as listed here.
struct SceneObjects {
  std::vector<SceneBody> bodies = {};          ///< Rigid bodies, still or moving.
  std::vector<SceneRope> ropes = {};           ///< Ropes, strings, hair.
  std::vector<SceneCloth> cloths = {};         ///< Cloths, flags, soft shells.
  std::vector<SceneSolid> solids = {};         ///< Soft solids: jelly, rubber.
  std::vector<SceneParticles> particles = {};  ///< Nets of masses and springs.
  std::vector<SceneField> fields = {};         ///< Forces on every particle and body.
  std::vector<SceneHook> hooks = {};           ///< What holds objects together.
  std::vector<SceneSeam> seams = {};           ///< What sews cloths and solids together.
};

/// Something that happens just before a step. Only the fields of its kind count.
struct SceneEvent {
  /// What happens.
  enum class Kind : std::uint8_t {
    kNone,      ///< Nothing.
    kAdd,       ///< Adds the objects in `add`.
    kRemove,    ///< Removes `object`, or all copies of an array of that name.
    kMotion,    ///< Pins `point` and moves it; of a kinematic body, its path from where it is.
    kUnpin,     ///< Lets `point` go.
    kForce,     ///< Pushes a point or a body for `steps` steps.
    kImpulse,   ///< Hits a point or a body.
    kVelocity,  ///< Sets the velocity of a point or a body.
    kMotor,     ///< World::set_motor
    kSpring,    ///< World::set_spring
    kSteering,  ///< World::set_steering
    kWind,      ///< World::set_wind
    kGravity,   ///< World::set_gravity
  };

  Kind kind = Kind::kNone;               ///< What happens.
  std::uint32_t at_step = 0;             ///< Number of steps done before it happens.
  SceneObjects add = {};                 ///< New objects, for kAdd.
  std::string object = {};               ///< Name of the object, hook or array that it happens to.
  std::optional<ScenePoint> point = {};  ///< Point of a rope, cloth, solid or particles; none of a body.
  /// Place of a force or impulse on a body [m]; its center of mass by default.
  std::optional<DVec3> at = {};
  MotionDesc motion = {};                     ///< Path, for kMotion.
  Vec3 vector = {};                           ///< Force [N], impulse [N s] or gravity [m/s^2].
  std::uint32_t steps = 1;                    ///< Number of steps that a force acts for. [1, 1e9]
  std::optional<Vec3> velocity = {};          ///< Velocity, for kVelocity [m/s]; as it was by default.
  std::optional<Vec3> angular_velocity = {};  ///< Angular velocity of a body [rad/s]; as it was by default.
  HookMotor motor = {};                       ///< Motor, for kMotor.
  HookSpring spring = {};                     ///< Spring, for kSpring.
  Real angle = Real(0);                       ///< Angle, for kSteering [rad].
  WindDesc wind = {};                         ///< Wind, for kWind.
};

/// Where the camera is at a time.
struct SceneKeyframe {
  double time = 0;    ///< Time since the start [s]; larger than that of the keyframe before.
  DVec3 eye = {};     ///< Position of the camera [m].
  DVec3 target = {};  ///< Place that it looks at [m].
};

/// Where a viewer stands.
struct SceneCamera {
  DVec3 eye = {2, 1.5, 4};               ///< Position of the camera [m].
  DVec3 target = {0, 1, 0};              ///< Place that it looks at [m].
  Real fov_deg = Real(45);               ///< Vertical opening angle [degrees]. [1, 170]
  std::vector<SceneKeyframe> path = {};  ///< Replaces eye and target; smooth between keyframes.
};

/// A light besides the sun. It lights what is drawn, and changes no motion. A white surface that faces a
/// light of intensity 1 is as bright as one that faces the usual sun: a directional light everywhere, the
/// others at a distance of 1 m, from where it falls off by the square (KHR_lights_punctual of glTF).
struct SceneLight {
  /// From where its light comes.
  enum class Kind : std::uint8_t {
    kDirectional,  ///< From far away, along `direction`.
    kPoint,        ///< From `position`, to all sides.
    kSpot,         ///< From `position`, within a cone about `direction`.
  };

  Kind kind = Kind::kPoint;                         ///< From where its light comes.
  DVec3 position = {0, 3, 0};                       ///< Of a point and a spot [m].
  Vec3 direction = {Real(0), Real(-1), Real(0)};    ///< In which its light goes; of any length but zero.
  std::array<float, 3> color = {1.0f, 1.0f, 1.0f};  ///< Linear red, green and blue, each in [0, 1].
  Real intensity = Real(1);                         ///< Not negative; as bright as the usual sun is 1.
  Real inner_deg = Real(20);  ///< Half angle of a spot within which it is as bright as its middle. [0, 80]
  Real outer_deg = Real(30);  ///< Half angle beyond which there is none of its light. (inner_deg, 80]
  bool shadows = true;        ///< Whether things keep its light from one another.
};

/// The most lights of a scene, besides the sun.
inline constexpr std::size_t kMostLights = 8;
/// The most shadow maps of them together: a point light that casts shadows needs six, any other one.
inline constexpr std::size_t kMostLightMaps = 12;

/// The sky and the sun in it.
struct SceneSky {
  Real brightness = Real(1);  ///< Of the sky and of its light, over the usual. [0, 10]
  Real sun = Real(1);         ///< Intensity of the sun, over the usual; 0 for none. [0, 10]
  /// In which the sun's light goes; of any length but zero.
  Vec3 sun_direction = {Real(-0.45f), Real(-0.8f), Real(-0.35f)};
  std::array<float, 3> sun_color = {1.0f, 0.89f, 0.71f};  ///< Linear red, green and blue, each in [0, 1].
};

/// How exact the laboratory must be, whatever the method.
struct SceneAccuracy {
  double max_error = 1e-3;  ///< Largest error of any point's position up to the end [m], positive.
};

/// What the laboratory does with the scene (`hooke run --stepper declared`).
struct SceneLaboratory {
  std::string stepper = "rk4";            ///< Method: a name of lab::steppers() or "auto".
  lab::CollisionOptions collisions = {};  ///< How bodies collide.
};

/// A figure that the scene promises.
struct SceneExpectation {
  /// Which figure it is.
  enum class Quantity : std::uint8_t {
    kX,                ///< x of a point or body [m].
    kY,                ///< y of a point or body [m].
    kZ,                ///< z of a point or body [m].
    kHeight,           ///< The same as kY.
    kSpeed,            ///< Speed of a point, or of a body's center of mass [m/s].
    kAngularSpeed,     ///< Angular speed of a body [rad/s].
    kTilt,             ///< Angle between the y axis of a body and that of the world [degrees].
    kExtension,        ///< Length of a rope, without segments that broke, minus its length at rest [m].
    kLargestStretch,   ///< Measurement::largest_stretch of the world.
    kMeanStretch,      ///< Measurement::mean_stretch of the world.
    kTension,          ///< Tension of a rope's segment, or the largest of them [N].
    kTwist,            ///< Twist of a rope's segment, or of all of them [rad].
    kLowest,           ///< y of an object's lowest point [m].
    kHighest,          ///< y of an object's highest point [m].
    kTotalEnergy,      ///< Energy::total of the world [J].
    kKineticEnergy,    ///< Energy::kinetic of the world [J].
    kPotentialEnergy,  ///< Energy::potential of the world [J].
    kElasticEnergy,    ///< Energy::elastic of the world [J].
    kMomentum,         ///< Length of the world's momentum [kg m/s].
    kPenetration,      ///< Measurement::largest_penetration of the world [m].
    kContacts,         ///< StepReport::contacts of the last step.
    kAsleep,           ///< Number of bodies that sleep.
    kForce,            ///< Size of a hook's force on b, as a mean over the last step [N].
    /// Size of a hook's torque on b, likewise [N m]; or the torque of a rope's segment (World::torques), or
    /// the largest of them.
    kTorque,
    kAngle,  ///< World::hook_value of a hinge [rad].
    kWay,    ///< World::hook_value of a slider, a wheel or a distance [m].
    kGap,    ///< World::hook_gap of a hook; of the world, the largest [m].
    /// 1 for a hook that has broken; how many segments of a rope have broken or were cut, or how many points
    /// of a cloth or a solid have split; of the world, the sum.
    kBroken,
    kYielded,  ///< How often a body has become soft (BodyDesc::yields); of the world, the sum.
    kSoft,     ///< 1 for a body that is soft now, 0 for others; of the world, the sum.
  };
  /// How the achieved figure is compared with `value`.
  enum class Op : std::uint8_t {
    kLess,            ///< achieved < value
    kLessOrEqual,     ///< achieved <= value
    kGreater,         ///< achieved > value
    kGreaterOrEqual,  ///< achieved >= value
    kEqual,           ///< |achieved - value| <= tolerance
    kWithin,          ///< |achieved - value| <= tolerance |value|
  };

  Quantity quantity = Quantity::kHeight;  ///< Which figure it is.
  std::string of = {};                    ///< Name of an object; empty for the world.
  std::optional<ScenePoint> point = {};  ///< Point of the object; of a tension, twist or torque, the segment.
  Op op = Op::kLess;                     ///< How the figure is compared.
  double value = 0;                      ///< The figure that is promised, in its unit.
  double tolerance = 0;                  ///< Tolerance of kEqual, in the figure's unit, or of kWithin.
  std::optional<std::uint32_t> at_step = {};  ///< Number of steps done by then; at the end by default.
};

struct SceneSource;     // the file a scene came from; src/io/scene/scene_source.h
struct SimulationData;  // src/io/scene/scene_simulation.cpp

/// Everything a scene file says.
struct Scene {
  int version = kSceneVersion;   ///< Version of the format. [1, kSceneVersion]
  std::string title = {};        ///< Title, in one line.
  std::string description = {};  ///< What there is to see.
  WorldDesc world = {};          ///< The world; its table of materials comes from `material_pairs`.
  Real dt = Real(1) / Real(60);  ///< Length of one step [s]. (0, 1]
  double seconds = 10;           ///< How long the scene runs [s]. [0, 1e6]
  std::optional<SceneAccuracy> accuracy = {};      ///< How exact the laboratory must be, if it is to choose.
  std::optional<SceneLaboratory> laboratory = {};  ///< What the laboratory does with the scene.
  std::vector<SceneMesh> meshes = {};              ///< Meshes that objects refer to.
  std::vector<SceneMaterial> materials = {};       ///< Materials that objects refer to.
  std::vector<ScenePair> material_pairs = {};      ///< What two materials do to each other.
  SceneObjects objects = {};                       ///< Objects at the start.
  std::vector<SceneEvent> timeline = {};           ///< What happens on the way, in any order.
  std::optional<SceneCamera> camera = {};          ///< Where a viewer stands; without it he frames the scene.
  SceneSky sky = {};                               ///< The sky and the sun in it.
  std::vector<SceneLight> lights = {};             ///< Lights besides the sun, at most kMostLights.
  std::vector<SceneExpectation> expect = {};       ///< Figures that the scene promises.
  /// File that textures and meshes are relative to; empty for the current folder.
  std::string path = {};
  /// The text that the scene was read from, for the places in messages; no part of what the scene says.
  std::shared_ptr<const SceneSource> source = {};

  /// Number of steps in `seconds`.
  [[nodiscard]] std::uint32_t step_count() const;
};

/// Whether two scenes say the same; `path` and `source` do not count.
[[nodiscard]] bool operator==(const Scene& a, const Scene& b);

/// A value with warnings, or everything that is wrong: at least one error.
template <class T>
/// A value and its warnings, or everything that is wrong: at least one error.
struct Loaded {
  std::optional<T> value = {};       ///< The value; nothing if there are errors.
  std::vector<Error> errors = {};    ///< Everything that is wrong, in the order of the file, at most 100.
  std::vector<Error> warnings = {};  ///< What the file says in vain, and what was made of models unasked.
  std::vector<Error> notes = {};     ///< What was made of models as the file asks, with figures.

  /// Whether there is a value.
  explicit operator bool() const { return value.has_value(); }
};

/// Writes an error in one line: "demo.json:12:17: ropes[0].masses: 1 is out of range, must be 2 to 65536".
[[nodiscard]] std::string to_line(const Error& error);

/// Reads a scene file. Limits: 64 MiB, 64 levels, 2e6 values, kMostScenePoints. It looks for model files,
/// which are read when the simulation is created.
[[nodiscard]] Loaded<Scene> load_scene(const std::string& path);

/// Reads a scene from memory. `name` stands in messages. Files are relative to the folder of `name`, and it
/// does not look for them.
[[nodiscard]] Loaded<Scene> parse_scene(std::string text, std::string name);

/// Writes the scene as a file, without what equals its default. parse_scene gives the scene back.
[[nodiscard]] std::string write_scene(const Scene& scene);

/// Saves the scene in a file: it writes a temporary file in the same folder, and renames it when it is
/// complete. Errors: a file that cannot be written.
[[nodiscard]] Result<void> save_scene(const Scene& scene, const std::string& path);

/// Returns the text of a scene file in which the value at `path`, such as "ropes[0].total_mass", is `value`,
/// written as JSON. Comments, order and everything else stay as they are; keys that are missing on the way
/// are added at the end of their object. It does not check what the value means: parse_scene does. Errors: a
/// text or a value that is no JSON, an element that a list does not have, a value on the way that has no
/// keys.
[[nodiscard]] Result<std::string> edit_scene_text(std::string text, std::string_view path,
                                                  std::string_view value);

/// Writes the JSON schema (draft 7) of the format.
[[nodiscard]] std::string scene_schema();

/// Writes Markdown tables of every object and key of the format, with type, unit, range, default and meaning.
[[nodiscard]] std::string scene_reference();

/// Gives a commented scene to start from. Kinds are "empty", "rope" and "flag"; there is nothing for another
/// word.
[[nodiscard]] std::optional<std::string> starter_scene(std::string_view kind);

/// One object of a running simulation: what to draw and how.
struct SceneObject {
  /// What the object is.
  enum class Kind : std::uint8_t {
    kBody,       ///< A body.
    kRope,       ///< A rope.
    kCloth,      ///< A cloth.
    kSolid,      ///< A soft solid.
    kParticles,  ///< Loose particles.
    kField,      ///< A field of force, which cannot be seen.
    kHook        ///< A hook, or a stitch of a seam.
  };

  std::string name = {};       ///< Name, with its number in an array: "rope[3]".
  Kind kind = Kind::kBody;     ///< What the object is.
  BodyId body = {};            ///< Id of a body; the ids of all other kinds are null.
  RopeId rope = {};            ///< Id of a rope.
  ClothId cloth = {};          ///< Id of a cloth.
  SolidId solid = {};          ///< Id of a soft solid.
  ParticlesId particles = {};  ///< Id of particles.
  FieldId field = {};          ///< Id of a field.
  HookId hook = {};            ///< Id of a hook; stale once it has broken.
  SceneMaterial look = {};     ///< Material of the object.
  /// Name of `look`; empty if that is the default, and a model's own materials apply.
  std::string material = {};
  std::string path = {};     ///< Place in the file, as "ropes[0]".
  std::string stepper = {};  ///< Method of the laboratory; empty for what the run chooses.
  /// One shape of a body that has several.
  struct Part {
    Shape shape = {};                         ///< The shape.
    Vec3 position = {};                       ///< Origin of its frame in the body's frame [m].
    Quat rotation = {};                       ///< Rotation of its frame in the body's.
    std::shared_ptr<const Model> model = {};  ///< Model of a mesh; of a hull, its faces; null for others.
    SceneMaterial look = {};                  ///< Material of the part.
    std::string material = {};                ///< Name of `look`, as SceneObject::material.
  };

  Shape shape = {};                      ///< Shape of a body.
  std::vector<Part> parts = {};          ///< Shapes of a compound body.
  std::optional<SceneBlade> blade = {};  ///< Edge of a body that is a blade.
  /// Radius of a rope's strand or of the first particle [m]; half the thickness of a cloth or solid.
  Real radius = Real(0);
  double rest_length = 0;                  ///< Length of a rope at rest [m].
  std::uint32_t columns = 0;               ///< Columns of a cloth's grid; 0 for a mesh.
  std::uint32_t rows = 0;                  ///< Rows of a cloth's grid; 0 for a mesh.
  HookKind hook_kind = HookKind::kBall;    ///< Kind of a hook.
  std::array<std::string, 2> hooked = {};  ///< Names of what a hook holds, a and b; empty for the world.
  /// Whether a hook has broken, whose id is stale then, a rope has snapped, a cloth or a solid has torn, or
  /// one of these was cut.
  bool broken = false;
  Real tore_at = Real(0);   ///< Strain at which a cloth tore first, or stress at which a solid did [Pa].
  std::string cut_by = {};  ///< Name of the blade, if it was cut before it broke or tore.
  BreakEvent broke = {};    ///< How a hook broke, or where a rope snapped first, without its HookId.
  int yielded = 0;          ///< How often a body has become soft (BodyDesc::yields).
  std::optional<YieldEvent> blow = {};       ///< How it yielded first, if it has.
  std::optional<FreezeEvent> froze = {};     ///< How it became rigid again last, if it has.
  std::shared_ptr<const Model> model = {};   ///< Model of a mesh body, cloth or solid; of a hull, its faces.
  std::shared_ptr<const Model> visual = {};  ///< Model that is drawn in place of a body's shape; may be null.
  double mesh_volume = 0;  ///< Volume of the closed surface that a solid fills [m^3]; 0 for others.
};

/// Positions of the points of a rope, a cloth, a solid or particles, as World::positions gives them; none for
/// other objects.
[[nodiscard]] PointView positions_of(const World& world, const SceneObject& object);
/// Velocities of the points of such an object, as World::velocities gives them; none for others.
[[nodiscard]] PointView velocities_of(const World& world, const SceneObject& object);
/// A reference to point `index` of such an object, whether or not it has so many; an empty one for others.
[[nodiscard]] PointRef point_of(const SceneObject& object, std::size_t index);
/// Whether a point belongs to such an object; false for other objects and for an empty reference.
[[nodiscard]] bool has_point(const SceneObject& object, PointRef point);

/// One expectation, evaluated.
struct SceneVerdict {
  std::size_t index = 0;   ///< Index in Scene::expect.
  bool passed = false;     ///< Whether the promise was kept.
  double achieved = 0;     ///< The figure that was measured; NaN if the object is gone.
  std::uint64_t step = 0;  ///< Number of steps done by then.
  std::string text = {};   ///< "height of 'rope' point 15 = 0.998, expected within 1 % of 1".
};

/// How a simulation is made.
struct LoadOptions {
  /// Folder for the convex parts of meshes, which take seconds to make: it is created, and read the next
  /// time. Empty for none.
  std::string cache = {};
  /// Is called with what is done now and which part of it is done, from 0 to 1; may be empty.
  std::function<void(std::string_view what, double part)> progress = {};
};

struct SimulationState;  // what a SimulationSnapshot holds

/// A state of a Simulation: its world, its objects, and how far its timeline and its expectations are. Copies
/// share their content.
class SimulationSnapshot {
 public:
  /// Makes an empty snapshot, which cannot be restored.
  SimulationSnapshot() = default;

  /// Memory that the content takes [bytes], as Snapshot::bytes; 0 for an empty one. What it shares with the
  /// snapshot before does not count.
  [[nodiscard]] std::size_t bytes() const;
  /// Number of steps that the world had made; 0 for an empty one.
  [[nodiscard]] std::uint64_t step_count() const;

 private:
  friend class Simulation;
  explicit SimulationSnapshot(std::shared_ptr<const SimulationState> state) : state_(std::move(state)) {}
  std::shared_ptr<const SimulationState> state_;
};

/// A World made from a scene, with its timeline and its expectations.
class Simulation {
 public:
  /// Reads the meshes, builds the world, and evaluates the expectations of step 0. Errors: everything that is
  /// wrong with the scene, its files and its objects.
  ///
  /// A placement turns and moves the whole scene. Its timeline and its expectations remain in the scene's own
  /// frame; only energies keep the world's origin as their zero. The options change no result.
  [[nodiscard]] static Loaded<Simulation> create(Scene scene, const Placement& placement = {},
                                                 const LoadOptions& options = {});
  ///@{
  /// Takes everything over. The Simulation moved from may only be destroyed or assigned to.
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ///@}
  /// Destroys the world and all that belongs to it.
  ~Simulation();

  /// Applies the events of this step, advances by Scene::dt, and evaluates the expectations that are now due.
  StepReport step();
  /// Steps until Scene::seconds are over, or until a step did not move. Returns the report of the last step.
  StepReport run();

  /// Adds objects to those of the scene, now, as an event of the timeline does. They may use the scene's
  /// materials and meshes, and hooks may hold any objects by their names. Returns what is wrong with those
  /// that were left out; the others are in the world. Errors: a name that an object has already, and those of
  /// create().
  std::vector<Error> add(const SceneObjects& objects);
  /// What add() was called with, in order. SceneObject::path of such an object begins with "added[i].".
  [[nodiscard]] std::span<const std::shared_ptr<const SceneObjects>> added() const;
  /// Removes the object of this name, or all copies of an array, with the hooks that hold it. Errors: there
  /// is none.
  Result<void> remove(const std::string& name);

  /// Copies the present state.
  [[nodiscard]] SimulationSnapshot snapshot() const;
  /// Puts everything back as it was. Ids of objects that came since then are stale. Errors: an empty
  /// snapshot.
  Result<void> restore(const SimulationSnapshot& snapshot);

  ///@{
  /// The world, which lives as long as the Simulation. Step it by step() only, and remove objects by
  /// remove(): otherwise events, expectations and objects() are wrong.
  [[nodiscard]] World& world();
  [[nodiscard]] const World& world() const;
  ///@}
  /// The scene that the simulation was made from.
  [[nodiscard]] const Scene& scene() const;
  /// The objects in the order in which they were added, valid until the next step().
  [[nodiscard]] std::span<const SceneObject> objects() const;
  /// Finds the object of this name, "rope" or "rope[3]"; null if there is none. It is valid until the next
  /// step().
  [[nodiscard]] const SceneObject* find(std::string_view name) const;

  /// Evaluates the expectation of this index in Scene::expect now, whatever its step. One that does not exist
  /// has not passed.
  [[nodiscard]] SceneVerdict check(std::size_t expectation) const;
  /// The verdicts on the expectations that were due, in the order in which they were; valid until the next
  /// step().
  [[nodiscard]] std::span<const SceneVerdict> verdicts() const;
  /// Whether all of the scene's expectations were due and passed, and no event failed.
  [[nodiscard]] bool passed() const;
  /// The events that could not happen, at most 100 errors; valid until the next step().
  [[nodiscard]] std::span<const Error> errors() const;
  /// Writes one line for each error and each verdict, and one for expectations that are not due yet.
  [[nodiscard]] std::string report() const;

 private:
  explicit Simulation(std::unique_ptr<SimulationData> data);
  std::unique_ptr<SimulationData> data_;
};

}  // namespace hooke
