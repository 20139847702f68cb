#include "hooke/figure.h"

#include "render/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace hooke::app {

namespace {

/// Thinner springs than these are drawn as lines: round ones cost a hundred triangles each.
constexpr std::size_t kMostRoundSprings = 3000;
constexpr float kHalfSpaceSize = 50;  ///< [m], of a half-space that is not the ground.
constexpr float kIronDensity = 7800;  ///< [kg/m^3]
const render::Color kIron = {0.30F, 0.31F, 0.33F};

float srgb_of(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
}

render::Color color_of(const std::array<float, 3>& linear) {
  return {srgb_of(linear[0]), srgb_of(linear[1]), srgb_of(linear[2])};
}

/// What an object without a material looks like.
render::Color usual_color(SceneObject::Kind kind) {
  switch (kind) {
    case SceneObject::Kind::kRope:
      return {0.80F, 0.68F, 0.48F};
    case SceneObject::Kind::kCloth:
      return {0.30F, 0.50F, 0.72F};
    case SceneObject::Kind::kParticles:
      return {0.90F, 0.55F, 0.25F};
    default:
      return {0.66F, 0.67F, 0.66F};
  }
}

Finish finish_of(const Scene& scene, const SceneObject& object, const TextureLoader& textures) {
  if (object.material.empty()) return {.color = usual_color(object.kind)};
  const SceneMaterial& look = object.look;
  Finish finish = {color_of(look.color), nullptr, look.opacity, look.shininess};
  if (look.texture.empty()) return finish;
  finish.texture = textures((std::filesystem::path(scene.path).parent_path() / look.texture).string());
  return finish;
}

std::vector<FigurePart> model_parts(const Model& model, const TextureLoader& textures) {
  std::vector<FigurePart> parts;
  for (const ModelPart& part : model.parts) {
    const ModelMaterial& material = model.materials[part.material];
    Finish finish = {color_of(material.color), nullptr, material.opacity, material.shininess};
    if (!material.texture.empty()) finish.texture = textures(material.texture);
    if (part.count > 0) parts.push_back({part.first, part.count, finish});
  }
  return parts;
}

/// Names of an object's description: "ropes[2]", or "timeline[0].add.ropes[2]".
const SceneObjects& objects_of(const Scene& scene, const std::string& path, std::size_t& row) {
  const auto number_after = [&](std::size_t bracket) {
    std::size_t value = 0;
    for (std::size_t i = bracket + 1; i < path.size() && path[i] >= '0' && path[i] <= '9'; ++i) {
      value = 10 * value + static_cast<std::size_t>(path[i] - '0');
    }
    return value;
  };
  const std::size_t last = path.rfind('[');
  row = last == std::string::npos ? 0 : number_after(last);
  if (path.rfind("timeline[", 0) != 0) return scene.objects;
  const std::size_t event = number_after(path.find('['));
  return event < scene.timeline.size() ? scene.timeline[event].add : scene.objects;
}

/// The ball of iron of that mass.
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

void prepare_body(const SceneObject& object, Figure& figure) {
  figure.shape = object.shape;
  switch (object.shape.kind) {
    case ShapeKind::kSphere:
      figure.geometry = std::make_shared<render::MeshGeometry>(render::make_sphere(4));
      break;
    case ShapeKind::kBox:
      figure.geometry = std::make_shared<render::MeshGeometry>(render::make_box(object.shape.half_extents));
      break;
    case ShapeKind::kCapsule:
      figure.geometry = std::make_shared<render::MeshGeometry>(
          render::make_capsule(object.shape.radius, object.shape.half_height));
      break;
    case ShapeKind::kCylinder:
      figure.geometry = std::make_shared<render::MeshGeometry>(
          render::make_cylinder(object.shape.radius, object.shape.half_height));
      break;
    case ShapeKind::kCone:
    case ShapeKind::kHull:
    case ShapeKind::kMesh:
      if (object.model != nullptr) figure.geometry = geometry_of(*object.model);
      break;
    case ShapeKind::kHalfSpace:
      figure.geometry = std::make_shared<render::MeshGeometry>(
          render::make_box({kHalfSpaceSize, 0.5F * kHalfSpaceSize, kHalfSpaceSize}));
      break;
  }
}

void prepare_cloth(const Simulation& simulation, const SceneObject& object, Figure& figure) {
  if (object.model != nullptr) {
    figure.surface = make_model_surface(*object.model);
  } else if (object.columns > 1 && object.rows > 1) {
    figure.surface =
        make_grid_surface(object.columns, object.rows, simulation.world().triangles(object.cloth));
  }
}

void prepare_points(const Simulation& simulation, const SceneObject& object, Figure& figure) {
  std::size_t row = 0;
  const SceneObjects& objects = objects_of(simulation.scene(), object.path, row);
  if (object.kind == SceneObject::Kind::kRope && row < objects.ropes.size()) {
    add_loads(objects.ropes[row].loads, simulation.world().positions(object.rope).size(), figure);
  }
  if (object.kind == SceneObject::Kind::kCloth && row < objects.cloths.size()) {
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

/// Shiny surfaces reflect more of the sun, in a smaller spot.
float specular_of(float shininess) {
  return std::clamp(0.03F + 0.004F * shininess, 0.03F, 0.45F);
}

void add_mesh(const Figure& figure, const std::shared_ptr<const render::MeshGeometry>& geometry,
              const Mat4& transform, render::DrawList& list) {
  for (const FigurePart& part : figure.parts) {
    render::DrawMesh mesh;
    mesh.geometry = geometry;
    mesh.first_index = part.first;
    mesh.index_count = part.count;
    mesh.transform = transform;
    mesh.texture = part.finish.texture;
    mesh.color = part.finish.color;
    mesh.opacity = part.finish.opacity;
    mesh.shininess = part.finish.shininess;
    mesh.specular = specular_of(part.finish.shininess);
    const bool holed = part.finish.texture != nullptr && part.finish.texture->channels == 4;
    mesh.alpha = holed ? render::AlphaMode::kCutout : render::AlphaMode::kOpaque;
    mesh.two_sided = figure.surface.has_value();
    list.meshes.push_back(std::move(mesh));
  }
}

bool add_ground(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  const Vec3 up = rotate(place.rotation, Vec3{0, 1, 0});
  if (list.ground.has_value() || up.y < 0.9999F) return false;
  render::Ground ground;
  const Finish& finish = figure.parts.front().finish;
  ground.height = place.position.y;
  ground.color = finish.color;
  ground.line_color = {0.78F * finish.color.r, 0.78F * finish.color.g, 0.78F * finish.color.b};
  ground.grid_spacing = 1;
  ground.grid_x = place.position.x;
  ground.grid_z = place.position.z;
  list.ground = ground;
  return true;
}

void add_body(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  if (figure.geometry == nullptr) return;
  Vec3 position = place.position;
  Vec3 scale = {1, 1, 1};
  if (figure.shape.kind == ShapeKind::kSphere) {
    scale = {figure.shape.radius, figure.shape.radius, figure.shape.radius};
  }
  if (figure.shape.kind == ShapeKind::kHalfSpace) {
    if (add_ground(figure, place, list)) return;
    position += rotate(place.rotation, Vec3{0, -0.5F * kHalfSpaceSize, 0});
  }
  add_mesh(figure, figure.geometry, make_transform(position, place.rotation, scale), list);
}

float visible_radius(float radius, Vec3 point, const FigurePlace& place) {
  return std::max(radius, place.least_rope_radius * length(point - place.eye));
}

void add_rope(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  if (place.points.empty()) return;
  const Finish& finish = figure.parts.front().finish;
  const float radius = visible_radius(figure.radius, place.points[place.points.size() / 2], place);
  list.ropes.push_back({{place.points.begin(), place.points.end()},
                        radius,
                        finish.color,
                        finish.shininess,
                        specular_of(finish.shininess)});
}

void add_loads(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  for (const FigureLoad& load : figure.loads) {
    if (load.point < place.points.size())
      list.spheres.push_back({place.points[load.point], load.radius, kIron});
  }
}

void add_springs(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  const Finish& finish = figure.parts.front().finish;
  const bool round = figure.springs.size() <= kMostRoundSprings;
  for (const SpringDesc& spring : figure.springs) {
    if (spring.a >= place.points.size() || spring.b >= place.points.size()) continue;
    const Vec3 from = place.points[spring.a];
    const Vec3 to = place.points[spring.b];
    if (round) {
      const float radius =
          visible_radius(0.3F * std::min(figure.radii[spring.a], figure.radii[spring.b]), from, place);
      list.ropes.push_back({{from, to}, radius, finish.color, finish.shininess, 0.1F});
    } else {
      list.lines.push_back({from, to, finish.color, 1, 1.5F});
    }
  }
}

void add_particles(const Figure& figure, const FigurePlace& place, render::DrawList& list) {
  add_springs(figure, place, list);
  const std::size_t count = std::min(place.points.size(), figure.radii.size());
  for (std::size_t i = 0; i < count; ++i) {
    list.spheres.push_back({place.points[i], figure.radii[i], figure.parts.front().finish.color});
  }
}

}  // namespace

Figure make_figure(const Simulation& simulation, const SceneObject& object, const TextureLoader& textures) {
  Figure figure;
  figure.kind = object.kind;
  figure.radius = static_cast<float>(object.radius);
  if (object.model != nullptr && object.material.empty()) figure.parts = model_parts(*object.model, textures);
  if (figure.parts.empty()) figure.parts.push_back({0, 0, finish_of(simulation.scene(), object, textures)});
  if (object.kind == SceneObject::Kind::kBody) prepare_body(object, figure);
  if (object.kind == SceneObject::Kind::kCloth) prepare_cloth(simulation, object, figure);
  prepare_points(simulation, object, figure);
  return figure;
}

void add_figure(Figure& figure, const FigurePlace& place, render::DrawList& list) {
  switch (figure.kind) {
    case SceneObject::Kind::kBody:
      add_body(figure, place, list);
      break;
    case SceneObject::Kind::kRope:
      add_rope(figure, place, list);
      break;
    case SceneObject::Kind::kCloth:
      if (!figure.surface) break;
      update_surface(*figure.surface, place.points);
      add_mesh(figure, figure.surface->geometry, affine(Mat3{}, Vec3{}), list);
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
