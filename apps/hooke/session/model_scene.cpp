#include "hooke/session/model_scene.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

namespace hooke::app {

namespace {

const char* const kName = "model";

constexpr double kLift = 0.2;        ///< Height from which forms that move fall, in longest sides.
constexpr double kCells = 12;        ///< Cells of jelly along the longest side.
constexpr double kSink = 0.03;       ///< Share of its height by which jelly sinks under its weight, about.
constexpr double kThickness = 4e-3;  ///< Thickness of cloth and jelly, in longest sides.
/// Points of a cloth that steps in real time on a usual machine, about.
constexpr std::size_t kMostClothPoints = 20000;
/// Points up to which a cloth also keeps from passing through itself, which costs as much again.
constexpr std::size_t kMostSelfPoints = 4000;

/// Sizes of a model as it is imported [m].
struct Extent {
  double lowest = 0;
  double longest = 1;
  double mean_edge = 0;
};

Extent extent_of(const Model& model) {
  std::array<double, 3> low = {1e30, 1e30, 1e30};
  std::array<double, 3> high = {-1e30, -1e30, -1e30};
  for (const ModelVertex& vertex : model.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], static_cast<double>(vertex.position[k]));
      high[k] = std::max(high[k], static_cast<double>(vertex.position[k]));
    }
  }
  Extent extent;
  extent.lowest = low[1];
  extent.longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  double sum = 0;
  for (const auto& [a, b, c] : model.mesh.triangles) {
    const auto& points = model.mesh.positions;
    sum += static_cast<double>(length(points[b] - points[a]) + length(points[c] - points[b]) +
                               length(points[a] - points[c]));
  }
  extent.mean_edge = sum / (3 * std::max(static_cast<double>(model.mesh.triangles.size()), 1.0));
  return extent;
}

/// Two digits are enough for a figure that a user reads in the inspector.
Real rounded(double value) {
  const double unit = std::pow(10, std::floor(std::log10(std::max(value, 1e-12))) - 1);
  return static_cast<Real>(unit * std::round(value / unit));
}

SceneBody body_of(const Extent& extent, bool moves) {
  SceneBody body;
  body.tag.name = body.mesh = kName;
  body.desc.shape.kind = ShapeKind::kMesh;
  body.desc.position = {0, (moves ? kLift * extent.longest : 0) - extent.lowest, 0};
  if (moves) body.desc.kind = BodyKind::kDynamic;
  return body;
}

SceneSolid solid_of(const Extent& extent, Real gravity) {
  SceneSolid solid;
  solid.tag.name = solid.mesh = kName;
  solid.desc.position = {0, kLift * extent.longest - extent.lowest, 0};
  solid.desc.cell = rounded(extent.longest / kCells);
  solid.desc.thickness = rounded(kThickness * extent.longest);
  // A column sinks by rho g h / (2 E) of its height h.
  const double load = static_cast<double>(solid.desc.density * gravity) * extent.longest;
  if (load > 0) solid.desc.young_modulus = rounded(load / (2 * kSink));
  return solid;
}

SceneCloth cloth_of(const Extent& extent, std::size_t points) {
  SceneCloth cloth;
  cloth.tag.name = cloth.mesh = kName;
  cloth.desc.position = {0, kLift * extent.longest - extent.lowest, 0};
  cloth.desc.thickness = rounded(std::min(kThickness * extent.longest, 0.4 * extent.mean_edge));
  cloth.desc.self_contact = points <= kMostSelfPoints;
  return cloth;
}

template <class T>
void drop_model(std::vector<T>& list) {
  std::erase_if(list, [](const T& object) { return object.tag.name == kName; });
}

template <class T>
const T* find_model(const std::vector<T>& list) {
  const auto found =
      std::find_if(list.begin(), list.end(), [](const T& object) { return object.tag.name == kName; });
  return found == list.end() ? nullptr : &*found;
}

Error too_many_points(std::size_t points) {
  return {ErrorCode::kLimitExceeded, kName,
          "its surface has " + std::to_string(points) +
              " points, and a cloth that runs in real time at most " + std::to_string(kMostClothPoints) +
              ": open a coarser model"};
}

}  // namespace

bool is_model_file(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto known = {".3ds", ".obj", ".stl", ".ply", ".gltf", ".glb"};
  return std::any_of(known.begin(), known.end(), [&](const char* e) { return ending == e; });
}

Result<SceneDocument> document_of_model(const std::string& file, const ImportOptions& options) {
  const auto model = import_model(file, options);
  if (!model) return model.error();
  Scene scene;
  const std::filesystem::path path = file;
  scene.title = path.filename().string();
  // Paths of meshes are relative to the scene, so that the scene gets a path beside the model. It keeps the
  // ending, so that what is saved beside it overwrites nothing of another model or scene.
  scene.path = file + ".json";
  scene.meshes.push_back({.name = kName, .file = path.filename().string(), .import = options});
  scene.materials.push_back({.name = "ground", .color = {0.13F, 0.16F, 0.14F}});
  scene.objects.bodies.push_back({.tag = {.name = "ground", .material = "ground"}});
  scene.objects.bodies.push_back(body_of(extent_of(model.value()), false));
  std::string text = write_scene(scene);
  return SceneDocument{file, std::move(text), std::move(scene)};
}

std::optional<ModelForm> form_of_model(const SceneDocument& document) {
  if (!is_model_file(document.file)) return {};
  const SceneObjects& objects = document.scene.objects;
  if (find_model(objects.solids) != nullptr) return ModelForm::kJelly;
  if (find_model(objects.cloths) != nullptr) return ModelForm::kCloth;
  const SceneBody* body = find_model(objects.bodies);
  if (body == nullptr) return {};
  return body->desc.kind == BodyKind::kDynamic ? ModelForm::kRigid : ModelForm::kStill;
}

Result<SceneDocument> turn_model(const SceneDocument& document, ModelForm form) {
  const std::vector<SceneMesh>& meshes = document.scene.meshes;
  const auto mesh =
      std::find_if(meshes.begin(), meshes.end(), [](const SceneMesh& one) { return one.name == kName; });
  if (!form_of_model(document) || mesh == meshes.end() || mesh->file.empty()) {
    return Error{
        ErrorCode::kUnsupported, kName,
        "only a model that was opened by itself takes another form; a scene says what its objects are"};
  }
  const auto folder = std::filesystem::path(document.scene.path).parent_path();
  const auto model = import_model((folder / mesh->file).string(), mesh->import);
  if (!model) return model.error();
  const Extent extent = extent_of(model.value());
  const std::size_t points = model.value().mesh.positions.size();
  if (form == ModelForm::kCloth && points > kMostClothPoints) return too_many_points(points);
  SceneDocument turned = document;
  SceneObjects& objects = turned.scene.objects;
  drop_model(objects.bodies);
  drop_model(objects.solids);
  drop_model(objects.cloths);
  if (form == ModelForm::kJelly) {
    objects.solids.push_back(solid_of(extent, length(turned.scene.world.gravity)));
  } else if (form == ModelForm::kCloth) {
    objects.cloths.push_back(cloth_of(extent, points));
  } else {
    objects.bodies.push_back(body_of(extent, form == ModelForm::kRigid));
  }
  turned.text = write_scene(turned.scene);
  return turned;
}

}  // namespace hooke::app
