#include "hooke/scene_io.h"

#include "base/float_environment.h"
#include "io/scene/parts_cache.h"
#include "io/scene/scene_check.h"
#include "io/scene/scene_data.h"
#include "io/scene/scene_source.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace hooke {

namespace {

void evaluate_due(SimulationData& data) {
  for (std::size_t i = 0; i < data.scene.expect.size(); ++i) {
    if (io::due_step(data.scene, data.scene.expect[i]) != data.world.step_count()) continue;
    data.verdicts.push_back(io::measure_expectation(data, i));
  }
}

void record(SimulationData& data, std::size_t event, const Result<void>& done) {
  if (done || data.errors.size() >= io::kMostErrors) return;
  data.errors.push_back(io::scene_error(data.scene, io::indexed("timeline", event), done.error()));
}

Result<void> act_on_body(World& world, BodyId body, const SceneEvent& event) {
  using EventKind = SceneEvent::Kind;
  switch (event.kind) {
    case EventKind::kMotion:
      return world.set_motion(body, event.motion);
    case EventKind::kImpulse:
      return event.at ? world.apply_impulse(body, event.vector, *event.at)
                      : world.apply_impulse(body, event.vector);
    case EventKind::kVelocity: {
      Result<void> done;
      if (event.velocity) done = world.set_velocity(body, *event.velocity);
      if (done && event.angular_velocity) done = world.set_angular_velocity(body, *event.angular_velocity);
      return done;
    }
    default:
      return event.at ? world.apply_force(body, event.vector, *event.at)
                      : world.apply_force(body, event.vector);
  }
}

Result<void> act_on_hook(World& world, HookId hook, const SceneEvent& event) {
  switch (event.kind) {
    case SceneEvent::Kind::kMotor:
      return world.set_motor(hook, event.motor);
    case SceneEvent::Kind::kSpring:
      return world.set_spring(hook, event.spring);
    default:
      return world.set_steering(hook, event.angle);
  }
}

Result<void> act_on_object(SimulationData& data, const SceneEvent& event) {
  const auto found = data.row_of.find(event.object);
  if (found == data.row_of.end()) {
    return Error{ErrorCode::kStaleId, "",
                 "there is no object " + io::in_quotes(event.object) + " at this step"};
  }
  const SceneObject& object = data.objects[found->second];
  if (object.kind == SceneObject::Kind::kBody) return act_on_body(data.world, object.body, event);
  if (object.kind == SceneObject::Kind::kHook) return act_on_hook(data.world, object.hook, event);
  const PointRef point = io::point_of(data.world, object, event.point.value_or(ScenePoint{}));
  switch (event.kind) {
    case SceneEvent::Kind::kMotion:
      return data.world.pin(point, event.motion);
    case SceneEvent::Kind::kUnpin:
      return data.world.unpin(point);
    case SceneEvent::Kind::kImpulse:
      return data.world.apply_impulse(point, event.vector);
    case SceneEvent::Kind::kVelocity:
      return data.world.set_velocity(point, event.velocity.value_or(Vec3{}));
    default:
      return data.world.apply_force(point, event.vector);
  }
}

Result<void> apply_event(SimulationData& data, std::size_t index) {
  const SceneEvent& event = data.timeline[index];
  switch (event.kind) {
    case SceneEvent::Kind::kNone:
      return {};
    case SceneEvent::Kind::kAdd:
      io::build_objects(event.add, io::indexed("timeline", index) + ".add.", data, data.errors);
      return {};
    case SceneEvent::Kind::kRemove:
      return io::remove_objects(data, event.object);
    case SceneEvent::Kind::kForce:
      data.forces.push_back({.event = index, .steps_left = event.steps});
      return {};
    case SceneEvent::Kind::kWind:
      return data.world.set_wind(event.wind);
    case SceneEvent::Kind::kGravity:
      return data.world.set_gravity(event.vector);
    default:
      return act_on_object(data, event);
  }
}

void apply_due_events(SimulationData& data) {
  const std::uint64_t step = data.world.step_count();
  for (; data.next_event < data.events.size(); ++data.next_event) {
    const std::size_t event = data.events[data.next_event];
    if (data.timeline[event].at_step > step) break;
    record(data, event, apply_event(data, event));
  }
  for (ActiveForce& force : data.forces) {
    record(data, force.event, act_on_object(data, data.timeline[force.event]));
    --force.steps_left;
  }
  std::erase_if(data.forces, [](const ActiveForce& force) { return force.steps_left == 0; });
}

/// Checks what a reader would have refused, because a scene may also be made or changed in code.
std::vector<Error> check(const Scene& scene) {
  const io::JsonDocument nothing;
  std::vector<io::JsonError> found;
  std::vector<io::JsonError> ignored;  // These were reported when the file was read.
  io::check_scene(scene, scene.source ? scene.source->document : nothing, false, found, ignored);
  std::vector<Error> errors;
  errors.reserve(found.size());
  for (io::JsonError& one : found) {
    errors.push_back(
        io::error_at(scene.source.get(), one.error.where, one.error.code, std::move(one.error.message)));
  }
  return errors;
}

/// Transforms positions and directions of an event to the world. Objects that it adds are placed when they
/// are built.
void place(SceneEvent& event, const Placement& at) {
  if (event.at) event.at = at.point(*event.at);
  event.motion = placed(event.motion, at);
  event.vector = at.direction(event.vector);
  if (event.velocity) event.velocity = at.direction(*event.velocity);
  if (event.angular_velocity) event.angular_velocity = at.direction(*event.angular_velocity);
  event.wind = placed(event.wind, at);
}

std::vector<SceneEvent> placed_timeline(const Scene& scene, const Placement& at) {
  std::vector<SceneEvent> timeline = scene.timeline;
  if (at == Placement{}) return timeline;
  for (SceneEvent& event : timeline) place(event, at);
  return timeline;
}

Loaded<std::unique_ptr<SimulationData>> build(Scene scene, const Placement& placement) {
  std::vector<Error> errors = check(scene);
  if (!errors.empty()) return {.errors = std::move(errors)};
  Result<World> world = World::create(placed(io::world_of(scene), placement));
  if (!world) return {.errors = {io::scene_error(scene, "world", world.error())}};
  auto data = std::make_unique<SimulationData>(
      SimulationData{.scene = std::move(scene), .world = std::move(world).value(), .placement = placement});
  for (std::size_t i = 0; i < data->scene.materials.size(); ++i) {
    data->material_of[data->scene.materials[i].name] = i;
  }
  io::build_meshes(*data, errors);
  if (errors.empty()) io::build_objects(data->scene.objects, "", *data, errors);
  if (!errors.empty()) return {.errors = std::move(errors)};
  data->timeline = placed_timeline(data->scene, placement);
  data->events.resize(data->timeline.size());
  std::iota(data->events.begin(), data->events.end(), std::size_t{0});
  std::stable_sort(data->events.begin(), data->events.end(), [&](std::size_t a, std::size_t b) {
    return data->timeline[a].at_step < data->timeline[b].at_step;
  });
  evaluate_due(*data);
  Loaded<std::unique_ptr<SimulationData>> loaded = {.warnings = std::move(data->warnings),
                                                    .notes = std::move(data->notes)};
  loaded.value = std::move(data);
  return loaded;
}

/// Notes how an object broke first. Null if it is none of the scene's, or had broken before.
SceneObject* note_first_break(SimulationData& data, std::vector<SceneObject>::iterator object,
                              const BreakEvent& how) {
  if (object == data.objects.end() || object->broken) return nullptr;
  data.saved_objects = nullptr;
  object->broken = true;
  object->broke = how;
  return &*object;
}

/// Notes the first break of each rope that snapped, and the first tear of each cloth and solid.
void note_snaps_and_tears(SimulationData& data) {
  const auto find = [&](auto is_it) { return std::find_if(data.objects.begin(), data.objects.end(), is_it); };
  for (const RopeBreakEvent& event : data.world.events().rope_breaks) {
    const auto rope = find([&](const SceneObject& one) { return one.rope == event.rope; });
    note_first_break(data, rope, {.force = event.force, .time = event.time});
  }
  for (const ClothTearEvent& event : data.world.events().tears) {
    const auto cloth = find([&](const SceneObject& one) { return one.cloth == event.cloth; });
    if (SceneObject* torn = note_first_break(data, cloth, {.time = event.time})) torn->tore_at = event.strain;
  }
  for (const SolidTearEvent& event : data.world.events().solid_tears) {
    const auto solid = find([&](const SceneObject& one) { return one.solid == event.solid; });
    if (SceneObject* torn = note_first_break(data, solid, {.time = event.time})) torn->tore_at = event.stress;
  }
}

/// Notes the first blow of each body that yielded, and its last freeze.
void note_yields(SimulationData& data) {
  const auto note = [&](BodyId body, auto&& change) {
    const auto object = std::find_if(data.objects.begin(), data.objects.end(),
                                     [&](const SceneObject& one) { return one.body == body; });
    if (object == data.objects.end()) return;
    data.saved_objects = nullptr;
    change(*object);
  };
  for (const YieldEvent& event : data.world.events().yields) {
    note(event.body, [&](SceneObject& object) {
      if (object.yielded++ == 0) object.blow = event;
    });
  }
  for (const FreezeEvent& event : data.world.events().freezes)
    note(event.body, [&](SceneObject& object) { object.froze = event; });
}

/// Ends of the edge of a blade in the world [m].
std::array<DVec3, 2> edge_of(const World& world, const SceneObject& blade) {
  const Pose pose = world.pose(blade.body);
  const auto at = [&](const Vec3& end) {
    return pose.position + vector_cast<double>(rotate(pose.rotation, end));
  };
  return {at(blade.blade->edge[0]), at(blade.blade->edge[1])};
}

/// Ends of the edges of all blades, in the order of objects.
std::vector<std::array<DVec3, 2>> list_edges(const SimulationData& data) {
  std::vector<std::array<DVec3, 2>> edges;
  for (const SceneObject& object : data.objects) {
    if (object.blade) edges.push_back(edge_of(data.world, object));
  }
  return edges;
}

/// Whether a blade cuts an object: one that it names, or a copy of an array that it names.
bool is_to_cut(const SceneBlade& blade, const SceneObject& object) {
  if (blade.cuts.empty()) return true;
  return std::any_of(blade.cuts.begin(), blade.cuts.end(), [&](const std::string& name) {
    return object.name == name || object.name.starts_with(name + "[");
  });
}

/// What a blade cuts, without where it moves.
CutDesc targets_of(const SimulationData& data, const SceneObject& blade) {
  CutDesc desc;
  for (const SceneObject& object : data.objects) {
    if (blade.blade->cuts.empty()) break;
    if (!is_to_cut(*blade.blade, object) || positions_of(data.world, object).empty()) continue;
    if (object.rope) desc.ropes.push_back(object.rope);
    if (object.cloth) desc.cloths.push_back(object.cloth);
    if (object.solid) desc.solids.push_back(object.solid);
  }
  return desc;
}

/// Notes which objects a blade has cut that had neither broken nor been cut before.
void note_cuts(SimulationData& data, const std::string& blade, const CutResult& cut) {
  const auto note = [&](auto is_it) {
    const auto object = std::find_if(data.objects.begin(), data.objects.end(), is_it);
    if (SceneObject* first = note_first_break(data, object, {.time = data.world.time()}))
      first->cut_by = blade;
  };
  for (const RopeCut& one : cut.ropes)
    note([&](const SceneObject& object) { return object.rope == one.rope; });
  for (const ClothCut& one : cut.cloths)
    note([&](const SceneObject& object) { return object.cloth == one.cloth; });
  for (const SolidCut& one : cut.solids)
    note([&](const SceneObject& object) { return object.solid == one.solid; });
}

/// Lets all blades cut what they have swept since their edges were at `before`.
void cut_by_blades(const std::vector<std::array<DVec3, 2>>& before, SimulationData& data) {
  std::size_t i = 0;
  for (std::size_t row = 0; row < data.objects.size() && i < before.size(); ++row) {
    if (!data.objects[row].blade) continue;
    CutDesc desc = targets_of(data, data.objects[row]);
    desc.from = before[i++];
    desc.to = edge_of(data.world, data.objects[row]);
    const bool names_none = desc.ropes.empty() && desc.cloths.empty() && desc.solids.empty();
    if (names_none && !data.objects[row].blade->cuts.empty()) continue;  // What it names is gone.
    const Result<CutResult> cut = data.world.cut(desc);
    if (cut) note_cuts(data, std::string(data.objects[row].name), cut.value());
  }
}

void note_broken_hooks(SimulationData& data) {
  const std::vector<BreakEvent>& breaks = data.world.events().breaks;
  if (breaks.empty()) return;
  for (SceneObject& object : data.objects) {
    const auto event = std::find_if(breaks.begin(), breaks.end(),
                                    [&](const BreakEvent& one) { return one.hook == object.hook; });
    if (event == breaks.end()) continue;
    data.saved_objects = nullptr;
    object.broken = true;
    object.broke = *event;
  }
}

std::string verdict_line(const Scene& scene, const SceneVerdict& verdict) {
  const std::string path = io::indexed("expect", verdict.index);
  const Error error = io::error_at(scene.source.get(), path, ErrorCode::kOutOfRange, verdict.text);
  return (verdict.passed ? "pass " : "FAIL ") + to_line(error) + "\n";
}

}  // namespace

Simulation::Simulation(std::unique_ptr<SimulationData> data) : data_(std::move(data)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Loaded<Simulation> Simulation::create(Scene scene, const Placement& placement, const LoadOptions& options) {
  const base::FloatEnvironment environment;
  io::PartsCache cache(options);
  const geometry::PartsListening listening(&cache);
  try {
    Loaded<std::unique_ptr<SimulationData>> built = build(std::move(scene), placement);
    Loaded<Simulation> loaded = {.errors = std::move(built.errors),
                                 .warnings = std::move(built.warnings),
                                 .notes = std::move(built.notes)};
    if (built) loaded.value = Simulation(std::move(*built.value));
    return loaded;
  } catch (const std::bad_alloc&) {
    return {.errors = {{ErrorCode::kLimitExceeded, "", "not enough memory for this scene"}}};
  }
}

StepReport Simulation::step() {
  const base::FloatEnvironment environment;
  apply_due_events(*data_);
  const std::vector<std::array<DVec3, 2>> edges = list_edges(*data_);
  const StepReport report = data_->world.step(data_->scene.dt);
  note_broken_hooks(*data_);
  note_snaps_and_tears(*data_);
  note_yields(*data_);
  if (report.moved && !edges.empty()) cut_by_blades(edges, *data_);
  data_->contacts = report.contacts;
  if (report.moved) evaluate_due(*data_);
  return report;
}

StepReport Simulation::run() {
  const base::FloatEnvironment environment;
  StepReport report;
  while (data_->world.step_count() < data_->scene.step_count()) {
    report = step();
    if (!report.moved) break;
  }
  return report;
}

World& Simulation::world() {
  return data_->world;
}
const World& Simulation::world() const {
  return data_->world;
}
const Scene& Simulation::scene() const {
  return data_->scene;
}
std::span<const SceneObject> Simulation::objects() const {
  return data_->objects;
}

const SceneObject* Simulation::find(std::string_view name) const {
  const auto found = data_->row_of.find(std::string(name));
  return found == data_->row_of.end() ? nullptr : &data_->objects[found->second];
}

SceneVerdict Simulation::check(std::size_t expectation) const {
  const base::FloatEnvironment environment;
  if (expectation >= data_->scene.expect.size()) return {.index = expectation};
  return io::measure_expectation(*data_, expectation);
}

std::span<const SceneVerdict> Simulation::verdicts() const {
  return data_->verdicts;
}
std::span<const Error> Simulation::errors() const {
  return data_->errors;
}

bool Simulation::passed() const {
  const bool all_due = data_->verdicts.size() == data_->scene.expect.size();
  const bool all_good = std::all_of(data_->verdicts.begin(), data_->verdicts.end(),
                                    [](const SceneVerdict& verdict) { return verdict.passed; });
  return all_due && all_good && data_->errors.empty();
}

std::string Simulation::report() const {
  std::string text;
  for (const Error& error : data_->errors) text += "FAIL " + to_line(error) + "\n";
  for (const SceneVerdict& verdict : data_->verdicts) text += verdict_line(data_->scene, verdict);
  const std::size_t open = data_->scene.expect.size() - data_->verdicts.size();
  if (open > 0) text += std::to_string(open) + " expectations are not due yet\n";
  return text;
}

}  // namespace hooke
