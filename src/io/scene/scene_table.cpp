#include "io/scene/scene_table.h"

#include <algorithm>
#include <array>

namespace hooke::io {

namespace {

Field event_object_row(const char* help) {
  return required(field<&SceneEvent::object>("object", "", kNotEmpty, help));
}

Field event_point_row() {
  return field<&SceneEvent::point>("point", "", kAny,
                                   "Of a rope, cloth, solid or particles; a body has none.");
}

Field event_place_row() {
  return field<&SceneEvent::at>("at", "m", kAny,
                                "Of a body: where in the world; at its center of mass without it.");
}

const Kind& motion_event_kind() {
  static const Kind kind = {
      .name = "motion_event",
      .help = "Holds a point from now on and moves it, or gives a kinematic body its path.",
      .fields = {event_object_row("Its name."), event_point_row(),
                 field<&SceneEvent::motion>("motion", "", kAny,
                                            "Starts now, from where it is; without it, it stands still.")},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

const Kind& unpin_event_kind() {
  static const Kind kind = {
      .name = "unpin_event",
      .help = "Lets a held point go.",
      .fields = {event_object_row("Its name."),
                 required(field<&SceneEvent::point>("point", "", kAny, "Of the object."))},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

const Kind& force_event_kind() {
  static const Kind kind = {
      .name = "force_event",
      .help = "Pushes a point or a body for some steps.",
      .fields = {event_object_row("Its name."), event_point_row(), event_place_row(),
                 required(field<&SceneEvent::vector>("force", "N", kAny, "Constant.")),
                 field<&SceneEvent::steps>("steps", "", between(1, 1e9), "For so many steps.")},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

const Kind& impulse_event_kind() {
  static const Kind kind = {.name = "impulse_event",
                            .help = "Hits a point or a body.",
                            .fields = {event_object_row("Its name."), event_point_row(), event_place_row(),
                                       required(field<&SceneEvent::vector>(
                                           "impulse", "N s", kAny, "Mass times change of velocity."))},
                            .defaults = defaults_of<SceneEvent>};
  return kind;
}

bool check_velocity_event(Reader& reader, const JsonNode& node, const void* object) {
  const auto& event = *static_cast<const SceneEvent*>(object);
  if (event.velocity || event.angular_velocity) return true;
  return reader.fail(node, ErrorCode::kOutOfRange, "needs 'velocity' or 'angular_velocity'");
}

const Kind& velocity_event_kind() {
  static const Kind kind = {
      .name = "velocity_event",
      .help = "Sets the velocity of a point or a body.",
      .fields = {event_object_row("Its name."), event_point_row(),
                 field<&SceneEvent::velocity>("velocity", "m/s", kAny, "Of a body, of its center of mass."),
                 field<&SceneEvent::angular_velocity>("angular_velocity", "rad/s", kAny,
                                                      "Of a body, in the world's axes.")},
      .defaults = defaults_of<SceneEvent>,
      .check = check_velocity_event};
  return kind;
}

const Kind& motor_event_kind() {
  static const Kind kind = {
      .name = "motor_event",
      .help = "Gives a hook another motor.",
      .fields = {event_object_row("Of a hook."),
                 field<&SceneEvent::motor, &HookMotor::speed>(
                     "speed", "m/s or rad/s", kAny, "Of b relative to a; without it the motor is friction."),
                 required(field<&SceneEvent::motor, &HookMotor::max_force>(
                     "max_force", "N or N m", kNotNegative, "0 switches the motor off."))},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

const Kind& spring_event_kind() {
  static const Kind kind = {
      .name = "spring_event",
      .help = "Gives a hook another spring.",
      .fields = {event_object_row("Of a hook."),
                 required(field<&SceneEvent::spring, &HookSpring::stiffness>("stiffness", "N/m or N m/rad",
                                                                             kNotNegative, "k.")),
                 field<&SceneEvent::spring, &HookSpring::damping>("damping", "N s/m or N m s/rad",
                                                                  kNotNegative, "c."),
                 field<&SceneEvent::spring, &HookSpring::target>(
                     "target", "m or rad", kAny, "Value at rest, from how things stood when hooked.")},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

const Kind& steering_event_kind() {
  static const Kind kind = {
      .name = "steering_event",
      .help = "Turns a wheel.",
      .fields = {event_object_row("Of a hook of kind wheel."),
                 required(field<&SceneEvent::angle>("angle", "rad", kAny, "About its suspension's axis."))},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

/// Makes keys for the lists of objects, at the path `Prefix...` of a struct.
template <auto... Prefix>
std::vector<Field> object_rows() {
  return {
      field<Prefix..., &SceneObjects::bodies>("bodies", "", kAny, "Rigid bodies, still or moving."),
      field<Prefix..., &SceneObjects::ropes>("ropes", "", kAny, "Ropes, strings, hair."),
      field<Prefix..., &SceneObjects::cloths>("cloths", "", kAny, "Cloths, flags, soft shells."),
      field<Prefix..., &SceneObjects::solids>("solids", "", kAny, "Soft solids: jelly, rubber."),
      field<Prefix..., &SceneObjects::particles>("particles", "", kAny, "Nets of masses and springs."),
      field<Prefix..., &SceneObjects::fields>("fields", "", kAny, "Forces on every particle and body."),
      field<Prefix..., &SceneObjects::hooks>("hooks", "", kAny, "What holds bodies together."),
      field<Prefix..., &SceneObjects::seams>("seams", "", kAny, "What sews edges of cloths together."),
  };
}

/// Editors use the key to find the schema; the scene does not keep it.
Field schema_row() {
  Field row;
  row.key = "$schema";
  row.help = "Where an editor finds the schema; not read.";
  row.read = [](Reader& reader, const JsonNode& node, const Rule& rule, void* /*object*/) {
    std::string ignored;
    return Codec<std::string>::read(reader, node, rule, ignored);
  };
  row.schema = &Codec<std::string>::schema;
  row.type = &Codec<std::string>::type;
  return row;
}

std::vector<Field> scene_rows() {
  constexpr Rule kStepRange = {.least = 0, .most = 1, .above_least = true};
  std::vector<Field> rows = {
      schema_row(),
      required(field<&Scene::version>("version", "", between(1, kSceneVersion), "Of the format.")),
      field<&Scene::title>("title", "", kAny, "One line."),
      field<&Scene::description>("description", "", kAny, "What there is to see."),
      field<&Scene::world>("world", "", kAny, "Gravity, wind, accuracy."),
      field<&Scene::dt>("dt", "s", kStepRange, "Length of a step."),
      field<&Scene::seconds>("seconds", "s", between(0, 1e6), "How long the scene runs."),
      field<&Scene::accuracy>(
          "accuracy", "", kAny,
          "Of the laboratory: it then chooses method and step; without it they are given."),
      field<&Scene::laboratory>("laboratory", "", kAny, "Its method, and how bodies collide in it."),
      field<&Scene::meshes>("meshes", "", kAny, "Triangles, by name."),
      field<&Scene::materials>("materials", "", kAny, "Looks and friction, by name."),
      field<&Scene::material_pairs>("material_pairs", "", kAny, "What two materials do to each other."),
  };
  for (const Field& row : object_rows<&Scene::objects>()) rows.push_back(row);
  rows.push_back(field<&Scene::timeline>("timeline", "", kAny, "What happens on the way."));
  rows.push_back(field<&Scene::camera>("camera", "", kAny, "Where a viewer stands."));
  rows.push_back(field<&Scene::sky>("sky", "", kAny, "The sky and the sun in it."));
  rows.push_back(field<&Scene::lights>("lights", "", kAny, "Lights besides the sun, at most 8."));
  rows.push_back(field<&Scene::expect>("expect", "", kAny, "Figures that the scene promises."));
  return rows;
}

bool check_scene(Reader& reader, const JsonNode& node, const void* object) {
  const auto& lights = static_cast<const Scene*>(object)->lights;
  const JsonNode* list = node.find("lights");
  if (list == nullptr) return true;
  if (lights.size() > kMostLights) {
    return reader.fail(*list, ErrorCode::kLimitExceeded,
                       "'lights': a scene has at most 8, not " + std::to_string(lights.size()));
  }
  std::size_t maps = 0;
  for (const SceneLight& light : lights)
    maps += light.shadows ? light.kind == SceneLight::Kind::kPoint ? 6 : 1 : 0;
  if (maps <= kMostLightMaps) return true;
  return reader.fail(*list, ErrorCode::kLimitExceeded,
                     "'lights': their shadows need " + std::to_string(maps) +
                         " maps, of which there are 12: six for a point light, one for any other; set "
                         "'shadows' of some to false");
}

}  // namespace

template <>
const Kind& kind_of<Scene>() {
  static const Kind kind = {.name = "scene",
                            .help = "The file.",
                            .fields = scene_rows(),
                            .defaults = defaults_of<Scene>,
                            .check = check_scene};
  return kind;
}

template <>
const Kind& kind_of<WorldDesc>() {
  constexpr Rule kPasses = between(1, 64);
  static const Kind kind = {
      .name = "world",
      .help = "What holds everywhere.",
      .fields =
          {field<&WorldDesc::gravity>("gravity", "m/s^2", kAny, "Acceleration of everything."),
           field<&WorldDesc::substeps>("substeps", "", kPasses, "Solver passes per step; more is stiffer."),
           field<&WorldDesc::particle_substeps>(
               "particle_substeps", "", kPasses,
               "Passes over ropes, cloths, solids, particles in each substep."),
           field<&WorldDesc::workers>("workers", "", kPasses, "Threads. The result does not depend on it."),
           field<&WorldDesc::wind>("wind", "", kAny, "Moving air."),
           field<&WorldDesc::contact_hz>("contact_hz", "Hz", between(0.1, 1000),
                                         "Stiffness of contacts between bodies."),
           field<&WorldDesc::contact_damping_ratio>("contact_damping_ratio", "", between(0.01, 100),
                                                    "Damping of the same."),
           field<&WorldDesc::bias_sweeps>("bias_sweeps", "", between(1, 8),
                                          "Passes over contacts in each substep."),
           field<&WorldDesc::sleeping>("sleeping", "", kAny, "Bodies at rest are skipped until touched.")},
      .defaults = defaults_of<WorldDesc>};
  return kind;
}

template <>
const Kind& kind_of<WindDesc>() {
  static const Kind kind = {
      .name = "wind",
      .help =
          "Moving air: |velocity| [(1 + gust r1) e_main + side_gust r2 e_side], r1 and r2 smooth random "
          "numbers in [-1, 1], functions of time and place.",
      .fields =
          {field<&WindDesc::velocity>("velocity", "m/s", kAny, "Mean wind."),
           field<&WindDesc::gust>("gust", "", between(0, 10), "Relative size of the gusts along the wind."),
           field<&WindDesc::side_gust>("side_gust", "", between(0, 10),
                                       "Relative size of the gusts across it."),
           field<&WindDesc::correlation_time>("correlation_time", "s", kPositive, "How long a gust lasts."),
           field<&WindDesc::correlation_length>("correlation_length", "m", kPositive, "How large a gust is."),
           field<&WindDesc::seed>("seed", "", kAny, "Of the random numbers."),
           field<&WindDesc::gusts>("gusts", "", kAny,
                                   "Smooth, or one factor per step as in the paper's equation 9."),
           field<&WindDesc::air_density>("air_density", "kg/m^3", kNotNegative,
                                         "0 switches drag and lift off.")},
      .defaults = defaults_of<WindDesc>};
  return kind;
}

namespace {

bool check_triangles(Reader& reader, const JsonNode& node, const MeshDesc& mesh) {
  const std::size_t count = mesh.positions.size();
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    const std::uint32_t corner = std::max({triangle[0], triangle[1], triangle[2]});
    if (corner < count) continue;
    return reader.fail(node, ErrorCode::kOutOfRange,
                       "a triangle has the corner " + std::to_string(corner) + ", there are " +
                           std::to_string(count) + " vertices");
  }
  return true;
}

bool check_mesh(Reader& reader, const JsonNode& node, const void* object) {
  const auto& mesh = *static_cast<const SceneMesh*>(object);
  const bool in_place = !mesh.mesh.positions.empty() || !mesh.mesh.triangles.empty();
  if (mesh.file.empty() == in_place) return check_triangles(reader, node, mesh.mesh);
  return reader.fail(node, ErrorCode::kOutOfRange, "needs either 'file' or 'vertices' and 'triangles'");
}

}  // namespace

template <>
const Kind& kind_of<SceneMesh>() {
  static const Kind kind = {
      .name = "mesh",
      .help = "Triangles: a model file, or vertices and triangles in place.",
      .fields = {field<&SceneMesh::file>(
                     "file", "", kNotEmpty,
                     "A model (.3ds .obj .stl .ply .gltf .glb), relative to the scene file."),
                 field<&SceneMesh::import, &ImportOptions::up>(
                     "up", "", kAny, "Axis that points up in the file; what its format says by default."),
                 field<&SceneMesh::import, &ImportOptions::scale>("scale", "m", kPositive,
                                                                  "Length of one unit of the file."),
                 field<&SceneMesh::import, &ImportOptions::fit>(
                     "fit", "m", kPositive, "Replaces `scale`: length of the longest side."),
                 field<&SceneMesh::import, &ImportOptions::origin>(
                     "origin", "", kAny,
                     "Where the origin of its frame is: as in the file; in the center of its box; or in the "
                     "center of the box's lower face."),
                 field<&SceneMesh::tree>(
                     "tree", "", kAny,
                     "By what rays and points ask it: boxes, or planes too, a BSP tree of a closed mesh, "
                     "which is solid then."),
                 field<&SceneMesh::voxel_size>(
                     "voxel_size", "m", kPositive,
                     "Bodies collide by, and solids fill, a closed surface made of such voxels; an open mesh "
                     "is closed by 1/64 of its longest side unasked, with a warning."),
                 field<&SceneMesh::mesh, &MeshDesc::positions>("vertices", "m", kAny, "Instead of a file."),
                 field<&SceneMesh::mesh, &MeshDesc::triangles>(
                     "triangles", "", kAny, "Three indices each, counter-clockwise seen from outside."),
                 field<&SceneMesh::connection_points>(
                     "connection_points", "m", kAny,
                     "Of all that is made of it: places in its frame, or vertices, that hooks may name.")},
      .defaults = defaults_of<SceneMesh>,
      .check = check_mesh};
  return kind;
}

namespace {

std::vector<Field> look_rows() {
  return {
      field<&SceneMaterial::color>("color", "", between(0, 1), "Red, green, blue, linear."),
      field<&SceneMaterial::texture>("texture", "", kNotEmpty, "An image, relative to the scene file."),
      field<&SceneMaterial::normal_map>(
          "normal_map", "", kNotEmpty,
          "An image of normals (red right, green up, blue outward), or of heights in grays."),
      field<&SceneMaterial::normal_scale>("normal_scale", "", between(-100, 100),
                                          "Strength of its relief; negative turns it inward."),
      field<&SceneMaterial::roughness_map>(
          "roughness_map", "", kNotEmpty,
          "An image whose green multiplies `roughness`, and whose blue `metalness`."),
      field<&SceneMaterial::shininess>("shininess", "", between(1, 1000),
                                       "Blinn-Phong exponent, without a `roughness`."),
      field<&SceneMaterial::opacity>("opacity", "", between(0, 1), "1 hides what is behind."),
      field<&SceneMaterial::like>("like", "", kNotEmpty,
                                  "A material of the library, which gives what is not said here."),
      field<&SceneMaterial::metalness>("metalness", "", between(0, 1), "1 is a metal."),
      field<&SceneMaterial::roughness>("roughness", "", between(0, 1),
                                       "0 is a mirror, 1 chalk; by `shininess` without it."),
      field<&SceneMaterial::transmission>("transmission", "", between(0, 1),
                                          "Share of the light that goes through, as through glass."),
      field<&SceneMaterial::sheen>("sheen", "", between(0, 1), "Light at the rim of a cloth, by its fibers."),
      field<&SceneMaterial::thread_pitch>("thread_pitch", "m", kPositive,
                                          "Distance of the threads of a grid of cloth."),
      field<&SceneMaterial::hair>("hair", "", kAny, "Ropes are drawn as tufts of hair."),
      field<&SceneMaterial::tiles>("tiles", "m", between(0, 1000),
                                   "Width of the tiles that lines mark on a level ground; 0 draws none.")};
}

/// What a material says of what is made of it, and of contacts.
std::vector<Field> matter_rows() {
  return {
      field<&SceneMaterial::density>("density", "kg/m^3", kPositive,
                                     "Of dynamic bodies and solids that give no mass themselves."),
      field<&SceneMaterial::young_modulus>("young_modulus", "Pa", kPositive,
                                           "Of solids that do not give it themselves."),
      field<&SceneMaterial::poisson_ratio>("poisson_ratio", "", between(0, 0.499),
                                           "Of solids that do not give it themselves."),
      field<&SceneMaterial::areal_density>("areal_density", "kg/m^2", kPositive,
                                           "Of cloths that give no mass themselves."),
      field<&SceneMaterial::stretch_stiffness>(
          "stretch_stiffness", "N/m", kPositive,
          "Of cloths that do not give it themselves: force per width over strain."),
      field<&SceneMaterial::shear_stiffness>(
          "shear_stiffness", "N/m", kPositive,
          "Of cloths that do not give it themselves: force per width over the angle [rad]."),
      field<&SceneMaterial::bend_stiffness>(
          "bend_stiffness", "N m", kPositive,
          "Of cloths that do not give it themselves and do not bend by springs."),
      field<&SceneMaterial::linear_density>("linear_density", "kg/m", kPositive,
                                            "Of ropes that give no mass themselves."),
      field<&SceneMaterial::diameter>("diameter", "m", kPositive, "Of ropes that give no radius themselves."),
      field<&SceneMaterial::strength>("strength", "N", kPositive, "Of ropes that do not give it themselves."),
      field<&SceneMaterial::yields>("yields", "", kAny,
                                    "Of bodies that move, are no compounds and do not give it themselves."),
      field<&SceneMaterial::friction>(
          "friction", "", between(0, 100),
          "Coulomb coefficient while sliding; a contact uses sqrt(a b) of the two surfaces."),
      field<&SceneMaterial::static_friction>("static_friction", "", between(0, 100),
                                             "While at rest; not below `friction`."),
      field<&SceneMaterial::restitution>(
          "restitution", "", between(0, 1),
          "Speed after over speed before; a contact uses the larger of the two."),
      field<&SceneMaterial::rolling_friction>(
          "rolling_friction", "m", kNotNegative,
          "Lever of the resistance to rolling; a contact uses the larger of the two."),
      field<&SceneMaterial::spinning_friction>(
          "spinning_friction", "m", kNotNegative,
          "Lever of the resistance to spin; a contact uses the larger of the two.")};
}

std::vector<Field> material_rows() {
  std::vector<Field> rows = look_rows();
  const std::vector<Field> matter = matter_rows();
  rows.insert(rows.end(), matter.begin(), matter.end());
  return rows;
}

}  // namespace

template <>
const Kind& kind_of<SceneMaterial>() {
  static const Kind kind = {.name = "material",
                            .help = "How a surface looks and how it answers a contact.",
                            .fields = material_rows(),
                            .defaults = defaults_of<SceneMaterial>};
  return kind;
}

template <>
const Kind& kind_of<SceneObjects>() {
  static const Kind kind = {.name = "objects",
                            .help = "Objects that are added, as in the scene itself.",
                            .fields = object_rows<>(),
                            .defaults = defaults_of<SceneObjects>};
  return kind;
}

template <>
const Kind& kind_of<SceneEvent>() {
  using EventKind = SceneEvent::Kind;
  static const Kind kind = {
      .name = "event",
      .help = "Something that happens just before a step. One of the keys besides `at_step`.",
      .fields = {required(field<&SceneEvent::at_step>("at_step", "", kAny, "Number of steps done before.")),
                 choice<EventKind::kAdd, &SceneEvent::kind>(
                     field<&SceneEvent::add>("add", "", kAny, "New objects.")),
                 choice<EventKind::kRemove, &SceneEvent::kind>(field<&SceneEvent::object>(
                     "remove", "", kNotEmpty, "Name of an object that disappears, or of an array.")),
                 choice<EventKind::kMotion, &SceneEvent::kind>(
                     group("motion", motion_event_kind, "Moves a point or a kinematic body.")),
                 choice<EventKind::kUnpin, &SceneEvent::kind>(
                     group("unpin", unpin_event_kind, "Lets a held point go.")),
                 choice<EventKind::kForce, &SceneEvent::kind>(
                     group("force", force_event_kind, "Pushes a point or a body for some steps.")),
                 choice<EventKind::kImpulse, &SceneEvent::kind>(
                     group("impulse", impulse_event_kind, "Hits a point or a body.")),
                 choice<EventKind::kVelocity, &SceneEvent::kind>(
                     group("velocity", velocity_event_kind, "Sets the velocity of a point or a body.")),
                 choice<EventKind::kMotor, &SceneEvent::kind>(
                     group("motor", motor_event_kind, "Gives a hook another motor.")),
                 choice<EventKind::kSpring, &SceneEvent::kind>(
                     group("spring", spring_event_kind, "Gives a hook another spring.")),
                 choice<EventKind::kSteering, &SceneEvent::kind>(
                     group("steering", steering_event_kind, "Turns a wheel.")),
                 choice<EventKind::kWind, &SceneEvent::kind>(
                     field<&SceneEvent::wind>("wind", "", kAny, "Replaces the wind.")),
                 choice<EventKind::kGravity, &SceneEvent::kind>(
                     field<&SceneEvent::vector>("gravity", "m/s^2", kAny, "Replaces gravity."))},
      .defaults = defaults_of<SceneEvent>};
  return kind;
}

namespace {

bool check_camera(Reader& reader, const JsonNode& node, const void* object) {
  const auto& path = static_cast<const SceneCamera*>(object)->path;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path[i].time > path[i - 1].time) continue;
    return reader.fail(node, ErrorCode::kOutOfRange,
                       "the times of the path must increase; keyframe " + std::to_string(i) + " does not");
  }
  return true;
}

}  // namespace

template <>
const Kind& kind_of<SceneCamera>() {
  static const Kind kind = {
      .name = "camera",
      .help = "Where a viewer stands.",
      .fields = {field<&SceneCamera::eye>("eye", "m", kAny, "Position."),
                 field<&SceneCamera::target>("target", "m", kAny, "What it looks at."),
                 field<&SceneCamera::fov_deg>("fov_deg", "degrees", between(1, 170),
                                              "Vertical opening angle."),
                 field<&SceneCamera::path>("path", "", kAny,
                                           "Replaces `eye` and `target`; smooth between keyframes.")},
      .defaults = defaults_of<SceneCamera>,
      .check = check_camera};
  return kind;
}

template <>
const Kind& kind_of<SceneKeyframe>() {
  static const Kind kind = {
      .name = "camera_keyframe",
      .help = "Where the camera is at a time.",
      .fields = {required(field<&SceneKeyframe::time>("time", "s", kAny, "Increasing.")),
                 required(field<&SceneKeyframe::eye>("eye", "m", kAny, "Position.")),
                 required(field<&SceneKeyframe::target>("target", "m", kAny, "What it looks at."))},
      .defaults = defaults_of<SceneKeyframe>};
  return kind;
}

namespace {

bool check_sky(Reader& reader, const JsonNode& node, const void* object) {
  if (length(static_cast<const SceneSky*>(object)->sun_direction) > Real(0)) return true;
  return reader.fail(node, ErrorCode::kOutOfRange, "'sun_direction' must not be zero");
}

bool check_light(Reader& reader, const JsonNode& node, const void* object) {
  const auto& light = *static_cast<const SceneLight*>(object);
  if (!(length(light.direction) > Real(0)))
    return reader.fail(node, ErrorCode::kOutOfRange, "'direction' must not be zero");
  if (light.inner_deg < light.outer_deg) return true;
  return reader.fail(node, ErrorCode::kOutOfRange, "'inner_deg' must be less than 'outer_deg'");
}

}  // namespace

template <>
const Kind& kind_of<SceneSky>() {
  static const Kind kind = {
      .name = "sky",
      .help = "The sky and the sun in it.",
      .fields = {field<&SceneSky::brightness>("brightness", "", between(0, 10),
                                              "Of the sky and of its light, over the usual; 0 is night."),
                 field<&SceneSky::sun>("sun", "", between(0, 10), "Of the sun, over the usual."),
                 field<&SceneSky::sun_direction>("sun_direction", "", kAny, "In which its light goes."),
                 field<&SceneSky::sun_color>("sun_color", "", between(0, 1), "Red, green, blue, linear.")},
      .defaults = defaults_of<SceneSky>,
      .check = check_sky};
  return kind;
}

template <>
const Kind& kind_of<SceneLight>() {
  static const Kind kind = {
      .name = "light",
      .help = "A light besides the sun.",
      .fields =
          {field<&SceneLight::kind>("kind", "", kAny,
                                    "From far away, from a place to all sides, or within a cone."),
           field<&SceneLight::position>("position", "m", kAny, "Of a point and a spot."),
           field<&SceneLight::direction>("direction", "", kAny, "In which its light goes."),
           field<&SceneLight::color>("color", "", between(0, 1), "Red, green, blue, linear."),
           field<&SceneLight::intensity>(
               "intensity", "", between(0, 1e6),
               "1 is as bright as the usual sun, of a point and a spot at 1 m; it falls off by the "
               "square."),
           field<&SceneLight::inner_deg>("inner_deg", "degrees", between(0, 80),
                                         "Half angle within which a spot is as bright as in its middle."),
           field<&SceneLight::outer_deg>("outer_deg", "degrees", between(0, 80),
                                         "Half angle beyond which there is none of its light."),
           field<&SceneLight::shadows>(
               "shadows", "", kAny,
               "Whether things shadow one another from it; 12 maps are shared: six for a point, one for "
               "any other.")},
      .defaults = defaults_of<SceneLight>,
      .check = check_light};
  return kind;
}

template <>
std::span<const EnumName> names_of<SceneLight::Kind>() {
  static constexpr EnumName kNames[] = {{"directional", static_cast<int>(SceneLight::Kind::kDirectional)},
                                        {"point", static_cast<int>(SceneLight::Kind::kPoint)},
                                        {"spot", static_cast<int>(SceneLight::Kind::kSpot)}};
  return kNames;
}

template <>
const Kind& kind_of<SceneExpectation>() {
  static const Kind kind = {
      .name = "expectation",
      .help = "A figure that the scene promises: `hooke run` fails when it is missed.",
      .fields =
          {required(field<&SceneExpectation::quantity>("quantity", "", kAny, "What is measured.")),
           field<&SceneExpectation::of>("of", "", kNotEmpty, "Name of an object; the world without it."),
           field<&SceneExpectation::point>("point", "", kAny,
                                           "Of the object; of a tension, twist or torque, the segment."),
           required(field<&SceneExpectation::op>("op", "", kAny,
                                                 "`==`: not further away than `tolerance`; `within`: not "
                                                 "further than `tolerance` times the value.")),
           required(field<&SceneExpectation::value>("value", "unit of the quantity", kAny, "Promised.")),
           field<&SceneExpectation::tolerance>("tolerance", "", kNotNegative, "For `==` and `within`."),
           field<&SceneExpectation::at_step>("at_step", "", kAny,
                                             "After so many steps; at the end without it.")},
      .defaults = defaults_of<SceneExpectation>};
  return kind;
}

template <>
const Kind& kind_of<SceneAccuracy>() {
  static const Kind kind = {
      .name = "accuracy",
      .help =
          "How exact the laboratory must be (`hooke run --stepper`); the real-time solver has no use for it.",
      .fields = {required(field<&SceneAccuracy::max_error>(
          "max_error", "m", kPositive, "Largest error of any point's position up to the end."))},
      .defaults = defaults_of<SceneAccuracy>};
  return kind;
}

template <>
const Kind& kind_of<SceneLaboratory>() {
  using Options = lab::CollisionOptions;
  constexpr Rule kDepth = {.least = 1e-12, .most = 1};
  static const Kind kind = {
      .name = "laboratory",
      .help =
          "What the laboratory does with the scene (`hooke run --stepper declared`); the real-time solver "
          "has no use for it.",
      .fields =
          {field<&SceneLaboratory::stepper>("stepper", "", kNotEmpty,
                                            "As `rk4`, or `auto`; `hooke compare --help` lists them."),
           field<&SceneLaboratory::collisions, &Options::collider>(
               "collider", "", kAny,
               "What finds collisions: all features, or as in the paper faces only, which misses edges."),
           field<&SceneLaboratory::collisions, &Options::preselection>(
               "preselection", "", kAny,
               "Which pairs it is asked about: whose bounding volumes may meet within the step."),
           field<&SceneLaboratory::collisions, &Options::mesh_search>(
               "mesh_search", "", kAny,
               "How places are found where solids of triangles touch: all against all, as in the paper; by "
               "trees of oriented boxes."),
           field<&SceneLaboratory::collisions, &Options::search>(
               "rollback", "", kAny,
               "How the next try after a canceled step is found: half of it, back by depth over speed, the "
               "root "
               "of the distance, conservative advancement."),
           field<&SceneLaboratory::collisions, &Options::sweep>(
               "sweep", "", kAny,
               "How the way is looked at: not, as in the paper; cast; cast where extruded silhouettes meet."),
           field<&SceneLaboratory::collisions, &Options::epsilon>("epsilon", "m", kDepth,
                                                                  "Depth that counts as touching."),
           field<&SceneLaboratory::collisions, &Options::iteration_limit>(
               "iteration_limit", "", between(1, 1000), "Tries in a row that may be canceled."),
           field<&SceneLaboratory::collisions, &Options::regional>(
               "regional", "", kAny, "Only bodies that meet in a step take it again.")},
      .defaults = defaults_of<SceneLaboratory>};
  return kind;
}

std::span<const Kind* const> all_kinds() {
  static const std::vector<const Kind*> kinds = [] {
    std::vector<const Kind*> list = {&kind_of<Scene>(),           &kind_of<WorldDesc>(),
                                     &kind_of<WindDesc>(),        &kind_of<SceneAccuracy>(),
                                     &kind_of<SceneLaboratory>(), &kind_of<SceneMesh>(),
                                     &kind_of<SceneMaterial>()};
    list.insert(list.end(), body_kinds().begin(), body_kinds().end());
    list.insert(list.end(), hook_kinds().begin(), hook_kinds().end());
    list.insert(list.end(), object_kinds().begin(), object_kinds().end());
    const std::initializer_list<const Kind*> last = {
        &kind_of<SceneEvent>(), &kind_of<SceneObjects>(), &motion_event_kind(),
        &unpin_event_kind(),    &force_event_kind(),      &impulse_event_kind(),
        &velocity_event_kind(), &motor_event_kind(),      &spring_event_kind(),
        &steering_event_kind(), &kind_of<SceneCamera>(),  &kind_of<SceneKeyframe>(),
        &kind_of<SceneSky>(),   &kind_of<SceneLight>(),   &kind_of<SceneExpectation>()};
    list.insert(list.end(), last);
    return list;
  }();
  return kinds;
}

template <>
std::span<const EnumName> names_of<WindDesc::Gusts>() {
  static constexpr EnumName kNames[] = {{"smooth", static_cast<int>(WindDesc::Gusts::kSmooth)},
                                        {"paper", static_cast<int>(WindDesc::Gusts::kPaper)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<MeshTree>() {
  static constexpr EnumName kNames[] = {{"boxes", static_cast<int>(MeshTree::kBoxes)},
                                        {"planes", static_cast<int>(MeshTree::kPlanes)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<lab::CollisionOptions::Collider>() {
  using Collider = lab::CollisionOptions::Collider;
  static constexpr EnumName kNames[] = {{"none", static_cast<int>(Collider::kNone)},
                                        {"exact", static_cast<int>(Collider::kExact)},
                                        {"faces", static_cast<int>(Collider::kFaces)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<Preselection>() {
  static const auto names = [] {
    std::array<EnumName, std::size(kPreselections)> list = {};
    for (std::size_t i = 0; i < list.size(); ++i)
      list[i] = {name_of(kPreselections[i]), static_cast<int>(kPreselections[i])};
    return list;
  }();
  return names;
}

template <>
std::span<const EnumName> names_of<lab::CollisionOptions::MeshSearch>() {
  using MeshSearch = lab::CollisionOptions::MeshSearch;
  static constexpr EnumName kNames[] = {{"all", static_cast<int>(MeshSearch::kAll)},
                                        {"tree", static_cast<int>(MeshSearch::kTree)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<lab::CollisionOptions::Search>() {
  using Search = lab::CollisionOptions::Search;
  static constexpr EnumName kNames[] = {{"halving", static_cast<int>(Search::kHalving)},
                                        {"backward", static_cast<int>(Search::kBackward)},
                                        {"event", static_cast<int>(Search::kEvent)},
                                        {"advancement", static_cast<int>(Search::kAdvancement)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<lab::CollisionOptions::Sweep>() {
  using Sweep = lab::CollisionOptions::Sweep;
  static constexpr EnumName kNames[] = {{"none", static_cast<int>(Sweep::kNone)},
                                        {"cast", static_cast<int>(Sweep::kCast)},
                                        {"extruded", static_cast<int>(Sweep::kExtruded)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<ModelOrigin>() {
  static constexpr EnumName kNames[] = {{"file", static_cast<int>(ModelOrigin::kFile)},
                                        {"center", static_cast<int>(ModelOrigin::kCenter)},
                                        {"bottom", static_cast<int>(ModelOrigin::kBottom)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<UpAxis>() {
  static constexpr EnumName kNames[] = {{"format", static_cast<int>(UpAxis::kFormat)},
                                        {"x", static_cast<int>(UpAxis::kX)},
                                        {"y", static_cast<int>(UpAxis::kY)},
                                        {"z", static_cast<int>(UpAxis::kZ)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<SceneExpectation::Op>() {
  using Op = SceneExpectation::Op;
  static constexpr EnumName kNames[] = {
      {"<", static_cast<int>(Op::kLess)},    {"<=", static_cast<int>(Op::kLessOrEqual)},
      {">", static_cast<int>(Op::kGreater)}, {">=", static_cast<int>(Op::kGreaterOrEqual)},
      {"==", static_cast<int>(Op::kEqual)},  {"within", static_cast<int>(Op::kWithin)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<SceneExpectation::Quantity>() {
  using Quantity = SceneExpectation::Quantity;
  static constexpr EnumName kNames[] = {{"x", static_cast<int>(Quantity::kX)},
                                        {"y", static_cast<int>(Quantity::kY)},
                                        {"z", static_cast<int>(Quantity::kZ)},
                                        {"height", static_cast<int>(Quantity::kHeight)},
                                        {"speed", static_cast<int>(Quantity::kSpeed)},
                                        {"angular_speed", static_cast<int>(Quantity::kAngularSpeed)},
                                        {"tilt", static_cast<int>(Quantity::kTilt)},
                                        {"extension", static_cast<int>(Quantity::kExtension)},
                                        {"largest_stretch", static_cast<int>(Quantity::kLargestStretch)},
                                        {"mean_stretch", static_cast<int>(Quantity::kMeanStretch)},
                                        {"tension", static_cast<int>(Quantity::kTension)},
                                        {"twist", static_cast<int>(Quantity::kTwist)},
                                        {"lowest", static_cast<int>(Quantity::kLowest)},
                                        {"highest", static_cast<int>(Quantity::kHighest)},
                                        {"total_energy", static_cast<int>(Quantity::kTotalEnergy)},
                                        {"kinetic_energy", static_cast<int>(Quantity::kKineticEnergy)},
                                        {"potential_energy", static_cast<int>(Quantity::kPotentialEnergy)},
                                        {"elastic_energy", static_cast<int>(Quantity::kElasticEnergy)},
                                        {"momentum", static_cast<int>(Quantity::kMomentum)},
                                        {"penetration", static_cast<int>(Quantity::kPenetration)},
                                        {"contacts", static_cast<int>(Quantity::kContacts)},
                                        {"asleep", static_cast<int>(Quantity::kAsleep)},
                                        {"force", static_cast<int>(Quantity::kForce)},
                                        {"torque", static_cast<int>(Quantity::kTorque)},
                                        {"angle", static_cast<int>(Quantity::kAngle)},
                                        {"way", static_cast<int>(Quantity::kWay)},
                                        {"gap", static_cast<int>(Quantity::kGap)},
                                        {"broken", static_cast<int>(Quantity::kBroken)},
                                        {"yielded", static_cast<int>(Quantity::kYielded)},
                                        {"soft", static_cast<int>(Quantity::kSoft)}};
  return kNames;
}

}  // namespace hooke::io
