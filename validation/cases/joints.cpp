/// Tests hooks between bodies: pendulums, mechanisms, chains, limits, motors, springs.

#include "validation/cases.h"
#include "validation/planar_mechanism.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hooke::check {

namespace {

constexpr Vec3 kAlongZ = {Real(0), Real(0), Real(1)};
constexpr Vec3 kUp = {Real(0), Real(1), Real(0)};

BodyDesc bar(DVec3 half, DVec3 center, double angle, double mass) {
  BodyDesc desc = moving(box_of(half), center);
  desc.rotation = quaternion_about(kAlongZ, real(angle));
  desc.mass = real(mass);
  return desc;
}

HookId hinge(Rig& rig, BodyId a, BodyId b, DVec3 anchor) {
  return must(rig.world().add_hook(
      {.kind = HookKind::kHinge, .a = {a}, .b = {b}, .anchor = anchor, .axis = kAlongZ}));
}

/// A bar of 1 m hangs on a hinge at its upper end and is released at an angle.
struct SwingingBar {
  static constexpr double kWidth = 0.1;
  Rig rig;
  BodyId body;

  SwingingBar(const CheckSetting& setting, double angle) : rig(setting, sleepless()) {
    const DVec3 center = {0.5 * std::sin(angle), -0.5 * std::cos(angle), 0};
    body = rig.add(bar({0.5 * kWidth, 0.5, 0.5 * kWidth}, center, angle, 1));
    hinge(rig, {}, body, {});
  }
  [[nodiscard]] double angle() const { return std::atan2(rig.center(body).x, -rig.center(body).y); }
  /// Returns the period of small oscillations [s], from the inertia about the hinge over m g / 2.
  static double small_period() {
    return kTau * std::sqrt((1.0 / 3 + kWidth * kWidth / 12) / (0.5 * kGravity));
  }
};

/// These are the bodies of a mechanism, square bars, which are compared with its equation of motion.
struct BuiltMechanism {
  Rig rig;
  std::vector<BodyId> ids;
  std::vector<PlanarMechanism::Body> bodies;
  double half_width;
  double half_substep;

  BuiltMechanism(const CheckSetting& setting, double width)
      : rig(setting, sleepless()),
        half_width(0.5 * width),
        half_substep(0.5 * setting.dt / setting.substeps) {}
  BodyId add(const PlanarPose& pose, double length, double mass) {
    BodyDesc desc = bar({0.5 * length, half_width, half_width}, {pose.x, pose.y, 0}, pose.angle, mass);
    desc.collides = false;
    ids.push_back(rig.add(desc));
    bodies.push_back({mass, mass * (length * length + 4 * half_width * half_width) / 12});
    return ids.back();
  }
  /// Returns the largest distance of a body from its position by the equation of motion, in 1 s [m].
  /// Positions are half a substep ahead (see Energy).
  double error(const PlanarMechanism::PosesOf& poses_of, double start) {
    const PlanarMechanism exact(bodies, poses_of);
    double worst = 0;
    for (int part = 1; part <= 5; ++part) {
      rig.run(0.2);
      const std::vector<PlanarPose> poses = exact.poses(exact.run(start, 0.2 * part + half_substep));
      for (std::size_t i = 0; i < ids.size(); ++i)
        worst = std::max(worst, length(rig.center(ids[i]) - DVec3{poses[i].x, poses[i].y, 0}));
    }
    return worst;
  }
};

double four_bar_error(const CheckSetting& setting, double width) {
  const FourBar shape;
  const double start = 1;
  BuiltMechanism built(setting, width);
  const std::vector<PlanarPose> poses = shape.poses(start);
  const BodyId crank = built.add(poses[0], shape.crank, 1);
  const BodyId coupler = built.add(poses[1], shape.coupler, 2);
  const BodyId rocker = built.add(poses[2], shape.rocker, 1.5);
  hinge(built.rig, {}, crank, {});
  hinge(built.rig, crank, coupler, {shape.crank * std::cos(start), shape.crank * std::sin(start), 0});
  hinge(built.rig, coupler, rocker, shape.pin(start));
  hinge(built.rig, {}, rocker, {shape.ground, 0, 0});
  return built.error([&](double q) { return shape.poses(q); }, start);
}

double slider_crank_error(const CheckSetting& setting) {
  const SliderCrank shape;
  const double start = 1.3;
  BuiltMechanism built(setting, 0.1);
  const std::vector<PlanarPose> poses = shape.poses(start);
  const BodyId crank = built.add(poses[0], shape.crank, 1);
  const BodyId rod = built.add(poses[1], shape.rod, 1);
  const BodyId slider = built.add(poses[2], 0.1, 3);
  hinge(built.rig, {}, crank, {});
  hinge(built.rig, crank, rod, {shape.crank * std::cos(start), shape.crank * std::sin(start), 0});
  hinge(built.rig, rod, slider, {poses[2].x, 0, 0});
  must(built.rig.world().add_hook({.kind = HookKind::kSlider,
                                   .b = {slider},
                                   .anchor = {poses[2].x, 0, 0},
                                   .axis = {Real(1), Real(0), Real(0)}}));
  return built.error([&](double q) { return shape.poses(q); }, start);
}

/// A chain of 16 links of 1 kg and 0.4 m hangs, with 1000 kg at its end.
struct LoadedChain {
  static constexpr int kLinks = 16;
  static constexpr double kLink = 0.4;
  Rig rig;
  BodyId load;
  HookId top;

  explicit LoadedChain(const CheckSetting& setting) : rig(setting, sleepless()) {
    BodyId last = {};
    for (int i = 0; i < kLinks; ++i) {
      const BodyId link = rig.add(bar({0.05, 0.5 * kLink, 0.05}, {0, -kLink * (i + 0.5), 0}, 0, 1));
      const HookId hook =
          must(rig.world().add_hook({.a = {last}, .b = {link}, .anchor = {0, -kLink * i, 0}}));
      if (i == 0) top = hook;
      last = link;
    }
    load = rig.add(bar({0.5, 0.5, 0.5}, {0, -kLink * kLinks - 0.5, 0}, 0, 1000));
    must(rig.world().add_hook({.a = {last}, .b = {load}, .anchor = {0, -kLink * kLinks, 0}}));
  }
};

/// A vertical slider holds a block of 2 kg.
struct HungBlock {
  static constexpr double kMass = 2;
  Rig rig;
  BodyId block;

  HungBlock(const CheckSetting& setting, HookDesc hook) : rig(setting, sleepless()) {
    block = rig.add(bar({0.1, 0.1, 0.1}, {}, 0, kMass));
    hook.kind = HookKind::kSlider;
    hook.b = {block};
    hook.axis = kUp;
    must(rig.world().add_hook(hook));
  }
  [[nodiscard]] double height() const { return rig.center(block).y; }
};

}  // namespace

/// T / T0 = 1 / agm(1, cos(theta0 / 2)), T0 = 2 pi sqrt(I / (m g d)) (Huygens; Gauss).
Rows swinging_bar(const CheckSetting& setting) {
  struct Amplitude {
    double angle_deg, ratio;
  };
  Rows rows;
  for (const Amplitude& a :
       {Amplitude{5, 1.000476}, Amplitude{60, 1.073182}, Amplitude{90, 1.180341}, Amplitude{150, 1.762204}}) {
    SwingingBar swing(setting, a.angle_deg * kTau / 360);
    const double expected = SwingingBar::small_period() * a.ratio;
    const std::vector<double> times =
        record(swing.rig, 2.5 * expected, [&] { return swing.angle(); }).zero_crossings();
    rows.push_back(relative_row(
        "period of a bar from " + std::to_string(static_cast<int>(a.angle_deg)) + " deg", "s", expected,
        times.size() < 3 ? std::numeric_limits<double>::quiet_NaN() : times[2] - times[0]));
  }
  SwingingBar swing(setting, kTau / 4);
  const Curve angle = record(swing.rig, 20 * SwingingBar::small_period(), [&] { return swing.angle(); });
  const std::vector<double> tops = angle.peaks();
  rows.push_back(
      relative_row("angle of a bar from 90 deg after 30 turns", "deg", 90,
                   tops.size() < 30 ? std::numeric_limits<double>::quiet_NaN() : tops[29] * 360 / kTau));
  return rows;
}

/// Mechanisms of the library of IFToMM are compared with their own equation of motion (planar_mechanism.h).
Rows mechanisms(const CheckSetting& setting) {
  CheckSetting fine = setting;
  fine.dt = 1.0 / 240;
  fine.substeps = 16;
  Rows rows;
  for (const CheckSetting& own : {setting, fine}) {
    const double tolerance = own.dt < setting.dt ? 5e-5 : 0.0025;  // 1e-4 and 0.5 % of a crank [m].
    rows.push_back(
        absolute_row("slider-crank: farthest from its motion", "m", 0, slider_crank_error(own), tolerance));
    rows.push_back(absolute_row("four-bar linkage: farthest from its motion", "m", 0,
                                four_bar_error(own, 0.1), tolerance));
    for (CheckRow* row : {&rows.back(), &rows[rows.size() - 2]}) {
      row->dt = own.dt;
      row->substeps = own.substeps;
    }
  }
  rows.push_back(absolute_row("four-bar linkage of bars of 2 cm: farthest from its motion", "m", 0,
                              four_bar_error(setting, 0.02), 0.0025));
  return rows;
}

/// A chain of 16 kg keeps its length under 1000 kg, and its hook carries the weight (statics).
Rows loaded_chain(const CheckSetting& setting) {
  LoadedChain chain(setting);
  chain.rig.run(5);
  const double length_at_rest = LoadedChain::kLink * LoadedChain::kLinks;
  const double stretch = (-0.5 - chain.rig.center(chain.load).y) / length_at_rest - 1;
  const HookForce force = chain.rig.world().hook_force(chain.top);
  return {absolute_row("stretch of a chain of 16 kg under 1000 kg, share", "", 0, stretch, 0.001),
          relative_row("force of its hook", "N", 1016 * kGravity, static_cast<double>(force.force.y), 0.001)};
}

/// At a limit a bar rests at that angle, and a block at that height (statics).
Rows hook_limits(const CheckSetting& setting) {
  const double limit = 30 * kTau / 360;
  Rig rig(setting, sleepless());
  const BodyId body = rig.add(bar({0.5, 0.05, 0.05}, {0.5, 0, 0}, 0, 1));
  const HookId hook = must(rig.world().add_hook({.kind = HookKind::kHinge,
                                                 .b = {body},
                                                 .axis = kAlongZ,
                                                 .limits = {.lower = real(-limit), .upper = real(limit)}}));
  rig.run(3);
  HungBlock block(setting, {.limits = {.lower = real(-0.25), .upper = real(1)}});
  block.rig.run(3);
  return {absolute_row("angle of a bar at a limit of -30 deg", "deg", -30,
                       std::atan2(rig.center(body).y, rig.center(body).x) * 360 / kTau, 0.1),
          absolute_row("the same by its hook", "deg", -30,
                       static_cast<double>(rig.world().hook_value(hook)) * 360 / kTau, 0.1),
          absolute_row("height of a block at a limit of -0.25 m", "m", -0.25, block.height(), 1e-4)};
}

/// A motor of torque t turns up a wheel at t / I until it has its speed. A motor with the target speed zero
/// holds a weight if and only if its force exceeds it (textbook).
Rows hook_motors(const CheckSetting& setting) {
  const double radius = 0.2;
  const double torque = 0.5;
  Rig rig(setting, sleepless());
  BodyDesc desc = moving(Shape::cylinder(real(radius), real(0.05)), {});
  desc.mass = real(4);
  const BodyId wheel = rig.add(desc);
  must(rig.world().add_hook({.kind = HookKind::kHinge,
                             .b = {wheel},
                             .axis = kUp,
                             .motor = {.speed = real(20), .max_force = real(torque)}}));
  rig.run(1);
  const double rising = rig.spin(wheel).y;
  rig.run(4);
  const double weight = HungBlock::kMass * kGravity;
  const double holds = bisect(1.2 * weight, 0.8 * weight, 10, [&](double force) {
    HungBlock block(setting, {.motor = {.max_force = real(force)}});
    block.rig.run(1);
    return block.height() > -1e-3;
  });
  return {relative_row("speed of a wheel after 1 s of torque", "rad/s", torque / (0.5 * 4 * radius * radius),
                       rising),
          relative_row("its speed in the end", "rad/s", 20, rig.spin(wheel).y),
          relative_row("least force of a motor that holds 2 kg", "N", weight, holds)};
}

/// x = m g / k at rest, T = 2 pi sqrt(m / k) (Hooke; textbook).
Rows hook_springs(const CheckSetting& setting) {
  const double stiffness = 200;
  HungBlock block(setting, {.spring = {.stiffness = real(stiffness)}});
  const double rest = -HungBlock::kMass * kGravity / stiffness;
  const Curve swing = record(block.rig, 5, [&] { return block.height() - rest; });
  HungBlock damped(setting, {.spring = {.stiffness = real(stiffness), .damping = real(20)}});
  damped.rig.run(10);
  Rig rig(setting, sleepless());
  const BodyId wheel = rig.add(bar({0.5, 0.05, 0.05}, {}, 0, 3));
  must(rig.world().add_hook({.kind = HookKind::kHinge,
                             .b = {wheel},
                             .axis = kAlongZ,
                             .spring = {.stiffness = real(10), .target = real(0.5)}}));
  const Curve turn = record(rig, 8, [&] {
    const DVec3 x = rig.direction(wheel, {1, 0, 0});
    return std::atan2(x.y, x.x) - 0.5;
  });
  const double inertia = 3 * (1 + 0.01) / 12;
  return {relative_row("period of 2 kg on a slider's spring", "s",
                       kTau * std::sqrt(HungBlock::kMass / stiffness), swing.period()),
          relative_row("where it rests with damping", "m", rest, damped.height()),
          relative_row("period of a bar on a hinge's spring", "s", kTau * std::sqrt(inertia / 10),
                       turn.period())};
}

}  // namespace hooke::check
