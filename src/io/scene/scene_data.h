#pragma once

#include "hooke/scene_io.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace hooke {

/// A force of the timeline that acts for some more steps.
struct ActiveForce {
  std::size_t event = 0;  ///< In SimulationData::timeline.
  std::uint32_t steps_left = 0;
};

/// A mesh of the scene, read.
struct SceneModel {
  MeshId id = {};
  std::shared_ptr<const Model> model = {};
  std::shared_ptr<const Model> hull = {};  ///< Of its points; made when the first body asks for it.
  std::vector<ConnectionPointDesc> connection_points = {};  ///< All as places.
};

/// What a Simulation owns. Built by scene_build.cpp, stepped by scene_simulation.cpp, measured by
/// scene_measure.cpp.
struct SimulationData {
  Scene scene;
  World world;
  Placement placement = {};                                       ///< Of the scene's frame in the world.
  std::unordered_map<std::string, std::size_t> material_of = {};  ///< From names to Scene::materials.
  std::unordered_map<std::string, SceneModel> models = {};
  std::vector<SceneObject> objects = {};
  std::unordered_map<std::string, std::size_t> row_of = {};  ///< From names to `objects`.
  std::size_t points = 0;                                    ///< Added so far, for kMostScenePoints.
  std::vector<SceneEvent> timeline = {};                     ///< Of the scene, placed in the world.
  std::vector<std::size_t> events = {};                      ///< `timeline` in the order of its steps.
  std::size_t next_event = 0;                                ///< In `events`.
  std::vector<ActiveForce> forces = {};
  std::uint32_t contacts = 0;  ///< Of the last step.
  std::vector<SceneVerdict> verdicts = {};
  std::vector<Error> errors = {};
};

namespace io {

/// The number that a material has in the world's table of pairs: its place in the list plus one.
[[nodiscard]] std::uint16_t material_number(const Scene& scene, const std::string& name);

/// The world as described, with the pairs of materials that are named.
[[nodiscard]] WorldDesc world_of(const Scene& scene);

/// Reads and adds the meshes.
void build_meshes(SimulationData& data, std::vector<Error>& errors);

/// Adds objects of the scene or of an event; `prefix` is "" or "timeline[3].add.". What fails is left out.
void build_objects(const SceneObjects& objects, const std::string& prefix, SimulationData& data,
                   std::vector<Error>& errors);

/// Fills `row_of` from `objects`.
void index_objects(SimulationData& data);

/// The handle of a point; of kind kNone for an object without points.
[[nodiscard]] PointRef point_of(const World& world, const SceneObject& object, ScenePoint point);

/// An error of the world about "rope.masses" as one of the scene about "ropes[0].masses".
[[nodiscard]] Error scene_error(const Scene& scene, const std::string& path, const Error& error);

/// Evaluates an expectation now.
[[nodiscard]] SceneVerdict measure_expectation(const SimulationData& data, std::size_t index);

/// The number of steps after which an expectation is due.
[[nodiscard]] std::uint32_t due_step(const Scene& scene, const SceneExpectation& expectation);

}  // namespace io

}  // namespace hooke
