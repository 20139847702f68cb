#include "world/soft_bodies.h"

#include "base/assert.h"
#include "build/build.h"
#include "build/connection_points.h"
#include "build/soft_forms.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/solid/tetrahedral_hulls.h"
#include "geometry/solid/tetrahedral_mesh.h"
#include "math/polar.h"
#include "math/rotation.h"
#include "math/symmetric.h"
#include "state/body_frames.h"
#include "state/sleeping_pairs.h"
#include "world/object_edits.h"
#include "world/sleep.h"
#include "world/soft_hooks.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace hooke::world {

namespace {

using math::in_double;
using math::in_real;
using state::Deformable;
using state::SoftForm;
using state::Tables;
using state::Yielding;
using Inertia = math::Symmetric3<double>;

/// The motion of a solid as a whole.
struct WholeMotion {
  double mass = 0;                   ///< [kg]
  DVec3 center = {};                 ///< [m]
  DVec3 v = {};                      ///< [m/s]
  DVec3 spin = {};                   ///< Angular momentum about the center [kg m^2/s].
  Inertia inertia = {};              ///< About the center, in world axes [kg m^2].
  DVec3 omega = {};                  ///< [rad/s]
  Quaternion<double> rotation = {};  ///< That which brings the form nearest to the solid.
};

std::uint32_t particle_of(const Tables& t, const Deformable& object, std::uint32_t point) {
  return object.particles.first + t.particles.row_of[object.particles.first + point];
}

DVec3 place_at(const Tables& t, const Deformable& object, std::uint32_t row) {
  return object.origin + vector_cast<double>(t.particles.position[row].x);
}

WholeMotion whole_motion(const Tables& t, const Deformable& object, const SoftForm& form) {
  WholeMotion whole;
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    const auto m = static_cast<double>(t.particles.mass[row]);
    whole.mass += m;
    whole.center += m * (place_at(t, object, row) - object.origin);
    whole.v += m * vector_cast<double>(t.particles.velocity[row].v);
  }
  whole.center = object.origin + 1 / whole.mass * whole.center;
  whole.v = 1 / whole.mass * whole.v;
  Matrix3<double> turn = {{}, {}, {}};
  for (std::uint32_t i = 0; i < form.points.size(); ++i) {
    const std::uint32_t row = particle_of(t, object, i);
    const auto m = static_cast<double>(t.particles.mass[row]);
    const DVec3 p = place_at(t, object, row) - whole.center;
    const DVec3 q = vector_cast<double>(form.points[i]);
    whole.spin += m * cross(p, vector_cast<double>(t.particles.velocity[row].v) - whole.v);
    whole.inertia = whole.inertia + math::inertia_of_point(m, p);
    turn = turn + Matrix3<double>{m * q.x * p, m * q.y * p, m * q.z * p};
  }
  whole.omega = math::inverse(whole.inertia) * whole.spin;
  whole.rotation = math::closest_rotation(turn);
  return whole;
}

/// Says that the narrow phase has seen a soft body where it is. It has no pairs, but its pose is hashed, and
/// whether the narrow phase reads it depends on steps that a restored world has not made.
void note_seen(std::uint32_t body, Tables& t) {
  if (body < t.pairs.seen.size()) t.pairs.seen[body] = {t.bodies.center[body], t.bodies.rotation[body]};
}

/// Puts the frame of a soft body where its solid is.
void follow(const WholeMotion& whole, std::uint32_t body, Tables& t) {
  state::Bodies& b = t.bodies;
  b.center[body] = whole.center;
  b.rotation[body] = normalize(in_real(whole.rotation));
  b.motion[body] = {.v = vector_cast<Real>(whole.v)};
  b.angular_velocity[body] = vector_cast<Real>(whole.omega);
  note_seen(body, t);
}

/// Largest speed of a point relative to the motion of the whole [m/s]. Positions are half a substep of `h`
/// [s] ahead of velocities, so that points are looked at where they were then: what spins without a change of
/// its form is at rest in itself.
Real inner_speed(const Tables& t, const Deformable& object, const WholeMotion& whole, double h) {
  double most = 0;
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    const DVec3 v = vector_cast<double>(t.particles.velocity[row].v) - whole.v;
    const DVec3 p = place_at(t, object, row) - whole.center - 0.5 * h * v;
    most = std::max(most, length_squared(v - cross(whole.omega, p)));
  }
  return static_cast<Real>(std::sqrt(most));
}

void drop_pairs(std::uint32_t body, Tables& t) {
  std::vector<std::uint8_t> goes(t.bodies.traits.size(), 0);
  goes[body] = 1;
  wake_neighbors(t, [body](std::uint32_t row) { return row == body; });
  state::remove_pairs(goes, t.colliders, t.pairs);
  note_seen(body, t);
}

/// Forgets contacts of deformables; the next step finds them again.
void reset_point_contacts(Tables& t) {
  t.contacts = {};
  t.element_contacts.clear();
}

/// Takes a body out of the simulation: its solid has its place.
void set_aside(Yielding& yielding, Tables& t) {
  state::Bodies& b = t.bodies;
  const std::uint32_t body = yielding.body;
  yielding.kind = b.traits[body].kind;
  yielding.mass = b.mass[body];
  b.traits[body].kind = BodyKind::kStatic;
  b.traits[body].collides = false;
  b.mass[body] = {.center = yielding.mass.center, .principal = yielding.mass.principal};
  b.motion[body] = {.v = b.motion[body].v};
  b.free_motion[body] = {};
  b.frozen_inertia[body] = {};
  b.angular_momentum[body] = {};
  b.direct_state[body] = 0;
  state::wake(b, body);
  std::erase(t.moving_bodies, body);
}

// The functions below make a solid a body again.

/// The form that a solid has now, in the frame of its body.
std::shared_ptr<const SoftForm> form_now(const Tables& t, const Deformable& object,
                                         const Yielding& yielding) {
  auto form = std::make_shared<SoftForm>(*yielding.form);
  const Quaternion<double> back = conjugate(in_double(t.bodies.rotation[yielding.body]));
  for (std::uint32_t i = 0; i < form->points.size(); ++i) {
    const DVec3 p = place_at(t, object, particle_of(t, object, i)) - t.bodies.center[yielding.body];
    form->points[i] = vector_cast<Real>(rotate(back, p));
  }
  return form;
}

/// Moves the named places of a body with the matter around them, those of its kind too.
void move_named_places(std::uint32_t body, const SoftForm& before, const SoftForm& after, Tables& t) {
  geometry::TetrahedralMesh mesh = {.tetrahedra = before.tetrahedra};
  for (const Vec3& p : before.points) mesh.points.push_back(vector_cast<double>(p));
  auto places = std::make_shared<state::NamedPlaces>(build::connection_points_of_body(body, t));
  std::vector<DVec3> at;
  for (const state::NamedPlace& place : *places) at.push_back(vector_cast<double>(place.position));
  const std::vector<geometry::TetrahedronPlace> found = geometry::locate(mesh, at);
  const Vec3 origin = -t.bodies.mass[body].center;
  for (std::size_t i = 0; i < places->size(); ++i) {
    state::NamedPlace& place = (*places)[i];
    if (place.name == "center") place.position = {};
    if (place.name == "origin") place.position = origin;
    if (place.name == "center" || place.name == "origin") continue;
    DVec3 sum;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 corner = after.points[mesh.tetrahedra[found[i].tetrahedron][k]];
      sum += found[i].weights[k] * vector_cast<double>(corner);
    }
    place.position = vector_cast<Real>(sum);
  }
  t.bodies.connection_points[body] = std::move(places);
}

state::BodyMass mass_now(const SoftForm& form, const state::BodyMass& before) {
  Inertia inertia = {};
  for (std::size_t i = 0; i < form.points.size(); ++i) {
    inertia = inertia +
              math::inertia_of_point(static_cast<double>(form.mass[i]), vector_cast<double>(form.points[i]));
  }
  const geometry::PrincipalAxes axes = geometry::principal_axes(inertia);
  return {.center = before.center,
          .principal = in_real(axes.rotation),
          .inertia = vector_cast<Real>(axes.moments),
          .mass = before.mass,
          .inverse_mass = before.inverse_mass};
}

/// Makes the body of a row move again, as its solid does, with colliders of its shape now.
void take_up(WorldData& world, Yielding& yielding, const WholeMotion& whole) {
  Tables& t = world.tables;
  state::Bodies& b = t.bodies;
  const std::uint32_t body = yielding.body;
  for (const std::uint32_t collider : state::colliders_of(b, body))
    world.derived.broad_phase.remove(collider);
  build::reshape_body(body, geometry::hulls_of(yielding.form->points, yielding.form->tetrahedra), t);
  b.mass[body] = mass_now(*yielding.form, yielding.mass);
  b.motion[body] = {.v = vector_cast<Real>(whole.v), .inverse_mass = b.mass[body].inverse_mass};
  b.angular_momentum[body] = vector_cast<Real>(whole.spin);
  b.traits[body].kind = yielding.kind;
  b.traits[body].collides = true;
  b.direct_state[body] = state::Bodies::kNew;
  state::wake(b, body);
  t.moving_bodies.insert(std::lower_bound(t.moving_bodies.begin(), t.moving_bodies.end(), body), body);
  world.derived.placed_bodies.push_back(body);
  world.derived.boxes_are_current = false;
}

void freeze(WorldData& world, Yielding& yielding, const WholeMotion& whole, double time) {
  Tables& t = world.tables;
  const std::uint32_t object = soft_object(t, yielding);
  const SolidId solid = t.solid_slots.id_of(yielding.solid);
  const std::shared_ptr<const SoftForm> form = form_now(t, t.objects[object], yielding);
  move_named_places(yielding.body, *yielding.form, *form, t);
  yielding.form = form;
  yielding.reshaped = true;
  take_up(world, yielding, whole);
  move_hooks_to_body(object, yielding.body, t);
  wake_near_points(t.objects[object], t);
  remove_object(t, object);
  yielding.solid = 0;
  yielding.calm = Real(0);
  world.last_step.events.freezes.push_back({.body = id_of(t, yielding.body),
                                            .solid = solid,
                                            .place = whole.center,
                                            .impulse = yielding.impulse,
                                            .time = time});
}

/// Whether a solid may become a body: nothing holds its points in the world, and it is in one piece.
bool may_freeze(const Tables& t, std::uint32_t object) {
  if (!t.objects[object].split_from.empty() || !t.objects[object].scored.empty()) return false;
  return std::none_of(t.pins.begin(), t.pins.end(),
                      [&](const state::Pin& pin) { return pin.object == object; });
}

}  // namespace

bool soften(WorldData& world, std::uint32_t row, const Blow& blow) {
  Tables& t = world.tables;
  Yielding& yielding = t.yielding[row];
  HOOKE_ASSERT(!yielding.is_soft());
  if (!build::append_soft_form(yielding, t)) {
    yielding.desc.impulse = kRigid;
    return false;
  }
  const auto object = static_cast<std::uint32_t>(t.objects.size()) - 1;
  const SolidId id = t.solid_slots.add(object);
  t.objects[object].slot = id.slot;
  yielding.solid = id.slot;
  yielding.impulse = blow.impulse;
  yielding.calm = Real(0);
  drop_pairs(yielding.body, t);
  push_soft_body(yielding, std::exchange(t.bodies.force[yielding.body], Vec3{}),
                 std::exchange(t.bodies.torque[yielding.body], Vec3{}), t);
  move_hooks_to_solid(yielding.body, object, t);
  set_aside(yielding, t);
  reset_point_contacts(t);
  std::erase(world.derived.placed_bodies, yielding.body);
  world.last_step.events.yields.push_back({.body = id_of(t, yielding.body),
                                           .solid = id,
                                           .place = blow.place,
                                           .impulse = blow.impulse,
                                           .time = blow.time});
  return true;
}

void follow_soft_bodies(WorldData& world, double dt) {
  Tables& t = world.tables;
  if (!t.held_hooks.empty()) drop_orphaned_helpers(t);
  const double h = dt / (t.desc.substeps * t.desc.particle_substeps);
  for (Yielding& yielding : t.yielding) {
    if (!yielding.is_soft()) continue;
    const std::uint32_t object = soft_object(t, yielding);
    HOOKE_ASSERT(object != Tables::kNoRow);
    const WholeMotion whole = whole_motion(t, t.objects[object], *yielding.form);
    follow(whole, yielding.body, t);
    const bool is_still = inner_speed(t, t.objects[object], whole, h) < yielding.desc.freeze_below;
    yielding.calm = is_still ? yielding.calm + static_cast<Real>(dt) : Real(0);
    if (!is_still || yielding.calm < yielding.desc.freeze_after || !may_freeze(t, object)) continue;
    freeze(world, yielding, whole, t.time + dt);
  }
}

void remove_soft_forms_of(const std::vector<std::uint8_t>& goes, Tables& t) {
  for (const Yielding& yielding : t.yielding) {
    if (!yielding.is_soft() || goes[yielding.body] == 0) continue;
    const std::uint32_t object = soft_object(t, yielding);
    wake_near_points(t.objects[object], t);
    remove_object(t, object);
  }
  drop_orphaned_helpers(t);
}

void change_soft_motion(const Yielding& yielding, Vec3 v, Vec3 omega, Tables& t) {
  const Deformable& object = t.objects[soft_object(t, yielding)];
  const WholeMotion whole = whole_motion(t, object, *yielding.form);
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    if (!(t.particles.velocity[row].inverse_mass > Real(0))) continue;
    const Vec3 p = vector_cast<Real>(place_at(t, object, row) - whole.center);
    t.particles.velocity[row].v += v + cross(omega, p);
  }
  follow(whole_motion(t, object, *yielding.form), yielding.body, t);
}

void push_soft_body(const Yielding& yielding, Vec3 force, Vec3 torque, Tables& t) {
  if (force == Vec3{} && torque == Vec3{}) return;
  const Deformable& object = t.objects[soft_object(t, yielding)];
  const WholeMotion whole = whole_motion(t, object, *yielding.form);
  const DVec3 a = 1 / whole.mass * vector_cast<double>(force);
  const DVec3 alpha = math::inverse(whole.inertia) * vector_cast<double>(torque);
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    const DVec3 p = place_at(t, object, row) - whole.center;
    t.particles.force[row] +=
        vector_cast<Real>(static_cast<double>(t.particles.mass[row]) * (a + cross(alpha, p)));
  }
  t.any_force = true;
}

void place_soft_body(const Yielding& yielding, const Pose& pose, Tables& t) {
  Deformable& object = t.objects[soft_object(t, yielding)];
  const WholeMotion whole = whole_motion(t, object, *yielding.form);
  const Quaternion<double> goal = in_double(pose.rotation);
  const Quaternion<double> turn = normalize(goal * conjugate(whole.rotation));
  const DVec3 center = pose.position + rotate(goal, vector_cast<double>(yielding.mass.center));
  const DVec3 origin = {std::floor(center.x + 0.5), std::floor(center.y + 0.5), std::floor(center.z + 0.5)};
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    const DVec3 p = rotate(turn, place_at(t, object, row) - whole.center);
    const DVec3 v = vector_cast<double>(t.particles.velocity[row].v) - whole.v;
    t.particles.position[row].x = vector_cast<Real>(center + p - origin);
    t.particles.velocity[row].v = vector_cast<Real>(whole.v + rotate(turn, v));
  }
  object.origin = origin;
  reset_point_contacts(t);
  wake_near_points(object, t);
  follow(whole_motion(t, object, *yielding.form), yielding.body, t);
}

Vec3 soft_spin(const Yielding& yielding, Vec3 angular_impulse, const Tables& t) {
  const WholeMotion whole = whole_motion(t, t.objects[soft_object(t, yielding)], *yielding.form);
  return vector_cast<Real>(math::inverse(whole.inertia) * vector_cast<double>(angular_impulse));
}

}  // namespace hooke::world
