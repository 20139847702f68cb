#include "solver/body/body_forces.h"

#include "base/assert.h"
#include "elements/fields.h"
#include "geometry/convex/immersion.h"
#include "math/rotation.h"
#include "solver/air/liquids.h"
#include "solver/air/wind.h"
#include "state/body_frames.h"

namespace hooke::solver {

namespace {

/// The state of one body in the middle of a step.
struct BodyNow {
  std::uint32_t row = 0;
  DVec3 center = {};  ///< Center of mass [m].
  Quat rotation = {};
  double mass = 0;  ///< Mass [kg].
  DVec3 v = {};
  Vec3 omega = {};
};

struct Push {
  DVec3 force = {};   ///< Force at the center of mass [N].
  DVec3 torque = {};  ///< Torque [N m].
};

BodyNow body_now(const state::Bodies& bodies, std::uint32_t row) {
  const Pose pose = state::pose_now(bodies, row);
  const state::MotionRecord& m = bodies.motion[row];
  return {.row = row,
          .center = pose.position,
          .rotation = pose.rotation,
          .mass = static_cast<double>(bodies.mass[row].mass),
          .v = vector_cast<double>(m.v),
          .omega = bodies.scale[row] * m.omega_scaled};
}

/// A shape of the body, placed relative to the body's center of mass.
geometry::PlacedShape placed(const BodyNow& body, const state::Colliders& colliders, std::uint32_t collider) {
  const Quaternion<double> rotation = math::in_double(body.rotation);
  const state::ColliderShape& own = colliders.shape[collider];
  return {.shape = own.shape,
          .hull = own.hull.get(),
          .rotation = rotation * math::in_double(colliders.rotation[collider]),
          .position = rotate(rotation, vector_cast<double>(colliders.position[collider]))};
}

/// The rotation by which the unit vector `up` becomes the y axis.
Quaternion<double> turn_to_y(DVec3 up) {
  if (up.y < -1 + 1e-12) return {1, 0, 0, 0};  // Half a turn about x.
  return normalize(Quaternion<double>{-up.z, 0, up.x, 1 + up.y});
}

void add_liquid(const FieldDesc& liquid, const BodyNow& body, const Surroundings& around,
                const state::Bodies& bodies, Push& push) {
  const LiquidSurface surface(liquid, around.desc.gravity);
  const double level = surface.depth(body.center);
  if (level + static_cast<double>(bodies.traits[body.row].radius) <= 0) return;
  // Shapes are cut across y: the body is rotated so that the surface lies across y.
  const Quaternion<double> turn = turn_to_y(surface.up);
  geometry::Immersion all;
  for (const std::uint32_t c : state::colliders_of(bodies, body.row)) {
    geometry::PlacedShape shape = placed(body, around.colliders, c);
    shape.rotation = turn * shape.rotation;
    shape.position = rotate(turn, shape.position);
    const geometry::Immersion part = geometry::immersion(shape, level);
    all.volume += part.volume;
    all.moment += rotate(conjugate(turn), part.moment);
  }
  const DVec3 lift = -liquid.density * vector_cast<double>(around.desc.gravity);
  push.force += all.volume * lift;
  push.torque += cross(all.moment, lift);
  const double rate = liquid.drag * liquid.density * all.volume / body.mass;
  const double slowing = rate / (1 + static_cast<double>(around.h) * rate);
  const Vec3 momentum = state::angular_momentum_of(bodies.mass[body.row], body.rotation, body.omega);
  push.force -= (slowing * body.mass) * (body.v - vector_cast<double>(liquid.vector));
  push.torque -= slowing * vector_cast<double>(momentum);
}

void add_air(const BodyNow& body, const Surroundings& around, const state::Bodies& bodies, Push& push) {
  const state::BodyTraits& traits = bodies.traits[body.row];
  if (traits.drag_coefficient == Real(0) && traits.magnus_volume == Real(0)) return;
  const auto h = static_cast<double>(around.h);
  const auto density = static_cast<double>(around.desc.wind.air_density);
  const DVec3 given = push.force + vector_cast<double>(bodies.force[body.row]);
  const DVec3 gravity = vector_cast<double>(traits.gravity_scale * around.desc.gravity);
  const DVec3 other_acceleration = gravity + (1 / body.mass) * given;
  const Vec3 wind = wind_at(around.desc.wind, body.center, around.time, around.step);
  const DVec3 u = body.v + (0.5 * h) * other_acceleration - vector_cast<double>(wind);
  const double speed = length(u);
  if (!(speed > 0) || !(density > 0)) return;
  double area = 0;
  if (traits.drag_coefficient > Real(0)) {
    for (const std::uint32_t c : state::colliders_of(bodies, body.row))
      area += geometry::shadow_area(placed(body, around.colliders, c), (1 / speed) * u);
  }
  const double drag = 0.5 * density * static_cast<double>(traits.drag_coefficient) * area * speed;
  push.force -= (drag / (1 + h * drag / body.mass)) * u;
  const double turning = static_cast<double>(traits.magnus_volume) * density / body.mass;
  const DVec3 turned = rotate(math::quaternion_of((h * turning) * vector_cast<double>(body.omega)), u);
  push.force += (body.mass / h) * (turned - u);
}

}  // namespace

void add_body_forces(std::span<const std::uint32_t> rows, const Surroundings& around, state::Bodies& bodies) {
  for (const std::uint32_t i : rows) {
    if (!is_dynamic(bodies, i)) continue;
    const BodyNow body = body_now(bodies, i);
    HOOKE_ASSERT(body.mass > 0);
    Push push;
    for (const state::Field& field : around.fields) {
      push.force += body.mass * elements::acceleration(field.desc, body.center);
      if (field.desc.kind == FieldDesc::Kind::kLiquid) add_liquid(field.desc, body, around, bodies, push);
    }
    add_air(body, around, bodies, push);
    bodies.force[i] += vector_cast<Real>(push.force);
    bodies.torque[i] += vector_cast<Real>(push.torque);
  }
}

}  // namespace hooke::solver
