#pragma once

#include "hooke/desc.h"
#include "hooke/lab.h"
#include "hooke/model_io.h"
#include "hooke/placement.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Scenes: what a JSON file says, as plain data, and the simulation that runs it. Part of the library
/// `hooke::io`. Read Scene first, then Simulation; docs/scene_format.md describes the file.

namespace hooke {

/// The newest version of the format that this library reads, and the one that it writes.
inline constexpr int kSceneVersion = 1;

/// Most points of all objects together, events included; a body counts as one, or as its parts.
inline constexpr std::size_t kMostScenePoints = 1'000'000;

/// How a surface looks and how it answers a contact.
struct SceneMaterial {
  std::string name = {};
  std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  ///< Linear base color, each [0, 1].
  std::string texture = {};   ///< Path of an image, relative to the scene file; empty for none.
  float shininess = 16.0f;    ///< Blinn-Phong exponent. [1, 1000]
  float opacity = 1.0f;       ///< [0, 1]
  Real friction = Real(0.5);  ///< Coulomb coefficient. [0, 100]
  std::optional<Real> static_friction = {};  ///< While at rest; not below `friction`, which it is by default.
  Real restitution = Real(0);                ///< [0, 1]
  Real rolling_friction = Real(0);           ///< Lever [m].
  Real spinning_friction = Real(0);          ///< Lever [m].
};

/// What two materials do to each other, in place of what their own numbers would give.
struct ScenePair {
  std::string a = {};  ///< Names in Scene::materials.
  std::string b = {};
  MaterialPairDesc desc = {};
};

/// Triangles for bodies, cloths and solids: a file, or vertices and triangles in place.
struct SceneMesh {
  std::string name = {};
  std::string file = {};  ///< Relative to the scene file; empty when `mesh` holds the triangles.
  ImportOptions import = {};
  MeshTree tree = MeshTree::kBoxes;  ///< For World::add_mesh.
  MeshDesc mesh = {};
  /// Of every object that is made of it, in its frame; the numbers are of vertices.
  std::vector<ConnectionPointDesc> connection_points = {};
};

/// A point of an object: an index, or the last one.
struct ScenePoint {
  std::uint32_t index = 0;  ///< 0 when `last`.
  bool last = false;
  friend bool operator==(const ScenePoint&, const ScenePoint&) = default;
};

/// Points that are held, by their number or by their place.
struct ScenePin {
  enum class Pick : std::uint8_t {
    kPoint,
    kColumn,   ///< All points of a column of a cloth's grid.
    kRow,      ///< All points of a row of a cloth's grid.
    kTopmost,  ///< All points not further than `within` below the highest.
  };

  Pick pick = Pick::kPoint;
  ScenePoint point = {};     ///< Of the object, or the number of the column or row.
  Real within = Real(0.01);  ///< kTopmost [m].
  MotionDesc motion = {};
};

struct SceneLoad {
  ScenePoint point = {};
  Real mass = Real(1);  ///< [kg], not negative.
};

/// Copies of one object. Instance i is named `name[i]`.
struct SceneArray {
  enum class Kind : std::uint8_t {
    kSingle,
    kGrid,     ///< grid[0] x grid[1] x grid[2] copies, x fastest, `spacing` apart.
    kPyramid,  ///< `pyramid` copies in the lowest row along x, one less in each row above.
    kRandom,   ///< `random` copies, uniform in `box`, by `seed`.
    kList,     ///< One copy for each of `list`.
  };

  Kind kind = Kind::kSingle;
  std::array<std::int32_t, 3> grid = {1, 1, 1};
  std::int32_t pyramid = 1;
  std::int32_t random = 1;
  DVec3 spacing = {1, 1, 1};  ///< [m]
  std::uint32_t seed = 1;
  std::array<DVec3, 2> box = {DVec3{}, DVec3{1, 1, 1}};  ///< Smallest and largest offset [m].
  std::vector<DVec3> list = {};                          ///< Offsets [m].
  std::vector<Quat> rotations = {};                      ///< Of a list of bodies: as many as `list`, or none.

  /// Number of copies; saturates.
  [[nodiscard]] std::size_t count() const;
  /// Offset of copy `i` from the object as described [m]; zero beyond count().
  [[nodiscard]] DVec3 offset(std::size_t i) const;
  /// Turn of copy `i` about its own origin, after the rotation of the object as described.
  [[nodiscard]] Quat rotation(std::size_t i) const;
};

/// What every object but a field has.
struct SceneTag {
  std::string name = {};      ///< Unique; when empty, the object is called by its path, as "ropes[0]".
  std::string material = {};  ///< A name in Scene::materials; empty for none.
  std::optional<Real> friction = {};  ///< Replaces the material's. [0, 100]
  /// How the laboratory integrates it: a name of lab::steppers() or "auto"; empty for what the run chooses.
  /// Not of a body.
  std::string stepper = {};
  SceneArray array = {};
};

// Descriptions by value. What refers to something by name or by place stands beside the description and is
// filled into it when the world is built: meshes, pins, loads, friction.
struct ScenePart {
  PartDesc desc = {};
  std::string mesh = {};      ///< A name in Scene::meshes, for a mesh or a hull.
  std::string material = {};  ///< A name in Scene::materials; the body's by default.
};
struct SceneBody {
  SceneTag tag = {};
  BodyDesc desc = {};
  std::string mesh = {};              ///< A name in Scene::meshes, for a mesh or a hull.
  std::vector<ScenePart> parts = {};  ///< Replace desc.shape.
};
struct SceneRope {
  SceneTag tag = {};
  RopeDesc desc = {};
  std::vector<ScenePin> pins = {{}};
  std::vector<SceneLoad> loads = {};
};
struct SceneCloth {
  SceneTag tag = {};
  ClothDesc desc = {};
  std::string mesh = {};  ///< A name in Scene::meshes; empty for a grid.
  std::vector<ScenePin> pins = {};
  std::vector<SceneLoad> loads = {};
};
struct SceneSolid {
  SceneTag tag = {};
  SolidDesc desc = {};
  std::string mesh = {};  ///< A name in Scene::meshes; empty for a box of cells.
  std::vector<ScenePin> pins = {};
};
struct SceneParticles {
  SceneTag tag = {};
  ParticlesDesc desc = {};
  std::vector<ScenePin> pins = {};
};
/// A hook. In an array, copy i holds copy i of `a` and of `b` where they are arrays, counted from the copy
/// that is named: with "link[1]", copy i holds link[1 + i].
struct SceneHook {
  std::string name = {};             ///< As SceneTag::name.
  HookDesc desc = {};                ///< All but `a`, `b` and `anchor`.
  std::optional<DVec3> anchor = {};  ///< HookDesc::anchor; needed unless a point says where.
  /// Name of what it holds, or "name.point" with one of its connection points; empty for the world.
  std::string a = {};
  std::string b = {};
  std::optional<ScenePoint> a_point = {};  ///< Of a rope, cloth, solid or particles; the place nearest to the
                                           ///< anchor without it.
  std::optional<ScenePoint> b_point = {};
  SceneArray array = {};  ///< Offsets of the anchors.
};
/// Two lines sewn together. The stitches are hooks named `name[0]`, ... In an array, copy i sews copy i of
/// `a` and of `b` as those of a hook are held, and its stitches follow those of the copy before.
struct SceneSeam {
  std::string name = {};                     ///< As SceneTag::name.
  std::string a = {};                        ///< "cloth.edge" as in SeamEdge, or what `a_points` are of.
  std::vector<std::uint32_t> a_points = {};  ///< SeamEdge::points.
  std::string b = {};
  std::vector<std::uint32_t> b_points = {};
  Real strength = kRigid;  ///< SeamDesc::strength.
  SceneArray array = {};
};
struct SceneField {
  std::string name = {};
  FieldDesc desc = {};
};

struct SceneObjects {
  std::vector<SceneBody> bodies = {};
  std::vector<SceneRope> ropes = {};
  std::vector<SceneCloth> cloths = {};
  std::vector<SceneSolid> solids = {};
  std::vector<SceneParticles> particles = {};
  std::vector<SceneField> fields = {};
  std::vector<SceneHook> hooks = {};
  std::vector<SceneSeam> seams = {};
};

/// Something that happens just before a step.
struct SceneEvent {
  enum class Kind : std::uint8_t {
    kNone,
    kAdd,
    kRemove,
    kMotion,  ///< Pins `point` and moves it; of a kinematic body, its path from where it is.
    kUnpin,
    kForce,
    kImpulse,
    kVelocity,
    kMotor,     ///< World::set_motor
    kSpring,    ///< World::set_spring
    kSteering,  ///< World::set_steering
    kWind,
    kGravity,
  };

  Kind kind = Kind::kNone;
  std::uint32_t at_step = 0;  ///< Number of steps done before it happens.
  SceneObjects add = {};
  std::string object = {};
  std::optional<ScenePoint> point = {};  ///< Of a rope, cloth, solid or particles; none of a body.
  std::optional<DVec3> at = {};  ///< Of a force or impulse on a body: where [m]; its center of mass without.
  MotionDesc motion = {};
  Vec3 vector = {};                           ///< Force [N], impulse [N s] or gravity [m/s^2].
  std::uint32_t steps = 1;                    ///< kForce: for so many steps.
  std::optional<Vec3> velocity = {};          ///< kVelocity [m/s]; without it, as it was.
  std::optional<Vec3> angular_velocity = {};  ///< kVelocity of a body [rad/s]; likewise.
  HookMotor motor = {};
  HookSpring spring = {};
  Real angle = Real(0);  ///< kSteering [rad].
  WindDesc wind = {};
};

struct SceneKeyframe {
  double time = 0;  ///< [s], increasing.
  DVec3 eye = {};
  DVec3 target = {};
};

/// Where a viewer stands.
struct SceneCamera {
  DVec3 eye = {2, 1.5, 4};               ///< [m]
  DVec3 target = {0, 1, 0};              ///< [m]
  Real fov_deg = Real(45);               ///< Vertical opening angle. [1, 170]
  std::vector<SceneKeyframe> path = {};  ///< Replaces eye and target; smooth between keyframes.
};

/// How exact the laboratory must be, whatever the method.
struct SceneAccuracy {
  double max_error = 1e-3;  ///< Of any point's position up to the end [m], positive.
};

/// What the laboratory does with the scene (`hooke run --stepper declared`).
struct SceneLaboratory {
  std::string stepper = "rk4";  ///< A name of lab::steppers() or "auto".
  lab::CollisionOptions collisions = {};
};

/// A figure that the scene promises.
struct SceneExpectation {
  enum class Quantity : std::uint8_t {
    kX,
    kY,
    kZ,
    kHeight,  ///< The same as kY.
    kSpeed,
    kAngularSpeed,
    kTilt,  ///< Angle between the y axis of a body and that of the world [deg].
    kExtension,
    kLargestStretch,
    kMeanStretch,
    kTension,
    kTwist,  ///< Of a rope's segment, or of all of them [rad].
    kLowest,
    kHighest,
    kTotalEnergy,
    kKineticEnergy,
    kPotentialEnergy,
    kElasticEnergy,
    kMomentum,
    kPenetration,
    kContacts,
    kAsleep,  ///< Number of bodies that sleep.
    kForce,   ///< Size of what a hook does to b, mean over the last step [N].
    kTorque,  ///< The same [N m]; or the largest of a rope's segments (World::torques), or of one.
    kAngle,   ///< World::hook_value of a hinge [rad].
    kWay,     ///< World::hook_value of a slider, a wheel or a distance [m].
    kGap,     ///< World::hook_gap; of the world, the largest [m].
    kBroken,  ///< 1 for a hook that has broken; of the world, their number.
  };
  enum class Op : std::uint8_t {
    kLess,
    kLessOrEqual,
    kGreater,
    kGreaterOrEqual,
    kEqual,   ///< |achieved - value| <= tolerance.
    kWithin,  ///< |achieved - value| <= tolerance |value|.
  };

  Quantity quantity = Quantity::kHeight;
  std::string of = {};                   ///< Name of an object; empty for the world.
  std::optional<ScenePoint> point = {};  ///< Of the object; of a tension, twist or torque, the segment.
  Op op = Op::kLess;
  double value = 0;
  double tolerance = 0;
  std::optional<std::uint32_t> at_step = {};  ///< Number of steps done; at the end by default.
};

struct SceneSource;     // the file a scene came from; src/io/scene/scene_source.h
struct SimulationData;  // src/io/scene/scene_simulation.cpp

/// Everything a scene file says.
struct Scene {
  int version = kSceneVersion;
  std::string title = {};
  std::string description = {};
  WorldDesc world = {};
  Real dt = Real(1) / Real(60);  ///< Of one step [s]. (0, 1]
  double seconds = 10;           ///< How long it runs. [0, 1e6]
  std::optional<SceneAccuracy> accuracy = {};
  std::optional<SceneLaboratory> laboratory = {};
  std::vector<SceneMesh> meshes = {};
  std::vector<SceneMaterial> materials = {};
  std::vector<ScenePair> material_pairs = {};
  SceneObjects objects = {};
  std::vector<SceneEvent> timeline = {};
  std::optional<SceneCamera> camera = {};
  std::vector<SceneExpectation> expect = {};
  /// File that textures and meshes are relative to; empty for the current folder.
  std::string path = {};
  /// For messages; not part of what the scene says.
  std::shared_ptr<const SceneSource> source = {};

  /// Number of steps in `seconds`.
  [[nodiscard]] std::uint32_t step_count() const;
};

/// The same content; `path` and `source` do not count.
[[nodiscard]] bool operator==(const Scene& a, const Scene& b);

/// A value with warnings, or everything that is wrong: at least one error.
template <class T>
struct Loaded {
  std::optional<T> value = {};
  std::vector<Error> errors = {};  ///< In the order of the file, at most 100.
  std::vector<Error> warnings = {};

  explicit operator bool() const { return value.has_value(); }
};

/// "demo.json:12:17: ropes[0].masses: 1 is out of range, must be 2 to 65536".
[[nodiscard]] std::string to_line(const Error& error);

/// Reads a scene file. Limits: 64 MiB, 64 levels, 2e6 values, kMostScenePoints. Model files are looked for,
/// and read when the simulation is created.
[[nodiscard]] Loaded<Scene> load_scene(const std::string& path);

/// Reads a scene from memory. `name` stands in messages; files are relative to its folder and not looked for.
[[nodiscard]] Loaded<Scene> parse_scene(std::string text, std::string name);

/// The scene as a file; what equals its default is left out. parse_scene gives the scene back.
[[nodiscard]] std::string write_scene(const Scene& scene);

/// Writes the scene: to a temporary file in the same folder, renamed when it is complete.
[[nodiscard]] Result<void> save_scene(const Scene& scene, const std::string& path);

/// The JSON schema (draft 7) of the format.
[[nodiscard]] std::string scene_schema();

/// Every object and key of the format with type, unit, range, default and meaning, as Markdown tables.
[[nodiscard]] std::string scene_reference();

/// A commented scene to start from. Kinds: "empty", "rope", "flag"; nothing for another word.
[[nodiscard]] std::optional<std::string> starter_scene(std::string_view kind);

/// One object of a running simulation: what to draw and how.
struct SceneObject {
  enum class Kind : std::uint8_t { kBody, kRope, kCloth, kSolid, kParticles, kField, kHook };

  std::string name = {};
  Kind kind = Kind::kBody;
  BodyId body = {};  ///< The id of its kind is set, the others are null.
  RopeId rope = {};
  ClothId cloth = {};
  SolidId solid = {};
  ParticlesId particles = {};
  FieldId field = {};
  HookId hook = {};
  SceneMaterial look = {};
  std::string material = {};  ///< Empty: `look` is the default, and a model's own materials apply.
  std::string path = {};      ///< In the file, as "ropes[0]".
  std::string stepper = {};   ///< Of the laboratory; empty for what the run chooses.
  /// One shape of a body that has several.
  struct Part {
    Shape shape = {};
    Vec3 position = {};  ///< In the body's frame [m].
    Quat rotation = {};
    std::shared_ptr<const Model> model = {};
    SceneMaterial look = {};
    std::string material = {};  ///< As of the object.
  };

  Shape shape = {};              ///< Of a body.
  std::vector<Part> parts = {};  ///< Of a compound body.
  Real radius = Real(0);   ///< Of a rope's strand or a particle [m]; half the thickness of a cloth or solid.
  double rest_length = 0;  ///< Of a rope [m].
  std::uint32_t columns = 0;  ///< Of a cloth's grid; 0 for a mesh.
  std::uint32_t rows = 0;
  HookKind hook_kind = HookKind::kBall;
  std::array<std::string, 2> hooked = {};   ///< Names of what a hook holds; empty for the world.
  bool broken = false;                      ///< Of a hook: its id is stale.
  BreakEvent broke = {};                    ///< Of one that is broken.
  std::shared_ptr<const Model> model = {};  ///< Of a mesh body, cloth or solid; of a hull, its faces.
};

/// The points of a rope, a cloth, a solid or particles, as World::positions gives them; none for other
/// objects.
[[nodiscard]] PointView positions_of(const World& world, const SceneObject& object);

/// One expectation, evaluated.
struct SceneVerdict {
  std::size_t index = 0;  ///< In Scene::expect.
  bool passed = false;
  double achieved = 0;  ///< NaN when the object is gone.
  std::uint64_t step = 0;
  std::string text = {};  ///< "height of 'rope' point 15 = 0.998, expected within 1 % of 1".
};

/// A World made from a scene, its timeline and its expectations.
class Simulation {
 public:
  /// Reads the meshes, builds the world, evaluates the expectations of step 0. With a placement the whole
  /// scene is turned and moved; its timeline and its expectations are still in the scene's own frame.
  /// Energies keep the world's origin as their zero.
  [[nodiscard]] static Loaded<Simulation> create(Scene scene, const Placement& placement = {});
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Applies the events of this step, advances by Scene::dt, evaluates the expectations that are now due.
  StepReport step();
  /// Steps until Scene::seconds are over; stops early at a step that did not move. The last step's report.
  StepReport run();

  /// Wrong once the world was stepped or objects were removed behind its back.
  [[nodiscard]] World& world();
  [[nodiscard]] const World& world() const;
  [[nodiscard]] const Scene& scene() const;
  /// In the order they were added. Valid until the next step().
  [[nodiscard]] std::span<const SceneObject> objects() const;
  /// The object of this name, "rope" or "rope[3]"; null if there is none.
  [[nodiscard]] const SceneObject* find(std::string_view name) const;

  /// Evaluates one expectation now, whatever its step.
  [[nodiscard]] SceneVerdict check(std::size_t expectation) const;
  /// Of the expectations that were due, in the order they were.
  [[nodiscard]] std::span<const SceneVerdict> verdicts() const;
  /// All of the scene's expectations were due and passed, and no event failed.
  [[nodiscard]] bool passed() const;
  /// Events that could not happen.
  [[nodiscard]] std::span<const Error> errors() const;
  /// One line for each verdict and error.
  [[nodiscard]] std::string report() const;

 private:
  explicit Simulation(std::unique_ptr<SimulationData> data);
  std::unique_ptr<SimulationData> data_;
};

}  // namespace hooke
