#include "hooke/scene_path.h"

namespace hooke::app {

namespace {

std::size_t number_after(const std::string& path, std::size_t bracket) {
  std::size_t value = 0;
  for (std::size_t i = bracket + 1; i < path.size() && path[i] >= '0' && path[i] <= '9'; ++i) {
    value = 10 * value + static_cast<std::size_t>(path[i] - '0');
  }
  return value;
}

std::size_t last_number(const std::string& path) {
  const std::size_t last = path.rfind('[');
  return last == std::string::npos ? 0 : number_after(path, last);
}

}  // namespace

const SceneObjects& objects_of(const Scene& scene, const std::string& path, std::size_t& row) {
  row = last_number(path);
  if (path.rfind("timeline[", 0) != 0) return scene.objects;
  const std::size_t event = number_after(path, path.find('['));
  return event < scene.timeline.size() ? scene.timeline[event].add : scene.objects;
}

const SceneObjects& objects_of(const Simulation& simulation, const std::string& path, std::size_t& row) {
  if (path.rfind("added[", 0) != 0) return objects_of(simulation.scene(), path, row);
  row = last_number(path);
  const std::size_t call = number_after(path, path.find('['));
  return call < simulation.added().size() ? *simulation.added()[call] : simulation.scene().objects;
}

}  // namespace hooke::app
