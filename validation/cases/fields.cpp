/// Tests bodies in liquid, in air and in magnetic fields.

#include "validation/cases.h"
#include "validation/rig.h"

#include <cmath>

namespace hooke::check {

namespace {

constexpr double kWater = 1000;  ///< [kg/m^3]
constexpr double kAir = 1.225;   ///< [kg/m^3]
constexpr const char* kFieldSolver = "body forces";

BodyDesc thrown_ball(double radius, double mass) {
  BodyDesc desc = moving(Shape::sphere(real(radius)), {});
  desc.mass = real(mass);
  return desc;
}

/// Returns how deep the bottom of a body lies that comes to rest in water with its surface at y = 0 [m].
double floating_depth(const CheckSetting& setting, const BodyDesc& desc, double below_center) {
  Rig rig(setting, without_air());
  must(rig.world().add_field({.kind = FieldDesc::Kind::kLiquid, .density = kWater, .drag = 3}));
  const BodyId id = rig.add(desc);
  rig.run(15);
  return below_center - rig.center(id).y;
}

CheckRow row(const char* title, const char* unit, double expected, double achieved, double tolerance = 0.01) {
  return {.title = title,
          .unit = unit,
          .expected = expected,
          .achieved = achieved,
          .tolerance = tolerance,
          .solver = kFieldSolver};
}

}  // namespace

/// The share of a floating body's volume that is under water is its density over the liquid's (Archimedes); a
/// ball of half the density floats to its equator. A box that moves up and down has T = 2 pi sqrt(m / (rho g
/// A)), without added mass.
Rows floating_bodies_in_water(const CheckSetting& setting) {
  const double share = 0.6;
  const double height = 0.5;
  BodyDesc box = moving(box_of({0.5, height / 2, 0.4}), {0, 0.1, 0});
  box.density = real(share * kWater);
  BodyDesc ball = moving(Shape::sphere(real(0.3)), {0, 0.1, 0});
  ball.density = real(0.5 * kWater);

  Rig heaving(setting, without_air());
  must(heaving.world().add_field({.kind = FieldDesc::Kind::kLiquid, .density = kWater}));
  const double rest = height / 2 - share * height;
  box.position = {0, rest + 0.05, 0};
  const BodyId id = heaving.add(box);
  const Curve way = record(heaving, 8, [&] { return heaving.center(id).y - rest; });
  return {row("depth of a box, density 0.6", "m", share * height, floating_depth(setting, box, height / 2)),
          row("depth of a ball, density 0.5", "m", 0.3, floating_depth(setting, ball, 0.3)),
          row("period of heave", "s", kTau * std::sqrt(share * height / kGravity), way.period())};
}

/// A falling ball: v_t = sqrt(2 m g / (rho C_d A)). A ball that flies along x and spins about z, its top
/// backward, turns upward at C rho V omega / m, and downward with the opposite spin (Magnus).
Rows bodies_in_air(const CheckSetting& setting) {
  const double radius = 0.1;
  const double mass = 0.05;
  BodyDesc ball = thrown_ball(radius, mass);
  ball.drag_coefficient = real(0.47);
  Rig falling(setting, sleepless());
  const BodyId falls = falling.add(ball);
  falling.run(15);
  const double area = 0.5 * kTau * radius * radius;
  const double terminal = std::sqrt(2 * mass * kGravity / (kAir * 0.47 * area));

  const double seconds = 0.5;
  const auto rise = [&](double spin) {
    Rig rig(setting, weightless());
    BodyDesc spinning = thrown_ball(radius, mass);
    spinning.magnus_coefficient = real(0.75);
    spinning.velocity = real(DVec3{10, 0, 0});
    spinning.angular_velocity = real(DVec3{0, 0, spin});
    const BodyId id = rig.add(spinning);
    rig.run(seconds);
    return rig.velocity(id).y;
  };
  const double volume = 2.0 / 3 * kTau * radius * radius * radius;
  const double expected = 10 * std::sin(0.75 * kAir * volume * 30 / mass * seconds);
  return {row("terminal speed of a ball", "m/s", terminal, -falling.velocity(falls).y),
          row("speed upward, backspin", "m/s", expected, rise(30)),
          row("speed upward, topspin", "m/s", -expected, rise(-30))};
}

/// Two dipoles m at a distance r on one axis attract with F = 3 mu0 m^2 / (2 pi r^4), here seen in the speed
/// after a short time; side by side they repel with half of that. A needle with inertia I in a uniform field
/// has T = 2 pi sqrt(I / (m B)). A disc floats above another, poles opposed, where F is its weight.
Rows magnetic_dipoles(const CheckSetting& setting) {
  constexpr double kMu0 = 2e-7 * kTau;  ///< [T m / A]
  const double moment = 100;
  const double mass = 2;
  const double apart = 0.4;
  const auto magnet = [&](DVec3 position, DVec3 own) {
    BodyDesc desc = thrown_ball(0.03, mass);
    desc.position = position;
    desc.dipole_moment = real(own);
    return desc;
  };
  const double force = 3 * kMu0 * moment * moment / (kTau * std::pow(apart, 4));
  const double seconds = 0.05;
  const auto pull = [&](DVec3 axis) {
    Rig rig(setting, weightless());
    rig.add(magnet({}, moment * axis));
    const BodyId id = rig.add(magnet({apart, 0, 0}, moment * axis));
    rig.run(seconds);
    return mass * rig.velocity(id).x / rig.time();
  };

  const double field = 0.01;
  Rig swinging(setting, weightless());
  must(swinging.world().add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {real(field), 0, 0}}));
  BodyDesc needle = magnet({}, {1, 0, 0});
  needle.rotation = quaternion_about(Vec3{0, real(1), 0}, real(-0.02));
  const BodyId id = swinging.add(needle);
  const Curve way = record(swinging, 4, [&] { return swinging.direction(id, {1, 0, 0}).z; });
  const double inertia = 0.4 * mass * 0.03 * 0.03;

  Rig floating(setting, without_air());
  must(floating.world().add_field({.kind = FieldDesc::Kind::kDipole, .vector = {0, real(-500), 0}}));
  BodyDesc disc = magnet({0, 0.3, 0}, {0, 500, 0});
  disc.linear_damping = real(3);
  const BodyId floats = floating.add(disc);
  must(floating.world().add_hook({.kind = HookKind::kSlider, .b = {floats}, .axis = {0, 1, 0}}));
  floating.run(8);
  const double height = std::pow(3 * kMu0 * 500 * 500 / (kTau * mass * kGravity), 0.25);
  return {row("force on one axis", "N", -force, pull({1, 0, 0})),
          row("force side by side", "N", force / 2, pull({0, 1, 0})),
          row("period of a needle", "s", kTau * std::sqrt(inertia / field), way.period()),
          row("height of a floating disc", "m", height, floating.center(floats).y)};
}

}  // namespace hooke::check
