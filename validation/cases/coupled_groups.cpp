/// Tests ropes with what they are tied to: pulleys, beads, loads, tables.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace hooke::check {

namespace {

std::vector<DVec3> line(DVec3 from, DVec3 to, int segments) {
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i)
    points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  return points;
}

/// Marks rows as those of coupled groups of ropes.
Rows by_ties(Rows rows) {
  for (CheckRow& row : rows) row.solver = "rope, ties";
  return rows;
}

HookId tie(Rig& rig, BodyId body, RopeId rope, std::uint32_t index) {
  return must(rig.world().add_hook({.a = {.body = body}, .b = {.point = point(rope, index)}}));
}

/// Two weights hang on a rope over a wheel that has mass and does not let the rope slip.
struct Atwood {
  static constexpr double kWheel = 4, kLight = 2, kHeavy = 3, kRadius = 0.25, kStrand = 0.005;
  static constexpr double kMiddle = kRadius + kStrand;  ///< Distance from the axle to the rope's middle line.
  Rig rig;
  BodyId wheel, light, heavy;

  explicit Atwood(const CheckSetting& setting) : rig(setting, without_air()) {
    BodyDesc round =
        moving({.kind = ShapeKind::kCylinder, .radius = real(kRadius), .half_height = real(0.1)}, {0, 5, 0});
    round.rotation = quaternion_about(Vec3{real(1), real(0), real(0)}, real(kTau / 4));
    round.mass = real(kWheel);
    round.contact.friction = real(3);
    wheel = rig.add(round);
    must(rig.world().add_hook({.kind = HookKind::kHinge,
                               .b = {.body = wheel},
                               .anchor = {0, 5, 0},
                               .axis = {real(0), real(0), real(1)}}));
    RopeDesc rope{.total_mass = real(0.002),
                  .points = line({-kMiddle, 3.2, 0}, {-kMiddle, 5, 0}, 60),
                  .pins = {},
                  .contact = {.friction = real(3)}};
    for (int i = 1; i <= 26; ++i) {
      const double angle = kTau / 2 * (1 - i / 26.0);
      rope.points.push_back({kMiddle * std::cos(angle), 5 + kMiddle * std::sin(angle), 0});
    }
    const std::vector<DVec3> down = line({kMiddle, 5, 0}, {kMiddle, 3.2, 0}, 60);
    rope.points.insert(rope.points.end(), down.begin() + 1, down.end());
    const RopeId id = rig.add(rope);
    light = weight({-kMiddle, 3, 0}, kLight);
    heavy = weight({kMiddle, 3, 0}, kHeavy);
    tie(rig, light, id, 0);
    tie(rig, heavy, id, static_cast<std::uint32_t>(rope.points.size()) - 1);
  }

  BodyId weight(DVec3 position, double mass) {
    BodyDesc desc = moving(box_of({0.2, 0.2, 0.2}), position);
    desc.mass = real(mass);
    return rig.add(desc);
  }
};

constexpr double kRolling = 0.5;  ///< R of the cycloid [m].

DVec3 on_cycloid(double t) {
  return {kRolling * (t - std::sin(t)), -kRolling * (1 - std::cos(t)), 0};
}

/// Returns the time of a bead on a wire from rest to where it passes `x` [s].
double bead_time(const CheckSetting& setting, const std::vector<DVec3>& wire, DVec3 start, double x) {
  Rig rig(setting, without_air());
  RopeDesc rope{.points = wire};
  rope.pins.clear();
  for (std::uint32_t i = 0; i < wire.size(); ++i) rope.pins.push_back({.point = i});
  const RopeId id = rig.add(rope);
  const ParticlesId bead = rig.add(ParticlesDesc{.particles = {{.position = start, .mass = real(0.1)}}});
  must(rig.world().add_hook({.kind = HookKind::kRopeSlide,
                             .a = {.point = point(id, PointRef::kNearest)},
                             .b = {.point = point(bead, 0)},
                             .anchor = start}));
  Curve curve;
  rig.run(1.5, [&] { curve.add(rig.time(), rig.positions(bead)[0].x - x); });
  const std::vector<double> times = curve.zero_crossings();
  return times.empty() ? NAN : times.front();
}

}  // namespace

/// a = (m2 - m1) g / (m1 + m2 + I / r^2), I = M R^2 / 2, r to the middle line of the rope (textbook).
Rows atwood(const CheckSetting& setting) {
  Atwood machine(setting);
  const double time = 0.75;
  machine.rig.run(time);
  const double a = (Atwood::kHeavy - Atwood::kLight) * kGravity /
                   (Atwood::kHeavy + Atwood::kLight +
                    0.5 * Atwood::kWheel * std::pow(Atwood::kRadius / Atwood::kMiddle, 2));
  const double way = 0.5 * (machine.rig.center(machine.light).y - machine.rig.center(machine.heavy).y);
  return by_ties({relative_row("acceleration of the weights", "m/s^2", a, 2 * way / (time * time)),
                  relative_row("turning of the wheel at the end", "rad/s", a * time / Atwood::kMiddle,
                               std::abs(machine.rig.spin(machine.wheel).z), 0.03)});
}

/// From any start it takes pi sqrt(R / g) to the bottom of a cycloid (Huygens 1673). From its cusp that is
/// the fastest path (Bernoulli 1696); the straight one takes sqrt(R (pi^2 + 4) / g).
Rows cycloid(const CheckSetting& setting) {
  std::vector<DVec3> wire;
  for (int i = 0; i <= 400; ++i) wire.push_back(on_cycloid(kTau * i / 400));
  const double bottom = kTau / 2 * kRolling;
  const double expected = kTau / 2 * std::sqrt(kRolling / kGravity);
  Rows rows;
  for (const double start : {0.3, 1.2, 2.2}) {
    rows.push_back(relative_row("time to the bottom from " + std::to_string(start).substr(0, 3), "s",
                                expected, bead_time(setting, wire, on_cycloid(start), bottom)));
  }
  const std::vector<DVec3> straight =
      line({-0.3 * bottom, 0.6 * kRolling, 0}, {2 * bottom, -4 * kRolling, 0}, 50);
  const double slope_time = std::sqrt(kRolling * (kTau * kTau / 4 + 4) / kGravity);
  rows.push_back(relative_row("time on the straight line", "s", slope_time,
                              bead_time(setting, straight, {0, 0, 0}, bottom)));
  return by_ties(std::move(rows));
}

/// A ton hangs on a kilogram of rope and is released at 30 degrees. Rope and load swing as one body about the
/// hook, which is above the load's center.
Rows swinging_load(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  const double angle = kTau / 12;
  const DVec3 along = {std::sin(angle), -std::cos(angle), 0};
  const RopeId rope = rig.add(RopeDesc{.points = line({}, 5.0 * along, 50)});
  BodyDesc load = moving(box_of({0.5, 0.5, 0.5}), 5.0 * along - DVec3{0, 0.5, 0});
  load.mass = real(1000);
  const BodyId body = rig.add(load);
  const HookId hook = tie(rig, body, rope, 50);
  const double energy = rig.energy().total();
  double stretch = 0;
  double gap = 0;
  double gain = 0;
  rig.run(20, [&] {
    stretch = std::max(stretch, rig.world().measure().largest_stretch);
    gap = std::max(gap, static_cast<double>(rig.world().hook_gap(hook)));
    gain = std::max(gain, rig.energy().total() - energy);
  });
  const double swing = 1000 * kGravity * 5 * (1 - std::cos(angle));
  return by_ties({absolute_row("largest stretch", "", 0, stretch, 1e-3),
                  absolute_row("largest gap of the hook", "m", 0, gap, 1e-4),
                  absolute_row("energy gained, share of the swing's", "", 0, gain / swing, 0.01),
                  absolute_row("energy lost after 20 s, share of the swing's", "", 0,
                               std::max(0.0, energy - rig.energy().total()) / swing, 0.01)});
}

/// A board of 40 kg hangs on four ropes of 1 kg and EA = 1e6 N, slightly splayed: each hook carries a
/// quarter.
Rows table_on_ropes(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  BodyDesc board = moving(box_of({0.5, 0.03, 0.5}), {});
  board.mass = real(40);
  const BodyId top = rig.add(board);
  std::vector<HookId> hooks;
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      const RopeId rope = rig.add(
          RopeDesc{.axial_stiffness = real(1e6), .points = line({1.2 * x, 2.03, 1.2 * z}, {x, 0.03, z}, 20)});
      hooks.push_back(tie(rig, top, rope, 20));
    }
  }
  rig.run(20);
  double least = HUGE_VAL;
  double most = 0;
  for (const HookId hook : hooks) {
    const double lift = -static_cast<double>(rig.world().hook_force(hook).force.y);
    least = std::min(least, lift);
    most = std::max(most, lift);
  }
  const double yaw = rig.direction(top, {1, 0, 0}).z;
  return by_ties({relative_row("least lift of a hook", "N", 10 * kGravity, least, 0.001),
                  relative_row("largest lift of a hook", "N", 10 * kGravity, most, 0.001),
                  absolute_row("yaw after 20 s", "rad", 0, std::abs(yaw), 1e-4)});
}

}  // namespace hooke::check
