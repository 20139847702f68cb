#include "hooke/model_io.h"

#include "base/float_environment.h"
#include "io/folder_file.h"
#include "io/model/model_child.h"
#include "io/model/model_flat.h"
#include "io/model/model_geometry.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace hooke {

namespace {

namespace fs = std::filesystem;

constexpr int kMaxFolderEntries = 100000;  // A larger folder is not searched to its end.

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Tells whether `folder` itself holds a regular file of this name.
bool has_file(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const auto real = io::resolve_in_folder(folder, name);
  return real && fs::is_regular_file(*real, error);
}

/// Returns the file of this name in `folder`, without regard to case; empty if there is none.
std::string find_image(const fs::path& folder, const std::string& name) {
  if (has_file(folder, name)) return (folder / name).string();
  std::error_code error;
  int seen = 0;
  std::string best;  // The smallest name is taken, so that the folder's order does not matter.
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end;
       !error && entry != end && seen < kMaxFolderEntries; entry.increment(error), ++seen) {
    const std::string candidate = entry->path().filename().string();
    if (lower(candidate) != lower(name) || !has_file(folder, candidate)) continue;
    if (best.empty() || candidate < best) best = candidate;
  }
  return best.empty() ? std::string() : (folder / best).string();
}

/// Looks for the files that materials name. What is not there is left out, and named.
void find_textures(Model& model, const fs::path& path) {
  const std::string ending = io::lower_ending(path);
  const auto find = [&](std::string& file, const ImageBytes& bytes) {
    if (file.empty() || bytes) return;
    std::string found = find_image(path.parent_path(), file);
    std::vector<std::string>& missing = model.missing_images;
    if (found.empty() && std::find(missing.begin(), missing.end(), file) == missing.end())
      missing.push_back(file);
    file = std::move(found);
  };
  for (ModelMaterial& material : model.materials) {
    find(material.normal_map.file, material.normal_map.bytes);
    find(material.roughness_map.file, material.roughness_map.bytes);
    if (material.texture.empty() || material.image) continue;
    find(material.texture, material.image);
    // glTF multiplies image and color; in the older formats the image replaces the color.
    const bool replaces_color = ending != ".gltf" && ending != ".glb";
    if (!material.texture.empty() && replaces_color) material.color = {1.0f, 1.0f, 1.0f};
  }
}

Result<void> check_options(const ImportOptions& options) {
  const auto is_size = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (!options.fit && !is_size(options.scale)) {
    return Error{ErrorCode::kOutOfRange, "scale", "the scale must be positive and finite"};
  }
  if (options.fit && !is_size(*options.fit)) {
    return Error{ErrorCode::kOutOfRange, "fit", "the size to fit must be positive and finite"};
  }
  if (options.origin > ModelOrigin::kBottom) {
    return Error{ErrorCode::kOutOfRange, "origin", "not one of file, center, bottom"};
  }
  if (options.up > UpAxis::kZ) return Error{ErrorCode::kOutOfRange, "up", "not one of format, x, y, z"};
  return {};
}

Result<Model> import_checked(const std::string& path, const ImportOptions& options) {
  if (path.empty() || path.find('\0') != std::string::npos) {
    return Error{ErrorCode::kFileNotReadable, path, "not a file name"};
  }
  if (auto sound = check_options(options); !sound) {
    return Error{sound.error().code, path, sound.error().where + ": " + sound.error().message};
  }
  auto bytes = io::run_importer(path, options);
  if (!bytes) return bytes.error();
  auto model = io::read_flat_model(bytes.value());
  if (!model) {
    return Error{model.error().code, path, "the importer gave an unusable model: " + model.error().message};
  }
  bytes.value().clear();
  bytes.value().shrink_to_fit();
  find_textures(model.value(), path);
  io::weld_model(model.value());
  if (model.value().mesh.triangles.empty()) {
    return Error{ErrorCode::kOutOfRange, path, "no triangle that is more than a point or a line"};
  }
  return model;
}

}  // namespace

Result<Model> import_model(const std::string& path, const ImportOptions& options) {
  const base::FloatEnvironment environment;
  try {
    return import_checked(path, options);
  } catch (const std::exception&) {  // Memory has run out, or the path is one that no folder can have.
    return Error{ErrorCode::kLimitExceeded, path, "not enough memory for this model"};
  }
}

Model model_of(const MeshDesc& mesh, double crease) {
  const base::FloatEnvironment environment;
  io::Soup soup;
  soup.materials.push_back({.name = "gray"});
  std::vector<std::uint8_t> is_usable;
  for (const Vec3 p : mesh.positions) {
    is_usable.push_back(is_finite(p) ? 1 : 0);
    soup.positions.push_back(is_finite(p) ? vector_cast<double>(p) : DVec3{});
  }
  soup.normals.resize(soup.positions.size());
  soup.uvs.resize(soup.positions.size());
  for (const auto& triangle : mesh.triangles) {
    const bool usable = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t i) {
      return i < is_usable.size() && is_usable[i] != 0;
    });
    if (usable) soup.triangles.push_back(triangle);
  }
  soup.material_of.assign(soup.triangles.size(), 0);
  Model model = io::assemble_model(soup, crease);
  io::weld_model(model);
  return model;
}

}  // namespace hooke
