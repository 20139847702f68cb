#include "hooke/view/scene_list.h"

#include "hooke/scene_io.h"
#include "hooke/session/model_scene.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <utility>

namespace hooke::app {

namespace {

namespace fs = std::filesystem;

/// Groups in the order in which they are shown.
constexpr std::array kTitles = {"The paper",   "Everything together", "Cloth",  "Ropes, springs and hair",
                                "Soft solids", "Mechanisms",          "Bodies", "Models"};

bool is_scene(const fs::path& path) {
  return path.extension() == ".json" && path.filename() != "schema.json";
}

/// The folder of which a file's scenes are a part: that of the file, or "scenes" above a subfolder of it such
/// as scenes/paper.
fs::path root_of(const std::string& file) {
  std::error_code failed;
  const fs::path folder = fs::absolute(fs::path(file), failed).parent_path();
  const fs::path above = folder.parent_path();
  return above.filename() == "scenes" ? above : folder;
}

/// The subject of a scene: what kinds of objects it has.
const char* title_of(const Scene& scene, bool is_of_paper) {
  if (is_of_paper) return "The paper";
  const SceneObjects& all = scene.objects;
  const bool has_cloth = !all.cloths.empty();
  const bool has_rope = !all.ropes.empty() || !all.particles.empty();
  const bool has_solid = !all.solids.empty();
  if (static_cast<int>(has_cloth) + static_cast<int>(has_rope) + static_cast<int>(has_solid) > 1)
    return "Everything together";
  if (has_cloth) return "Cloth";
  if (has_solid) return "Soft solids";
  if (has_rope) return "Ropes, springs and hair";
  return all.hooks.empty() ? "Bodies" : "Mechanisms";
}

/// The small picture that the gallery has of a scene: docs/gallery/paper_fig2.jpg for scenes/paper/fig2.json.
std::string picture_of(const fs::path& root, const fs::path& file) {
  std::string name = file.lexically_relative(root).replace_extension("").generic_string();
  std::replace(name.begin(), name.end(), '/', '_');
  const fs::path picture = root.parent_path() / "docs" / "gallery" / (name + ".jpg");
  std::error_code failed;
  return fs::exists(picture, failed) ? picture.string() : std::string();
}

std::vector<fs::path> files_of(const fs::path& root) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (fs::recursive_directory_iterator i(root, fs::directory_options::skip_permission_denied, failed);
       !failed && i != fs::recursive_directory_iterator(); i.increment(failed)) {
    if (i.depth() >= 1) i.disable_recursion_pending();
    const bool is_listed = is_scene(i->path()) || is_model_file(i->path().string());
    if (is_listed && i->is_regular_file(failed)) files.push_back(i->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

SceneList::SceneList(std::string file) : thread_([this, file = std::move(file)] { read(file); }) {}

SceneList::~SceneList() {
  ends_ = true;
  thread_.join();
}

std::shared_ptr<const std::vector<SceneGroup>> SceneList::groups() const {
  const std::lock_guard lock(mutex_);
  return groups_;
}

void SceneList::read(const std::string& file) {
  std::map<std::string, std::vector<ListedScene>> found;
  const fs::path root = root_of(file);
  for (const fs::path& path : files_of(root)) {
    if (ends_) return;
    const std::string name = path.filename().string();
    if (is_model_file(name)) {
      found["Models"].push_back({path.string(), name, "A model on a ground."});
      continue;
    }
    // Those with mistakes are not listed: opening one by name tells them.
    const Loaded<Scene> scene = load_scene(path.string());
    if (!scene) continue;
    const char* title =
        title_of(*scene.value, path.parent_path().filename() == "paper" || name == "fig1.json");
    found[title].push_back({path.string(), scene.value->title.empty() ? name : scene.value->title,
                            scene.value->description, picture_of(root, path)});
  }
  auto groups = std::make_shared<std::vector<SceneGroup>>();
  for (const char* title : kTitles) {
    if (found.contains(title)) groups->push_back({title, std::move(found[title])});
  }
  const std::lock_guard lock(mutex_);
  groups_ = std::move(groups);
}

}  // namespace hooke::app
