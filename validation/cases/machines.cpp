/// Tests machines of ropes, drums and bodies: winch, drive, tackle, yo-yo, carousel, brake, and rods that
/// swing bodies.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace hooke::check {

namespace {

constexpr double kRadius = 0.25;  ///< Radius of every drum [m].
/// Distance from its axis to the middle line of a rope on it [m].
constexpr double kMiddle = kRadius + 0.005;
constexpr double kSegment = 0.03;  ///< Approximate length of a rope's segments [m].

/// Describes a drum whose axis lies along z.
BodyDesc drum(BodyKind kind, DVec3 place, double friction) {
  BodyDesc desc{.kind = kind,
                .shape = {.kind = ShapeKind::kCylinder, .radius = real(kRadius), .half_height = real(0.1)},
                .position = place,
                .rotation = quaternion_about(Vec3{real(1), real(0), real(0)}, real(kTau / 4))};
  desc.contact.friction = real(friction);
  return desc;
}

/// Lays a rope strand by strand and arc by arc, in the plane z = 0.
struct Laid {
  RopeDesc desc{.total_mass = real(0.002), .points = {}, .pins = {}, .drag_coefficient = real(0)};

  Laid(DVec3 start, double friction) {
    desc.contact.friction = real(friction);
    desc.points.push_back(start);
  }
  void go(DVec3 to) {
    const DVec3 from = desc.points.back();
    const int segments = std::max(1, static_cast<int>(std::lround(length(to - from) / kSegment)));
    for (int i = 1; i <= segments; ++i)
      desc.points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  }
  /// Lays the rope around a drum, from one angle to another.
  void turn(DVec3 axis, double from, double to) {
    const int segments = static_cast<int>(std::lround(std::abs(to - from) * kMiddle / kSegment));
    for (int i = 1; i <= segments; ++i) {
      const double angle = from + (to - from) * i / segments;
      desc.points.push_back(axis + kMiddle * DVec3{std::cos(angle), std::sin(angle), 0});
    }
  }
  [[nodiscard]] std::uint32_t last() const { return static_cast<std::uint32_t>(desc.points.size()) - 1; }
};

/// Hangs a ball that collides with nothing on a point of a rope.
BodyId hang(Rig& rig, RopeId rope, std::uint32_t index, double mass, DVec3 velocity = {}) {
  const DVec3 place = rig.positions(rope)[index];
  BodyDesc desc = moving(Shape::sphere(real(0.05)), place);
  desc.mass = real(mass);
  desc.velocity = real(velocity);
  desc.collides = false;
  const BodyId body = rig.add(desc);
  must(rig.world().add_hook({.a = {.body = body}, .b = {.point = point(rope, index)}, .anchor = place}));
  return body;
}

HookId on_axle(Rig& rig, BodyId body, const HookMotor& motor) {
  return must(rig.world().add_hook({.kind = HookKind::kHinge,
                                    .b = {body},
                                    .anchor = rig.center(body),
                                    .axis = {real(0), real(0), real(1)},
                                    .motor = motor}));
}

/// A drum of 4 kg has an axle with a motor; a rope over its upper half ends in it and carries a load.
struct Winch {
  static constexpr double kMass = 4, kLoad = 2;
  Rig rig;
  BodyId body, load;
  HookId axle;

  Winch(const CheckSetting& setting, const HookMotor& motor) : rig(setting, without_air()) {
    BodyDesc desc = drum(BodyKind::kDynamic, {}, 1);
    desc.mass = real(kMass);
    body = rig.add(desc);
    axle = on_axle(rig, body, motor);
    Laid rope({-kMiddle, 0, 0}, 1);
    rope.turn({}, kTau / 2, 0);
    rope.go({kMiddle, -1.5, 0});
    const RopeId id = rig.add(rope.desc);
    must(rig.world().add_hook({.a = {body}, .b = {.point = point(id, 0)}, .anchor = {-kMiddle, 0, 0}}));
    load = hang(rig, id, rope.last(), kLoad);
  }
};

/// Marks rows as those of ropes and bodies together.
Rows by_machine(Rows rows) {
  for (CheckRow& row : rows) row.solver = "rope, bodies";
  return rows;
}

/// Returns the tension at the fixed end of a rope over half of a drum that rotates at `spin`, with 1 kg at
/// the other end [N].
double held_end(const CheckSetting& setting, double spin) {
  Rig rig(setting, without_air());
  BodyDesc desc = drum(BodyKind::kKinematic, {}, 0.3);
  desc.angular_velocity = real(DVec3{0, 0, spin});
  rig.add(desc);
  Laid rope({-kMiddle, -1, 0}, 0.3);
  rope.go({-kMiddle, 0, 0});
  rope.turn({}, kTau / 2, 0);
  rope.go({kMiddle, -1, 0});
  rope.desc.pins = {{.point = 0}};
  const RopeId id = rig.add(rope.desc);
  hang(rig, id, rope.last(), 1);
  rig.run(4);
  double sum = 0;
  rig.run(1, [&] { sum += static_cast<double>(rig.world().tensions(id).front()); });
  return sum * setting.dt;
}

}  // namespace

/// A winch lifts at w r, and its motor's torque is m g r, with r to the middle line of the rope.
Rows winch(const CheckSetting& setting) {
  const double spin = 1;
  Winch winch(setting, {.speed = real(spin), .max_force = real(100)});
  winch.rig.run(1);
  const double before = winch.rig.center(winch.load).y;
  winch.rig.run(2);
  const double torque = static_cast<double>(winch.rig.world().hook_force(winch.axle).torque.z);
  return by_machine({relative_row("speed of a load on a winch of 1 rad/s", "m/s", spin * kMiddle,
                                  (winch.rig.center(winch.load).y - before) / 2),
                     relative_row("torque of its motor", "N m", Winch::kLoad * kGravity * kMiddle,
                                  std::abs(torque), 0.01)});
}

/// With a brake of torque M on the axle of a drum a = (m g r - M) / (m r + I / r), I = M R^2 / 2, and zero
/// for M >= m g r. The brake is set only after the rope has taken its load up, which needs more torque.
Rows braked_drum(const CheckSetting& setting) {
  const double pull = Winch::kLoad * kGravity * kMiddle;
  const auto way = [&](double torque, double seconds) {
    Winch winch(setting, {.max_force = real(2 * pull)});
    winch.rig.run(1);
    must(winch.rig.world().in_its_frame().set_motor(winch.axle, {.max_force = real(torque)}));
    const double before = winch.rig.center(winch.load).y;
    winch.rig.run(seconds);
    return before - winch.rig.center(winch.load).y;
  };
  const double inertia = 0.5 * Winch::kMass * kRadius * kRadius;
  // The motion ends before the rope has unwound from its half of the drum.
  const double seconds = 0.5;
  const double a = 0.5 * pull / (Winch::kLoad * kMiddle + inertia / kMiddle);
  return by_machine(
      {relative_row("acceleration of a load against a brake of half its torque", "m/s^2", a,
                    2 * way(0.5 * pull, seconds) / (seconds * seconds)),
       absolute_row("way in 5 s against a brake of 1.02 of it", "mm", 0, 1000 * way(1.02 * pull, 5), 1)});
}

/// A car and a counterweight hang on a rope over a driven drum. They go with the drum while the ratio of
/// their weights is less than e^(mu pi). Beyond it the car falls with (m - c M) g / (m + c M), c = e^(mu pi),
/// M the counterweight's mass, until the rope is as fast as the drum (Euler and Eytelwein; Atwood).
Rows elevator(const CheckSetting& setting) {
  const double car = 2;
  const double counter = 1.2;
  struct Outcome {
    double speed, acceleration, torque;
  };
  const auto run = [&](double friction, double spin) {
    Rig rig(setting, without_air());
    BodyDesc desc = drum(BodyKind::kDynamic, {}, friction);
    desc.mass = real(4);
    const BodyId sheave = rig.add(desc);
    const HookId axle = on_axle(rig, sheave, {.speed = real(spin), .max_force = real(100)});
    Laid rope({-kMiddle, -1.5, 0}, friction);
    rope.go({-kMiddle, 0, 0});
    rope.turn({}, kTau / 2, 0);
    rope.go({kMiddle, -1.5, 0});
    const RopeId id = rig.add(rope.desc);
    const BodyId load = hang(rig, id, rope.last(), car);
    hang(rig, id, 0, counter);
    rig.run(0.5);
    const double before = rig.center(load).y;
    const double speed = rig.velocity(load).y;
    rig.run(0.25);
    return Outcome{.speed = (rig.center(load).y - before) / 0.25,
                   .acceleration = (speed - rig.velocity(load).y) / 0.25,
                   .torque = std::abs(static_cast<double>(rig.world().hook_force(axle).torque.z))};
  };
  const Outcome driven = run(0.3, 0.5);
  const double ratio = std::exp(0.05 * kTau / 2);
  const Outcome slipping = run(0.05, 0);
  const char* why = "contacts of a light rope that runs over a drum need 16 substeps";
  return by_machine({relative_row("speed of an elevator by friction on its driven drum", "m/s", 0.5 * kMiddle,
                                  driven.speed),
                     known_miss(relative_row("torque of its motor", "N m",
                                             (car - counter) * kGravity * kMiddle, driven.torque, 0.01),
                                why),
                     known_miss(relative_row("fall of the car over a drum that stands, too smooth", "m/s^2",
                                             (car - ratio * counter) / (car + ratio * counter) * kGravity,
                                             slipping.acceleration, 0.02),
                                why)});
}

/// A rope slips on a drum that rotates under it, and its tensions differ by the factor e^(mu pi) (Euler and
/// Eytelwein).
Rows driven_rope(const CheckSetting& setting) {
  const double ratio = std::exp(0.3 * kTau / 2);
  return by_machine(
      {relative_row("pull of the fixed end, drum turns away from it", "N", kGravity * ratio,
                    held_end(setting, -2), 0.03),
       relative_row("the same, drum turns towards it", "N", kGravity / ratio, held_end(setting, 2), 0.03)});
}

/// A pulley of mass M in the bight of a rope, and a counterweight m beyond a fixed one, both without
/// friction: the counterweight falls with (m - M / 2) g / (m + M / 4).
Rows tackle(const CheckSetting& setting) {
  const double heavy = 4;
  const double weight = 3;
  Rig rig(setting, without_air());
  BodyDesc desc = drum(BodyKind::kDynamic, {}, 0);
  desc.mass = real(heavy);
  const BodyId pulley = rig.add(desc);
  const DVec3 fixed = {2 * kMiddle, 2, 0};
  rig.add(drum(BodyKind::kStatic, fixed, 0));
  Laid rope({-kMiddle, 2, 0}, 0);
  rope.go({-kMiddle, 0, 0});
  rope.turn({}, kTau / 2, kTau);
  rope.go({kMiddle, 2, 0});
  rope.turn(fixed, kTau / 2, 0);
  rope.go({3 * kMiddle, 1.2, 0});
  rope.desc.pins = {{.point = 0}};
  const RopeId id = rig.add(rope.desc);
  const BodyId counter = hang(rig, id, rope.last(), weight);
  const double seconds = 0.75;
  rig.run(seconds);
  const double a = (weight - heavy / 2) * kGravity / (weight + heavy / 4);
  const char* why = "a body that a light rope carries by contacts alone is not solved with the rope";
  return by_machine({known_miss(relative_row("acceleration of the counterweight", "m/s^2", a,
                                             2 * (1.2 - rig.center(counter).y) / (seconds * seconds)),
                                why),
                     known_miss(relative_row("way of the pulley over that of the counterweight", "", 0.5,
                                             rig.center(pulley).y / (1.2 - rig.center(counter).y)),
                                why)});
}

/// A drum unrolls from a rope that is wound around it: a = g / (1 + I / (m r^2)) (textbook).
Rows unrolling_drum(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  BodyDesc desc = drum(BodyKind::kDynamic, {}, 1);
  desc.mass = real(4);
  const BodyId body = rig.add(desc);
  Laid rope({kMiddle, 1, 0}, 1);
  rope.go({kMiddle, 0, 0});
  rope.turn({}, 0, -1.5 * kTau);
  rope.desc.pins = {{.point = 0}};
  const RopeId id = rig.add(rope.desc);
  must(rig.world().add_hook(
      {.a = {body}, .b = {.point = point(id, rope.last())}, .anchor = rope.desc.points.back()}));
  const double seconds = 0.6;
  rig.run(seconds);
  const double a = kGravity / (1 + 0.5 * std::pow(kRadius / kMiddle, 2));
  return by_machine(
      {relative_row("acceleration of a drum that unrolls", "m/s^2", a,
                    -2 * rig.center(body).y / (seconds * seconds)),
       relative_row("its spin", "rad/s", a * seconds / kMiddle, std::abs(rig.spin(body).z), 0.01)});
}

/// A load hangs on a rope of length l at a distance d from an axis about which it rotates with w. It leans
/// outward by tan a = w^2 (d + l sin a) / g (statics in the rotating frame).
Rows carousel(const CheckSetting& setting) {
  Rows rows;
  for (const double spin : {2.0, 4.0}) {
    const double arm = 0.5;
    const double lean = bisect(0, kTau / 4 - 1e-6, 60, [&](double a) {
      return kGravity * std::tan(a) < spin * spin * (arm + std::sin(a));
    });
    Rig rig(setting, without_air());
    BodyDesc desc = drum(BodyKind::kKinematic, {}, 0);
    desc.collides = false;
    desc.angular_velocity = real(DVec3{0, spin, 0});
    const BodyId wheel = rig.add(desc);
    Laid rope({arm, 0, 0}, 0);
    rope.go({arm + std::sin(lean), -std::cos(lean), 0});
    const RopeId id = rig.add(rope.desc);
    const auto speed = [&](DVec3 x) { return DVec3{0, 0, -spin * x.x}; };
    for (std::uint32_t i = 0; i <= rope.last(); ++i)
      must(rig.world().set_velocity(point(id, i), real(speed(rope.desc.points[i]))));
    must(rig.world().add_hook({.a = {wheel}, .b = {.point = point(id, 0)}, .anchor = {arm, 0, 0}}));
    const BodyId load = hang(rig, id, rope.last(), 5, speed(rope.desc.points.back()));
    rig.run(10);
    rows.push_back(
        relative_row("lean of a load on a carousel of " + std::to_string(std::lround(spin)) + " rad/s", "rad",
                     lean, std::acos(-rig.center(load).y)));
  }
  return by_machine(std::move(rows));
}

namespace {

/// Describes a rod from the origin to (1, 0, 0) of EI = 1 and GJ = 0.8 N m^2, with one more point beyond
/// either end.
RopeDesc rod() {
  RopeDesc desc{.total_mass = real(0.001),
                .bend_stiffness = real(1),
                .twist_stiffness = real(0.8),
                .points = {},
                .pins = {{.point = 0}, {.point = 1}}};
  for (int i = -1; i <= 21; ++i) desc.points.push_back({i / 20.0, 0, 0});
  return desc;
}

BodyId heavy_end(Rig& rig, double half, double mass, DVec3 velocity, DVec3 spin) {
  BodyDesc desc = moving(box_of({half, half, half}), {1, 0, 0});
  desc.mass = real(mass);
  desc.velocity = real(velocity);
  desc.angular_velocity = real(spin);
  desc.collides = false;
  return rig.add(desc);
}

}  // namespace

/// A body on the end of a clamped rod rotates with T = 2 pi sqrt(I L / GJ) where it is clamped, too. It
/// swings with T = 2 pi sqrt(m L^3 / 3 EI) where a ball hook holds it (textbook).
Rows bodies_on_rods(const CheckSetting& setting) {
  WorldDesc space = without_air();
  space.gravity = {};
  Rig turning(setting, space);
  const RopeId wire = turning.add(rod());
  const double mass = 100;
  const double inertia = mass * 4 * 0.05 * 0.05 * 2 / 12;
  const BodyId disk = heavy_end(turning, 0.05, mass, {}, {0.5, 0, 0});
  for (const std::uint32_t i : {21u, 22u}) {
    must(turning.world().add_hook(
        {.a = {disk}, .b = {.point = point(wire, i)}, .anchor = turning.positions(wire)[i]}));
  }
  const Curve turn = record(turning, 20, [&] { return turning.direction(disk, {0, 1, 0}).z; });

  Rig swinging(setting, space);
  RopeDesc beam = rod();
  beam.points.pop_back();
  const RopeId id = swinging.add(beam);
  const BodyId bob = heavy_end(swinging, 0.05, 1, {0, 0.05, 0}, {});
  must(swinging.world().add_hook({.a = {bob}, .b = {.point = point(id, 21)}, .anchor = {1, 0, 0}}));
  const Curve swing = record(swinging, 20, [&] { return swinging.center(bob).y; });
  return by_machine({relative_row("period of a body on a wire in torsion", "s",
                                  kTau * std::sqrt(inertia / 0.8), turn.period(), 0.01),
                     relative_row("period of a body on the end of a rod", "s", kTau * std::sqrt(1.0 / 3),
                                  swing.period(), 0.01)});
}

}  // namespace hooke::check
