#include "hooke/scene_path.h"

namespace hooke::app {

const SceneObjects& objects_of(const Scene& scene, const std::string& path, std::size_t& row) {
  const auto number_after = [&](std::size_t bracket) {
    std::size_t value = 0;
    for (std::size_t i = bracket + 1; i < path.size() && path[i] >= '0' && path[i] <= '9'; ++i) {
      value = 10 * value + static_cast<std::size_t>(path[i] - '0');
    }
    return value;
  };
  const std::size_t last = path.rfind('[');
  row = last == std::string::npos ? 0 : number_after(last);
  if (path.rfind("timeline[", 0) != 0) return scene.objects;
  const std::size_t event = number_after(path.find('['));
  return event < scene.timeline.size() ? scene.timeline[event].add : scene.objects;
}

}  // namespace hooke::app
