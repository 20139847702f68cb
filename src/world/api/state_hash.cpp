#include "world/api/state_hash.h"

#include "base/hash.h"

#include <type_traits>

/// \file
/// Structs are hashed field by field, because the padding between fields has no meaning. Fields are left out
/// if they follow from others, or if each step writes them before it reads them.

namespace hooke::world {

namespace {

using base::StateHash;
using state::Tables;

template <class... Values>
void add(StateHash& hash, const Values&... values) {
  (hash.add(values), ...);
}

template <class Table>
void add_columns(StateHash& hash, const Table& table) {
  Table::for_each_column(table, [&](const auto& column) { hash.add(column); });
}

void add_optional(StateHash& hash, const std::optional<Real>& value) {
  add(hash, value.has_value(), value.value_or(Real(0)));
}

void add_motion(StateHash& hash, const MotionDesc& m) {
  add(hash, m.kind, m.velocity, m.amplitude, m.frequency_hz, m.phase, m.keyframes.size());
  for (const MotionDesc::Keyframe& key : m.keyframes) add(hash, key.time, key.offset);
}

void add_setting(StateHash& hash, const WorldDesc& desc) {
  add(hash, desc.gravity, desc.substeps, desc.particle_substeps, desc.contact_hz, desc.contact_damping_ratio,
      desc.bias_sweeps, desc.sleeping);
  const WindDesc& wind = desc.wind;
  add(hash, wind.velocity, wind.gust, wind.side_gust, wind.correlation_time, wind.correlation_length,
      wind.seed, wind.gusts, wind.air_density);
  add(hash, desc.materials.size());
  for (const MaterialPairDesc& pair : desc.materials) {
    add(hash, pair.a, pair.b, pair.friction, pair.restitution);
    add_optional(hash, pair.static_friction);
  }
}

void add_fields(StateHash& hash, const Tables& t) {
  add(hash, t.fields.size(), t.force_laws.size());
  for (const state::Field& field : t.fields) {
    const FieldDesc& f = field.desc;
    add(hash, f.kind, f.vector, f.center, f.strength, f.reach, f.falloff, f.height, f.density, f.drag,
        f.time);
  }
  for (const state::ForceLawEntry& law : t.force_laws) hash.add(law.body_law != nullptr);
}

void add_rows(StateHash& hash, const state::Rows& rows) {
  add(hash, rows.first, rows.count);
}

void add_rest_form(StateHash& hash, const state::Deformable& object) {
  add(hash, object.rest_shape != nullptr, object.rest_edges != nullptr);
  if (object.rest_shape) {
    const state::RestShape& rest = *object.rest_shape;
    add(hash, rest.place, rest.mass, rest.volume, rest.inertia, rest.stiffness, rest.damping);
  }
  if (object.rest_edges) hash.add(*object.rest_edges);
}

/// Adds what the description said of contacts with deformables, if it said anything, and whether it is looked
/// at for crossings, if it is.
void add_surface(StateHash& hash, const state::Deformable& object) {
  if (object.surface.may_cross) hash.add(object.surface.may_cross);
  if (object.reports_contacts || object.hit_speed < kRigid)
    add(hash, object.reports_contacts, object.hit_speed);
  const FilterDesc& filter = object.surface.filter;
  const FilterDesc usual = {};
  const bool touches = object.surface.self_contact || object.touches_surfaces;
  if (!touches && filter.category == usual.category && filter.mask == usual.mask &&
      filter.group == usual.group)
    return;
  add(hash, touches, filter.category, filter.mask, filter.group);
}

/// Adds whether segments hold, of ropes that can snap or were cut.
void add_strength(StateHash& hash, const state::Deformable& object, const state::Segments& segments) {
  if (!(object.strength < kRigid) && !object.has_gaps) return;
  hash.add(object.strength);
  for (std::uint32_t row = object.segments.first; row < object.segments.end(); ++row)
    hash.add(segments.hold[row]);
}

/// Adds what cloths and solids take, and where they have split.
void add_tears(StateHash& hash, const state::Deformable& object) {
  if (object.tear_strain < kRigid || !object.split_from.empty())
    add(hash, object.tear_strain, object.split_from);
  if (object.tear_stress < kRigid) hash.add(object.tear_stress);
  if (!object.scored.empty()) hash.add(object.scored);
}

void add_segments(StateHash& hash, const state::Segments& s) {
  add(hash, s.rest_length, s.stiffness, s.damping, s.length_limit, s.tension, s.mean_tension, s.limited,
      s.clamped);
}

void add_objects(StateHash& hash, const Tables& t) {
  hash.add(t.objects.size());
  for (const state::Deformable& o : t.objects) {
    add(hash, o.kind, o.origin, o.columns, o.gas, o.gas_volume, o.bend_stiffness, o.bend_damping,
        o.twist_stiffness, o.twist_rate, o.yield_angle, o.yield_stress, o.touches_ropes, o.repulsion_strength,
        o.repulsion_range, o.friction, o.drag_coefficient, o.lift_coefficient, o.points_drag);
    for (const state::Rows& rows : {o.particles, o.springs, o.bends, o.triangles, o.segments, o.tetrahedra})
      add_rows(hash, rows);
    add_rest_form(hash, o);
    add_surface(hash, o);
    add_strength(hash, o, t.segments);
    add_tears(hash, o);
  }
  add_columns(hash, t.particles);
  add_columns(hash, t.springs);
  add_columns(hash, t.bends);
  add_columns(hash, t.triangles);
  add_segments(hash, t.segments);
  add_columns(hash, t.tetrahedra);
  for (const state::Pin& pin : t.pins) {
    add(hash, pin.object, pin.particle, pin.start, pin.start_time);
    add_motion(hash, pin.motion);
  }
  for (const state::TwistSpan& span : t.twists) {
    add(hash, span.object, span.length, span.angle, span.expected, span.reaction);
    for (const state::TwistClamp& clamp : {span.a, span.b})
      add(hash, clamp.segment, clamp.body, clamp.tangent, clamp.director);
  }
}

/// Adds what contacts of points carry over to the next step.
void add_point_contacts(StateHash& hash, const Tables& t) {
  const state::Contacts& c = t.contacts;
  add(hash, c.particle, c.collider, c.feature, c.normal_force, c.friction_force);
  hash.add(t.element_contacts.size());
  for (const state::ElementContact& element_contact : t.element_contacts) {
    add(hash, element_contact.collider, element_contact.element, element_contact.edge,
        element_contact.feature, element_contact.particle, element_contact.joined, element_contact.normal,
        element_contact.normal_force, element_contact.friction_force, element_contact.clearance);
  }
  hash.add(t.rope_contacts.size());
  for (const state::RopeContact& contact : t.rope_contacts) {
    add(hash, contact.segment_a, contact.segment_b, contact.adjacent, contact.joined, contact.normal,
        contact.normal_force, contact.friction_force, contact.clearance);
  }
}

void add_traits(StateHash& hash, const state::BodyTraits& t) {
  add(hash, t.kind, t.alive, t.collides, t.sensor, t.bullet, t.can_sleep, t.reports_contacts, t.hit_speed);
  add(hash, t.linear_damping, t.angular_damping, t.gravity_scale, t.drag_coefficient, t.magnus_volume);
  add(hash, t.dipole_moment, t.radius, t.inner_radius, t.filter.category, t.filter.mask, t.filter.group);
}

void add_bodies(StateHash& hash, const Tables& t) {
  const state::Bodies& b = t.bodies;
  add(hash, b.center, b.rotation, b.angular_momentum, b.angular_velocity, b.force, b.torque, b.rest_time,
      b.asleep, b.direct_state, b.first_collider, b.collider_count, b.path_start, b.path_time, t.free_bodies);
  for (std::size_t i = 0; i < b.traits.size(); ++i) {
    add(hash, b.motion[i].v, b.motion[i].inverse_mass);
    const state::BodyMass& mass = b.mass[i];
    add(hash, mass.center, mass.principal, mass.inertia, mass.mass, mass.inverse_mass);
    add_traits(hash, b.traits[i]);
    add_motion(hash, b.path[i]);
  }
}

void add_colliders(StateHash& hash, const Tables& t) {
  const state::Colliders& c = t.colliders;
  add(hash, c.body, c.position, c.rotation);
  for (std::size_t i = 0; i < c.body.size(); ++i) {
    const state::ColliderShape& s = c.shape[i];
    add(hash, s.shape.kind, s.shape.radius, s.shape.half_height, s.shape.half_extents);
    for (const auto& mesh : {s.mesh, s.whole}) hash.add(mesh ? mesh->hash : std::uint64_t{0});
    const ContactDesc& surface = c.surface[i];
    add(hash, surface.friction, surface.restitution, surface.rolling_friction, surface.spinning_friction,
        surface.surface_velocity, surface.material);
    add_optional(hash, surface.static_friction);
  }
  for (const state::Rows& rows : t.free_colliders) add_rows(hash, rows);
}

void add_manifold(StateHash& hash, const state::Manifold& m) {
  add(hash, m.collider_a, m.collider_b, m.patch, m.point_count, m.normal, m.friction_impulse, m.twist_impulse,
      m.rolling_impulse, m.touching, m.largest_impulse);
  for (std::int32_t i = 0; i < m.point_count; ++i) {
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(i)];
    add(hash, p.anchor_a, p.anchor_b, p.separation, p.normal_impulse, p.key);
  }
}

void add_pairs(StateHash& hash, const state::Pairs& pairs) {
  for (const auto* list : {&pairs.pair, &pairs.sleeping.pair}) {
    hash.add(list->size());
    for (const state::Pair& pair : *list) {
      add(hash, pair.collider_a, pair.collider_b, pair.gap, pair.drift.displacement, pair.drift.angle_a,
          pair.drift.angle_b, pair.axis, pair.tested);
    }
  }
  for (const state::SeenPose& seen : pairs.seen) add(hash, seen.center, seen.rotation);
  for (const state::Manifold& m : pairs.manifold) add_manifold(hash, m);
  for (const state::Manifold& m : pairs.sleeping.manifold) add_manifold(hash, m);
}

void add_place(StateHash& hash, const state::HookPlace& end) {
  add(hash, end.body, end.anchor, end.axes, end.object, end.particle_count, end.particle, end.weight);
}

void add_hooks(StateHash& hash, const Tables& t) {
  hash.add(t.hooks.size());
  for (const state::Hook& hook : t.hooks) {
    add(hash, hook.kind, hook.collide, hook.break_force, hook.break_torque, hook.cone, hook.rest_distance);
    add_place(hash, hook.a);
    add_place(hash, hook.b);
    add(hash, hook.impulse, hook.angular_impulse, hook.value, hook.row_impulse, hook.last_impulse,
        hook.last_angular_impulse, hook.energy_debt, hook.spring_energy, hook.inside);
    for (const HookFreedom& freedom : hook.freedom) {
      add(hash, freedom.locked, freedom.limits, freedom.spring, freedom.motor);
    }
  }
}

void add_yielding(StateHash& hash, const Tables& t) {
  for (const state::Yielding& y : t.yielding) {
    const YieldsDesc& d = y.desc;
    add(hash, y.body, d.impulse, d.young_modulus, d.poisson_ratio, d.damping, d.yield_stress, d.thickness,
        d.freeze_below, d.freeze_after);
    add(hash, y.form->points, y.form->mass, y.form->tetrahedra, y.reshaped, y.solid, y.impulse, y.calm);
    add(hash, y.kind, y.mass.center, y.mass.principal, y.mass.inertia, y.mass.mass);
  }
  for (const state::HeldHook& held : t.held_hooks) {
    add(hash, held.hook.slot, held.helpers, held.hook.kind, held.hook.cone, held.hook.rest_distance);
    add(hash, held.hook.a.axes, held.hook.b.axes, held.hook.value);
    for (const HookFreedom& freedom : held.hook.freedom)
      add(hash, freedom.locked, freedom.limits, freedom.spring, freedom.motor);
  }
}

}  // namespace

std::uint64_t hash_of(const Tables& t) {
  StateHash hash;
  add(hash, t.time, t.step_count, t.substep, t.body_substep);
  add_setting(hash, t.desc);
  add_fields(hash, t);
  add_objects(hash, t);
  add_point_contacts(hash, t);
  add_bodies(hash, t);
  add_colliders(hash, t);
  add_pairs(hash, t.pairs);
  add_hooks(hash, t);
  add_yielding(hash, t);
  return hash.value();
}

std::uint64_t hash_of(const MeshDesc& mesh) {
  StateHash hash;
  add(hash, mesh.positions, mesh.triangles);
  return hash.value();
}

}  // namespace hooke::world
