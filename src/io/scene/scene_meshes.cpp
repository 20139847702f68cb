/// Reads the meshes of a scene, and makes closed surfaces of those by which something moves or is filled.

#include "hooke/geometry.h"

#include "geometry/triangle_mesh.h"
#include "io/scene/scene_check.h"
#include "io/scene/scene_data.h"
#include "io/scene/scene_source.h"

#include <algorithm>
#include <cstdio>

namespace hooke::io {

namespace {

Result<Model> read_model(const Scene& scene, const SceneMesh& mesh) {
  if (mesh.file.empty()) return model_of(mesh.mesh);
  const Result<std::string> file = locate_file(scene.path, mesh.file);
  if (!file) return file.error();
  return import_model(file.value(), mesh.import);
}

/// Returns the connection points of a mesh, all as positions, because an object made of it has its points in
/// another order. Indices are those of vertices as they stand in the scene, or as the model was read.
Result<std::vector<ConnectionPointDesc>> places_of(const SceneMesh& mesh, const MeshDesc& model) {
  const MeshDesc& read = mesh.file.empty() ? mesh.mesh : model;
  std::vector<ConnectionPointDesc> places = mesh.connection_points;
  for (ConnectionPointDesc& place : places) {
    if (!place.point) continue;
    if (*place.point >= read.positions.size()) {
      return Error{ErrorCode::kOutOfRange, "mesh.connection_points." + place.name,
                   std::to_string(*place.point) + " is out of range, must be 0 to " +
                       std::to_string(read.positions.size() - 1)};
    }
    place.position = vector_cast<double>(read.positions[*place.point]);
    place.point.reset();
  }
  return places;
}

const SceneMesh* find_mesh(const Scene& scene, const std::string& name) {
  const auto named = [&](const SceneMesh& mesh) { return mesh.name == name; };
  const auto found = std::find_if(scene.meshes.begin(), scene.meshes.end(), named);
  return found == scene.meshes.end() ? nullptr : &*found;
}

/// A closed surface, and what it took to make it; empty for a mesh that is one already.
struct Closing {
  MeshDesc mesh;
  std::string text;
};

std::string remesh_text(const SolidRemesh& remesh) {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "closed for physics by voxels of %.3g m: its surface moved by %.3g m on average and %.3g m at "
      "most, and lies up to %.3g m from the given one over holes; the eye sees the given one",
      static_cast<double>(remesh.voxel), static_cast<double>(remesh.moved_mean),
      static_cast<double>(remesh.moved_max), static_cast<double>(remesh.bridged));
  return text;
}

/// Mends a mesh, or makes it anew of voxels if it cannot be mended or the scene says so.
Result<Closing> close(const MeshDesc& mesh, const std::optional<Real>& voxel) {
  std::string reason;
  if (!voxel) {
    if (geometry::validate_solid(mesh)) return Closing{.mesh = mesh, .text = {}};
    Result<SolidRepair> repair = repair_solid(mesh);
    if (repair) {
      const std::size_t dropped = repair.value().degenerate.size() + repair.value().duplicate.size();
      return Closing{.mesh = std::move(repair.value().mesh),
                     .text = "mended for physics: " + std::to_string(dropped) + " triangles left out, " +
                             std::to_string(repair.value().turned.size()) + " turned"};
    }
    reason = "is no solid (" + repair.error().message + "), ";
  }
  Result<SolidRemesh> remesh = remesh_solid(mesh, voxel.value_or(default_voxel(mesh)));
  if (!remesh) return Error{remesh.error().code, voxel ? ".voxel_size" : "", remesh.error().message};
  return Closing{.mesh = std::move(remesh.value().mesh), .text = reason + remesh_text(remesh.value())};
}

}  // namespace

bool is_made_of_voxels(const Scene& scene, const std::string& name) {
  const SceneMesh* mesh = find_mesh(scene, name);
  return mesh != nullptr && mesh->voxel_size.has_value();
}

Result<MeshId> find_solid_mesh(SimulationData& data, const std::string& name) {
  SceneModel& model = data.models[name];
  if (model.solid) return model.solid;
  const SceneMesh* mesh = find_mesh(data.scene, name);
  if (mesh == nullptr) return Error{ErrorCode::kStaleId, "", "is no mesh of the scene"};
  Result<Closing> closing = close(model.model->mesh, mesh->voxel_size);
  if (!closing) return closing.error();
  const MeshDesc& surface = closing.value().mesh;
  model.volume = geometry::compute_signed_volume(surface.positions, surface.triangles);
  if (closing.value().text.empty()) {
    model.solid = model.id;
  } else {
    const Result<MeshId> added = data.world.add_mesh(surface, mesh->tree);
    if (!added) return Error{added.error().code, "", added.error().message};
    model.solid = added.value();
    std::string text = closing.value().text;
    if (!mesh->voxel_size) text += "; 'voxel_size' asks for this, and no warning is given then";
    (mesh->voxel_size ? data.notes : data.warnings)
        .push_back(error_at(data.scene.source.get(), "meshes." + name, ErrorCode::kOutOfRange, text));
  }
  data.solid_surfaces[name] = std::move(closing.value().mesh);
  return model.solid;
}

void build_meshes(SimulationData& data, std::vector<Error>& errors) {
  for (const SceneMesh& mesh : data.scene.meshes) {
    const std::string path = "meshes." + mesh.name;
    Result<Model> read = read_model(data.scene, mesh);
    if (!read) {
      errors.push_back(
          error_at(data.scene.source.get(), path + ".file", read.error().code, read.error().message));
      continue;
    }
    auto model = std::make_shared<Model>(std::move(read).value());
    for (const std::string& image : model->missing_images) {
      data.warnings.push_back(
          error_at(data.scene.source.get(), path + ".file", ErrorCode::kFileNotReadable,
                   "its image " + in_quotes(image) + " is not beside it, and is left out: put it there"));
    }
    const Result<MeshId> added = data.world.add_mesh(model->mesh, mesh.tree);
    if (!added) {
      errors.push_back(scene_error(data.scene, path, added.error()));
      continue;
    }
    const Result<std::vector<ConnectionPointDesc>> places = places_of(mesh, model->mesh);
    if (!places) {
      errors.push_back(scene_error(data.scene, path, places.error()));
      continue;
    }
    data.models[mesh.name] = {
        .id = added.value(), .model = std::move(model), .connection_points = places.value()};
  }
}

}  // namespace hooke::io
