/// Model files, changed, through the real `hooke-import`: the process that reads them may die, this one gets
/// an Error or a sound model.

#include "hooke/model_io.h"

#include "fuzz/bytes.h"
#include "fuzz/mesh_maker.h"
#include "fuzz/target.h"
#include "io/model/model_flat.h"
#include "temporary_folder.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/wait.h>

namespace hooke::fuzz {

namespace {

using Bytes = std::vector<std::byte>;

Bytes read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

void write_file(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Models of the scenes that are not large.
const std::vector<std::filesystem::path>& model_files() {
  static const std::vector<std::filesystem::path> files = [] {
    std::vector<std::filesystem::path> found;
    for (const char* folder : {"models", "paper/models"}) {
      for (const auto& entry :
           std::filesystem::directory_iterator(std::filesystem::path(setting().scenes) / folder)) {
        const std::string ending = entry.path().extension().string();
        const bool is_model = ending == ".3ds" || ending == ".glb" || ending == ".obj" || ending == ".stl";
        if (is_model && entry.file_size() < 200'000) found.push_back(entry.path());
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }();
  return files;
}

constexpr const char* kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[1,2,1]}],)"
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":44,"uri":)"
    R"("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA="}],)"
    R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],)"
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
    R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})";
constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
    "face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

Bytes bytes_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

/// A model file and how its name ends.
Bytes make_file(Random& random, const std::string& folder, std::string& ending) {
  if (random.chance(0.4)) {
    const std::filesystem::path& file = random.one_of(model_files());
    ending = file.extension().string();
    return read_file(file);
  }
  if (random.chance(0.3)) {
    ending = random.pick<const char*>({".gltf", ".ply"});
    return bytes_of(ending == ".ply" ? kPly : kGltf);
  }
  ending = random.pick<const char*>({".obj", ".glb", ".stl", ".3ds"});
  const std::string path = folder + "/made" + ending;
  if (!export_model(model_of(make_solid(random, 1)), path)) return {};
  return read_file(path);
}

/// What a text format goes wrong on.
void change_text(Random& random, Bytes& bytes) {
  const char* word = random.pick<const char*>({"-1",
                                               "0",
                                               "999999999999",
                                               "4294967295",
                                               "nan",
                                               "inf",
                                               "1e400",
                                               "/",
                                               "f",
                                               "v",
                                               "usemtl x",
                                               "mtllib ../../x",
                                               "\"uri\":\"/etc/passwd\"",
                                               "\n",
                                               "}",
                                               "[[[[[[[[",
                                               "element",
                                               "end_header",
                                               "\\\n",
                                               ",,"});
  const std::size_t at = random.below(bytes.size() + 1);
  const Bytes piece = bytes_of(word);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(), piece.end());
}

}  // namespace

void try_import(Random& random) {
  static const test::TemporaryFolder folder;  // of this process
  ::setenv("HOOKE_IMPORT", setting().importer.c_str(), 1);
  std::string ending;
  Bytes bytes = make_file(random, folder.path().string(), ending);
  const int changes = random.integer(0, 6);
  for (int i = 0; i < changes; ++i) {
    const bool is_text = ending == ".obj" || ending == ".gltf" || ending == ".ply";
    if (is_text && random.chance(0.6)) {
      change_text(random, bytes);
    } else {
      change_bytes(random, bytes);
    }
  }
  const std::string path = folder / ("tried" + ending);
  write_file(path, bytes);
  save_tried(bytes);
  note("import " + ending + " of " + std::to_string(bytes.size()) + " bytes");
  const ImportOptions options = {.up = random.pick<UpAxis>({UpAxis::kFormat, UpAxis::kX, UpAxis::kZ}),
                                 .scale = random.chance(0.9) ? 1.0 : bad_number(random)};
  const Result<Model> model = import_model(path, options);
  expect(::waitpid(-1, nullptr, WNOHANG) < 0, "a process is left behind");
  if (!model) {
    expect(!model.error().message.empty() && model.error().message.find('\n') == std::string::npos,
           "an error of no or several lines");
    return;
  }
  Model drawn = *model;
  for (ModelMaterial& material : drawn.materials) material.texture.clear();  // a path by now
  expect(io::check_model(drawn).has_value(), "an unsound model came in");
  for (const auto& triangle : model->mesh.triangles) {
    for (const std::uint32_t v : triangle) expect(v < model->mesh.positions.size(), "a triangle of nothing");
  }
}

}  // namespace hooke::fuzz
