#include "hooke/drawing/figure.h"

#include "hooke/scene_path.h"

#include "render/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace hooke::app {

namespace {

/// Above this number springs are drawn as lines, because round ones cost a hundred triangles each.
constexpr std::size_t kMostRoundSprings = 3000;
constexpr float kLeastRopeRadius = 1.2F;  ///< Half the least width of a rope [px].
/// Spheres and capsules with a radius above the first [px] are drawn by the finest level, smaller ones by the
/// next, and below the second by the coarsest. None is more than half a pixel off.
constexpr std::array<float, 2> kLevelRadius = {40, 10};
constexpr float kIronDensity = 7850;   ///< That of the library's steel [kg/m^3].
constexpr float kHookRadius = 0.008F;  ///< Radius of the line that shows a distance hook [m].

float srgb_of(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
}

/// Returns the color of an object without a material.
render::Color usual_color(SceneObject::Kind kind) {
  switch (kind) {
    case SceneObject::Kind::kRope:
    case SceneObject::Kind::kHook:
      return {0.80F, 0.68F, 0.48F};
    case SceneObject::Kind::kCloth:
      return {0.30F, 0.50F, 0.72F};
    case SceneObject::Kind::kSolid:
      return {0.78F, 0.32F, 0.38F};
    case SceneObject::Kind::kParticles:
      return {0.90F, 0.55F, 0.25F};
    default:
      return {0.66F, 0.67F, 0.66F};
  }
}

/// Returns the roughness whose highlight is as wide as that of Blinn and Phong's exponent (Walter and others,
/// 2007).
float roughness_of(float shininess) {
  return std::pow(2 / (shininess + 2), 0.25F);
}

float shininess_of(float roughness) {
  const float squared = std::max(roughness * roughness, 1e-3F);
  return std::clamp(2 / (squared * squared) - 2, 1.0F, 1000.0F);
}

Finish finish_of(const Scene& scene, const SceneMaterial& look, const TextureLoader& textures) {
  Finish finish = {.color = srgb_color_of(look.color), .opacity = look.opacity, .shininess = look.shininess};
  finish.metalness = look.metalness;
  finish.roughness = look.roughness ? static_cast<float>(*look.roughness) : roughness_of(look.shininess);
  if (look.roughness) finish.shininess = shininess_of(finish.roughness);
  finish.transmission = look.transmission;
  finish.sheen = look.sheen;
  finish.thread_pitch = static_cast<float>(look.thread_pitch.value_or(Real(0)));
  finish.hair = look.hair;
  finish.tiles = static_cast<float>(look.tiles);
  finish.relief = look.normal_scale;
  const auto image = [&](const std::string& file, ImageUse use) -> std::shared_ptr<const render::Image> {
    if (file.empty()) return nullptr;
    return textures((std::filesystem::path(scene.path).parent_path() / file).string(), nullptr, use);
  };
  finish.texture = image(look.texture, ImageUse::kColor);
  finish.normals = image(look.normal_map, ImageUse::kNormals);
  finish.finish = image(look.roughness_map, ImageUse::kFinish);
  return finish;
}

/// Whether a model's file says nothing of how this material looks. Files of .obj without materials give one
/// of that name.
bool is_plain(const ModelMaterial& material) {
  const ModelMaterial plain;
  return (material.color == plain.color || material.name == "DefaultMaterial") &&
         material.opacity == plain.opacity && material.texture.empty() && material.normal_map.file.empty() &&
         material.roughness_map.file.empty() && material.metalness == plain.metalness && !material.roughness;
}

/// Parts of which the model says nothing get the other finish, if there is one.
std::vector<PaintedRange> model_ranges(const Model& model, const std::optional<Finish>& other,
                                       const TextureLoader& textures) {
  std::vector<PaintedRange> ranges;
  for (const ModelPart& part : model.parts) {
    const ModelMaterial& material = model.materials[part.material];
    if (other && is_plain(material)) {
      if (part.count > 0) ranges.push_back({part.first, part.count, *other});
      continue;
    }
    Finish finish = {.color = srgb_color_of(material.color),
                     .opacity = material.opacity,
                     .shininess = material.shininess,
                     .metalness = material.metalness,
                     .roughness = material.roughness.value_or(roughness_of(material.shininess))};
    finish.relief = material.normal_scale;
    const auto image = [&](const std::string& file, const ImageBytes& bytes, ImageUse use) {
      return file.empty() ? nullptr : textures(file, bytes, use);
    };
    finish.texture = image(material.texture, material.image, ImageUse::kColor);
    finish.normals = image(material.normal_map.file, material.normal_map.bytes, ImageUse::kNormals);
    finish.finish = image(material.roughness_map.file, material.roughness_map.bytes, ImageUse::kFinish);
    if (part.count > 0) ranges.push_back({part.first, part.count, finish});
  }
  return ranges;
}

/// This is what the ranges of an object, or of a part of it, depend on.
struct Look {
  SceneObject::Kind kind;
  const std::string& material;  ///< Empty for a model's own materials, or the usual color.
  const SceneMaterial& look;
  const Model* model;
  bool is_visual = false;  ///< The model is drawn in place of the object, and keeps its own materials.
};

std::vector<PaintedRange> ranges_of(const Scene& scene, const Look& look, const TextureLoader& textures) {
  std::optional<Finish> finish;
  if (!look.material.empty()) finish = finish_of(scene, look.look, textures);
  if (finish && !look.is_visual) return {{0, 0, *finish}};
  std::vector<PaintedRange> ranges;
  if (look.model != nullptr) ranges = model_ranges(*look.model, finish, textures);
  if (ranges.empty()) ranges.push_back({0, 0, {.color = usual_color(look.kind)}});
  return ranges;
}

/// Returns the radius of an iron ball of that mass.
float load_radius(Real mass) {
  return std::cbrt(3 * static_cast<float>(mass) / (4 * std::numbers::pi_v<float> * kIronDensity));
}

void add_loads(const std::vector<SceneLoad>& loads, std::size_t points, Figure& figure) {
  for (const SceneLoad& load : loads) {
    const float radius = load_radius(load.mass);
    const std::size_t point = load.point.last && points > 0 ? points - 1 : load.point.index;
    if (radius > 1.2F * figure.radius) figure.loads.push_back({point, radius});
  }
}

/// A hull has faces of its own, and no materials.
const Model* drawn_materials(const Shape& shape, const std::shared_ptr<const Model>& model) {
  return shape.kind == ShapeKind::kMesh ? model.get() : nullptr;
}

std::vector<FigureSolid> solids_of(const Scene& scene, const SceneObject& object,
                                   const TextureLoader& textures, BodyGeometries& geometries) {
  if (object.visual != nullptr) {
    const Look look = {object.kind, object.material, object.look, object.visual.get(), true};
    return {{.geometry = geometries.find(Shape::of_mesh({}), object.visual),
             .ranges = ranges_of(scene, look, textures)}};
  }
  if (object.shape.kind != ShapeKind::kCompound) {
    const Look look = {object.kind, object.material, object.look,
                       drawn_materials(object.shape, object.model)};
    return {{.geometry = geometries.find(object.shape, object.model),
             .ranges = ranges_of(scene, look, textures)}};
  }
  std::vector<FigureSolid> solids;
  for (const SceneObject::Part& part : object.parts) {
    const Look look = {object.kind, part.material, part.look, drawn_materials(part.shape, part.model)};
    solids.push_back({.geometry = geometries.find(part.shape, part.model),
                      .position = part.position,
                      .rotation = part.rotation,
                      .ranges = ranges_of(scene, look, textures)});
  }
  return solids;
}

void prepare_cloth(const Simulation& simulation, const SceneObject& object, Figure& figure) {
  const World& world = simulation.world();
  const std::vector<std::uint32_t> splits = world.splits(object.cloth);
  const auto triangles = world.triangles(object.cloth);
  figure.splits = splits.size();
  if (object.model != nullptr) {
    figure.surface = make_model_surface(*object.model);
  } else if (object.columns > 1 && object.rows > 1) {
    const std::size_t points = std::size_t{object.columns} * object.rows;
    figure.surface = make_grid_surface(object.columns, object.rows, untorn(triangles, splits, points));
  }
  if (figure.surface) tear_surface(triangles, splits, *figure.surface);
}

/// The surface of a solid without a model.
ClothSurface surface_from(const std::vector<DVec3>& places,
                          std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<Vec3> points;
  points.reserve(places.size());
  for (const DVec3& place : places) points.push_back(vector_cast<float>(place - places.front()));
  return make_solid_surface(points, triangles);
}

void prepare_solid(const Simulation& simulation, const SceneObject& object, Figure& figure) {
  const std::vector<std::uint32_t> splits = simulation.world().splits(object.solid);
  figure.splits = splits.size();
  if (object.model != nullptr) {
    figure.surface = make_model_surface(*object.model);
    const std::size_t before = figure.surface->geometry->indices.size();
    tear_surface(simulation.world().triangles(object.solid), splits, *figure.surface);
    // Faces that have come open have the last material of the model.
    const auto opened = static_cast<std::uint32_t>(figure.surface->geometry->indices.size() - before);
    if (!figure.ranges.empty() && figure.ranges.back().count > 0) figure.ranges.back().count += opened;
    return;
  }
  figure.surface =
      surface_from(simulation.world().surface(object.solid), simulation.world().triangles(object.solid));
}

/// A body that is soft, or has a dent, is drawn as a solid is.
void prepare_reshaped(const Simulation& simulation, const SceneObject& object, const TextureLoader& textures,
                      Figure& figure) {
  const World& world = simulation.world();
  // A model that had to be closed has other vertices than what moves.
  const bool has_model = object.shape.kind == ShapeKind::kMesh && object.model != nullptr &&
                         world.triangles(object.body).size() * 3 == object.model->indices.size();
  figure.kind = SceneObject::Kind::kSolid;
  figure.reshaped = true;
  const Look look = {object.kind, object.material, object.look, has_model ? object.model.get() : nullptr};
  figure.ranges = ranges_of(simulation.scene(), look, textures);
  // Faces are told apart by their directions, so that the body is looked at as if it were not turned.
  const Quat turn = world.pose(object.body).rotation;
  std::vector<DVec3> places = world.surface(object.body);
  for (DVec3& place : places) {
    place = vector_cast<double>(
        rotate(conjugate(turn), vector_cast<Real>(place - world.pose(object.body).position)));
  }
  figure.surface =
      has_model ? make_model_surface(*object.model) : surface_from(places, world.triangles(object.body));
}

void prepare_points(const Simulation& simulation, const SceneObject& object, Figure& figure) {
  std::size_t row = 0;
  const SceneObjects& objects = objects_of(simulation, object.path, row);
  if (object.kind == SceneObject::Kind::kRope && row < objects.ropes.size()) {
    add_loads(objects.ropes[row].loads, simulation.world().positions(object.rope).size(), figure);
  }
  if (object.kind == SceneObject::Kind::kCloth && row < objects.cloths.size()) {
    if (object.model == nullptr) figure.width = static_cast<float>(objects.cloths[row].desc.width);
    add_loads(objects.cloths[row].loads, simulation.world().positions(object.cloth).size(), figure);
  }
  if (object.kind == SceneObject::Kind::kParticles && row < objects.particles.size()) {
    const ParticlesDesc& desc = objects.particles[row].desc;
    for (const ParticleDesc& particle : desc.particles) {
      figure.radii.push_back(static_cast<float>(particle.radius));
    }
    figure.springs = desc.springs;
  }
}

render::Surface surface_of(const Finish& finish, render::Shading shading) {
  const bool is_cloth = shading == render::Shading::kCloth;
  return {.shading = shading,
          .metalness = finish.metalness,
          .roughness = finish.roughness,
          .sheen = is_cloth ? finish.sheen : 0,
          .transmission = finish.transmission,
          .threads = 0,
          .relief = finish.relief};
}

/// Returns a mesh to be drawn with one finish.
render::DrawMesh painted(const PaintedRange& range, render::Shading shading) {
  const Finish& finish = range.finish;
  render::DrawMesh mesh;
  mesh.first_index = range.first;
  mesh.index_count = range.count;
  mesh.texture = finish.texture;
  mesh.normals = finish.normals;
  mesh.finish = finish.finish;
  mesh.color = finish.color;
  mesh.opacity = finish.opacity;
  mesh.surface = surface_of(finish, shading);
  const bool holed = finish.texture != nullptr && finish.texture->channels == 4;
  mesh.alpha = holed ? render::AlphaMode::kCutout : render::AlphaMode::kOpaque;
  return mesh;
}

bool add_ground(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  const Vec3 up = rotate(place.rotation, Vec3{0, 1, 0});
  if (list.ground.has_value() || up.y < 0.9999F) return false;
  render::Ground ground;
  const Finish& finish = figure.solids.front().ranges.front().finish;
  ground.height = place.position.y;
  ground.color = finish.color;
  ground.line_color = {0.88F * finish.color.r, 0.88F * finish.color.g, 0.88F * finish.color.b};
  ground.grid_spacing = finish.tiles;
  ground.grid_x = place.position.x;
  ground.grid_z = place.position.z;
  list.ground = ground;
  return true;
}

void add_body(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  if (figure.half_space && add_ground(figure, place, list)) return;
  const float distance = length(place.position - place.eye);
  const Mat4 body = make_transform(place.position, place.rotation, Vec3{1, 1, 1});
  for (const FigureSolid& solid : figure.solids) {
    const float radius = solid.geometry.radius / std::max(place.pixel * distance, 1e-9F);
    const std::size_t level = radius > kLevelRadius[0] ? 0 : radius > kLevelRadius[1] ? 1 : 2;
    if (solid.geometry.levels[level] == nullptr) continue;
    for (const PaintedRange& range : solid.ranges) {
      render::DrawMesh mesh = painted(range, render::Shading::kSolid);
      mesh.geometry = solid.geometry.levels[level];
      mesh.transform = body * transform_of(solid);
      list.meshes.push_back(std::move(mesh));
    }
  }
}

void add_cloth(Figure& figure, const FigurePlace& place, render::DrawList& list) {
  if (!figure.surface) return;
  update_surface(*figure.surface, place.points);
  const bool is_cloth = figure.kind == SceneObject::Kind::kCloth;
  for (const PaintedRange& range : figure.ranges) {
    render::DrawMesh mesh = painted(range, is_cloth ? render::Shading::kCloth : render::Shading::kSolid);
    mesh.geometry = figure.surface->geometry;
    if (is_cloth && range.finish.thread_pitch > 0)
      mesh.surface.threads = figure.width / range.finish.thread_pitch;
    mesh.transform = affine(Mat3{}, Vec3{});
    mesh.two_sided = true;
    list.meshes.push_back(std::move(mesh));
  }
}

float visible_radius(float radius, Vec3 point, const FigurePlace& place) {
  return std::max(radius, kLeastRopeRadius * place.pixel * length(point - place.eye));
}

void add_rope(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  if (place.points.empty()) return;
  const Finish& finish = figure.ranges.front().finish;
  const float radius = visible_radius(figure.radius, place.points[place.points.size() / 2], place);
  std::size_t first = 0;
  const auto add_until = [&](std::size_t end) {
    const auto points = place.points.begin();
    if (end - first > 1) {
      list.ropes.push_back(
          {{points + static_cast<std::ptrdiff_t>(first), points + static_cast<std::ptrdiff_t>(end)},
           radius,
           finish.color,
           surface_of(finish, finish.hair ? render::Shading::kHair : render::Shading::kRope)});
    }
    first = end;
  };
  for (const std::uint32_t gap : place.gaps) add_until(gap + 1);
  add_until(place.points.size());
}

void add_loads(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  for (const FigureLoad& load : figure.loads) {
    if (load.point >= place.points.size()) continue;
    list.spheres.push_back({place.points[load.point], load.radius, iron_finish().color,
                            surface_of(iron_finish(), render::Shading::kSolid)});
  }
}

void add_springs(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  const Finish& finish = figure.ranges.front().finish;
  const bool round = figure.springs.size() <= kMostRoundSprings;
  for (const SpringDesc& spring : figure.springs) {
    if (spring.a >= place.points.size() || spring.b >= place.points.size()) continue;
    const Vec3 from = place.points[spring.a];
    const Vec3 to = place.points[spring.b];
    if (round) {
      const float radius =
          visible_radius(0.3F * std::min(figure.radii[spring.a], figure.radii[spring.b]), from, place);
      list.ropes.push_back({{from, to}, radius, finish.color, surface_of(finish, render::Shading::kSolid)});
    } else {
      list.lines.push_back({from, to, finish.color, 1, 1.5F});
    }
  }
}

void add_particles(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  add_springs(figure, place, list);
  const std::size_t count = std::min(place.points.size(), figure.radii.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Finish& finish = figure.ranges.front().finish;
    list.spheres.push_back(
        {place.points[i], figure.radii[i], finish.color, surface_of(finish, render::Shading::kSolid)});
  }
}

}  // namespace

const Finish& iron_finish() {
  static const Finish iron = {.color = {0.56F, 0.57F, 0.58F}, .metalness = 1, .roughness = 0.5F};
  return iron;
}

render::Color srgb_color_of(const std::array<float, 3>& linear) {
  return {srgb_of(linear[0]), srgb_of(linear[1]), srgb_of(linear[2])};
}

ObjectKey key_of(const SceneObject& object) {
  // The ids of other kinds are null.
  return {object.kind,
          object.body.slot + object.rope.slot + object.cloth.slot + object.solid.slot +
              object.particles.slot + object.hook.slot,
          object.body.generation + object.rope.generation + object.cloth.generation +
              object.solid.generation + object.particles.generation + object.hook.generation};
}

Figure make_figure(const Simulation& simulation, const SceneObject& object, const TextureLoader& textures,
                   BodyGeometries& geometries) {
  Figure figure;
  figure.kind = object.kind;
  figure.radius = object.kind == SceneObject::Kind::kHook ? kHookRadius : static_cast<float>(object.radius);
  if (object.kind == SceneObject::Kind::kBody && simulation.world().is_reshaped(object.body)) {
    prepare_reshaped(simulation, object, textures, figure);
    return figure;
  }
  if (object.kind == SceneObject::Kind::kBody) {
    figure.solids = solids_of(simulation.scene(), object, textures, geometries);
    figure.half_space = object.shape.kind == ShapeKind::kHalfSpace;
    return figure;
  }
  const Look look = {object.kind, object.material, object.look, object.model.get(), object.visual != nullptr};
  figure.ranges = ranges_of(simulation.scene(), look, textures);
  if (object.kind == SceneObject::Kind::kCloth) prepare_cloth(simulation, object, figure);
  if (object.kind == SceneObject::Kind::kSolid) prepare_solid(simulation, object, figure);
  prepare_points(simulation, object, figure);
  return figure;
}

Figure make_reshaped_figure(const Simulation& simulation, const SceneObject& object,
                            const TextureLoader& textures) {
  Figure figure;
  prepare_reshaped(simulation, object, textures, figure);
  return figure;
}

Mat4 transform_of(const FigureSolid& solid) {
  const Vec3 position = solid.position + rotate(solid.rotation, solid.geometry.shift);
  return make_transform(position, solid.rotation, solid.geometry.scale);
}

void add_figure(Figure& figure, const FigurePlace& place, render::DrawList& list) {
  switch (figure.kind) {
    case SceneObject::Kind::kBody:
      add_body(figure, place, list);
      break;
    case SceneObject::Kind::kRope:
    case SceneObject::Kind::kHook:
      add_rope(figure, place, list);
      break;
    case SceneObject::Kind::kCloth:
    case SceneObject::Kind::kSolid:
      add_cloth(figure, place, list);
      break;
    case SceneObject::Kind::kParticles:
      add_particles(figure, place, list);
      break;
    case SceneObject::Kind::kField:
      break;
  }
  add_loads(figure, place, list);
}

}  // namespace hooke::app
