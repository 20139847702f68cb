#pragma once

#include "hooke/scene_io.h"

#include "io/json/json_document.h"

namespace hooke::io {

/// Checks what only the whole scene can tell: names that refer to nothing or to two things, points that do
/// not exist, too many points, files outside of the scene's folder. With `files_must_exist` the files must
/// also be there. `ignored` gets keys without effect: points of objects that have none, and what hooks of
/// points do not use.
void check_scene(const Scene& scene, const JsonDocument& document, bool files_must_exist,
                 std::vector<JsonError>& errors, std::vector<JsonError>& ignored);

/// A CopyName is a name such as "ball[3]", split into an array and the number of a copy; nothing for other
/// names.
struct CopyName {
  std::string array = {};
  std::size_t copy = 0;
};
[[nodiscard]] std::optional<CopyName> take_copy_name(const std::string& name);

/// Returns the name of the hooks between the cells of a fractured body, before their numbers.
[[nodiscard]] std::string glue_name(const std::string& body);

/// An EndName is a name such as "crane.tip", split into an object and one of its connection points. Names
/// have no dots, but the path that stands for an object without a name may, as in "timeline[0].add.ropes[0]".
struct EndName {
  std::string object = {};
  std::string connection_point = {};  ///< Empty for none.
};
[[nodiscard]] EndName take_end_name(const std::string& name);

/// Returns the number of points of one instance. It is 0 for the cloth or solid of a mesh, where it is known
/// only after the mesh is read.
[[nodiscard]] std::size_t point_count(const SceneRope& rope);
[[nodiscard]] std::size_t point_count(const SceneCloth& cloth);
[[nodiscard]] std::size_t point_count(const SceneSolid& solid);
[[nodiscard]] std::size_t point_count(const SceneParticles& particles);

/// Returns the path of a file named in a scene, relative to the folder of the scene, or an Error if the file
/// is outside of that folder.
[[nodiscard]] Result<std::string> locate_file(const std::string& scene_path, const std::string& file);

}  // namespace hooke::io
