/// Tests bodies that rotate freely: no axis, no contact, or one point held.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

WorldDesc floating_bodies() {
  WorldDesc desc = sleepless();
  desc.gravity = {};
  return desc;
}

/// Returns the complete elliptic integral K of modulus k, by the arithmetic-geometric mean (Gauss).
double elliptic_quarter(double modulus_squared) {
  double a = 1;
  double b = std::sqrt(1 - modulus_squared);
  for (int i = 0; i < 40; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.25 * kTau / a;
}

/// Tells whether a disc of 0.15 m on a tip 0.1 m below its center, tilted by 1e-4 rad, stays up for 12 s. The
/// tilt of one that stands grows at most (1 - (1 - margin)^2)^(-1/2) fold, 7 times at a margin of 1 %.
bool top_sleeps(const CheckSetting& setting, double spin) {
  const double tilt = 1e-4;
  const DVec3 axis = {std::sin(tilt), std::cos(tilt), 0};
  Rig rig(setting, sleepless());
  BodyDesc disc = moving(Shape::cylinder(real(0.15), real(0.01)), 0.1 * axis);
  disc.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(-1)}, real(tilt));
  disc.angular_velocity = real(spin * axis);
  const BodyId top = rig.add(disc);
  must(rig.world().add_hook({.kind = HookKind::kBall, .b = {top}}));
  bool up = true;
  rig.run(12, [&] { up = up && rig.direction(top, {0, 1, 0}).y > std::cos(0.02); });
  return up;
}

/// These are the sums of |m v| and |x x m v + L| over the bodies, with which a change of their sum is
/// compared.
struct MomentumScale {
  double linear = 0;
  double angular = 0;
};

struct Swarm {
  Rig rig;
  MomentumScale scale;

  /// Makes five boxes or balls that will collide.
  Swarm(const CheckSetting& setting, const Shape& shape, double restitution, double friction)
      : rig(setting, floating_bodies()) {
    for (int i = 0; i < 5; ++i) {
      BodyDesc body = moving(shape, {1.6 * i, 0.13 * i, 0.07 * i * i});
      body.velocity = real(DVec3{2.0 - i, 0.1, 0});
      body.angular_velocity = real(DVec3{0.3, 1.0 * i, -1});
      body.contact = {.friction = real(friction), .restitution = real(restitution)};
      const BodyId id = rig.add(body);
      const double momentum = static_cast<double>(rig.world().mass(id)) * length(rig.velocity(id));
      scale.linear += momentum;
      scale.angular += length(rig.center(id)) * momentum;
    }
  }
};

Rows conservation_rows(const CheckSetting& setting, const char* what, const Shape& shape, double restitution,
                       double friction) {
  Swarm swarm(setting, shape, restitution, friction);
  const Measurement before = swarm.rig.world().measure();
  swarm.rig.run(4);
  const Measurement after = swarm.rig.world().measure();
  const std::string of = std::string(" of five ") + what + ", share";
  Rows rows = {
      absolute_row("change of momentum" + of, "", 0,
                   length(after.momentum - before.momentum) / swarm.scale.linear, 1e-5),
      absolute_row("change of angular momentum" + of, "", 0,
                   length(after.angular_momentum - before.angular_momentum) / swarm.scale.angular, 1e-5)};
  const double kept = after.energy.kinetic / before.energy.kinetic;
  if (restitution == 1) rows.push_back(absolute_row("change of energy" + of, "", 0, kept - 1, 1e-5));
  return rows;
}

}  // namespace

/// A body that spins about its middle axis turns over again and again (Euler; Landau and Lifshitz, Mechanics,
/// 37). The period is
/// T = 4 K(k) / W, W^2 = (I3 - I2)(L^2 - 2 E I1) / (I1 I2 I3),
/// k^2 = (I2 - I1)(2 E I3 - L^2) / ((I3 - I2)(L^2 - 2 E I1)) for L^2 > 2 E I2. L and E stay constant.
Rows turning_over(const CheckSetting& setting) {
  const double i1 = (0.2 * 0.2 + 0.5 * 0.5) / 12;  // Moment about x per mass; I2 is about z, I3 about y.
  const double i2 = (1 + 0.2 * 0.2) / 12;
  const double i3 = (1 + 0.5 * 0.5) / 12;
  const double middle = 6;
  const double aside = 0.3;
  Rig rig(setting, floating_bodies());
  BodyDesc desc = moving(box_of({0.5, 0.1, 0.25}), {});
  desc.mass = real(1);
  desc.angular_velocity = real(DVec3{0, aside, middle});
  const BodyId box = rig.add(desc);

  const double energy = i2 * middle * middle + i3 * aside * aside;  // Twice the energy.
  const double momentum = i2 * i2 * middle * middle + i3 * i3 * aside * aside;
  const double rate = std::sqrt((i3 - i2) * (momentum - energy * i1) / (i1 * i2 * i3));
  const double modulus = (i2 - i1) * (energy * i3 - momentum) / ((i3 - i2) * (momentum - energy * i1));
  const double kinetic = rig.energy().kinetic;
  const auto angular_momentum = [&] {
    if (!setting.laboratory()) return rig.world().measure().angular_momentum;
    const DVec3 own = rig.own_spin(box);
    return i1 * own.x * rig.direction(box, {1, 0, 0}) + i3 * own.y * rig.direction(box, {0, 1, 0}) +
           i2 * own.z * rig.direction(box, {0, 0, 1});
  };
  const DVec3 before = angular_momentum();
  double energy_error = 0;
  const Curve spin = record(rig, 100, [&] {
    energy_error = std::max(energy_error, std::abs(rig.energy().kinetic / kinetic - 1));
    return rig.own_spin(box).z;
  });
  return {relative_row("period of turning over, 1 : 0.2 : 0.5, 6 rad/s", "s",
                       4 * elliptic_quarter(modulus) / rate, spin.period()),
          absolute_row("largest error of energy in 100 s, share", "", 0, energy_error, 1e-4),
          absolute_row("change of angular momentum in 100 s, share", "", 0,
                       length(angular_momentum() - before) / length(before), 1e-4)};
}

/// In a symmetric top (textbook) the spin goes round the body's axis at (I3 - I1) / I1 w3, and the axis round
/// L at L / I1.
Rows free_precession(const CheckSetting& setting) {
  const double radius = 0.5;
  const double half = 0.1;
  const double along = radius * radius / 2;  // Per mass.
  const double across = (3 * radius * radius + 4 * half * half) / 12;
  const DVec3 spin = {1, 5, 0};
  Rig rig(setting, floating_bodies());
  BodyDesc desc = moving(Shape::cylinder(real(radius), real(half)), {});
  desc.angular_velocity = real(spin);
  const BodyId disc = rig.add(desc);
  const DVec3 momentum = {across * spin.x, along * spin.y, 0};
  const DVec3 aside = {0, 0, 1};  // Perpendicular to L and the axis at the start.
  Curve in_body;
  Curve in_space;
  rig.run(60, [&] {
    in_body.add(rig.time(), rig.own_spin(disc).x);
    in_space.add(rig.time(), dot(rig.direction(disc, {0, 1, 0}), aside));
  });
  return {
      relative_row("period of the spin in the body, 5 rad/s", "s",
                   kTau / ((along - across) / across * spin.y), in_body.period()),
      relative_row("period of the axis in space", "s", kTau * across / length(momentum), in_space.period())};
}

/// An upright top stays up if and only if w3^2 > 4 I1 m g l / I3^2, with I1 about the tip (textbook).
Rows sleeping_top(const CheckSetting& setting) {
  const double radius = 0.15;
  const double half = 0.01;
  const double lever = 0.1;
  const double along = radius * radius / 2;  // Per mass.
  const double across = (3 * radius * radius + 4 * half * half) / 12 + lever * lever;
  const double expected = std::sqrt(4 * across * kGravity * lever) / along;
  const double found =
      bisect(1.2 * expected, 0.8 * expected, 8, [&](double spin) { return top_sleeps(setting, spin); });
  return {relative_row("slowest spin that keeps a top up", "rad/s", expected, found, 0.01)};
}

/// Without forces from outside, momentum and angular momentum stay, and so does energy where impacts lose
/// none.
Rows isolated_bodies(const CheckSetting& setting) {
  Rows rows = conservation_rows(setting, "balls, e = 1", Shape::sphere(real(0.6)), 1, 0);
  for (const Rows& more : {conservation_rows(setting, "rough balls", Shape::sphere(real(0.6)), 0.5, 0.5),
                           conservation_rows(setting, "boxes", box_of({0.5, 0.5, 0.5}), 0.5, 0.5)}) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

}  // namespace hooke::check
