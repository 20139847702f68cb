#pragma once

#include "hooke/scene_io.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

/// \file
/// The file of a session: its text, which is edited and saved, and when it was changed by others.

namespace hooke::app {

/// A scene and the text that says it. It does not change: an edit makes another one.
struct SceneDocument {
  std::string file = {};  ///< The file that it was read from: a scene or a model.
  std::string text = {};
  Scene scene = {};
};

using SharedDocument = std::shared_ptr<const SceneDocument>;

/// How a session gets scenes. Both run on the session's thread.
struct Loader {
  /// Reads a file.
  std::function<Loaded<SceneDocument>(const std::string& file)> read;
  /// Makes the simulation, and calls `progress` with what is done.
  std::function<Loaded<Simulation>(const Scene& scene,
                                   const std::function<void(const std::string&)>& progress)>
      build;
};

/// Reads a scene file.
Loaded<SceneDocument> read_document(const std::string& file);

/// Returns the document with a value changed: `value` is JSON, `path` is as "ropes[0].total_mass". Errors:
/// those of edit_scene_text and of parse_scene.
Loaded<SceneDocument> edit_document(const SceneDocument& document, const std::string& path,
                                    const std::string& value);

/// Whether a world made from the one scene can take over the other while it runs: they differ in gravity,
/// wind and workers alone.
bool can_change_live(const Scene& from, const Scene& to);

/// What tells that a file was saved: its time and its size.
class FileWatch {
 public:
  /// Watches a file from now on; an empty name watches nothing.
  void watch(const std::string& file);
  /// Whether the file was saved since it was watched, or since the last call that said so. A file that is
  /// missing for a moment, as while an editor writes it, was not saved.
  bool was_saved();

 private:
  struct Stamp {
    std::filesystem::file_time_type time = {};
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
  };
  [[nodiscard]] std::optional<Stamp> stamp() const;

  std::string file_;
  std::optional<Stamp> seen_;
};

}  // namespace hooke::app
