#include "hooke/scene_io.h"

#include "base/float_environment.h"
#include "io/folder_file.h"
#include "io/scene/material_library.h"
#include "io/scene/scene_check.h"
#include "io/scene/scene_ignored.h"
#include "io/scene/scene_source.h"
#include "io/scene/scene_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace hooke {

namespace io {

std::string indexed(std::string_view list, std::size_t index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

Error error_at(const SceneSource* source, const std::string& path, ErrorCode code, std::string reason) {
  if (source == nullptr) return {code, path, std::move(reason)};
  const JsonDocument& document = source->document;
  const std::string place = document.place(document.find_closest(path).offset);
  return {code, path.empty() ? place : place + ": " + path, std::move(reason)};
}

namespace {

/// Returns the errors in the order of the file, with their places.
std::vector<Error> finish(const JsonDocument& document, std::vector<JsonError> found) {
  std::stable_sort(found.begin(), found.end(),
                   [](const JsonError& a, const JsonError& b) { return a.offset < b.offset; });
  if (found.size() > kMostErrors) found.resize(kMostErrors);
  std::vector<Error> errors;
  errors.reserve(found.size());
  for (JsonError& one : found) {
    const std::string place = document.place(one.offset);
    std::string& where = one.error.where;
    // Keys come from the user; an error must stay one readable line whatever they are.
    constexpr std::size_t kLongestPath = 300;
    if (where.size() > kLongestPath) where.resize(kLongestPath);
    for (char& c : where) c = static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
    if (!where.empty()) where.insert(0, ": ");
    where.insert(0, place);
    errors.push_back(std::move(one.error));
  }
  return errors;
}

/// A file of a newer version is not read at all, because its content may have another meaning.
bool check_version(const JsonDocument& document, std::vector<JsonError>& errors) {
  const JsonNode* version = document.root.find("version");
  if (version == nullptr || version->kind != JsonNode::Kind::kNumber || version->number <= kSceneVersion) {
    return true;
  }
  errors.push_back({version->offset,
                    {ErrorCode::kUnsupported, "version",
                     document.number_text(*version) + " is newer than this program, which reads version " +
                         std::to_string(kSceneVersion)}});
  return false;
}

/// Returns warnings about parts of the scene that have no effect.
std::vector<Error> warnings_of(const Scene& scene, const JsonDocument& document,
                               std::vector<JsonError> ignored) {
  for (JsonError& one : find_ignored_keys(scene, document)) ignored.push_back(std::move(one));
  for (std::size_t i = 0; i < scene.timeline.size() && ignored.size() < kMostErrors; ++i) {
    if (scene.timeline[i].at_step < scene.step_count()) continue;
    const std::string path = indexed("timeline", i) + ".at_step";
    ignored.push_back({document.find_closest(path).offset,
                       {ErrorCode::kOutOfRange, path,
                        "never happens: the scene ends at step " + std::to_string(scene.step_count())}});
  }
  return finish(document, std::move(ignored));
}

Loaded<Scene> read_scene(std::string text, std::string name, bool files_must_exist) {
  auto source = std::make_shared<SceneSource>();
  JsonDocument& document = source->document;
  std::vector<JsonError> errors = parse_json(std::move(text), name, document);
  // After repeated keys the tree is complete; after all other errors it is not.
  const bool parsed = std::all_of(errors.begin(), errors.end(), [](const JsonError& one) {
    return one.error.code == ErrorCode::kUnknownKey;
  });
  std::vector<JsonError> ignored;
  Scene scene;
  scene.path = std::move(name);
  if (parsed && check_version(document, errors)) {
    take_from_library(document.root);
    Reader reader(document, errors);
    read_object(reader, document.root, kind_of<Scene>(), &scene);
    check_scene(scene, document, files_must_exist, errors, ignored);
  }
  if (!errors.empty()) return {.errors = finish(document, std::move(errors))};
  std::vector<Error> warnings = warnings_of(scene, document, std::move(ignored));
  scene.source = std::move(source);
  return {.value = std::move(scene), .warnings = std::move(warnings)};
}

Loaded<Scene> unreadable(const std::string& path, ErrorCode code, std::string reason) {
  return {.errors = {{code, path, std::move(reason)}}};
}

}  // namespace

}  // namespace io

std::uint32_t Scene::step_count() const {
  const double steps = dt > Real(0) ? std::round(seconds / static_cast<double>(dt)) : 0.0;
  return static_cast<std::uint32_t>(std::clamp(steps, 0.0, 4e9));
}

bool operator==(const Scene& a, const Scene& b) {
  return io::same_object(io::kind_of<Scene>(), &a, &b);
}

std::string to_line(const Error& error) {
  return error.where.empty() ? error.message : error.where + ": " + error.message;
}

Loaded<Scene> parse_scene(std::string text, std::string name) {
  const base::FloatEnvironment environment;
  return io::read_scene(std::move(text), std::move(name), false);
}

Loaded<Scene> load_scene(const std::string& path) {
  const base::FloatEnvironment environment;
  std::error_code failure;
  const std::filesystem::path file(path);
  for (const char* const model : {".3ds", ".obj", ".stl", ".ply", ".gltf", ".glb"}) {
    if (io::lower_ending(file) == model) {
      return io::unreadable(path, ErrorCode::kUnsupported,
                            "is a model, no scene: `hooke view` shows it, and a scene names it in `meshes`");
    }
  }
  // Devices and pipes may never end.
  if (!std::filesystem::is_regular_file(file, failure)) {
    const bool there = std::filesystem::exists(file, failure);
    return io::unreadable(path, ErrorCode::kFileNotReadable, there ? "is not a file" : "no such file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (failure) return io::unreadable(path, ErrorCode::kFileNotReadable, failure.message());
  if (size > io::kLargestJson) {
    return io::unreadable(path, ErrorCode::kLimitExceeded, "the file is larger than 64 MiB");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream) return io::unreadable(path, ErrorCode::kFileNotReadable, "cannot be read");
  return io::read_scene(std::move(text), path, true);
}

}  // namespace hooke
