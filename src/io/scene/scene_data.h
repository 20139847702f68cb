#pragma once

#include "hooke/scene_io.h"

#include "io/scene/scene_check.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace hooke {

/// An ActiveForce is a force of the timeline that acts for some more steps.
struct ActiveForce {
  std::size_t event = 0;  ///< Index into SimulationData::timeline.
  std::uint32_t steps_left = 0;
};

/// A SceneModel is a mesh of the scene, after it was read.
struct SceneModel {
  MeshId id = {};
  std::shared_ptr<const Model> model = {};
  std::shared_ptr<const Model> hull = {};  ///< Hull of its points; made when the first body asks for it.
  std::vector<ConnectionPointDesc> connection_points = {};  ///< All given as positions.
  /// Closed surface for what moves or is filled: `id`, or the mesh made of it; null until it is asked for.
  MeshId solid = {};
  double volume = 0;  ///< Volume of `solid` [m^3].
};

/// SimulationData is what a Simulation owns. scene_build.cpp builds it, scene_simulation.cpp steps it, and
/// scene_measure.cpp measures it.
struct SimulationData {
  Scene scene;
  World world;
  Placement placement = {};  ///< Placement of the scene's frame in the world.
  std::unordered_map<std::string, std::size_t> material_of = {};  ///< Maps names to Scene::materials.
  std::unordered_map<std::string, SceneModel> models = {};
  /// Surfaces of the solids among `models`, by name.
  std::unordered_map<std::string, MeshDesc> solid_surfaces = {};
  std::vector<SceneObject> objects = {};
  std::unordered_map<std::string, std::size_t> row_of = {};  ///< Maps names to `objects`.
  std::size_t points = 0;                                    ///< Points added so far, for kMostScenePoints.
  std::vector<SceneEvent> timeline = {};                     ///< Timeline of the scene, placed in the world.
  std::vector<std::size_t> events = {};  ///< Indices of `timeline` in the order of its steps.
  std::size_t next_event = 0;            ///< Index into `events`.
  std::vector<ActiveForce> forces = {};
  std::uint32_t contacts = 0;  ///< Contacts of the last step.
  std::vector<SceneVerdict> verdicts = {};
  std::vector<Error> errors = {};
  std::vector<Error> warnings = {};  ///< What was made of meshes unasked.
  std::vector<Error> notes = {};     ///< What was made of meshes as the scene asks.
  std::vector<std::shared_ptr<const SceneObjects>> added = {};  ///< What came by Simulation::add.
  /// Copy of `objects` that snapshots share; null after a change of them.
  mutable std::shared_ptr<const std::vector<SceneObject>> saved_objects = {};
};

/// SimulationState is what a snapshot of a simulation holds.
struct SimulationState {
  Snapshot world;
  std::uint64_t step_count = 0;
  std::shared_ptr<const std::vector<SceneObject>> objects = {};
  /// Ids of meshes that were added to the world after the snapshot are stale in it.
  std::unordered_map<std::string, SceneModel> models = {};
  std::vector<std::shared_ptr<const SceneObjects>> added = {};
  std::size_t points = 0;
  std::size_t next_event = 0;
  std::vector<ActiveForce> forces = {};
  std::uint32_t contacts = 0;
  std::vector<SceneVerdict> verdicts = {};
  std::vector<Error> errors = {};
};

namespace io {

/// Returns the number of a material in the world's table of pairs: its place in the list plus one.
[[nodiscard]] std::uint16_t material_number(const Scene& scene, const std::string& name);

/// Returns the description of the world, with the pairs of materials that have names.
[[nodiscard]] WorldDesc world_of(const Scene& scene);

/// Whether the scene gives a mesh of this name a `voxel_size`.
[[nodiscard]] bool is_made_of_voxels(const Scene& scene, const std::string& name);

/// Returns a mesh of the world that is a solid: the mesh of this name, or what it becomes when it is mended
/// or closed, which is said among the warnings or notes. `where` of an Error is "" or ".voxel_size".
[[nodiscard]] Result<MeshId> find_solid_mesh(SimulationData& data, const std::string& name);

/// Reads and adds the meshes.
void build_meshes(SimulationData& data, std::vector<Error>& errors);

/// Adds objects of the scene or of an event; `prefix` is "" or "timeline[3].add.". Objects that fail are left
/// out.
void build_objects(const SceneObjects& objects, const std::string& prefix, SimulationData& data,
                   std::vector<Error>& errors);

/// Returns the object among those named `end.object[0]`, ... that has the connection point, or, if the end
/// names none, in which a place of the world lies or which is nearest to it; null if there is none.
[[nodiscard]] const SceneObject* find_cell(const SimulationData& data, const EndName& end, DVec3 place);

/// Fills `row_of` from `objects`, which have changed.
void index_objects(SimulationData& data);

/// Removes the object of this name, or all copies of an array.
[[nodiscard]] Result<void> remove_objects(SimulationData& data, const std::string& name);

/// Returns the handle of a point; it is of kind kNone for an object without points.
[[nodiscard]] PointRef point_of(const World& world, const SceneObject& object, ScenePoint point);

/// Turns an error of the world about "rope.masses" into one of the scene about "ropes[0].masses".
[[nodiscard]] Error scene_error(const Scene& scene, const std::string& path, const Error& error);

/// Evaluates an expectation now.
[[nodiscard]] SceneVerdict measure_expectation(const SimulationData& data, std::size_t index);

/// Returns the number of steps after which an expectation is due.
[[nodiscard]] std::uint32_t due_step(const Scene& scene, const SceneExpectation& expectation);

}  // namespace io

}  // namespace hooke
