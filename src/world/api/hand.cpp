#include "hooke/hand.h"

#include "base/float_environment.h"
#include "build/checks.h"

#include <cmath>
#include <numbers>

namespace hooke {

namespace {

/// Mass of the ball between the spring and a deformable, as a share of the object's. It is not so light that
/// the hook to the point loses digits, and not so heavy that what is held feels it.
constexpr Real kBallShare = Real(0.02);
constexpr Real kHandRadius = Real(0.01);  ///< Radius of the bodies of a hand, which touch nothing [m].

Result<void> check_hand(const HandDesc& desc) {
  build::Checks checks("hand");
  const auto max_force = static_cast<double>(desc.max_force);
  checks.in_range("frequency_hz", static_cast<double>(desc.frequency_hz), 0.1, 30)
      .in_range("damping_ratio", static_cast<double>(desc.damping_ratio), 0, 10)
      .require(max_force > 0, "max_force", max_force, "must be positive")
      .up_to("margin", static_cast<double>(desc.margin), limits::kSize);
  if (desc.mass) {
    checks.in_range("mass", static_cast<double>(*desc.mass), limits::kLeastMass, limits::kMass);
  }
  return checks.result();
}

Real mass_of_object(const World& world, PointRef object) {
  switch (object.kind) {
    case PointRef::Kind::kRope:
      return world.mass(RopeId{object.slot, object.generation, object.world});
    case PointRef::Kind::kCloth:
      return world.mass(ClothId{object.slot, object.generation, object.world});
    case PointRef::Kind::kSolid:
      return world.mass(SolidId{object.slot, object.generation, object.world});
    case PointRef::Kind::kParticles:
      return world.mass(ParticlesId{object.slot, object.generation, object.world});
    case PointRef::Kind::kNone:
      break;
  }
  return Real(0);
}

/// Describes one of the two bodies of a hand: it is felt by nothing but hooks.
BodyDesc body_of_hand(BodyKind kind, DVec3 at) {
  return {.kind = kind,
          .shape = Shape::sphere(kHandRadius),
          .position = at,
          .gravity_scale = Real(0),
          .collides = false,
          .can_sleep = true};
}

/// Velocity of the point of a body that is at `place` [m/s].
Vec3 velocity_at(const World& world, BodyId body, DVec3 place) {
  const Vec3 lever = vector_cast<Real>(place - world.center_of_mass(body));
  return world.velocity(body) + cross(world.angular_velocity(body), lever);
}

}  // namespace

Result<bool> Hand::grab_along(World& world, DVec3 origin, DVec3 motion, const HandDesc& desc) {
  const base::FloatEnvironment environment;
  if (const auto good = check_hand(desc); !good) return good.error();
  const auto on_body = world.cast_ray(origin, motion);
  if (!on_body) return on_body.error();
  const auto on_object = world.cast_ray_on_deformables(origin, motion, {.margin = desc.margin});
  if (!on_object) return on_object.error();
  const bool is_body =
      on_body.value() && (!on_object.value() || on_body.value()->fraction <= on_object.value()->fraction);
  if (is_body && !(world.mass(on_body.value()->body) > Real(0))) return false;
  if (!is_body && !on_object.value()) return false;
  const Result<void> grabbed =
      is_body ? grab(world, on_body.value()->body, on_body.value()->point, desc)
              : grab(world, on_object.value()->place.nearest, on_object.value()->place.point, desc);
  if (!grabbed) return grabbed.error();
  return true;
}

Result<void> Hand::grab(World& world, BodyId body, DVec3 at, const HandDesc& desc) {
  const base::FloatEnvironment environment;
  if (const auto good = check_hand(desc); !good) return good;
  if (const auto found = world.find_place({.body = body}); !found || !body) {
    return Error{ErrorCode::kStaleId, "body", "is gone"};
  }
  const Real mass = world.mass(body);
  if (!(mass > Real(0))) {
    return Error{ErrorCode::kOutOfRange, "body", "is not dynamic: nothing can pull it"};
  }
  release(world);
  // A body that yields may be points at any time, which the spring itself cannot hold.
  Result<void> held = Error{ErrorCode::kUnsupported, "body", "is soft"};
  if (!world.soft_form(body)) held = hold(world, {.body = body}, at, desc, mass);
  if (!held && held.error().code == ErrorCode::kUnsupported)
    held = hold_by_ball(world, {.body = body}, at, desc, mass);
  if (held) body_ = body;
  return held;
}

Result<void> Hand::grab(World& world, PointRef object, DVec3 at, const HandDesc& desc) {
  const base::FloatEnvironment environment;
  if (const BodyId body = world.body_of(object)) return grab(world, body, at, desc);
  if (const auto good = check_hand(desc); !good) return good;
  const Real mass = mass_of_object(world, object);
  if (!(mass > Real(0))) return Error{ErrorCode::kStaleId, "object", "is gone"};
  release(world);
  object.index = PointRef::kNearest;
  const Result<void> held = hold_by_ball(world, {.point = object}, at, desc, mass);
  if (held) object_ = object;
  return held;
}

Result<void> Hand::hold_by_ball(World& world, const HookEnd& end, DVec3 at, const HandDesc& desc, Real mass) {
  BodyDesc ball = body_of_hand(BodyKind::kDynamic, at);
  ball.mass = kBallShare * mass;
  const Result<BodyId> added = world.add_body(ball);
  if (!added) return added.error();
  ball_ = added.value();
  const auto tie = [&](DVec3 place) {
    return world.add_hook({.kind = HookKind::kBall, .a = end, .b = {.body = ball_}, .anchor = place});
  };
  Result<HookId> tied = tie(at);
  DVec3 place = at;
  if (tied) {
    // The nearest place of the object is not quite where it was grabbed: the ball belongs there.
    place = world.hook_anchors(tied.value())[0];
    world.remove(tied.value());
    const Result<void> placed = world.set_pose(ball_, {.position = place});
    tied = placed ? tie(place) : Result<HookId>(placed.error());
  }
  if (tied) ball_hook_ = tied.value();
  Result<void> held =
      tied ? hold(world, {.body = ball_}, place, desc, mass + *ball.mass) : Result<void>(tied.error());
  if (!held) release(world);
  return held;
}

Result<void> Hand::hold(World& world, const HookEnd& end, DVec3 at, const HandDesc& desc, Real mass) {
  const Real w = static_cast<Real>(2 * std::numbers::pi) * desc.frequency_hz;
  const Real m = desc.mass.value_or(mass);
  stiffness_ = m * w * w;
  damping_ = Real(2) * desc.damping_ratio * m * w;
  max_force_ = desc.max_force;
  target_ = at;
  velocity_ = {};
  const Result<BodyId> handle = world.add_body(body_of_hand(BodyKind::kKinematic, at));
  if (!handle) return handle.error();
  HookDesc hook = {.kind = HookKind::kSixDegrees, .a = {.body = handle.value()}, .b = end, .anchor = at};
  for (std::size_t i = 0; i < 3; ++i)
    hook.freedoms[i].spring = {.stiffness = stiffness_, .damping = damping_};
  const Result<HookId> spring = world.add_hook(hook);
  if (!spring) {
    world.remove(handle.value());
    return spring.error();
  }
  handle_ = handle.value();
  spring_ = spring.value();
  return {};
}

bool Hand::is_there(const World& world) const {
  PointRef some_point = object_;
  some_point.index = 0;
  const HookEnd held = body_ ? HookEnd{.body = body_} : HookEnd{.point = some_point};
  return world.find_place({.body = handle_}).has_value() && world.find_place(held).has_value();
}

Result<bool> Hand::before_step(World& world, Real dt) {
  const base::FloatEnvironment environment;
  build::Checks checks("hand");
  checks.place("target", target_)
      .in_range("dt", static_cast<double>(dt), limits::kShortestStep, limits::kLongestStep);
  if (!checks.good()) return checks.result().error();
  if (!holds()) return false;
  if (!is_there(world)) {
    release(world);
    return false;
  }
  const BodyId pulled = ball_ ? ball_ : body_;
  const DVec3 x = place(world);
  const Vec3 v = velocity_at(world, pulled, x);
  const Vec3 change = v - velocity_;
  velocity_ = v;
  const Vec3 wanted = stiffness_ * vector_cast<Real>(target_ - x) - damping_ * v;
  DVec3 handle = target_;
  MotionDesc motion;
  if (length(wanted) > max_force_) {
    // The spring is stretched as far as the force allows, and its end goes along with what it holds: with a
    // free mass that accelerates, and not with one that is stuck. Springs act by velocities at the ends of
    // substeps, whose mean over a step is this share of its change beyond the start.
    const Real share = Real(0.5) + Real(0.5) / static_cast<Real>(world.desc().substeps);
    handle = x + vector_cast<double>(max_force_ / (stiffness_ * length(wanted)) * wanted);
    motion = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = v + share * change};
  }
  const bool is_still =
      motion == MotionDesc{} && world.velocity(handle_) == Vec3{} && handle == world.pose(handle_).position;
  if (is_still) return true;
  Result<void> done = world.set_pose(handle_, {.position = handle});
  if (done) done = world.set_motion(handle_, motion);
  // A push of nothing wakes it.
  if (done) done = world.apply_impulse(pulled, Vec3{});
  if (!done) return done.error();
  return true;
}

bool Hand::release(World& world) {
  const bool held = holds();
  world.remove(spring_);
  world.remove(ball_hook_);
  world.remove(ball_);
  world.remove(handle_);
  *this = Hand{};
  return held;
}

DVec3 Hand::place(const World& world) const {
  return holds() ? world.hook_anchors(spring_)[1] : target_;
}

Vec3 Hand::force(const World& world) const {
  return world.hook_force(spring_).force;
}

}  // namespace hooke
