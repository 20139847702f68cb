#include "world/object_edits.h"

#include "base/assert.h"
#include "build/checks.h"
#include "state/particle_numbers.h"
#include "state/sleeping_pairs.h"
#include "world/hook_stages.h"

#include <algorithm>
#include <array>

namespace hooke::world {

namespace {

using state::Deformable;
using state::Rows;
using state::Tables;

template <class Table>
void erase_rows(Table& table, Rows rows) {
  HOOKE_ASSERT(rows.end() <= static_cast<std::uint32_t>(table.count()));
  Table::for_each_column(
      table, [&](auto& column) { column.erase(column.begin() + rows.first, column.begin() + rows.end()); });
}

/// Lowers the row numbers of particles behind those of a removed object, wherever they are stored. In the
/// tables only rows of later objects have such numbers; these rows now begin where those of `gone` did.
void renumber_particles(Tables& t, const Deformable& gone) {
  const auto moved = [&](std::uint32_t& p) {
    if (p >= gone.particles.end()) p -= gone.particles.count;
  };
  state::for_each_particle_number(t, gone, moved);
}

/// Lowers the object rows in hooks, because objects behind `removed` have moved up by one row.
void renumber_hooked_objects(Tables& t, std::uint32_t removed) {
  for (state::Hook& hook : t.hooks) {
    for (state::HookPlace* end : {&hook.a, &hook.b}) end->object -= end->is_point() && end->object > removed;
  }
}

/// Notes that a particle was pinned or let go. Of its object that changes tethers alone: those count only
/// while their ends are pinned.
void note_pin(Tables& t, ParticleRow row) {
  ++t.revision;
  Deformable& object = t.objects[row.object];
  const state::Springs& springs = t.springs;
  for (std::uint32_t i = object.springs.first; i < object.springs.end(); ++i) {
    if (springs.particle_b[i] != row.particle || springs.kind[i] != state::SpringClass::kTether) continue;
    return note_change(t, object);
  }
}

void move_slot(Tables& t, const Deformable& object, std::uint32_t row) {
  if (object.kind == PointRef::Kind::kRope) t.rope_slots.move(object.slot, row);
  if (object.kind == PointRef::Kind::kCloth) t.cloth_slots.move(object.slot, row);
  if (object.kind == PointRef::Kind::kSolid) t.solid_slots.move(object.slot, row);
  if (object.kind == PointRef::Kind::kParticles) t.particles_slots.move(object.slot, row);
}

}  // namespace

Error stale(const char* what) {
  return {ErrorCode::kStaleId, what, "refers to nothing that is in the world"};
}

Result<void> check_force(const char* what, Vec3 force, Vec3 sum) {
  return build::Checks("")
      .within(what, force, limits::kForce, " N")
      .within(what, sum, limits::kForce, " N with what was given before")
      .result();
}

std::optional<ParticleRow> find_particle(const Tables& tables, PointRef point) {
  const std::uint32_t row = state::object_row(tables, point);
  if (row == state::SlotTable<RopeId>::kNone) return std::nullopt;
  const Deformable& object = tables.objects[row];
  if (point.index >= object.particles.count) return std::nullopt;
  const std::uint32_t first = object.particles.first;
  return ParticleRow{first + tables.particles.row_of[first + point.index], row};
}

void remove_object(Tables& t, std::uint32_t row) {
  HOOKE_ASSERT(row < t.objects.size());
  remove_hooks_of_object(row, t);
  renumber_hooked_objects(t, row);
  const Deformable gone = t.objects[row];
  erase_rows(t.particles, gone.particles);
  erase_rows(t.springs, gone.springs);
  erase_rows(t.bends, gone.bends);
  erase_rows(t.triangles, gone.triangles);
  erase_rows(t.segments, gone.segments);
  erase_rows(t.tetrahedra, gone.tetrahedra);
  std::erase_if(t.pins, [&](const state::Pin& pin) { return pin.object == row; });
  for (state::Pin& pin : t.pins) pin.object -= pin.object > row ? 1 : 0;
  std::erase_if(t.twists, [&](const state::TwistSpan& span) { return span.object == row; });
  for (state::TwistSpan& span : t.twists) span.object -= span.object > row ? 1 : 0;
  renumber_particles(t, gone);
  t.contacts = {};  // Detect finds contacts again in the next step.
  t.element_contacts.clear();
  t.rope_contacts.clear();

  move_slot(t, gone, state::SlotTable<RopeId>::kNone);
  t.objects.erase(t.objects.begin() + row);
  for (std::uint32_t i = row; i < t.objects.size(); ++i) {
    Deformable& object = t.objects[i];
    object.particles.first -= gone.particles.count;
    object.springs.first -= gone.springs.count;
    object.bends.first -= gone.bends.count;
    object.triangles.first -= gone.triangles.count;
    object.segments.first -= gone.segments.count;
    object.tetrahedra.first -= gone.tetrahedra.count;
    move_slot(t, object, i);
  }
  ++t.revision;
}

void pin_particle(Tables& t, ParticleRow row, const MotionDesc& motion) {
  HOOKE_ASSERT(row.object < t.objects.size() && row.particle < t.particles.position.size());
  const Vec3 x = t.particles.position[row.particle].x;
  const DVec3 place = t.objects[row.object].origin + vector_cast<double>(x);
  const state::Pin pin = {row.object, row.particle, place, t.time, motion};
  const auto at =
      std::lower_bound(t.pins.begin(), t.pins.end(), row.particle,
                       [](const state::Pin& p, std::uint32_t particle) { return p.particle < particle; });
  if (at != t.pins.end() && at->particle == row.particle) {
    *at = pin;
  } else {
    t.pins.insert(at, pin);
  }
  t.particles.velocity[row.particle] = {};
  note_pin(t, row);
}

void unpin_particle(Tables& t, ParticleRow row) {
  const auto removed =
      std::erase_if(t.pins, [&](const state::Pin& pin) { return pin.particle == row.particle; });
  if (removed == 0) return;
  HOOKE_ASSERT(removed == 1 && t.particles.mass[row.particle] > Real(0));
  t.particles.velocity[row.particle].inverse_mass = Real(1) / t.particles.mass[row.particle];
  note_pin(t, row);
}

BodyId id_of(const Tables& t, std::uint32_t body) {
  return t.body_slots.id_of(t.bodies.slot[body]);
}

PointRef point_of(const Tables& t, const Deformable& object, std::uint32_t index) {
  switch (object.kind) {
    case PointRef::Kind::kRope:
      return point(t.rope_slots.id_of(object.slot), index);
    case PointRef::Kind::kCloth:
      return point(t.cloth_slots.id_of(object.slot), index);
    case PointRef::Kind::kSolid:
      return point(t.solid_slots.id_of(object.slot), index);
    case PointRef::Kind::kParticles:
      return point(t.particles_slots.id_of(object.slot), index);
    case PointRef::Kind::kNone:
      break;
  }
  return {};
}

BodyPart part_of(const Tables& t, std::uint32_t collider) {
  const std::uint32_t body = t.colliders.body[collider];
  HOOKE_ASSERT(collider - t.bodies.first_collider[body] < t.bodies.collider_count[body]);
  return {id_of(t, body), collider - t.bodies.first_collider[body]};
}

bool is_swapped(const Tables& t, const state::Manifold& m) {
  return t.bodies.slot[m.body_b] < t.bodies.slot[m.body_a];
}

void wake_all(Tables& t) {
  for (const std::uint32_t body : t.moving_bodies) state::wake(t.bodies, body);
}

namespace {

template <class Visit>
void for_each_slots(Tables& t, Visit&& visit) {
  const auto each = [&](auto&... slots) { (visit(slots), ...); };
  each(t.mesh_slots, t.body_slots, t.rope_slots, t.cloth_slots, t.particles_slots, t.field_slots,
       t.force_law_slots, t.hook_slots, t.solid_slots);
}

}  // namespace

void mark_ids(std::uint32_t mark, Tables& t) {
  for_each_slots(t, [&](auto& slots) { slots.set_world(mark); });
}

void restore_tables(const Tables& from, Tables& to) {
  const int workers = to.desc.workers;
  const std::uint64_t revision = std::max(from.revision, to.revision) + 1;
  const std::uint64_t hook_revision = std::max(from.hook_revision, to.hook_revision) + 1;
  const std::uint32_t mark = to.body_slots.world();
  std::array<std::uint32_t, 9> generations = {};
  std::size_t i = 0;
  for_each_slots(to, [&](const auto& slots) { generations[i++] = slots.generation() + 1; });
  HOOKE_ASSERT(i == generations.size());
  const auto go_on = [&] {
    to.desc.workers = workers;
    to.revision = revision;
    to.hook_revision = hook_revision;
    state::note_change_of_all(to);
    i = 0;
    for_each_slots(to, [&](auto& slots) { slots.set_generation(generations[i++]); });
    mark_ids(mark, to);
  };
  try {
    to = from;  // Nothing is allocated where there is room already.
  } catch (...) {
    to = Tables();
    go_on();
    throw;
  }
  go_on();
}

}  // namespace hooke::world
