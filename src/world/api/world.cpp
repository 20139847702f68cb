/// This file implements the public API over deformables, meshes, fields, force laws and the World itself. The
/// step is in src/world/step.cpp.

#include "hooke/world.h"

#include "build/build.h"
#include "build/checks.h"
#include "geometry/triangle_mesh.h"
#include "solver/air/force_fields.h"
#include "solver/air/gas_pressure.h"
#include "solver/air/wind.h"
#include "solver/rope/rope_twist.h"
#include "world/api/machine.h"
#include "world/api/state_hash.h"
#include "world/api/undo.h"
#include "world/claim.h"
#include "world/events.h"
#include "world/hook_stages.h"
#include "world/object_edits.h"
#include "world/sleep.h"
#include "world/world_data.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace hooke {

namespace {

using build::Checks;

/// Runs `add`, which appends an object, and gives that object an id. If `add` fails, the tables are as
/// before.
template <class IdType, class Add>
Result<IdType> add_object(state::Tables& tables, state::SlotTable<IdType>& slots, Add&& add) {
  world::Undo undo(tables);
  const Result<void> added = add();
  if (!added) return added.error();
  const IdType id = slots.add(static_cast<std::uint32_t>(tables.objects.size()) - 1);
  tables.objects.back().slot = id.slot;
  undo.keep();
  return id;
}

template <class IdType>
bool remove_object(state::Tables& tables, const state::SlotTable<IdType>& slots, IdType id) {
  const std::uint32_t row = slots.find(id);
  if (row == slots.kNone) return false;
  world::wake_near_points(tables.objects[row], tables);
  world::remove_object(tables, row);
  return true;
}

/// A view of an object's rows in a column of records. Positions are offsets from the object's origin;
/// velocities have the origin zero.
template <class IdType, class Line>
PointView view_of(const state::Tables& tables, const state::SlotTable<IdType>& slots, IdType id,
                  const std::vector<Line>& column) {
  const std::uint32_t row = slots.find(id);
  if (row == slots.kNone) return {};
  const state::Deformable& object = tables.objects[row];
  const std::size_t first = object.particles.first;
  constexpr bool kPlaces = std::is_same_v<Line, state::PositionRecord>;
  return {kPlaces ? object.origin : DVec3{}, reinterpret_cast<const std::byte*>(column.data() + first),
          object.particles.count, sizeof(Line), tables.particles.row_of.data() + first};
}

/// Sum of the masses of an object's points [kg]; 0 for a stale or null id.
template <class IdType>
Real mass_of(const state::Tables& tables, const state::SlotTable<IdType>& slots, IdType id) {
  const std::uint32_t row = slots.find(id);
  if (row == slots.kNone) return Real(0);
  const state::Rows rows = tables.objects[row].particles;
  double sum = 0;
  for (std::uint32_t i = rows.first; i < rows.end(); ++i)
    sum += static_cast<double>(tables.particles.mass[i]);
  return static_cast<Real>(sum);
}

/// Returns figure(span, rest length) for each segment of a rope that lies in a twist span, and 0 for others.
template <class Figure>
std::vector<Real> twist_figures(const state::Tables& t, RopeId id, Figure&& figure) {
  const std::uint32_t row = t.rope_slots.find(id);
  if (row == t.rope_slots.kNone) return {};
  const state::Rows segments = t.objects[row].segments;
  std::vector<Real> figures(segments.count, Real(0));
  for (const state::TwistSpan& span : t.twists) {
    if (span.object != row) continue;
    for (std::uint32_t i = span.a.segment + 1; i < span.b.segment; ++i)
      figures[i] = figure(span, static_cast<double>(t.segments.rest_length[segments.first + i]));
  }
  return figures;
}

/// Returns the mark of a new World, which its ids contain. No World has the mark 0.
std::uint32_t next_mark() {
  static std::atomic<std::uint32_t> last = 0;
  const std::uint32_t mark = ++last;
  return mark != 0 ? mark : ++last;
}

Error no_function() {
  return {ErrorCode::kOutOfRange, "force_law", "must be a function"};
}

Result<ForceLawId> add_law(WorldData& w, state::ForceLawEntry entry) {
  state::Tables& t = w.tables;
  world::Undo undo(t);
  const ForceLawId id = t.force_law_slots.add(static_cast<std::uint32_t>(t.force_laws.size()));
  entry.slot = id.slot;
  const bool of_bodies = entry.body_law != nullptr;
  t.force_laws.push_back(std::move(entry));
  undo.keep();
  if (of_bodies) world::wake_all(t);
  return id;
}

}  // namespace

Vec3 PointView::offset(std::size_t i) const {
  if (i >= count_) return {};
  const std::size_t row = row_of_ != nullptr ? row_of_[i] : i;
  Vec3 value;
  std::memcpy(&value, first_ + row * stride_, sizeof(value));
  return value;
}

Real ForceView::mass(std::size_t i) const {
  if (i >= size()) return Real(0);
  state::VelocityRecord record;
  std::memcpy(&record, records_ + row_of_[i] * sizeof(record), sizeof(record));
  return record.inverse_mass > Real(0) ? Real(1) / record.inverse_mass : Real(0);
}

void ForceView::add_force(std::size_t i, Vec3 force) {
  if (i < size()) forces_[row_of_[i]] += force;
}

Result<World> World::create(const WorldDesc& desc) {
  const base::FloatEnvironment environment;
  const Result<void> good = build::validate(desc);
  if (!good) return good.error();
  if (const Result<void> heeded = world::heed_environment(); !heeded) return heeded.error();
  auto data = std::make_shared<WorldData>();
  data->tables.desc = desc;
  world::mark_ids(next_mark(), data->tables);
  data->pool = std::make_unique<parallel::ThreadPool>(desc.workers);
  return World(std::move(data));
}

World::World(std::shared_ptr<WorldData> data) : data_(std::move(data)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Result<MeshId> World::add_mesh(const MeshDesc& desc, MeshTree tree) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  if (const Result<void> good = geometry::validate_mesh(desc); !good) return good.error();
  Checks checks("mesh");
  for (std::size_t i = 0; i < desc.positions.size() && checks.good(); ++i)
    checks.within(build::indexed("positions", i), desc.positions[i], limits::kSize, " m");
  if (!checks.good()) return checks.result().error();
  auto mesh = std::make_shared<state::Mesh>();
  mesh->desc = desc;
  mesh->bvh = geometry::build_bvh(desc.positions, desc.triangles);
  mesh->protrusions = geometry::find_protrusions(desc);
  mesh->hash = world::hash_of(desc);
  if (tree == MeshTree::kPlanes) {
    Result<BspTree> planes = build_bsp(desc);
    if (!planes) return planes.error();
    mesh->planes = std::move(planes).value();
  }
  state::Tables& t = claim.tables();
  world::Undo undo(t);
  t.meshes.push_back(std::move(mesh));
  t.hulls.push_back(nullptr);
  t.convex_parts.emplace_back();
  const MeshId id = t.mesh_slots.add(static_cast<std::uint32_t>(t.meshes.size()) - 1);
  undo.keep();
  return id;
}

Result<RopeId> World::add_rope(const RopeDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  state::Tables& t = claim.tables();
  return add_object(t, t.rope_slots, [&] { return build::add_rope(desc, t); });
}

Result<ClothId> World::add_cloth(const ClothDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  state::Tables& t = claim.tables();
  return add_object(t, t.cloth_slots, [&] { return build::add_cloth(desc, t); });
}

Result<SolidId> World::add_solid(const SolidDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  state::Tables& t = claim.tables();
  return add_object(t, t.solid_slots, [&] { return build::add_solid(desc, t); });
}

Result<ParticlesId> World::add_particles(const ParticlesDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  state::Tables& t = claim.tables();
  return add_object(t, t.particles_slots, [&] { return build::add_particles(desc, t); });
}

Result<FieldId> World::add_field(const FieldDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const Result<void> good = build::validate(desc);
  if (!good) return good.error();
  state::Tables& t = claim.tables();
  world::Undo undo(t);
  const FieldId id = t.field_slots.add(static_cast<std::uint32_t>(t.fields.size()));
  t.fields.push_back({desc, id.slot});
  undo.keep();
  world::wake_all(t);
  return id;
}

Result<ForceLawId> World::add_force_law(ForceLaw law) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  if (!law) return no_function();
  return add_law(*claim, {.law = std::move(law)});
}

Result<ForceLawId> World::add_force_law(BodyForceLaw law) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  if (!law) return no_function();
  return add_law(*claim, {.body_law = std::move(law)});
}

bool World::remove(MeshId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  state::Tables& t = claim.tables();
  const std::uint32_t row = t.mesh_slots.find(id);
  if (row == t.mesh_slots.kNone || !t.meshes[row]) return false;
  t.meshes[row] = nullptr;  // Bodies that use the mesh share it, so it lives on with them.
  t.hulls[row] = nullptr;
  t.convex_parts[row].clear();
  t.mesh_slots.move(id.slot, t.mesh_slots.kNone);
  return true;
}

bool World::remove(FieldId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  state::Tables& t = claim.tables();
  if (!world::remove_row(t.field_slots, id, t.fields)) return false;
  world::wake_all(t);
  return true;
}

bool World::remove(ForceLawId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  state::Tables& t = claim.tables();
  const std::uint32_t row = t.force_law_slots.find(id);
  if (row == t.force_law_slots.kNone) return false;
  if (t.force_laws[row].body_law) world::wake_all(t);
  return world::remove_row(t.force_law_slots, id, t.force_laws);
}

bool World::remove(RopeId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  return remove_object(claim.tables(), claim.tables().rope_slots, id);
}

bool World::remove(ClothId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  return remove_object(claim.tables(), claim.tables().cloth_slots, id);
}

bool World::remove(SolidId id) {
  if (const BodyId body = body_of(id); body != BodyId{}) return remove(body);
  const world::Claim claim(data_);
  if (!claim) return false;
  return remove_object(claim.tables(), claim.tables().solid_slots, id);
}

bool World::remove(ParticlesId id) {
  const world::Claim claim(data_);
  if (!claim) return false;
  return remove_object(claim.tables(), claim.tables().particles_slots, id);
}

PointView World::positions(RopeId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().rope_slots, id, reading.tables().particles.position);
}
PointView World::positions(ClothId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().cloth_slots, id, reading.tables().particles.position);
}
PointView World::positions(SolidId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().solid_slots, id, reading.tables().particles.position);
}
PointView World::positions(ParticlesId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().particles_slots, id, reading.tables().particles.position);
}
PointView World::velocities(RopeId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().rope_slots, id, reading.tables().particles.velocity);
}
PointView World::velocities(ClothId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().cloth_slots, id, reading.tables().particles.velocity);
}
PointView World::velocities(SolidId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().solid_slots, id, reading.tables().particles.velocity);
}
PointView World::velocities(ParticlesId id) const {
  const world::Reading reading(data_);
  return view_of(reading.tables(), reading.tables().particles_slots, id, reading.tables().particles.velocity);
}

Real World::mass(RopeId id) const {
  const world::Reading reading(data_);
  return mass_of(reading.tables(), reading.tables().rope_slots, id);
}
Real World::mass(ClothId id) const {
  const world::Reading reading(data_);
  return mass_of(reading.tables(), reading.tables().cloth_slots, id);
}
Real World::mass(SolidId id) const {
  const world::Reading reading(data_);
  return mass_of(reading.tables(), reading.tables().solid_slots, id);
}
Real World::mass(ParticlesId id) const {
  const world::Reading reading(data_);
  return mass_of(reading.tables(), reading.tables().particles_slots, id);
}

std::vector<std::uint32_t> World::broken_segments(RopeId id) const {
  const world::Reading reading(data_);
  const state::Tables& t = reading.tables();
  const std::uint32_t row = t.rope_slots.find(id);
  if (row == t.rope_slots.kNone) return {};
  const state::Rows rows = t.objects[row].segments;
  std::vector<std::uint32_t> broken;
  for (std::uint32_t i = 0; i < rows.count; ++i) {
    if (!t.segments.joins(rows.first + i)) broken.push_back(i);
  }
  return broken;
}

std::vector<Real> World::tensions(RopeId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().rope_slots.find(id);
  if (row == reading.tables().rope_slots.kNone) return {};
  const state::Rows rows = reading.tables().objects[row].segments;
  const auto first = reading.tables().segments.mean_tension.begin() + rows.first;
  return {first, first + rows.count};
}

std::vector<Real> World::twists(RopeId id) const {
  const world::Reading reading(data_);
  return twist_figures(reading.tables(), id, [&](const state::TwistSpan& span, double rest) {
    return static_cast<Real>(solver::twist_now(reading.tables(), span) * rest / span.length);
  });
}

std::vector<Real> World::torques(RopeId id) const {
  const world::Reading reading(data_);
  return twist_figures(reading.tables(), id,
                       [](const state::TwistSpan& span, double) { return span.mean_torque; });
}

std::vector<std::array<std::uint32_t, 3>> World::triangles(ClothId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().cloth_slots.find(id);
  if (row == reading.tables().cloth_slots.kNone) return {};
  const state::Deformable& object = reading.tables().objects[row];
  std::vector<std::uint32_t> point_of(object.particles.count);
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    point_of[reading.tables().particles.row_of[object.particles.first + i]] = i;
  }
  std::vector<std::array<std::uint32_t, 3>> result;
  for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
    const auto [a, b, c] = reading.tables().triangles.corners[i];
    const std::uint32_t first = object.particles.first;
    result.push_back({point_of[a - first], point_of[b - first], point_of[c - first]});
  }
  return result;
}

Real World::pressure(ClothId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().cloth_slots.find(id);
  if (row == reading.tables().cloth_slots.kNone || !(reading.tables().objects[row].gas > 0)) return Real(0);
  solver::GasVolume gas;
  solver::measure_gas(reading.tables().objects[row], reading.tables().triangles, reading.tables().particles,
                      gas);
  return static_cast<Real>(solver::gas_pressure(reading.tables().objects[row], gas.volume));
}

std::vector<DVec3> World::surface(SolidId id) const {
  const world::Reading reading(data_);
  const PointView points = positions(id);
  if (points.empty()) return {};
  std::vector<DVec3> surface;
  for (const auto& anchor : reading.tables().objects[reading.tables().solid_slots.find(id)].skin->vertices) {
    DVec3& place = surface.emplace_back(points.origin());
    for (std::size_t k = 0; k < 4; ++k)
      place += static_cast<double>(anchor.weights[k]) * vector_cast<double>(points.offset(anchor.points[k]));
  }
  return surface;
}

std::vector<std::array<std::uint32_t, 3>> World::triangles(SolidId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().solid_slots.find(id);
  if (row == reading.tables().solid_slots.kNone) return {};
  return reading.tables().objects[row].skin->triangles;
}

double World::volume(SolidId id) const {
  const world::Reading reading(data_);
  const state::Tables& t = reading.tables();
  const std::uint32_t row = t.solid_slots.find(id);
  if (row == t.solid_slots.kNone) return 0;
  double sum = 0;
  if (t.objects[row].rest_shape) {
    const std::vector<DVec3> x = surface(id);
    for (const auto& [a, b, c] : t.objects[row].skin->triangles)
      sum += dot(x[a] - x[0], cross(x[b] - x[0], x[c] - x[0])) / 6;
  }
  for (std::uint32_t i = t.objects[row].tetrahedra.first; i < t.objects[row].tetrahedra.end(); ++i) {
    const auto [a, b, c, d] = t.tetrahedra.corners[i];
    const auto x = [&](std::uint32_t p) { return vector_cast<double>(t.particles.position[p].x); };
    sum += dot(x(b) - x(a), cross(x(c) - x(a), x(d) - x(a))) / 6;
  }
  return sum;
}

Result<void> World::apply_force(PointRef point, Vec3 force) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const auto row = world::find_particle(claim.tables(), point);
  if (!row) return world::stale("point");
  Vec3& given = claim.tables().particles.force[row->particle];
  Result<void> good = world::check_force("force", force, given + force);
  if (!good) return good;
  given += force;
  claim.tables().any_force = true;
  return {};
}

Result<void> World::apply_impulse(PointRef point, Vec3 impulse) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const auto row = world::find_particle(claim.tables(), point);
  if (!row) return world::stale("point");
  state::VelocityRecord& record = claim.tables().particles.velocity[row->particle];
  const Vec3 v = record.v + record.inverse_mass * impulse;
  Result<void> good = Checks("")
                          .within("impulse", impulse, limits::kForce)
                          .within("impulse", v, limits::kSpeed, " m/s, the velocity that it gives")
                          .result();
  if (good) record.v = v;
  return good;
}

Result<void> World::set_velocity(PointRef point, Vec3 velocity) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const auto row = world::find_particle(claim.tables(), point);
  if (!row) return world::stale("point");
  if (auto good = Checks("").velocity("velocity", velocity).result(); !good) return good;
  state::Particles& particles = claim.tables().particles;
  if (particles.velocity[row->particle].inverse_mass > Real(0))
    particles.velocity[row->particle].v = velocity;
  return {};
}

Result<void> World::set_position(PointRef point, DVec3 position) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const auto row = world::find_particle(claim.tables(), point);
  if (!row) return world::stale("point");
  if (auto good = Checks("").place("position", position).result(); !good) return good;
  state::Tables& t = claim.tables();
  t.particles.position[row->particle].x = vector_cast<Real>(position - t.objects[row->object].origin);
  t.objects[row->object].surface.may_cross = true;
  for (state::Pin& pin : t.pins) {
    if (pin.particle == row->particle)
      pin.start = position - solver::motion_offset(pin.motion, t.time - pin.start_time);
  }
  return {};
}

Result<void> World::pin(PointRef point, const MotionDesc& motion) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const auto row = world::find_particle(claim.tables(), point);
  if (!row) return world::stale("point");
  const Result<void> good = build::validate(motion, "motion");
  if (!good) return good.error();
  world::pin_particle(claim.tables(), *row, motion);
  world::wake_near_points(claim.tables().objects[row->object], claim.tables());
  return {};
}

Result<void> World::unpin(PointRef point) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  const auto row = world::find_particle(claim.tables(), point);
  if (!row) return world::stale("point");
  world::unpin_particle(claim.tables(), *row);
  world::wake_near_points(claim.tables().objects[row->object], claim.tables());
  return {};
}

bool World::is_pinned(PointRef point) const {
  const world::Reading reading(data_);
  const auto row = world::find_particle(reading.tables(), point);
  return row && std::any_of(reading.tables().pins.begin(), reading.tables().pins.end(),
                            [&](const state::Pin& pin) { return pin.particle == row->particle; });
}

Result<void> World::set_gravity(Vec3 gravity) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  auto good = Checks("").within("gravity", gravity, limits::kAcceleration, " m/s^2").result();
  if (!good) return good;
  state::Tables& t = claim.tables();
  if (gravity == t.desc.gravity) return {};
  t.desc.gravity = gravity;
  world::wake_all(t);
  return {};
}

Result<void> World::set_wind(const WindDesc& wind) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Result<void> good = build::validate(wind);
  state::Tables& t = claim.tables();
  if (!good || wind == t.desc.wind) return good;
  t.desc.wind = wind;
  world::wake_all(t);
  return {};
}

Result<void> World::set_workers(int workers) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  if (workers < 1 || workers > 64) return Error{ErrorCode::kOutOfRange, "workers", "must be 1 to 64"};
  claim->pool = std::make_unique<parallel::ThreadPool>(workers);
  claim.tables().desc.workers = workers;
  return {};
}

double World::time() const {
  const world::Reading reading(data_);
  return reading.tables().time;
}
std::uint64_t World::step_count() const {
  const world::Reading reading(data_);
  return reading.tables().step_count;
}
const WorldDesc& World::desc() const {
  const world::Reading reading(data_);
  return reading.tables().desc;
}

Vec3 World::wind_at(DVec3 place, double time) const {
  const world::Reading reading(data_);
  return solver::wind_at(reading.tables().desc.wind, place, time, reading.tables().step_count);
}

std::uint64_t World::state_hash() const {
  const world::Reading reading(data_);
  return world::hash_of(reading.tables());
}

Snapshot World::snapshot() const {
  const world::Reading reading(data_);
  if (!data_ || reading->stepping) return {};
  return Snapshot(std::make_shared<const SnapshotData>(SnapshotData{reading.tables()}));
}

Result<void> World::restore(const Snapshot& snapshot) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  if (!snapshot.data_) return Error{ErrorCode::kOutOfRange, "snapshot", "is empty"};
  claim->derived.broad_phase_stale = true;
  claim->derived.placed_bodies.clear();  // These rows belong to the world before the restoration.
  claim->derived.boxes_are_current = false;
  world::clear_events(claim->last_step.events);
  claim->last_step.broken_hooks.clear();
  world::clear_deformable_contacts(claim->last_step);
  claim->frame.surfaces.active = false;  // What it found is not of these tables.
  world::restore_tables(snapshot.data_->tables, claim.tables());
  return {};
}

World::Memory World::memory() const {
  const world::Reading reading(data_);
  Memory memory;
  const state::Tables& t = reading.tables();
  memory.particles = static_cast<std::size_t>(t.particles.count());
  memory.springs = static_cast<std::size_t>(t.springs.count());
  const auto bytes = [](const auto& column) { return column.size() * sizeof(column[0]); };
  state::Particles::for_each_column(t.particles,
                                    [&](const auto& column) { memory.particle_bytes += bytes(column); });
  state::Springs::for_each_column(t.springs,
                                  [&](const auto& column) { memory.spring_bytes += bytes(column); });
  memory.particle_bytes += bytes(reading->frame.start_position) + bytes(reading->frame.velocity_before) +
                           bytes(reading->frame.wind) + bytes(reading->frame.law_force);
  for (const solver::SoftGroup& group : reading->derived.soft.groups)
    memory.spring_bytes += bytes(group.springs.blocks);
  return memory;
}

}  // namespace hooke
