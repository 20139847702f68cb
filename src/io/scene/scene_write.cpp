#include "hooke/scene_io.h"

#include "base/float_environment.h"
#include "io/scene/material_library.h"
#include "io/scene/scene_table.h"
#include "process/new_file.h"

#include <string_view>

namespace hooke {

namespace {

using io::JsonNode;
using io::Kind;

/// Adds to an object the keys that only `completed` has, with their defaults. What has none is left out.
void state_defaults(const Kind& kind, JsonNode& object, const JsonNode& completed) {
  for (const JsonNode& child : completed.children) {
    if (object.find(child.key) != nullptr) continue;
    for (const io::Field& field : kind.fields) {
      if (field.key != child.key || field.write == nullptr) continue;
      JsonNode value = field.write(kind.defaults());
      if (value.kind != JsonNode::Kind::kNull) object.add(child.key, std::move(value));
    }
  }
}

/// The same for the elements of a list, or for the values of an object of which each has a name.
void state_defaults_in(const Kind& kind, JsonNode& tree, const JsonNode& completed, std::string_view key) {
  JsonNode* list = tree.find(key);
  if (list == nullptr) return;
  const JsonNode& complete = *completed.find(key);
  for (std::size_t i = 0; i < list->children.size(); ++i) {
    JsonNode& object = list->children[i];
    state_defaults(kind, object, complete.children[i]);
    if (JsonNode* shape = object.find("shape"); shape != nullptr)
      state_defaults_in(io::kind_of<ScenePart>(), *shape, *complete.children[i].find("shape"), "parts");
  }
}

void state_defaults_of_objects(JsonNode& objects, const JsonNode& completed) {
  state_defaults_in(io::kind_of<SceneBody>(), objects, completed, "bodies");
  state_defaults_in(io::kind_of<SceneRope>(), objects, completed, "ropes");
  state_defaults_in(io::kind_of<SceneCloth>(), objects, completed, "cloths");
  state_defaults_in(io::kind_of<SceneSolid>(), objects, completed, "solids");
}

/// Says what a reader would otherwise take from the library of materials: a silk of 0.2 kg/m^2, the default
/// of cloths, is not as light as the library's.
void state_what_differs_from_the_library(JsonNode& scene) {
  JsonNode completed = scene;
  io::take_from_library(completed);
  state_defaults_in(io::kind_of<SceneMaterial>(), scene, completed, "materials");
  state_defaults_of_objects(scene, completed);
  JsonNode* timeline = scene.find("timeline");
  if (timeline == nullptr) return;
  for (std::size_t i = 0; i < timeline->children.size(); ++i) {
    JsonNode* added = timeline->children[i].find("add");
    if (added == nullptr) continue;
    state_defaults_of_objects(*added, *completed.find("timeline")->children[i].find("add"));
  }
}

}  // namespace

std::string write_scene(const Scene& scene) {
  const base::FloatEnvironment environment;
  JsonNode tree = io::write_object(io::kind_of<Scene>(), &scene);
  state_what_differs_from_the_library(tree);
  return io::to_text(tree);
}

Result<void> save_scene(const Scene& scene, const std::string& path) {
  return process::write_file(path, write_scene(scene));
}

}  // namespace hooke
