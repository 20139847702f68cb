#include "hooke/session/scene_document.h"

#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace hooke::app {

namespace {

Loaded<SceneDocument> parse_document(std::string file, const std::string& name, std::string text) {
  Loaded<Scene> scene = parse_scene(text, name);
  Loaded<SceneDocument> document = {.errors = std::move(scene.errors), .warnings = std::move(scene.warnings)};
  if (scene)
    document.value = {.file = std::move(file), .text = std::move(text), .scene = *std::move(scene.value)};
  return document;
}

}  // namespace

Loaded<SceneDocument> read_document(const std::string& file) {
  std::ostringstream text;
  const std::ifstream stream(file, std::ios::binary);
  if (!stream || !(text << stream.rdbuf()))
    return {.errors = {{ErrorCode::kFileNotReadable, file, "cannot be read, or is empty"}}};
  return parse_document(file, file, std::move(text).str());
}

Loaded<SceneDocument> edit_document(const SceneDocument& document, const std::string& path,
                                    const std::string& value) {
  Result<std::string> text = edit_scene_text(document.text, path, value);
  if (!text) return {.errors = {text.error()}};
  return parse_document(document.file, document.scene.path, std::move(text).value());
}

bool can_change_live(const Scene& from, const Scene& to) {
  Scene changed = from;
  changed.world.gravity = to.world.gravity;
  changed.world.wind = to.world.wind;
  changed.world.workers = to.world.workers;
  return changed == to;
}

std::optional<FileWatch::Stamp> FileWatch::stamp() const {
  std::error_code failed;
  Stamp stamp;
  stamp.time = std::filesystem::last_write_time(file_, failed);
  if (failed) return {};
  stamp.size = std::filesystem::file_size(file_, failed);
  if (failed) return {};
  return stamp;
}

void FileWatch::watch(const std::string& file) {
  file_ = file;
  seen_ = file.empty() ? std::nullopt : stamp();
}

bool FileWatch::was_saved() {
  if (file_.empty()) return false;
  const std::optional<Stamp> now = stamp();
  if (!now || now == seen_) return false;
  seen_ = now;
  return true;
}

}  // namespace hooke::app
