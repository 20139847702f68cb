/// Tests spinning bodies that also move along: tops, crossed shafts, rolling balls, wobbling discs; and
/// stacked blocks.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace hooke::check {

namespace {

constexpr double kOneDegree = kTau / 360;
constexpr Vec3 kAbout = {Real(0), Real(0), Real(-1)};  ///< Axis by which the y axis leans towards x.

/// Returns the next angle without a jump of 2 pi.
double unwrapped(double before, double now) {
  return now - kTau * std::round((now - before) / kTau);
}

/// Two shafts meet at the origin at an angle and are joined by a cross.
struct CrossedShafts {
  static constexpr double kSpeed = 2;
  double bend;
  DVec3 along;  ///< Direction of the driven shaft.
  Rig rig;
  BodyId driving, driven;

  CrossedShafts(const CheckSetting& setting, double angle)
      : bend(angle), along{std::cos(angle), 0, std::sin(angle)}, rig(setting, weightless()) {
    driving = shaft({1, 0, 0}, -0.5, 0, kSpeed, {.speed = real(kSpeed), .max_force = real(1e4)});
    // At the start the driving fork lies in the plane of both shafts, and the driven shaft has its highest
    // speed.
    driven = shaft(along, 0.5, bend, kSpeed / std::cos(bend), {});
    HookDesc cross{.kind = HookKind::kSixDegrees,
                   .a = {driving},
                   .b = {driven},
                   .axis = {Real(0), Real(0), Real(1)},
                   .second_axis = Vec3{Real(1), Real(0), Real(0)}};
    for (const std::size_t i : {0U, 1U, 2U, 4U}) cross.freedoms[i].locked = true;
    must(rig.world().add_hook(cross));
  }

  BodyId shaft(DVec3 direction, double place, double turn, double speed, const HookMotor& motor) {
    BodyDesc desc = moving(box_of({0.3, 0.05, 0.05}), place * direction);
    desc.rotation = quaternion_about(Vec3{Real(0), Real(-1), Real(0)}, real(turn));
    desc.angular_velocity = real(speed * direction);
    desc.collides = false;
    const BodyId id = rig.add(desc);
    must(rig.world().add_hook({.kind = HookKind::kHinge,
                               .b = {id},
                               .anchor = place * direction,
                               .axis = real(direction),
                               .motor = motor}));
    return id;
  }
  /// Returns how far a shaft has rotated about its own line [rad]; it was upright at the start.
  [[nodiscard]] double angle(BodyId id, DVec3 direction) const {
    const DVec3 up = rig.direction(id, {0, 1, 0});
    return std::atan2(dot(up, cross(direction, DVec3{0, 1, 0})), up.y);
  }
};

/// A disc wobbles steadily on its rim; these are its rate and the energy it lost in 1 s.
struct Wobble {
  double rate = 0, lost = 0;
};

Wobble wobble(const CheckSetting& setting, double lean, double expected) {
  const double radius = 0.5;
  const double half = 0.0025;
  Rig rig(setting, sleepless());
  rig.add(level_ground(1));
  BodyDesc desc = moving(Shape::cylinder(real(radius), real(half)),
                         {0, radius * std::sin(lean) + half * std::cos(lean), 0});
  desc.rotation = quaternion_about(kAbout, real(lean));
  const DVec3 down = {std::cos(lean), -std::sin(lean), 0};  // From the center to the lowest point of the rim.
  desc.angular_velocity = real(-expected * std::sin(lean) * down);
  desc.contact.friction = real(1);
  const BodyId disc = rig.add(desc);
  const double energy = rig.energy().total();
  double angle = 0;
  rig.run(1, [&] {
    const DVec3 axis = rig.direction(disc, {0, 1, 0});
    angle = unwrapped(angle, std::atan2(-axis.z, axis.x));
  });
  return {std::abs(angle), 1 - rig.energy().total() / energy};
}

/// Tells whether blocks that hang over by `share` of the most that statics allows stay on the table.
bool overhang_stands(const CheckSetting& setting, int count, double share) {
  const DVec3 half = {0.2, 0.05, 0.1};
  Rig rig(setting, sleepless());
  BodyDesc table = {.shape = box_of({1, 0.5, 1}), .position = {-1, -0.5, 0}};
  table.contact.friction = real(1);
  rig.add(table);
  double edge = 0;
  BodyId top = {};
  for (int level = 0; level < count; ++level) {
    edge += share * half.x / (count - level);
    BodyDesc block = moving(box_of(half), {edge - half.x, half.y * (2 * level + 1), 0});
    block.contact.friction = real(1);
    top = rig.add(block);
  }
  const double height = rig.center(top).y;
  rig.run(8);
  return rig.center(top).y > height - half.y;
}

}  // namespace

/// The rate is the slow root of I1 W^2 cos(a) - I3 w3 W + m g l = 0 (textbook); the top starts in this
/// motion.
Rows steady_precession(const CheckSetting& setting) {
  const double radius = 0.15;
  const double half = 0.01;
  const double lever = 0.1;
  const double lean = 30 * kOneDegree;
  const double spin = 40;
  const double along = radius * radius / 2;  // Per mass.
  const double across = (3 * radius * radius + 4 * half * half) / 12 + lever * lever;
  const double turn = along * spin;
  const double steep = 2 * across * std::cos(lean);
  const double rate = (turn - std::sqrt(turn * turn - 2 * steep * kGravity * lever)) / steep;
  const DVec3 axis = {std::sin(lean), std::cos(lean), 0};
  const DVec3 omega = DVec3{0, rate, 0} + (spin - rate * std::cos(lean)) * axis;
  Rig rig(setting, sleepless());
  BodyDesc desc = moving(Shape::cylinder(real(radius), real(half)), lever * axis);
  desc.rotation = quaternion_about(kAbout, real(lean));
  desc.angular_velocity = real(omega);
  desc.velocity = real(cross(omega, lever * axis));
  const BodyId top = rig.add(desc);
  must(rig.world().add_hook({.kind = HookKind::kBall, .b = {top}}));
  double nutation = 0;
  const Curve curve = record(rig, 20, [&] {
    const DVec3 now = rig.direction(top, {0, 1, 0});
    nutation = std::max(nutation, std::abs(std::acos(now.y) - lean));
    return now.x;
  });
  return {relative_row("period of a top's precession, 30 deg, 40 rad/s", "s", kTau / rate, curve.period()),
          absolute_row("its nutation in 20 s", "deg", 0, nutation / kOneDegree, 0.2)};
}

/// tan(t2) = tan(t1) / cos(b), so that the driven shaft's speed varies between cos(b) and 1 / cos(b) of the
/// driving one's (Hooke 1676; textbook).
Rows hookes_joint(const CheckSetting& setting) {
  CrossedShafts shafts(setting, 30 * kOneDegree);
  double error = 0;
  double least = HUGE_VAL;
  double most = 0;
  double first = 0;
  shafts.rig.run(7, [&] {
    first = unwrapped(first, shafts.angle(shafts.driving, {1, 0, 0}));
    const double expected = std::atan2(std::sin(first), std::cos(first) * std::cos(shafts.bend));
    error = std::max(error, std::abs(unwrapped(0, shafts.angle(shafts.driven, shafts.along) - expected)));
    const double ratio =
        dot(shafts.rig.spin(shafts.driven), shafts.along) / shafts.rig.spin(shafts.driving).x;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  });
  const double expected = std::cos(shafts.bend);
  return {
      relative_row("least speed of a shaft driven at 30 deg, over the driving one's", "", expected, least),
      relative_row("its largest speed", "", 1 / expected, most),
      absolute_row("largest error of its angle in 2 turns", "deg", 0, error / kOneDegree, 0.1),
      relative_row("way of the driving shaft in 7 s", "rad", 7 * CrossedShafts::kSpeed, first)};
}

/// A ball rolls into an equal one with the angle f between its path and the line of centers. It ends at
/// tan(d) = sin f cos f / (sin^2 f + 2/5) from its path, for smooth balls with e = 1 (Alciatore 2004, TP
/// A.4).
Rows half_ball_hit(const CheckSetting& setting) {
  const double radius = 0.028575;
  const double cut = 30 * kOneDegree;
  const double speed = 1;
  WorldDesc desc = sleepless();
  desc.materials = {{.a = 1, .b = 1, .friction = real(0), .restitution = real(1)},
                    {.a = 1, .b = 2, .friction = real(0.2)}};
  Rig rig(setting, desc);
  BodyDesc table = level_ground(0.2);
  table.contact.material = 2;
  rig.add(table);
  BodyDesc ball = moving(Shape::sphere(real(radius)), {0, radius, 0});
  ball.contact.material = 1;
  rig.add(ball);
  ball.position = {-2 * radius * std::cos(cut) - 0.1, radius, 2 * radius * std::sin(cut)};
  ball.velocity = real(DVec3{speed, 0, 0});
  ball.angular_velocity = real(DVec3{0, 0, -speed / radius});
  const BodyId cue = rig.add(ball);
  rig.run(2);
  const DVec3 v = rig.velocity(cue);
  const double expected =
      std::atan2(std::sin(cut) * std::cos(cut), std::pow(std::sin(cut), 2) + 0.4) / kOneDegree;
  return {absolute_row("way of a rolling ball off a half-ball hit", "deg", expected,
                       std::abs(std::atan2(v.z, v.x)) / kOneDegree, 0.3)};
}

/// A solid ball that rolls on a turntable goes round a circle at 2/7 of the table's rate, whatever its size
/// (Weltner 1979).
Rows ball_on_turntable(const CheckSetting& setting) {
  const double radius = 0.1;
  const double rate = 3;
  const double speed = 0.3;
  const double start = 0.5;
  Rig rig(setting, sleepless());
  BodyDesc table = {.kind = BodyKind::kKinematic,
                    .shape = Shape::cylinder(real(3), real(0.1)),
                    .position = {0, -0.1, 0},
                    .angular_velocity = {real(0), real(rate), real(0)}};
  table.contact.friction = real(1);
  rig.add(table);
  BodyDesc desc = moving(Shape::sphere(real(radius)), {start, radius, 0});
  desc.contact.friction = real(1);
  desc.velocity = real(DVec3{0, 0, speed});
  desc.angular_velocity = real(DVec3{(speed + rate * start) / radius, 0, 0});
  const BodyId ball = rig.add(desc);
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  const Curve curve = record(rig, 20, [&] {
    least = std::min(least, rig.center(ball).z);
    most = std::max(most, rig.center(ball).z);
    return rig.velocity(ball).z;
  });
  const double expected = 2.0 / 7 * rate;
  return {relative_row("period of a ball on a turntable, 3 rad/s", "s", kTau / expected, curve.period()),
          relative_row("diameter of its circle, 0.3 m/s", "m", 2 * speed / expected, most - least)};
}

/// W^2 sin(a) = 4 g / r for a thin disc that rolls on its rim about a center at rest (Moffatt 2000).
Rows eulers_disk(const CheckSetting& setting) {
  Rows rows;
  for (const double lean : {10.0, 20.0}) {
    const double expected = std::sqrt(4 * kGravity / (0.5 * std::sin(lean * kOneDegree)));
    const Wobble found = wobble(setting, lean * kOneDegree, expected);
    const std::string at = " at " + std::to_string(std::lround(lean)) + " deg";
    rows.push_back(relative_row("way round of Euler's disk in 1 s" + at, "rad", expected, found.rate, 0.01));
    rows.push_back(absolute_row("its energy lost in 1 s, share" + at, "", 0, found.lost, 0.01));
  }
  return rows;
}

/// n equal blocks reach out over an edge by L / 2 (1 + 1/2 + ... + 1/n) at most (Hall 2005, "Fun with
/// stacking blocks").
Rows overhanging_blocks(const CheckSetting& setting) {
  const int count = 4;
  return {
      absolute_row("4 blocks at 0.99 of the largest overhang stand", "", 1,
                   overhang_stands(setting, count, 0.99) ? 1 : 0, 0),
      absolute_row("4 blocks at 1.01 of it fall", "", 1, overhang_stands(setting, count, 1.01) ? 0 : 1, 0)};
}

}  // namespace hooke::check
