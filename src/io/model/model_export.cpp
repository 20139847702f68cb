#include "hooke/model_io.h"

#include "base/float_environment.h"
#include "io/folder_file.h"
#include "io/model/model_flat.h"
#include "io/model/model_write.h"
#include "process/new_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <system_error>

namespace hooke {

namespace io {

std::string image_name(const ModelMaterial& material) {
  const auto separator = material.texture.find_last_of("/\\");
  const std::string name = material.texture.substr(separator == std::string::npos ? 0 : separator + 1);
  return is_bare_file_name(name) ? name : std::string();
}

std::vector<std::string> plain_material_names(const Model& model, std::size_t size) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  const auto lower = [](std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  for (const ModelMaterial& material : model.materials) {
    std::string base = material.name.empty() ? "material" : material.name;
    for (char& c : base) c = c > ' ' && c < 0x7F && c != '#' ? c : '_';
    std::string name = base.substr(0, size);
    for (std::size_t number = 2; !taken.insert(lower(name)).second; ++number) {
      std::string ending = ".";
      ending += std::to_string(number);
      name = base.substr(0, size - ending.size()) + ending;
    }
    names.push_back(name);
  }
  return names;
}

float srgb_of_linear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

bool has_uvs(const Model& model) {
  return std::any_of(model.vertices.begin(), model.vertices.end(),
                     [](const ModelVertex& vertex) { return vertex.uv != std::array<float, 2>{}; });
}

}  // namespace io

namespace {

namespace fs = std::filesystem;

/// Returns the bytes of a file of at most 64 MiB; null if there is none.
ImageBytes read_image_file(const fs::path& path) {
  std::error_code code;
  const auto size = fs::file_size(path, code);
  if (code || !fs::is_regular_file(path, code) || size == 0 || size > io::kMaxImageSize) return nullptr;
  std::vector<std::byte> bytes(size);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) return nullptr;
  return std::make_shared<const std::vector<std::byte>>(std::move(bytes));
}

/// Writes an image into a folder, under another name if there is another file of that name. Returns the name.
Result<std::string> put_image(const fs::path& folder, const std::string& name, const ImageBytes& bytes) {
  const fs::path wanted(name);
  for (int number = 2; number < 1000; ++number) {
    const std::string tried =
        number == 2 ? name
                    : wanted.stem().string() + "-" + std::to_string(number - 1) + wanted.extension().string();
    std::error_code code;
    if (fs::exists(folder / tried, code)) {
      const ImageBytes there = read_image_file(folder / tried);
      if (there == nullptr || *there != *bytes) continue;
      return tried;
    }
    if (auto written = process::write_file((folder / tried).string(), *bytes); !written)
      return written.error();
    return tried;
  }
  return Error{ErrorCode::kFileNotWritable, (folder / name).string(), "too many files of this name"};
}

/// Returns the model with its images read, and written beside the file at `path` where the file cannot hold
/// them.
Result<Model> with_images(Model model, const std::string& path, bool can_hold) {
  for (ModelMaterial& material : model.materials) {
    const std::string name = io::image_name(material);
    if (name.empty()) continue;
    if (!material.image) material.image = read_image_file(material.texture);
    if (!material.image || (can_hold && io::is_gltf_image(*material.image))) continue;
    Result<std::string> put = put_image(fs::path(path).parent_path(), name, material.image);
    if (!put) return put.error();
    material.texture = put.value();
  }
  return model;
}

Result<void> export_checked(const Model& given, const std::string& path) {
  if (path.empty() || path.find('\0') != std::string::npos) {
    return Error{ErrorCode::kFileNotWritable, path, "not a file name"};
  }
  if (const auto sound = io::check_model(given); !sound) {
    return Error{sound.error().code, path, "the model cannot be written: " + sound.error().message};
  }
  const std::filesystem::path file(path);
  const std::string ending = io::lower_ending(file);
  if (ending == ".stl") return process::write_file(path, io::write_stl(given));
  if (ending != ".glb" && ending != ".3ds" && ending != ".obj")
    return Error{ErrorCode::kOutOfRange, path, "not one of .obj .stl .glb .3ds"};
  const Result<Model> made = with_images(given, path, ending == ".glb");
  if (!made) return made.error();
  const Model& model = made.value();
  if (ending == ".glb") return process::write_file(path, io::write_glb(model));
  if (ending == ".3ds") return process::write_file(path, io::write_3ds(model));
  std::filesystem::path library = file;
  library.replace_extension(".mtl");
  const io::ObjText text = io::write_obj(model, library.filename().string());
  // The materials are written first, so that an .obj file always finds its .mtl file.
  if (auto written = process::write_file(library.string(), text.mtl); !written) return written;
  return process::write_file(path, text.obj);
}

}  // namespace

Result<void> export_model(const Model& model, const std::string& path) {
  const base::FloatEnvironment environment;
  try {
    return export_checked(model, path);
  } catch (const std::exception&) {
    return Error{ErrorCode::kLimitExceeded, path, "not enough memory to write this model"};
  }
}

}  // namespace hooke
