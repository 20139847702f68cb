#include "build/build.h"
#include "build/checks.h"
#include "build/hook_ends.h"

#include <algorithm>
#include <cmath>

namespace hooke::build {

namespace {

using state::Hook;
using state::HookPlace;
using state::Tables;

using DMat3 = Matrix3<double>;
using DQuat = Quaternion<double>;

constexpr double kPi = 3.14159265358979323846;

double to_double(Real value) {
  return static_cast<double>(value);
}

void check_limits(const HookLimits& limits, const std::string& field, Checks& checks) {
  checks.require(limits.lower <= limits.upper, field, "must have lower not above upper")
      .require(to_double(limits.lower) < HUGE_VAL && to_double(limits.upper) > -HUGE_VAL, field,
               "must leave some value in between");
  for (const Real bound : {limits.lower, limits.upper}) {
    const bool good = std::isinf(bound) || std::abs(to_double(bound)) <= limits::kPlace;
    checks.require(good, field, to_double(bound), "must be within 1e9, or infinite");
  }
}

void check_spring(const HookSpring& spring, const std::string& field, Checks& checks) {
  checks.up_to(field + "stiffness", to_double(spring.stiffness), limits::kStiffness)
      .up_to(field + "damping", to_double(spring.damping), limits::kResistance)
      .in_range(field + "target", to_double(spring.target), -limits::kPlace, limits::kPlace);
}

void check_motor(const HookMotor& motor, const std::string& field, Checks& checks) {
  checks.in_range(field + "speed", to_double(motor.speed), -limits::kSpeed, limits::kSpeed)
      .not_negative(field + "max_force", to_double(motor.max_force));
}

void check_freedom(const HookFreedom& freedom, const std::string& field, Checks& checks) {
  check_limits(freedom.limits, field + ".limits", checks);
  check_spring(freedom.spring, field + ".spring.", checks);
  check_motor(freedom.motor, field + ".motor.", checks);
}

/// Whether `second` is across `axis` enough to define the second axis.
bool is_across(Vec3 axis, Vec3 second) {
  const DVec3 a = normalize(vector_cast<double>(axis));
  const DVec3 b = normalize(vector_cast<double>(second));
  return length(cross(a, b)) > 1e-3;
}

/// Returns the coordinate axis that is farthest from x, to replace a second axis that is not given.
DVec3 some_direction_across(DVec3 x) {
  const DVec3 size = {std::abs(x.x), std::abs(x.y), std::abs(x.z)};
  if (size.x <= size.y && size.x <= size.z) return {1, 0, 0};
  return size.y <= size.z ? DVec3{0, 1, 0} : DVec3{0, 0, 1};
}

/// Returns the hook's axes in the world. The x axis is along `axis`. The y axis, or the z axis of a wheel, is
/// along the part of `second_axis` across it.
DMat3 axes_of(const HookDesc& desc) {
  const DVec3 x = normalize(vector_cast<double>(desc.axis));
  const DVec3 second = desc.second_axis ? vector_cast<double>(*desc.second_axis) : some_direction_across(x);
  const DVec3 across = normalize(second - dot(second, x) * x);
  if (desc.kind == HookKind::kWheel) return {x, cross(across, x), across};
  return {x, across, cross(x, across)};
}

/// Converts a rotation matrix to a unit quaternion, by the largest of its four components.
DQuat quaternion_of(const DMat3& m) {
  const double trace = m.x.x + m.y.y + m.z.z;
  if (trace > 0) {
    return normalize(DQuat{m.y.z - m.z.y, m.z.x - m.x.z, m.x.y - m.y.x, 1 + trace});
  }
  if (m.x.x >= m.y.y && m.x.x >= m.z.z) {
    return normalize(DQuat{1 + m.x.x - m.y.y - m.z.z, m.y.x + m.x.y, m.z.x + m.x.z, m.y.z - m.z.y});
  }
  if (m.y.y >= m.z.z) {
    return normalize(DQuat{m.y.x + m.x.y, 1 - m.x.x + m.y.y - m.z.z, m.z.y + m.y.z, m.z.x - m.x.z});
  }
  return normalize(DQuat{m.z.x + m.x.z, m.z.y + m.y.z, 1 - m.x.x - m.y.y + m.z.z, m.x.y - m.y.x});
}

template <class To, class From>
Quaternion<To> quaternion_cast(Quaternion<From> q) {
  return {static_cast<To>(q.x), static_cast<To>(q.y), static_cast<To>(q.z), static_cast<To>(q.w)};
}

/// Gives an end its anchor and axes, in the frame of its body or of the world. A point has no frame, so its
/// anchor stays zero.
void place(const state::Bodies& bodies, DVec3 anchor, DQuat axes, HookPlace& end) {
  end.axes = quaternion_cast<Real>(axes);
  if (end.is_point()) return;
  end.anchor = anchor;
  if (end.body == HookPlace::kWorld) return;
  const DQuat inverse = conjugate(normalize(quaternion_cast<double>(bodies.rotation[end.body])));
  end.anchor = rotate(inverse, anchor - bodies.center[end.body]);
  end.axes = quaternion_cast<Real>(inverse * axes);
}

constexpr HookFreedom kLocked = {.locked = true};

/// Returns the freedoms of a hook of this kind; `distance` is that of its anchors [m].
std::array<HookFreedom, 6> freedoms_of(const HookDesc& desc, double distance) {
  const HookFreedom moving = {.limits = desc.limits, .spring = desc.spring, .motor = desc.motor};
  switch (desc.kind) {
    case HookKind::kBall: {
      const HookFreedom turn = {.spring = {desc.spring.stiffness, desc.spring.damping},
                                .motor = {Real(0), desc.motor.max_force}};
      HookFreedom twist = turn;
      twist.limits = desc.limits;
      twist.motor.speed = desc.motor.speed;
      return {kLocked, kLocked, kLocked, twist, turn, turn};
    }
    case HookKind::kHinge:
      return {kLocked, kLocked, kLocked, moving, kLocked, kLocked};
    case HookKind::kSlider:
      return {moving, kLocked, kLocked, kLocked, kLocked, kLocked};
    case HookKind::kFixed:
      return {kLocked, kLocked, kLocked, kLocked, kLocked, kLocked};
    case HookKind::kDistance:
      return {line_freedom(moving, static_cast<Real>(distance)), {}, {}, {}, {}, {}};
    case HookKind::kWheel: {
      HookFreedom suspension = moving;
      suspension.motor = {};
      return {suspension, kLocked, kLocked, desc.steering, kLocked, {.motor = desc.motor}};
    }
    case HookKind::kRopeSlide:
      return {HookFreedom{.limits = {Real(-1), Real(1)}}, kLocked, kLocked, {}, {}, {}};
    case HookKind::kSixDegrees:
      break;
  }
  return desc.freedoms;
}

/// Replaces limits that leave one value only by a lock.
void lock_closed_limits(HookFreedom& freedom) {
  if (!is_closed(freedom.limits)) return;
  freedom = {.locked = true, .limits = freedom.limits, .spring = {.target = freedom.limits.lower}};
}

bool share_particle(const HookPlace& a, const HookPlace& b) {
  const auto end_a = a.particle.begin() + a.particle_count;
  return std::any_of(b.particle.begin(), b.particle.begin() + b.particle_count,
                     [&](std::uint32_t p) { return std::find(a.particle.begin(), end_a, p) != end_a; });
}

bool is_dynamic(const Tables& t, std::uint32_t body) {
  return body != HookPlace::kWorld && t.bodies.traits[body].kind == BodyKind::kDynamic;
}

/// Whether an end is a body that may become soft.
bool may_yield(const Tables& t, const HookPlace& end) {
  return !end.is_point() && state::yielding_row(t, end.body) != Tables::kNoRow;
}

/// Checks whether a hook of this kind can hold these two ends.
Result<void> check_ends(HookKind kind, const HookPlace& a, const HookPlace& b, const Tables& t) {
  const auto wrong = [](const char* where, const char* what) {
    return Error{ErrorCode::kOutOfRange, where, what};
  };
  const auto is_rope = [&](const HookPlace& end) {
    return end.is_point() && t.objects[end.object].kind == PointRef::Kind::kRope;
  };
  const bool any_point = a.is_point() || b.is_point();
  const bool yields = may_yield(t, a) || may_yield(t, b);
  if (yields && (kind == HookKind::kSlider || kind == HookKind::kWheel || kind == HookKind::kSixDegrees)) {
    return Error{
        ErrorCode::kUnsupported, "hook.kind",
        "cannot hold a body that yields, whose points have no axes; hold it by ball, hinge, fixed or "
        "distance hooks, or hook it to a body that has the freedom"};
  }
  if (kind == HookKind::kRopeSlide) {
    if (!is_rope(a)) return wrong("hook.a", "must be a rope, along which `b` slides");
    if (is_rope(b) && b.object == a.object) return wrong("hook.b", "must not be of the rope it slides along");
    return {};
  }
  if (!any_point) {
    if (a.body == b.body) return wrong("hook.b", "must be another body than `a`, or the world");
    if (!is_dynamic(t, a.body) && !is_dynamic(t, b.body))
      return wrong("hook", "needs a dynamic body at one end at least");
    return {};
  }
  if (kind == HookKind::kSlider) {
    if (a.is_point())
      return wrong("hook.a", "must be a body or the world: a point has no axes to slide along");
    return {};
  }
  if (kind != HookKind::kBall && kind != HookKind::kDistance)
    return wrong("hook.kind", "must be ball, slider, distance or rope_slide: a point has no rotation");
  if (a.is_point() && b.is_point() && a.object == b.object && share_particle(a, b))
    return wrong("hook.b", "must be another place than `a`");
  return {};
}

/// How far a rope may be from what is to slide along it, over the length of a segment [ratio]: a chord is so
/// far from its curve where that bends as sharply as ropes of a few segments do. With this much a rope of 1
/// kg in 11 segments of 9 cm gets 0.8 mJ.
constexpr double kMostSlideGap = 0.1;

/// Positions in the world at which a hook holds its two ends [m].
struct Anchors {
  DVec3 a, b;
};

DVec3 wanted_anchor_b(const HookDesc& desc) {
  return desc.kind == HookKind::kDistance ? desc.anchor_b.value_or(desc.anchor) : desc.anchor;
}

/// Points and connection points are held where they are, and the other end is held at the same place.
/// Distances and rope slides keep both anchors.
Anchors anchors_of(const HookDesc& desc, const FoundEnd& a, const FoundEnd& b) {
  Anchors anchors = {a.is_given ? a.position : desc.anchor, b.is_given ? b.position : wanted_anchor_b(desc)};
  if (desc.kind == HookKind::kDistance || desc.kind == HookKind::kRopeSlide) return anchors;
  if (a.is_given && !b.is_given) anchors.b = a.position;
  if (b.is_given && !a.is_given) anchors.a = b.position;
  return anchors;
}

/// Refuses a slide whose rope does not go through what is to slide along it. The rows of the slide would draw
/// the two together at once: a rope of 1 kg that was 0.3 m off got 400 J.
Result<void> check_slide(const HookDesc& desc, const FoundEnd& a, const FoundEnd& b, const Tables& t) {
  const state::Deformable& rope = t.objects[a.place.object];
  const DVec3 wanted = anchors_of(desc, a, b).b;
  const HookPlace nearest = nearest_place(t, rope, wanted);
  DVec3 place = rope.origin;
  auto most = static_cast<double>(2 * t.particles.position[rope.particles.first].radius);
  for (std::uint32_t i = 0; i < nearest.particle_count; ++i) {
    place += static_cast<double>(nearest.weight[i]) *
             vector_cast<double>(t.particles.position[nearest.particle[i]].x);
  }
  for (std::uint32_t i = rope.segments.first; i < rope.segments.end(); ++i)
    most = std::max(most, kMostSlideGap * static_cast<double>(t.segments.rest_length[i]));
  const double gap = length(wanted - place);
  if (gap <= most) return {};
  return Error{ErrorCode::kOutOfRange, b.is_given ? "hook.b" : "hook.anchor",
               "is " + std::to_string(gap) + " m off the rope that it is to slide along, more than " +
                   std::to_string(most) + " m (its thickness, or a tenth of a segment); put it at (" +
                   std::to_string(place.x) + ", " + std::to_string(place.y) + ", " + std::to_string(place.z) +
                   "), which is the nearest place of the rope, or lay the rope through it"};
}

/// Where the search for the nearest place of an end begins [m]: at the other end if that has a connection
/// point, and else at the anchor.
Result<DVec3> search_start(const HookEnd& other, DVec3 anchor, const char* where, const Tables& t) {
  if (other.connection_point.empty()) return anchor;
  const Result<FoundEnd> found = find_end(other, anchor, where, t);
  if (!found) return found.error();
  return found.value().position;
}

/// Takes both points of the segment at which the slide begins. solver::slide_hooks then gives them their
/// weights.
void begin_slide(const Tables& t, Hook& hook) {
  const state::Deformable& rope = t.objects[hook.a.object];
  const std::uint32_t first = std::min(hook.a.particle[0], rope.particles.end() - 2);
  hook.a.particle = {first, first + 1};
  hook.a.weight = {Real(1), Real(0)};
  hook.a.particle_count = 2;
  hook.a.axes = {};  // The x axis follows the rope; see solver::slide_rotation.
}

}  // namespace

Result<void> validate(const HookMotor& motor) {
  Checks checks("motor");
  check_motor(motor, "", checks);
  return checks.result();
}

Result<void> validate(const HookSpring& spring) {
  Checks checks("spring");
  check_spring(spring, "", checks);
  return checks.result();
}

HookFreedom line_freedom(HookFreedom line, Real distance) {
  line.spring.target += distance;
  line.locked = line == HookFreedom{.spring = {.target = line.spring.target}};
  return line;
}

bool is_closed(const HookLimits& limits) {
  return limits.lower == limits.upper;
}

Result<void> validate(const HookDesc& desc) {
  Checks checks("hook");
  checks.require(desc.kind <= HookKind::kRopeSlide, "kind", "must be one of HookKind")
      .place("anchor", desc.anchor)
      .finite("axis", desc.axis)
      .require(length(vector_cast<double>(desc.axis)) > 0, "axis", "must not be zero");
  if (desc.anchor_b) checks.place("anchor_b", *desc.anchor_b);
  if (desc.second_axis) {
    checks.finite("second_axis", *desc.second_axis)
        .require(is_across(desc.axis, *desc.second_axis), "second_axis", "must not be zero or along `axis`");
  }
  check_limits(desc.limits, "limits", checks);
  check_spring(desc.spring, "spring.", checks);
  check_motor(desc.motor, "motor.", checks);
  if (desc.cone) checks.in_range("cone", to_double(*desc.cone), 1e-6, kPi + 1e-6);
  check_freedom(desc.steering, "steering", checks);
  for (std::size_t i = 0; i < desc.freedoms.size(); ++i)
    check_freedom(desc.freedoms[i], indexed("freedoms", i), checks);
  if (desc.kind == HookKind::kDistance) {
    checks.require(desc.limits.upper > Real(0), "limits", "must allow some distance");
  }
  checks.require(desc.break_force > Real(0), "break_force", to_double(desc.break_force), "must be positive")
      .require(desc.break_torque > Real(0), "break_torque", to_double(desc.break_torque), "must be positive");
  return checks.result();
}

void append_hook(const HookDesc& desc, const FoundEnd& a, const FoundEnd& b, Tables& t) {
  const Anchors anchors = anchors_of(desc, a, b);
  const DQuat axes = quaternion_of(axes_of(desc));
  Hook hook = {.kind = desc.kind,
               .collide = desc.collide,
               .a = a.place,
               .b = b.place,
               .break_force = desc.break_force,
               .break_torque = desc.break_torque,
               .freedom = freedoms_of(desc, length(anchors.b - anchors.a)),
               .cone = desc.kind == HookKind::kBall ? desc.cone.value_or(kRigid) : kRigid};
  place(t.bodies, anchors.a, axes, hook.a);
  place(t.bodies, anchors.b, axes, hook.b);
  if (hook.holds_point()) {
    for (int i = 3; i < 6; ++i) hook.freedom[i] = {};
    hook.cone = kRigid;
  }
  if (hook.kind == HookKind::kRopeSlide) begin_slide(t, hook);
  std::for_each(hook.freedom.begin(), hook.freedom.end(), lock_closed_limits);
  if (desc.kind == HookKind::kDistance) {
    hook.value[0] = length(anchors.b - anchors.a);
    hook.rest_distance = static_cast<Real>(hook.value[0]);
  }
  t.hooks.push_back(hook);
  ++t.hook_revision;
}

Result<void> add_hook(const HookDesc& desc, Tables& t) {
  const Result<void> good = validate(desc);
  if (!good) return good.error();
  const Result<DVec3> near_a = search_start(desc.b, desc.anchor, "hook.b", t);
  if (!near_a) return near_a.error();
  const Result<FoundEnd> a = find_end(desc.a, near_a.value(), "hook.a", t);
  if (!a) return a.error();
  const Result<DVec3> near_b = search_start(desc.a, wanted_anchor_b(desc), "hook.a", t);
  if (!near_b) return near_b.error();
  const Result<FoundEnd> b = find_end(desc.b, near_b.value(), "hook.b", t);
  if (!b) return b.error();
  Result<void> fits = check_ends(desc.kind, a.value().place, b.value().place, t);
  if (fits && desc.kind == HookKind::kRopeSlide) fits = check_slide(desc, a.value(), b.value(), t);
  if (fits) append_hook(desc, a.value(), b.value(), t);
  return fits;
}

}  // namespace hooke::build
