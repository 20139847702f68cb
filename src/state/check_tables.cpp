#include "state/check_tables.h"

#include "base/assert.h"
#include "state/sleeping_pairs.h"

#include <algorithm>
#include <span>

namespace hooke::state {

namespace {

// Each function returns what is wrong, or null.

template <class Table>
bool columns_agree(const Table& table) {
  bool agree = true;
  Table::for_each_column(table, [&](const auto& column) {
    agree = agree && column.size() == static_cast<std::size_t>(table.count());
  });
  return agree;
}

bool is_within(std::uint32_t row, Rows rows) {
  return row >= rows.first && row < rows.end();
}

const char* find_in_columns(const Tables& t) {
  if (!columns_agree(t.particles)) return "columns of particles";
  if (!columns_agree(t.springs)) return "columns of springs";
  if (!columns_agree(t.bends)) return "columns of bends";
  if (!columns_agree(t.triangles)) return "columns of triangles";
  if (!columns_agree(t.segments)) return "columns of segments";
  if (!columns_agree(t.tetrahedra)) return "columns of tetrahedra";
  if (!columns_agree(t.contacts)) return "columns of contacts";
  if (!columns_agree(t.bodies)) return "columns of bodies";
  if (!columns_agree(t.colliders)) return "columns of colliders";
  if (t.meshes.size() != t.hulls.size() || t.meshes.size() != t.convex_parts.size())
    return "columns of meshes";
  return nullptr;
}

/// The rows of objects follow one another, in their order, without gaps.
const char* find_in_ranges(const Tables& t) {
  Deformable end = {};
  for (const Deformable& o : t.objects) {
    if (o.particles.first != end.particles.first || o.springs.first != end.springs.first ||
        o.bends.first != end.bends.first || o.triangles.first != end.triangles.first ||
        o.segments.first != end.segments.first || o.tetrahedra.first != end.tetrahedra.first)
      return "rows of objects";
    end.particles.first = o.particles.end();
    end.springs.first = o.springs.end();
    end.bends.first = o.bends.end();
    end.triangles.first = o.triangles.end();
    end.segments.first = o.segments.end();
    end.tetrahedra.first = o.tetrahedra.end();
  }
  const auto is_end = [](std::uint32_t row, int count) { return row == static_cast<std::uint32_t>(count); };
  const bool all =
      is_end(end.particles.first, t.particles.count()) && is_end(end.springs.first, t.springs.count()) &&
      is_end(end.bends.first, t.bends.count()) && is_end(end.triangles.first, t.triangles.count()) &&
      is_end(end.segments.first, t.segments.count()) && is_end(end.tetrahedra.first, t.tetrahedra.count());
  return all ? nullptr : "rows of no object";
}

const char* find_in_elements(const Tables& t, const Deformable& o) {
  for (std::uint32_t i = o.particles.first; i < o.particles.end(); ++i) {
    if (t.particles.row_of[i] >= o.particles.count) return "order of an object's points";
  }
  const auto owns = [&](auto... particle) { return (is_within(particle, o.particles) && ...); };
  for (std::uint32_t i = o.springs.first; i < o.springs.end(); ++i) {
    if (!owns(t.springs.particle_a[i], t.springs.particle_b[i])) return "particles of a spring";
  }
  for (std::uint32_t i = o.bends.first; i < o.bends.end(); ++i) {
    const Bends::Stencil& s = t.bends.stencil[i];
    if (!owns(s.edge_a, s.edge_b, s.wing_a, s.wing_b)) return "particles of a bend";
  }
  for (std::uint32_t i = o.triangles.first; i < o.triangles.end(); ++i) {
    const Triangles::Corners& c = t.triangles.corners[i];
    if (!owns(c.a, c.b, c.c)) return "particles of a triangle";
  }
  for (std::uint32_t i = o.tetrahedra.first; i < o.tetrahedra.end(); ++i) {
    const Tetrahedra::Corners& c = t.tetrahedra.corners[i];
    if (!owns(c.a, c.b, c.c, c.d)) return "particles of a tetrahedron";
  }
  const bool is_rope = o.kind == PointRef::Kind::kRope;
  if (is_rope && o.segments.count + 1 != o.particles.count) return "segments of a rope";
  return nullptr;
}

/// The row to which the id of an object leads.
std::uint32_t row_of_id(const Tables& t, const Deformable& o) {
  switch (o.kind) {
    case PointRef::Kind::kRope:
      return t.rope_slots.find(t.rope_slots.id_of(o.slot));
    case PointRef::Kind::kCloth:
      return t.cloth_slots.find(t.cloth_slots.id_of(o.slot));
    case PointRef::Kind::kSolid:
      return t.solid_slots.find(t.solid_slots.id_of(o.slot));
    case PointRef::Kind::kParticles:
      return t.particles_slots.find(t.particles_slots.id_of(o.slot));
    default:
      return Tables::kNoRow;
  }
}

const char* find_in_objects(const Tables& t) {
  for (std::uint32_t row = 0; row < t.objects.size(); ++row) {
    const Deformable& o = t.objects[row];
    if (const char* what = find_in_elements(t, o)) return what;
    if (row_of_id(t, o) != row) return "id of an object";
  }
  for (std::size_t i = 0; i < t.pins.size(); ++i) {
    const Pin& pin = t.pins[i];
    if (pin.object >= t.objects.size() || !is_within(pin.particle, t.objects[pin.object].particles))
      return "particle of a pin";
    if (i > 0 && t.pins[i - 1].particle >= pin.particle) return "order of pins";
  }
  for (std::uint32_t row = 0; row < t.fields.size(); ++row) {
    if (t.field_slots.find(t.field_slots.id_of(t.fields[row].slot)) != row) return "id of a field";
  }
  for (std::uint32_t row = 0; row < t.force_laws.size(); ++row) {
    if (t.force_law_slots.find(t.force_law_slots.id_of(t.force_laws[row].slot)) != row)
      return "id of a force law";
  }
  return nullptr;
}

bool lives(const Tables& t, std::uint32_t body) {
  return body < t.bodies.traits.size() && t.bodies.traits[body].alive;
}

const char* find_in_body(const Tables& t, std::uint32_t body) {
  if (t.body_slots.find(t.body_slots.id_of(t.bodies.slot[body])) != body) return "id of a body";
  if (t.bodies.first_collider[body] + t.bodies.collider_count[body] > t.colliders.body.size())
    return "colliders of a body";
  for (const std::uint32_t c : colliders_of(t.bodies, body)) {
    if (t.colliders.body[c] != body) return "body of a collider";
  }
  return nullptr;
}

const char* find_in_moving_bodies(const Tables& t) {
  for (std::size_t i = 0; i < t.moving_bodies.size(); ++i) {
    if (!lives(t, t.moving_bodies[i])) return "a moving body";
    if (i > 0 && t.moving_bodies[i - 1] >= t.moving_bodies[i]) return "order of moving bodies";
  }
  return nullptr;
}

const char* find_in_bodies(const Tables& t) {
  std::size_t colliders = 0;
  std::size_t moving = 0;
  std::size_t living = 0;
  for (std::uint32_t body = 0; body < t.bodies.traits.size(); ++body) {
    if (!lives(t, body)) continue;
    ++living;
    moving += t.bodies.traits[body].kind != BodyKind::kStatic ? 1 : 0;
    colliders += t.bodies.collider_count[body];
    if (const char* what = find_in_body(t, body)) return what;
  }
  for (const std::uint32_t body : t.free_bodies) {
    if (body >= t.bodies.traits.size() || lives(t, body)) return "a hole that is a body";
  }
  if (living + t.free_bodies.size() != t.bodies.traits.size()) return "number of bodies";
  const auto used = std::count_if(t.colliders.body.begin(), t.colliders.body.end(),
                                  [](std::uint32_t body) { return body != Colliders::kNoBody; });
  if (static_cast<std::size_t>(used) != colliders) return "number of colliders";
  if (moving != t.moving_bodies.size()) return "number of moving bodies";
  return find_in_moving_bodies(t);
}

const char* find_in_yielding(const Tables& t) {
  for (const Yielding& yielding : t.yielding) {
    if (!lives(t, yielding.body)) return "a body that yields";
    if (!yielding.form || yielding.form->points.size() != yielding.form->mass.size()) return "form of a body";
    if (yielding.is_soft() && soft_object(t, yielding) == Tables::kNoRow) return "solid of a body";
    if (yielding.is_soft() && t.bodies.traits[yielding.body].kind != BodyKind::kStatic)
      return "a soft body that moves";
  }
  return nullptr;
}

bool is_place(const Tables& t, const HookPlace& place) {
  if (!place.is_point()) return place.body == HookPlace::kWorld || lives(t, place.body);
  if (place.object >= t.objects.size() || place.particle_count > HookPlace::kMostParticles) return false;
  return std::all_of(place.particle.begin(), place.particle.begin() + place.particle_count,
                     [&](std::uint32_t p) { return is_within(p, t.objects[place.object].particles); });
}

const char* find_in_hooks(const Tables& t) {
  for (std::uint32_t row = 0; row < t.hooks.size(); ++row) {
    const Hook& hook = t.hooks[row];
    if (!is_place(t, hook.a) || !is_place(t, hook.b)) return "end of a hook";
    if (t.hook_slots.find(t.hook_slots.id_of(hook.slot)) != row) return "id of a hook";
  }
  for (const TwistSpan& span : t.twists) {
    if (span.object >= t.objects.size() || t.objects[span.object].kind != PointRef::Kind::kRope)
      return "rope of a twist";
    const std::uint32_t segments = t.objects[span.object].segments.count;
    if (span.a.segment >= span.b.segment || span.b.segment >= segments) return "segments of a twist";
  }
  return nullptr;
}

const char* find_in_pairs(const Tables& t, std::span<const Pair> pairs, std::span<const Manifold> manifolds) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i];
    if (pair.collider_a >= pair.collider_b || pair.collider_b >= t.colliders.body.size())
      return "colliders of a pair";
    if (i > 0 && !comes_before(pairs[i - 1], pair)) return "order of pairs";
    const std::uint32_t a = t.colliders.body[pair.collider_a];
    const std::uint32_t b = t.colliders.body[pair.collider_b];
    if (!lives(t, a) || !lives(t, b)) return "bodies of a pair";
    if (pair.first_manifold + std::size_t{pair.manifold_count} > manifolds.size())
      return "manifolds of a pair";
    for (const Manifold& m : manifolds.subspan(pair.first_manifold, pair.manifold_count)) {
      if (m.collider_a != pair.collider_a || m.collider_b != pair.collider_b)
        return "colliders of a manifold";
      if (m.body_a != a || m.body_b != b) return "bodies of a manifold";
      if (m.point_count < 0 || m.point_count > Manifold::kMaxPoints) return "points of a manifold";
    }
  }
  return nullptr;
}

const char* find_in_contacts(const Tables& t) {
  for (std::size_t i = 0; i < t.contacts.particle.size(); ++i) {
    const std::uint32_t object = t.contacts.object[i];
    if (object >= t.objects.size() || !is_within(t.contacts.particle[i], t.objects[object].particles))
      return "particle of a contact";
    if (t.contacts.collider[i] >= t.colliders.body.size() || t.contacts.body[i] >= t.bodies.traits.size())
      return "collider of a contact";
  }
  return nullptr;
}

const char* find_in_element_contacts(const Tables& t) {
  for (const ElementContact& inner : t.element_contacts) {
    if (inner.object >= t.objects.size() || inner.count > inner.particle.size())
      return "object of an inner contact";
    const Deformable& o = t.objects[inner.object];
    for (std::uint32_t k = 0; k < inner.count; ++k) {
      if (!is_within(inner.particle[k], o.particles)) return "particle of an inner contact";
    }
    if (!is_within(inner.element, o.kind == PointRef::Kind::kRope ? o.segments : o.triangles))
      return "element of an inner contact";
    if (inner.collider >= t.colliders.body.size() || inner.body >= t.bodies.traits.size())
      return "collider of an inner contact";
  }
  return nullptr;
}

const char* find_in_rope_contacts(const Tables& t) {
  for (const RopeContact& contact : t.rope_contacts) {
    if (contact.object_a >= t.objects.size() || contact.object_b >= t.objects.size())
      return "ropes of a contact";
    if (!is_within(contact.segment_a, t.objects[contact.object_a].segments) ||
        !is_within(contact.segment_b, t.objects[contact.object_b].segments))
      return "segments of a contact of ropes";
    for (const std::uint32_t row : contact.neighbor) {
      if (row != RopeContact::kNone && row >= t.rope_contacts.size()) return "neighbor of a contact of ropes";
    }
    if (contact.successor != RopeContact::kNone && contact.successor >= t.rope_contacts.size())
      return "heir of a contact of ropes";
  }
  return nullptr;
}

/// What is not a number passes: quarantine finds it.
const char* find_in_masses(const Tables& t) {
  const auto is_negative = [](Real mass) { return mass < Real(0); };
  if (std::any_of(t.particles.mass.begin(), t.particles.mass.end(), is_negative)) return "mass of a particle";
  for (const VelocityRecord& record : t.particles.velocity)
    if (is_negative(record.inverse_mass)) return "inverse mass of a particle";
  for (const BodyMass& mass : t.bodies.mass)
    if (is_negative(mass.mass) || is_negative(mass.inverse_mass)) return "mass of a body";
  for (const MotionRecord& record : t.bodies.motion)
    if (is_negative(record.inverse_mass)) return "inverse mass of a body";
  return nullptr;
}

}  // namespace

const char* find_disagreement(const Tables& t) {
  if (const char* what = find_in_columns(t)) return what;
  if (const char* what = find_in_ranges(t)) return what;
  if (const char* what = find_in_objects(t)) return what;
  if (const char* what = find_in_bodies(t)) return what;
  if (const char* what = find_in_yielding(t)) return what;
  if (const char* what = find_in_masses(t)) return what;
  if (const char* what = find_in_hooks(t)) return what;
  if (const char* what = find_in_pairs(t, t.pairs.pair, t.pairs.manifold)) return what;
  if (const char* what = find_in_pairs(t, t.pairs.sleeping.pair, t.pairs.sleeping.manifold)) return what;
  if (const char* what = find_in_contacts(t)) return what;
  if (const char* what = find_in_element_contacts(t)) return what;
  return find_in_rope_contacts(t);
}

void check_tables([[maybe_unused]] const Tables& t) {
  HOOKE_VALIDATE(find_disagreement(t));
}

}  // namespace hooke::state
