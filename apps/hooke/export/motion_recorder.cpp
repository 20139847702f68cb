#include "hooke/export/motion_recorder.h"

#include "hooke/clock.h"
#include "hooke/drawing/scene_camera.h"
#include "hooke/scene_path.h"

#include "render/batches.h"
#include "render/sky_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace hooke::app {

namespace {

constexpr float kGroundSize = 50;   ///< Half the side of the square that shows a half-space [m].
constexpr std::size_t kCrowd = 64;  ///< Number of bodies beyond which balls have 320 triangles, not 5120.
constexpr float kRadians = std::numbers::pi_v<float> / 180;  ///< Of a degree.

using Kind = SceneObject::Kind;

DVec3 mean_of(const PointView& points) {
  DVec3 sum;
  for (std::size_t i = 0; i < points.size(); ++i) sum += points[i];
  return points.empty() ? sum : 1.0 / static_cast<double>(points.size()) * sum;
}

DVec3 mix(DVec3 a, DVec3 b, double part) {
  return (1 - part) * a + part * b;
}

Vec3 mix(Vec3 a, Vec3 b, double part) {
  const auto t = static_cast<float>(part);
  return (1 - t) * a + t * b;
}

MotionState mix(const MotionState& a, const MotionState& b, double part) {
  const Pose pose = blend(Pose{a.position, a.rotation}, Pose{b.position, b.rotation}, part);
  const auto number = [&](double x, double y) { return (1 - part) * x + part * y; };
  return {
      .position = pose.position,
      .rotation = pose.rotation,
      .velocity = mix(a.velocity, b.velocity, part),
      .angular_velocity = mix(a.angular_velocity, b.angular_velocity, part),
      .energy = {number(a.energy.kinetic, b.energy.kinetic), number(a.energy.potential, b.energy.potential),
                 number(a.energy.elastic, b.energy.elastic)}};
}

MotionLight::Kind kind_of(SceneLight::Kind kind) {
  switch (kind) {
    case SceneLight::Kind::kDirectional:
      return MotionLight::Kind::kDirectional;
    case SceneLight::Kind::kSpot:
      return MotionLight::Kind::kSpot;
    case SceneLight::Kind::kPoint:
      break;
  }
  return MotionLight::Kind::kPoint;
}

/// Returns the description that an object was made from, or null.
template <class Desc>
const Desc* desc_of(const Scene& scene, const std::string& path, std::vector<Desc> SceneObjects::*list) {
  std::size_t row = 0;
  const SceneObjects& objects = objects_of(scene, path, row);
  return row < (objects.*list).size() ? &(objects.*list)[row] : nullptr;
}

}  // namespace

bool MotionRecorder::is_recorded(const SceneObject& object) const {
  if (object.kind == Kind::kHook) {
    return detail_ == Detail::kSkins && object.hook_kind == HookKind::kDistance && !object.broken;
  }
  return object.kind != Kind::kField;
}

bool MotionRecorder::has_dents(const World& world, const SceneObject& object) const {
  return detail_ == Detail::kSkins && object.kind == Kind::kBody && !world.triangles(object.body).empty();
}

MotionRecorder::Taken MotionRecorder::taken(const World& world, const SceneObject& object) const {
  Taken now;
  now.key = key_of(object);
  if (object.kind == Kind::kBody) {
    const Pose pose = world.pose(object.body);
    now.state = {.position = pose.position,
                 .rotation = pose.rotation,
                 .velocity = world.velocity(object.body),
                 .angular_velocity = world.angular_velocity(object.body),
                 .energy = world.energy(object.body)};
    if (has_dents(world, object)) now.points = world.surface(object.body);
    return now;
  }
  if (object.kind == Kind::kHook) {
    const std::array<DVec3, 2> anchors = world.hook_anchors(object.hook);
    now.points.assign(anchors.begin(), anchors.end());
    now.state.position = mix(anchors[0], anchors[1], 0.5);
    return now;
  }
  const PointView points = positions_of(world, object);
  now.state.position = mean_of(points);
  now.state.velocity = vector_cast<Real>(mean_of(velocities_of(world, object)));
  const bool is_skin_of_solid = object.kind == Kind::kSolid && detail_ == Detail::kSkins;
  now.points = is_skin_of_solid ? world.surface(object.solid) : copy_points(points);
  // Formats of motion keep the points of the first frame: a tear shows as a triangle that is long.
  const std::size_t splits = world.splits(object.cloth).size() + world.splits(object.solid).size();
  if (!is_skin_of_solid) now.points.resize(points.size() - splits);
  return now;
}

void MotionRecorder::take(const Simulation& simulation, double time) {
  std::swap(previous_, current_);
  current_.time = time;
  current_.objects.clear();
  for (const SceneObject& object : simulation.objects()) {
    if (is_recorded(object)) current_.objects.push_back(taken(simulation.world(), object));
  }
}

Result<void> MotionRecorder::record(const Simulation& simulation, double time) {
  const double span = current_.time - previous_.time;
  const double part = span > 0 ? std::clamp((time - previous_.time) / span, 0.0, 1.0) : 1.0;
  is_crowded_ = current_.objects.size() > kCrowd;
  std::size_t i = 0;
  for (const SceneObject& object : simulation.objects()) {
    if (!is_recorded(object)) continue;
    const Taken& now = current_.objects[i];
    // Most often the objects are the same in the same order.
    const auto& before = previous_.objects;
    const auto same = [&](const Taken& other) { return other.key == now.key; };
    const auto found = i < before.size() && same(before[i])
                           ? before.begin() + static_cast<std::ptrdiff_t>(i)
                           : std::find_if(before.begin(), before.end(), same);
    ++i;
    const Taken& from = found == before.end() ? now : *found;
    const std::vector<DVec3> points = blend(from.points, std::span<const DVec3>(now.points), part);
    const auto entry = find_entry(simulation, object, {now.key, now.state, points});
    if (!entry) return entry.error();
    if (entry.value() == nullptr) continue;
    const MotionState state = mix(from.state, now.state, part);
    if (object.kind == Kind::kBody && !entry.value()->skin) {
      motion_.set_state(entry.value()->object, state);
    } else if (entry.value()->skin) {
      motion_.set_points(entry.value()->object, state, entry.value()->skin->vertices(points));
    } else {
      std::vector<Vec3> places;
      places.reserve(points.size());
      for (const DVec3& point : points) places.push_back(vector_cast<float>(point));
      motion_.set_points(entry.value()->object, state, places);
    }
  }
  if (!has_joints_) {
    if (auto added = add_joints(simulation); !added) return added;
  }
  if (auto set = set_camera(simulation.scene(), time); !set) return set;
  return motion_.finish_frame();
}

Result<MotionRecorder::Entry*> MotionRecorder::find_entry(const Simulation& simulation,
                                                          const SceneObject& object, const Taken& now) {
  if (const auto known = entries_.find(now.key); known != entries_.end()) return &known->second;
  const auto load = [this](const std::string& path, const ImageBytes& bytes, ImageUse use) {
    return looks_.load(path, bytes, use);
  };
  const bool yields = has_dents(simulation.world(), object);
  const Figure figure = yields ? make_reshaped_figure(simulation, object, load)
                               : make_figure(simulation, object, load, geometries_);
  if (yields) {
    yielding_.insert(object.name);
  } else if (object.kind == Kind::kBody) {
    const auto added = add_body(simulation, object, figure);
    if (!added) return added.error();
    if (!has_joints_) bodies_[object.name] = added.value();
    return &entries_.emplace(now.key, Entry{added.value(), std::nullopt}).first->second;
  }
  if (detail_ == Detail::kSkins && !figure.surface && now.points.size() < 2 && figure.radii.empty()) {
    if (std::find(names_.begin(), names_.end(), object.name) == names_.end()) names_.push_back(object.name);
    return static_cast<Entry*>(nullptr);
  }
  auto added = add_points(object, figure, now);
  if (!added) return added.error();
  return &entries_.emplace(now.key, std::move(added).value()).first->second;
}

Result<MotionRecorder::Entry> MotionRecorder::add_points(const SceneObject& object, const Figure& figure,
                                                         const Taken& now) {
  Entry entry;
  MotionMesh mesh;
  if (detail_ == Detail::kSkins) {
    const bool is_sheet = figure.surface.has_value();
    std::vector<std::uint32_t> materials;
    for (const PaintedRange& range : figure.ranges) {
      materials.push_back(looks_.find(motion_, range.finish, object.material, is_sheet));
    }
    const std::uint32_t iron = figure.loads.empty() ? 0 : looks_.find(motion_, iron_finish(), "iron", false);
    entry.skin.emplace(figure, now.points, materials, iron);
    mesh = entry.skin->mesh();
  } else {
    mesh.vertices.resize(now.points.size());
  }
  const auto number = motion_.add_mesh(std::move(mesh));
  if (!number) return Error{number.error().code, object.name, number.error().message};
  const auto added =
      motion_.add_object({.name = object.name, .kind = MotionObject::Kind::kPoints, .mesh = number.value()});
  if (!added) return added.error();
  entry.object = added.value();
  return entry;
}

/// Returns a square in the plane y = 0.
Result<std::uint32_t> MotionRecorder::add_plane(std::uint32_t material) {
  const auto [entry, is_new] = meshes_.try_emplace({nullptr, 0.0F, 0.0F, 0.0F, {material}});
  if (!is_new) return entry->second;
  MotionMesh mesh;
  for (const float x : {-kGroundSize, kGroundSize}) {
    for (const float z : {-kGroundSize, kGroundSize}) {
      mesh.vertices.push_back({.position = {x, 0, z}, .normal = {0, 1, 0}});
    }
  }
  mesh.indices = {0, 1, 2, 2, 1, 3};
  mesh.parts = {{0, 6, material}};
  auto added = motion_.add_mesh(std::move(mesh));
  if (added) entry->second = added.value();
  return added;
}

/// Returns the mesh of a piece, with its size in its vertices: equal pieces share it.
Result<std::uint32_t> MotionRecorder::add_piece_mesh(const FigureSolid& solid,
                                                     std::vector<std::uint32_t> materials) {
  const render::MeshGeometry& geometry = *solid.geometry.levels[is_crowded_ ? 1 : 0];
  const Vec3 scale = solid.geometry.scale;
  const auto [entry, is_new] = meshes_.try_emplace({&geometry, scale.x, scale.y, scale.z, materials});
  if (!is_new) return entry->second;
  MotionMesh mesh;
  for (std::size_t r = 0; r < solid.ranges.size(); ++r) {
    const PaintedRange& range = solid.ranges[r];
    const std::size_t end = range.count == 0 ? geometry.indices.size() : range.first + range.count;
    const auto begin = static_cast<std::uint32_t>(mesh.indices.size());
    std::map<std::uint32_t, std::uint32_t> number_of;
    for (std::size_t i = range.first; i < end; ++i) number_of.try_emplace(geometry.indices[i]);
    for (auto& [index, number] : number_of) {
      number = static_cast<std::uint32_t>(mesh.vertices.size());
      const render::Vertex& v = geometry.vertices[index];
      const Vec3 n = normalize(Vec3{v.normal.x / scale.x, v.normal.y / scale.y, v.normal.z / scale.z});
      mesh.vertices.push_back(
          {.position = {scale.x * v.position.x, scale.y * v.position.y, scale.z * v.position.z},
           .normal = {n.x, n.y, n.z},
           .uv = {v.u, v.v}});
    }
    for (std::size_t i = range.first; i < end; ++i) mesh.indices.push_back(number_of[geometry.indices[i]]);
    mesh.parts.push_back({begin, static_cast<std::uint32_t>(end - range.first), materials[r]});
  }
  auto added = motion_.add_mesh(std::move(mesh));
  if (added) entry->second = added.value();
  return added;
}

Result<std::uint32_t> MotionRecorder::add_body(const Simulation& simulation, const SceneObject& object,
                                               const Figure& figure) {
  const World& world = simulation.world();
  const Pose pose = world.pose(object.body);
  MotionObject body = {.name = object.name, .mass = world.mass(object.body)};
  const DVec3 lever = world.center_of_mass(object.body) - pose.position;
  body.center_of_mass = rotate(conjugate(pose.rotation), vector_cast<float>(lever));
  body.friction = object.look.friction;
  body.restitution = object.look.restitution;
  if (const SceneBody* desc = desc_of(simulation.scene(), object.path, &SceneObjects::bodies)) {
    body.body_kind = desc->desc.kind;
    body.collides = desc->desc.collides && !desc->desc.sensor;
    body.friction = desc->tag.friction.value_or(body.friction);
  }
  for (std::size_t i = 0; i < figure.solids.size() && detail_ == Detail::kSkins; ++i) {
    const FigureSolid& solid = figure.solids[i];
    const bool is_part = object.shape.kind == ShapeKind::kCompound;
    if (!figure.half_space && solid.geometry.levels[0] == nullptr) continue;
    const std::string& material = is_part ? object.parts[i].material : object.material;
    std::vector<std::uint32_t> materials;
    for (const PaintedRange& range : solid.ranges) {
      materials.push_back(looks_.find(motion_, range.finish, material, figure.half_space));
    }
    const auto mesh = figure.half_space ? add_plane(materials.front()) : add_piece_mesh(solid, materials);
    if (!mesh) return Error{mesh.error().code, object.name, mesh.error().message};
    body.pieces.push_back({.mesh = mesh.value(),
                           .position = solid.position,
                           .rotation = solid.rotation,
                           .shape = is_part ? object.parts[i].shape : object.shape});
  }
  return motion_.add_object(std::move(body));
}

/// Sets the camera of this frame, if the scene has one. Where it passes what it looks at it keeps its
/// direction.
Result<void> MotionRecorder::set_camera(const Scene& scene, double time) {
  if (!scene.camera) return {};
  const Viewpoint view = viewpoint_at(*scene.camera, time);
  if (view.eye == view.target) return {};
  return motion_.set_camera({view.eye, view.target, view.vertical_fov_deg * kRadians});
}

/// Adds the sun, the sky and the lights, as bright as a picture of the scene shows them.
Result<void> MotionRecorder::add_lights(const Scene& scene) {
  render::DrawList list;
  list.sun.intensity = static_cast<float>(scene.sky.sun);
  list.sky.brightness = static_cast<float>(scene.sky.brightness);
  const render::SkyLight light = render::sky_light_of(list);
  std::array<float, 3> luminance = {};
  for (std::size_t i = 0; i < 3; ++i)
    luminance[i] = light.ambient * 0.5F * (light.zenith[i] + light.horizon[i]);
  if (auto set = motion_.set_sky(luminance); !set) return set;
  const float sun = render::kSunStrength * list.sun.intensity;
  if (sun > 0) {
    auto added = motion_.add_light({.name = "sun",
                                    .kind = MotionLight::Kind::kDirectional,
                                    .direction = scene.sky.sun_direction,
                                    .color = scene.sky.sun_color,
                                    .strength = sun});
    if (!added) return added;
  }
  for (const SceneLight& one : scene.lights) {
    const auto radians = [](Real degrees) { return static_cast<float>(degrees) * kRadians; };
    auto added = motion_.add_light({.name = "light",
                                    .kind = kind_of(one.kind),
                                    .position = one.position,
                                    .direction = one.direction,
                                    .color = one.color,
                                    .strength = render::kSunStrength * static_cast<float>(one.intensity),
                                    .inner_angle = radians(one.inner_deg),
                                    .outer_angle = radians(one.outer_deg),
                                    .shadows = one.shadows});
    if (!added) return added;
  }
  return {};
}

/// Adds the hooks of bodies as they are in the first frame.
Result<void> MotionRecorder::add_joints(const Simulation& simulation) {
  has_joints_ = true;
  motion_.set_gravity(simulation.world().desc().gravity);
  if (auto added = add_lights(simulation.scene()); !added) return added;
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind != Kind::kHook || object.broken) continue;
    const SceneHook* desc = object.path.find("hooks[") != std::string::npos
                                ? desc_of(simulation.scene(), object.path, &SceneObjects::hooks)
                                : nullptr;
    MotionJoint joint = {.name = object.name, .kind = object.hook_kind};
    const auto end_of = [&](const std::string& name, std::optional<std::uint32_t>& end) {
      const auto body = bodies_.find(name);
      if (body != bodies_.end()) end = body->second;
      return name.empty() || end.has_value();
    };
    if (yielding_.contains(object.hooked[0]) || yielding_.contains(object.hooked[1])) ++lost_joints_;
    // A hook at a point of a rope or cloth is no joint of two bodies.
    const bool holds_bodies = end_of(object.hooked[0], joint.a) && end_of(object.hooked[1], joint.b);
    if (!holds_bodies || desc == nullptr) continue;
    joint.anchors = simulation.world().hook_anchors(object.hook);
    joint.axis = desc->desc.axis;
    joint.limits = desc->desc.limits;
    joint.cone = desc->desc.cone;
    joint.break_force = desc->desc.break_force;
    joint.break_torque = desc->desc.break_torque;
    if (auto added = motion_.add_joint(std::move(joint)); !added) return added;
  }
  return {};
}

std::vector<std::string> MotionRecorder::warnings() const {
  std::vector<std::string> lines = looks_.warnings();
  for (const std::string& name : names_) {
    lines.push_back("'" + name + "' is left out, as it has nothing that could be drawn");
  }
  if (lost_joints_ > 0) {
    lines.push_back(std::to_string(lost_joints_) +
                    " hooks of bodies with 'yields' are no joints: such bodies are recorded as what deforms");
  }
  return lines;
}

}  // namespace hooke::app
