#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace hooke::app {

/// A scene or model that a user may open.
struct ListedScene {
  std::string file = {};
  std::string title = {};
  std::string description = {};
  std::string picture = {};  ///< File of a small picture; empty for none.
};

/// Scenes of one subject.
struct SceneGroup {
  std::string title = {};
  std::vector<ListedScene> scenes = {};
};

/// Lists the scenes of a folder, and the scenes and models of its subfolders, by groups; those of the paper
/// come first. It reads them on a thread of its own, because a hundred take longer than a picture.
class SceneList {
 public:
  /// Starts to read the folder of a scene; of a scene in a subfolder of a folder "scenes", that folder.
  explicit SceneList(std::string file);
  /// Stops reading.
  ~SceneList();
  SceneList(const SceneList&) = delete;
  SceneList& operator=(const SceneList&) = delete;

  /// What was found; null while it reads.
  [[nodiscard]] std::shared_ptr<const std::vector<SceneGroup>> groups() const;

 private:
  void read(const std::string& file);

  mutable std::mutex mutex_;
  std::shared_ptr<const std::vector<SceneGroup>> groups_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;  ///< Comes last: it uses all of the above.
};

}  // namespace hooke::app
