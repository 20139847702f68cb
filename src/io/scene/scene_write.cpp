#include "hooke/scene_io.h"

#include "base/float_environment.h"
#include "io/scene/scene_table.h"
#include "process/new_file.h"

namespace hooke {

std::string write_scene(const Scene& scene) {
  const base::FloatEnvironment environment;
  return io::to_text(io::write_object(io::kind_of<Scene>(), &scene));
}

Result<void> save_scene(const Scene& scene, const std::string& path) {
  return process::write_file(path, write_scene(scene));
}

}  // namespace hooke
