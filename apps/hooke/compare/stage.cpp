#include "hooke/compare/stage.h"

#include "hooke/command_line.h"
#include "hooke/text_of.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <utility>

namespace hooke::app {

namespace {

constexpr double kGone = 1e6;  // Distance beyond which a point counts as gone [m].

/// This is a text such as "rope:15", split at its last colon, since names may hold colons themselves.
struct PointWords {
  std::string object;
  std::string index = "last";
};

PointWords cut(const std::string& text, const Simulation& simulation) {
  if (simulation.find(text) != nullptr) return {.object = text};
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return {.object = text};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// Returns what can be watched of an object at the start: its points, or the center of mass of a body that
/// forces move.
std::vector<DVec3> points_of(const World& world, const SceneObject& object) {
  if (object.kind == SceneObject::Kind::kBody) {
    if (!(world.mass(object.body) > 0)) return {};
    return {world.center_of_mass(object.body)};
  }
  const PointView points = positions_of(world, object);
  std::vector<DVec3> list;
  for (std::size_t i = 0; i < points.size(); ++i) list.push_back(points[i]);
  return list;
}

const SceneObject* find_object(const Simulation& simulation, const std::string& name) {
  if (!name.empty()) return simulation.find(name);
  const SceneObject* second = nullptr;  // A body or a solid, used where nothing else has points.
  for (const SceneObject& object : simulation.objects()) {
    if (points_of(simulation.world(), object).empty()) continue;
    const bool first = object.kind != SceneObject::Kind::kBody && object.kind != SceneObject::Kind::kSolid;
    if (first) return &object;
    if (second == nullptr) second = &object;
  }
  return second;
}

Result<Player> make_solver_player(const Stage& stage, double dt) {
  Loaded<Simulation> built = Simulation::create(stage.scene(), {}, load_options());
  if (!built) return built.errors.front();
  const auto simulation = std::make_shared<Simulation>(std::move(*built.value));
  const SceneObject object = *simulation->find(stage.object.name);  // Ids belong to one world.
  const WorldDesc& desc = stage.scene().world;
  const double evaluations_per_step = static_cast<double>(desc.substeps) * desc.particle_substeps;
  return Player{
      .advance = [simulation, dt]() -> Result<void> {
        const StepReport report = simulation->world().step(static_cast<Real>(dt));
        if (report.healthy()) return {};
        return Error{ErrorCode::kOutOfRange, kSolverName, "the state is not finite any more"};
      },
      .position = [simulation, object,
                   point = stage.point] { return points_of(simulation->world(), object)[point]; },
      .points = [simulation, object] { return points_of(simulation->world(), object); },
      .energy = [simulation] { return simulation->world().measure().energy; },
      .evaluations =
          [simulation, evaluations_per_step] {
            return evaluations_per_step * static_cast<double>(simulation->world().step_count());
          },
      .collisions = [] { return lab::CollisionReport(); },
  };
}

/// Returns a text such as "rk4 at 0.00104 s for 'rope', reached 2e-05 m".
std::string chosen_text(const lab::Run& run, const Stage& stage) {
  std::string text;
  for (const lab::ObjectReport& report : run.report()) {
    std::string name;
    for (const SceneObject& object : stage.start.objects()) {
      if (is_of(report, object)) name = object.name;
    }
    text += (text.empty() ? "" : "; ") + report.stepper + text_of(" at %.3g s for '", report.dt) + name + "'";
    if (report.error) text += text_of(", estimated error %.2g m", *report.error);
  }
  return text;
}

}  // namespace

Result<Stage> make_stage(Scene scene, const std::string& point) {
  scene.timeline.clear();
  scene.expect.clear();
  const std::string path = scene.path;
  Loaded<Simulation> built = Simulation::create(std::move(scene), {}, load_options());
  if (!built) return built.errors.front();
  const PointWords words = cut(point, *built.value);
  const SceneObject* object = find_object(*built.value, words.object);
  const std::size_t count = object == nullptr ? 0 : points_of(built.value->world(), *object).size();
  if (count == 0) {
    return Error{ErrorCode::kOutOfRange, words.object.empty() ? path : "--point",
                 words.object.empty() ? "the scene has no points to compare"
                                      : "there is no object '" + words.object + "' that has points"};
  }
  std::size_t index = count - 1;
  const char* end = words.index.data() + words.index.size();
  const bool number = words.index != "last";
  if (number && std::from_chars(words.index.data(), end, index).ptr != end) index = count;
  if (index >= count || words.index.empty()) {
    return Error{ErrorCode::kOutOfRange, "--point",
                 "'" + words.index + "' is no point of '" + object->name + "', which has points 0 to " +
                     std::to_string(count - 1)};
  }
  const SceneObject watched = *object;
  std::vector<DVec3> points = points_of(built.value->world(), watched);
  return Stage{std::move(*built.value), watched, std::move(points), static_cast<std::uint32_t>(index),
               watched.name + ":" + std::to_string(index)};
}

Error refusal(const std::string& scene, const Error& reason) {
  return {ErrorCode::kOutOfRange, scene, reason.message};
}

Result<void> check_stepper(const std::string& name) {
  if (name == kSolverName) return {};
  const auto found = lab::find_stepper(name);
  if (found && found.value().available) return {};
  if (found) return Error{ErrorCode::kUnsupported, "stepper", "'" + name + "' needs a build with SUNDIALS"};
  std::string names = kSolverName;
  for (const lab::StepperInfo& info : lab::steppers()) names += ", " + std::string(info.name);
  return Error{ErrorCode::kOutOfRange, "stepper", "there is no '" + name + "'; there are " + names};
}

Result<Player> make_player(const Stage& stage, const std::string& name, double dt, bool force) {
  if (name == kSolverName) return make_solver_player(stage, dt);
  auto created = make_stage_run(stage, name, dt, force);
  if (!created) return created.error();
  const auto run = std::make_shared<lab::Run>(std::move(created).value());
  // Solids stand still in the laboratory, and have no points there.
  const auto points = [run, object = stage.object, still = stage.points] {
    std::vector<DVec3> list = positions_of(*run, object);
    return list.empty() ? still : list;
  };
  Player player = {
      .advance = [run] { return run->advance(); },
      .position = [points, point = stage.point] { return points()[point]; },
      .points = points,
      .energy = [run] { return run->energy(); },
      .evaluations = [run] { return static_cast<double>(run->evaluations()); },
      .collisions = [run] { return run->collisions(); },
  };
  if (name == kDeclaredName) player.note = chosen_text(*run, stage);
  return player;
}

Result<lab::Run> make_stage_run(const Stage& stage, const std::string& name, double dt, bool force) {
  lab::Options options = {.dt = dt, .force = force, .rigid_stretch = kRigidStretch, .solids_stand = true};
  if (stage.scene().laboratory) options.collisions = stage.scene().laboratory->collisions;
  if (name == kDeclaredName && stage.scene().accuracy) {
    options.accuracy = {.max_error = stage.scene().accuracy->max_error, .seconds = stage.scene().seconds};
  } else {
    options.stepper = name;
  }
  return lab::Run::create(stage.start.world(), options);
}

Result<lab::Run> make_run(const Simulation& simulation, const std::string& stepper, double seconds,
                          bool force) {
  const Scene& scene = simulation.scene();
  lab::Options options = {.dt = static_cast<double>(scene.dt), .force = force};
  if (scene.laboratory) options.collisions = scene.laboratory->collisions;
  if (stepper == kDeclaredName && !scene.accuracy) {
    if (!scene.laboratory) {
      return Error{ErrorCode::kOutOfRange, "--stepper",
                   "'declared' needs 'accuracy' or 'laboratory' in the scene"};
    }
    options.stepper = scene.laboratory->stepper;
  } else if (stepper == kDeclaredName) {
    options.accuracy = {.max_error = scene.accuracy->max_error, .seconds = seconds};
  } else {
    options.stepper = stepper;
  }
  for (const SceneObject& object : simulation.objects()) {
    if (!object.stepper.empty()) options.object_steppers.push_back({reference_of(object), object.stepper});
  }
  const auto known = stepper == kDeclaredName || stepper == "auto" ? Result<void>() : check_stepper(stepper);
  if (!known) return known.error();
  auto run = lab::Run::create(simulation.world(), options);
  if (!run) return refusal(scene.path, run.error());
  return run;
}

static std::vector<DVec3> velocities_of(const lab::Run& run, const SceneObject& object) {
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return run.velocities(object.rope);
    case SceneObject::Kind::kCloth:
      return run.velocities(object.cloth);
    default:
      return run.velocities(object.particles);
  }
}

/// Bodies that stand have no state in the run, and stay.
static Result<void> show_body(const lab::Run& run, const SceneObject& object, World& world) {
  const auto state = run.body(object.body);
  if (!state) return {};
  const lab::BodyState& now = state.value();
  if (!(length(now.center) < kGone)) return Error{ErrorCode::kOutOfRange, object.name, "is gone"};
  const Pose before = world.pose(object.body);
  const Vec3 lever = vector_cast<Real>(world.center_of_mass(object.body) - before.position);
  const DVec3 own = vector_cast<double>(rotate(conjugate(before.rotation), lever));
  const auto real = [](double value) { return static_cast<Real>(value); };
  const auto& q = now.rotation;
  const Pose pose = {now.center - rotate(q, own), {real(q.x), real(q.y), real(q.z), real(q.w)}};
  if (auto moved = world.set_pose(object.body, pose); !moved) return moved;
  if (auto moved = world.set_velocity(object.body, vector_cast<Real>(now.velocity)); !moved) return moved;
  return world.set_angular_velocity(object.body, vector_cast<Real>(now.angular_velocity));
}

Result<void> show_run(const lab::Run& run, Simulation& simulation) {
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind == SceneObject::Kind::kBody) {
      auto moved = show_body(run, object, simulation.world());
      if (!moved) return moved;
      continue;
    }
    const std::vector<DVec3> points = positions_of(run, object);
    const std::vector<DVec3> velocities = velocities_of(run, object);
    PointRef reference = reference_of(object);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(length(points[i]) < kGone)) return Error{ErrorCode::kOutOfRange, object.name, "is gone"};
      reference.index = static_cast<std::uint32_t>(i);
      auto moved = simulation.world().set_position(reference, points[i]);
      if (!moved) return moved;
      moved = simulation.world().set_velocity(reference, vector_cast<Real>(velocities[i]));
      if (!moved) return moved;
    }
  }
  return {};
}

std::vector<DVec3> positions_of(const lab::Run& run, const SceneObject& object) {
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return run.positions(object.rope);
    case SceneObject::Kind::kCloth:
      return run.positions(object.cloth);
    case SceneObject::Kind::kBody: {
      const auto state = run.body(object.body);
      return state ? std::vector<DVec3>{state.value().center} : std::vector<DVec3>();
    }
    default:
      return run.positions(object.particles);
  }
}

bool is_of(const lab::ObjectReport& report, const SceneObject& object) {
  if (report.kind == PointRef::Kind::kNone)
    return object.kind == SceneObject::Kind::kBody && object.body.slot == report.slot;
  const PointRef reference = reference_of(object);
  return reference.kind == report.kind && reference.slot == report.slot;
}

PointRef reference_of(const SceneObject& object) {
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return point(object.rope, 0);
    case SceneObject::Kind::kCloth:
      return point(object.cloth, 0);
    case SceneObject::Kind::kParticles:
      return point(object.particles, 0);
    case SceneObject::Kind::kSolid:
      return point(object.solid, 0);
    default:
      return {};
  }
}

}  // namespace hooke::app
