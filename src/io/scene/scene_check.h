#pragma once

#include "hooke/scene_io.h"

#include "io/json/json_document.h"

namespace hooke::io {

/// What only the whole scene can tell: names that refer to nothing or to two things, points that do not
/// exist, too many points, files outside of the scene's folder. `look_for_files`: they must also be there.
/// `ignored`: points of what has none, and what a hook of points makes no use of.
void check_scene(const Scene& scene, const JsonDocument& document, bool files_must_exist,
                 std::vector<JsonError>& errors, std::vector<JsonError>& ignored);

/// "ball[3]" taken apart: the name of an array and the number of a copy. Nothing for another name.
struct CopyName {
  std::string array = {};
  std::size_t copy = 0;
};
[[nodiscard]] std::optional<CopyName> take_copy_name(const std::string& name);

/// "crane.tip" taken apart: an object and one of its connection points. Names have no dots; the place of an
/// object that has none may, as "timeline[0].add.ropes[0]".
struct EndName {
  std::string object = {};
  std::string connection_point = {};  ///< Empty for none.
};
[[nodiscard]] EndName take_end_name(const std::string& name);

/// Number of points of one instance; 0 for the cloth or solid of a mesh, which is known once the mesh is
/// read.
[[nodiscard]] std::size_t point_count(const SceneRope& rope);
[[nodiscard]] std::size_t point_count(const SceneCloth& cloth);
[[nodiscard]] std::size_t point_count(const SceneSolid& solid);
[[nodiscard]] std::size_t point_count(const SceneParticles& particles);

/// A file named in a scene, from the folder of the scene. An Error if it is outside of that folder.
[[nodiscard]] Result<std::string> locate_file(const std::string& scene_path, const std::string& file);

}  // namespace hooke::io
