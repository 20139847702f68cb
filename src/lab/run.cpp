/// Implements the public class: from a World to one part per object, and from their states to points.

#include "base/float_environment.h"
#include "lab/methods/part.h"
#include "lab/rigid/collisions.h"
#include "lab/system/body_laws.h"
#include "math/rotation.h"
#include "world/access.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hooke::lab {

struct Run::Data {
  double dt = 0;
  std::uint64_t outputs = 0;
  double start_time = 0;
  std::vector<Part> parts;   ///< One per object, in order of creation.
  std::vector<Part> bodies;  ///< One per body that moves, by row.
  Collisions collisions;
  state::SlotTable<ParticlesId> particles_slots;
  state::SlotTable<RopeId> rope_slots;
  state::SlotTable<ClothId> cloth_slots;
  state::SlotTable<BodyId> body_slots;
  std::vector<std::uint32_t> body_of_row;  ///< Index into `bodies`; kNone for bodies that stand.
  /// Rotation from a body's frame to its principal axes, by row.
  std::vector<Quaternion<double>> principal_of_frame;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  Result<void> add_bodies(const state::Tables& tables, const Options& options);
  Result<void> advance_bodies(double t);

  template <class Visit>
  void for_each_part(Visit&& visit) const {
    for (const Part& part : parts) visit(part);
    for (const Part& part : bodies) visit(part);
  }
};

namespace {

Result<void> in_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  char text[96];
  std::snprintf(text, sizeof(text), "is %g; must be %g to %g", value, low, high);
  return Error{ErrorCode::kOutOfRange, name, text};
}

Result<void> check_numbers(const Options& options) {
  // The smallest step still changes a time of some hours.
  if (const auto good = in_range("dt", options.dt, 1e-9, 1e6); !good) return good.error();
  const CollisionOptions& collisions = options.collisions;
  if (const auto good = in_range("collisions.epsilon", collisions.epsilon, 1e-12, 1); !good)
    return good.error();
  if (const auto good = in_range("collisions.iteration_limit", collisions.iteration_limit, 1, 1000); !good)
    return good.error();
  if (const auto good = in_range("rigid_stretch", options.rigid_stretch, 0, 0.1); !good) return good.error();
  if (const auto good = in_range("tolerance", options.tolerance, 1e-14, 0.1); !good) return good.error();
  if (!options.accuracy) return {};
  if (const auto good = in_range("accuracy.max_error", options.accuracy->max_error, 1e-12, 1e6); !good)
    return good.error();
  return in_range("accuracy.seconds", options.accuracy->seconds, 1e-9, 1e6);
}

/// Returns the name of the method for an object.
const std::string& stepper_of(const System& system, const Options& options) {
  for (const ObjectStepper& choice : options.object_steppers) {
    if (choice.object.kind == system.kind() && choice.object.slot == system.slot()) return choice.stepper;
  }
  return options.stepper;
}

Result<Part> make_part(Result<System> system, Bodies bodies, double start_time, const Options& options) {
  if (!system) return system.error();
  Part part = {.system = std::move(system).value(), .bodies = std::move(bodies)};
  part.start_time = start_time;
  part.h = options.dt;
  part.y = part.system.initial_state();
  part.work.tolerance = options.tolerance;
  if (options.accuracy) {
    if (const auto reached = reach(*options.accuracy, options, part); !reached) return reached.error();
    return part;
  }
  const std::string& name = stepper_of(part.system, options);
  part.method = name == "auto" ? automatic_method(part.system, part.start_time, part.h) : find_method(name);
  if (part.method == nullptr) return unknown_method(name);
  if (const auto good = check(part, options); !good) return good.error();
  return part;
}

/// Undoes one output step.
void take_back(Part& part, const State& y) {
  part.y = y;
  part.work.reset();
  part.steps -= static_cast<std::uint64_t>(part.steps_per_output);
  --part.outputs;
}

/// Checks every name, also those that no object uses.
Result<void> check_names(const state::Tables& tables, const Options& options) {
  std::vector<std::string_view> names = {options.stepper};
  for (const ObjectStepper& choice : options.object_steppers) {
    names.push_back(choice.stepper);
    const bool found = std::any_of(tables.objects.begin(), tables.objects.end(), [&](const auto& object) {
      return object.kind == choice.object.kind && object.slot == choice.object.slot;
    });
    if (!found)
      return Error{ErrorCode::kStaleId, "object_steppers", "names an object that is not in the world"};
  }
  for (const std::string_view name : names) {
    if (name != "auto" && find_method(name) == nullptr) return unknown_method(name);
  }
  return {};
}

}  // namespace

Run::Run(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Run::~Run() = default;
Run::Run(Run&&) noexcept = default;
Run& Run::operator=(Run&&) noexcept = default;

Result<Run> Run::create(const World& world, const Options& options) {
  const base::FloatEnvironment environment;
  const state::Tables& tables = WorldAccess::tables(world);
  if (const auto good = check_numbers(options); !good) return good.error();
  if (const auto good = check_names(tables, options); !good) return good.error();
  auto data = std::make_unique<Data>();
  data->dt = options.dt;
  data->start_time = tables.time;
  data->particles_slots = tables.particles_slots;
  data->rope_slots = tables.rope_slots;
  data->cloth_slots = tables.cloth_slots;
  for (std::uint32_t object = 0; object < tables.objects.size(); ++object) {
    Bodies near = options.contacts ? bodies_near(tables, tables.objects[object]) : Bodies{};
    auto system = System::create(tables, object, {options.rigid_stretch, options.solids_stand});
    Result<Part> part = make_part(std::move(system), std::move(near), tables.time, options);
    if (!part) return part.error();
    data->parts.push_back(std::move(part).value());
  }
  if (const auto added = data->add_bodies(tables, options); !added) return added.error();
  return Run(std::move(data));
}

Result<void> Run::Data::add_bodies(const state::Tables& tables, const Options& options) {
  body_slots = tables.body_slots;
  body_of_row.assign(tables.bodies.motion.size(), kNone);
  const std::shared_ptr<BodyLaws> laws = BodyLaws::create(tables);
  for (const std::uint32_t row : tables.moving_bodies) {
    Result<Part> part = make_part(System::create_body(tables, row, laws), {}, tables.time, options);
    if (!part) return part.error();
    body_of_row[row] = static_cast<std::uint32_t>(bodies.size());
    bodies.push_back(std::move(part).value());
  }
  Result<Collisions> collider = Collisions::create(tables, options);
  if (!collider) return collider.error();
  collisions = std::move(collider).value();
  for (const state::BodyMass& mass : tables.bodies.mass)
    principal_of_frame.push_back(conjugate(math::in_double(mass.principal)));
  return {};
}

Result<void> Run::advance() {
  const base::FloatEnvironment environment;
  std::vector<State> before;
  for (Part& part : data_->parts) {
    before.push_back(part.y);
    const Result<void> moved = lab::advance(part);
    if (moved) continue;
    for (std::size_t i = 0; i + 1 < before.size(); ++i) take_back(data_->parts[i], before[i]);
    return moved.error();
  }
  if (const auto moved = data_->advance_bodies(time()); !moved) {
    for (std::size_t i = 0; i < before.size(); ++i) take_back(data_->parts[i], before[i]);
    return moved.error();
  }
  ++data_->outputs;
  return {};
}

/// Advances all bodies, or none of them.
Result<void> Run::Data::advance_bodies(double t) {
  const std::vector<Part> before = bodies;
  for (const Part& part : bodies) part.system.show_laws(t, part.y);
  Result<void> moved = collisions.advance(t, dt, bodies);
  for (std::size_t i = 0; i < bodies.size() && moved; ++i) {
    if (!collisions.collides(i)) moved = lab::advance(bodies[i]);
  }
  if (!moved) {
    bodies = before;
    // Copies share the memory of SUNDIALS, so that it must be reset.
    for (Part& part : bodies) part.work.reset();
  }
  return moved;
}

double Run::dt() const {
  return data_->dt;
}

double Run::time() const {
  return data_->start_time + static_cast<double>(data_->outputs) * data_->dt;
}

namespace {

template <class IdType, class Read>
std::vector<DVec3> of_object(const state::SlotTable<IdType>& slots, IdType id, const std::vector<Part>& parts,
                             Read&& read) {
  const std::uint32_t row = slots.find(id);
  if (row == slots.kNone) return {};
  return read(parts[row]);
}

std::vector<DVec3> positions_of(const Part& part) {
  return part.system.positions(part.time(), part.y);
}
std::vector<DVec3> velocities_of(const Part& part) {
  return part.system.velocities(part.time(), part.y);
}

std::vector<DVec3> all(const std::vector<Part>& parts, std::vector<DVec3> (*read)(const Part&)) {
  std::vector<DVec3> result;
  for (const Part& part : parts) {
    const std::vector<DVec3> some = read(part);
    result.insert(result.end(), some.begin(), some.end());
  }
  return result;
}

}  // namespace

std::vector<DVec3> Run::positions(ParticlesId id) const {
  return of_object(data_->particles_slots, id, data_->parts, positions_of);
}
std::vector<DVec3> Run::positions(RopeId id) const {
  return of_object(data_->rope_slots, id, data_->parts, positions_of);
}
std::vector<DVec3> Run::positions(ClothId id) const {
  return of_object(data_->cloth_slots, id, data_->parts, positions_of);
}
std::vector<DVec3> Run::velocities(ParticlesId id) const {
  return of_object(data_->particles_slots, id, data_->parts, velocities_of);
}
std::vector<DVec3> Run::velocities(RopeId id) const {
  return of_object(data_->rope_slots, id, data_->parts, velocities_of);
}
std::vector<DVec3> Run::velocities(ClothId id) const {
  return of_object(data_->cloth_slots, id, data_->parts, velocities_of);
}
std::vector<DVec3> Run::positions() const {
  return all(data_->parts, positions_of);
}
std::vector<DVec3> Run::velocities() const {
  return all(data_->parts, velocities_of);
}

Result<BodyState> Run::body(BodyId id) const {
  const std::uint32_t row = data_->body_slots.find(id);
  if (row == data_->body_slots.kNone || data_->body_of_row[row] == Data::kNone)
    return Error{ErrorCode::kStaleId, "body", "no body that moves has this id"};
  const Part& part = data_->bodies[data_->body_of_row[row]];
  const BodyMotion now = part.system.body(part.time(), part.y);
  return BodyState{now.center, normalize(now.rotation * data_->principal_of_frame[row]), now.velocity,
                   now.spin};
}

Energy Run::energy() const {
  const base::FloatEnvironment environment;
  Energy sum;
  data_->for_each_part([&](const Part& part) {
    const Energy energy = part.system.energy(part.time(), part.y);
    sum.kinetic += energy.kinetic;
    sum.potential += energy.potential;
    sum.elastic += energy.elastic;
  });
  return sum;
}

std::uint64_t Run::evaluations() const {
  std::uint64_t sum = 0;
  data_->for_each_part([&](const Part& part) { sum += part.system.evaluations(); });
  return sum;
}

std::vector<Spectrum> Run::spectra() const {
  const base::FloatEnvironment environment;
  std::vector<Spectrum> list;
  for (const Part& part : data_->parts) list.push_back(part.system.spectrum(part.time(), part.y));
  return list;
}

const CollisionReport& Run::collisions() const {
  return data_->collisions.report();
}

std::vector<ObjectReport> Run::report() const {
  std::vector<ObjectReport> reports;
  data_->for_each_part([&](const Part& part) {
    const bool adaptive = part.method->info.adaptive;
    reports.push_back({.kind = part.system.kind(),
                       .slot = part.system.slot(),
                       .stepper = std::string(part.method->info.name),
                       .dt = part.h,
                       .steps = adaptive ? part.work.inner_steps : part.steps,
                       .evaluations = part.system.evaluations(),
                       .error = part.error_estimate,
                       .left_out = part.system.left_out()});
  });
  return reports;
}

}  // namespace hooke::lab
