/// Changes of a running simulation from outside: objects that come and go, and states that are put back.

#include "hooke/scene_io.h"

#include "base/float_environment.h"
#include "io/scene/scene_check.h"
#include "io/scene/scene_data.h"
#include "io/scene/scene_source.h"

#include <algorithm>

namespace hooke {

namespace io {

Result<void> remove_objects(SimulationData& data, const std::string& name) {
  const auto named = [&](const SceneObject& object) {
    if (!object.name.starts_with(name)) return false;
    const std::optional<CopyName> copy = take_copy_name(object.name);
    return object.name == name || (copy && copy->array == name);
  };
  std::vector<std::string> names = {};
  std::vector<BodyId> bodies = {};
  for (const SceneObject& object : data.objects) {
    if (!named(object)) continue;
    names.push_back(object.name);
    // Ids of other kinds are null, and their removal does nothing.
    bodies.push_back(object.body);
    data.world.remove(object.rope);
    data.world.remove(object.cloth);
    data.world.remove(object.solid);
    data.world.remove(object.particles);
    data.world.remove(object.field);
    data.world.remove(object.hook);
  }
  data.world.remove(bodies);
  std::sort(names.begin(), names.end());
  const auto gone = [&](const std::string& held) {
    return std::binary_search(names.begin(), names.end(), held);
  };
  const std::size_t removed = std::erase_if(data.objects, [&](const SceneObject& object) {
    // The hooks of an object are removed with it.
    return named(object) || gone(object.hooked[0]) || gone(object.hooked[1]);
  });
  if (removed == 0) {
    return Error{ErrorCode::kStaleId, "", "there is no object " + in_quotes(name) + " any more"};
  }
  index_objects(data);
  std::erase_if(data.forces,
                [&](const ActiveForce& force) { return data.timeline[force.event].object == name; });
  return {};
}

}  // namespace io

namespace {

/// Calls visit(name, path) with the name of each object, which may be empty.
template <class Visit>
void visit_names(const SceneObjects& objects, const std::string& prefix, Visit&& visit) {
  const auto visit_list = [&](const auto& list, const std::string& what, const auto& name_of) {
    for (std::size_t i = 0; i < list.size(); ++i) visit(name_of(list[i]), io::indexed(prefix + what, i));
  };
  const auto tagged = [](const auto& object) { return object.tag.name; };
  const auto named = [](const auto& object) { return object.name; };
  visit_list(objects.bodies, "bodies", tagged);
  visit_list(objects.ropes, "ropes", tagged);
  visit_list(objects.cloths, "cloths", tagged);
  visit_list(objects.solids, "solids", tagged);
  visit_list(objects.particles, "particles", tagged);
  visit_list(objects.fields, "fields", named);
  visit_list(objects.hooks, "hooks", named);
  visit_list(objects.seams, "seams", named);
}

}  // namespace

std::vector<Error> Simulation::add(const SceneObjects& objects) {
  const base::FloatEnvironment environment;
  std::vector<Error> errors;
  const std::string prefix = io::indexed("added", data_->added.size()) + ".";
  visit_names(objects, prefix, [&](const std::string& name, const std::string& path) {
    if (name.empty() || !data_->row_of.contains(name)) return;
    errors.push_back(
        {ErrorCode::kOutOfRange, path + ".name", "there is an object " + io::in_quotes(name) + " already"});
  });
  if (!errors.empty()) return errors;
  data_->added.push_back(std::make_shared<const SceneObjects>(objects));
  io::build_objects(objects, prefix, *data_, errors);
  return errors;
}

std::span<const std::shared_ptr<const SceneObjects>> Simulation::added() const {
  return data_->added;
}

Result<void> Simulation::remove(const std::string& name) {
  const base::FloatEnvironment environment;
  return io::remove_objects(*data_, name);
}

SimulationSnapshot Simulation::snapshot() const {
  const SimulationData& data = *data_;
  if (!data.saved_objects) {
    data.saved_objects = std::make_shared<const std::vector<SceneObject>>(data.objects);
  }
  return SimulationSnapshot(
      std::make_shared<const SimulationState>(SimulationState{.world = data.world.snapshot(),
                                                              .step_count = data.world.step_count(),
                                                              .objects = data.saved_objects,
                                                              .models = data.models,
                                                              .added = data.added,
                                                              .points = data.points,
                                                              .next_event = data.next_event,
                                                              .forces = data.forces,
                                                              .contacts = data.contacts,
                                                              .verdicts = data.verdicts,
                                                              .errors = data.errors}));
}

Result<void> Simulation::restore(const SimulationSnapshot& snapshot) {
  if (!snapshot.state_) return Error{ErrorCode::kOutOfRange, "snapshot", "is empty"};
  const SimulationState& state = *snapshot.state_;
  SimulationData& data = *data_;
  if (auto restored = data.world.restore(state.world); !restored) return restored;
  data.objects = *state.objects;
  io::index_objects(data);
  data.saved_objects = state.objects;
  data.models = state.models;
  data.added = state.added;
  data.points = state.points;
  data.next_event = state.next_event;
  data.forces = state.forces;
  data.contacts = state.contacts;
  data.verdicts = state.verdicts;
  data.errors = state.errors;
  return {};
}

std::size_t SimulationSnapshot::bytes() const {
  if (!state_) return 0;
  return sizeof(SimulationState) + state_->world.bytes() + state_->models.size() * sizeof(SceneModel) +
         state_->verdicts.size() * sizeof(SceneVerdict);
}

std::uint64_t SimulationSnapshot::step_count() const {
  return state_ ? state_->step_count : 0;
}

}  // namespace hooke
