/// Tests bodies that slide, stick, roll and topple.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

constexpr double kDegree = kTau / 360;

/// An Incline is a plane through the origin that goes down along x by `angle`, with coordinates on it.
struct Incline {
  double angle = 0;
  DVec3 normal = {std::sin(angle), std::cos(angle), 0};
  DVec3 down = {std::cos(angle), -std::sin(angle), 0};

  [[nodiscard]] BodyDesc ground(double friction) const {
    BodyDesc desc = level_ground(friction);
    desc.rotation = turn();
    return desc;
  }
  [[nodiscard]] Quat turn() const { return quaternion_about(Vec3{Real(0), Real(0), Real(-1)}, real(angle)); }
};

/// A box is released on an incline. Both have the friction `friction`.
struct BoxOnIncline {
  Incline incline;
  Rig rig;
  BodyId box;

  BoxOnIncline(const CheckSetting& setting, double angle, double friction, DVec3 half = {0.1, 0.1, 0.1})
      : incline{angle}, rig(setting, sleepless()) {
    rig.add(incline.ground(friction));
    BodyDesc desc = moving(box_of(half), half.y * incline.normal);
    desc.rotation = incline.turn();
    desc.contact.friction = real(friction);
    box = rig.add(desc);
  }

  [[nodiscard]] double place() const { return dot(rig.center(box), incline.down); }
  [[nodiscard]] double speed() const { return dot(rig.velocity(box), incline.down); }
  /// Returns the angle between the box's up direction and the normal of the incline [rad].
  [[nodiscard]] double tilt() const {
    return std::acos(std::min(1.0, dot(rig.direction(box, {0, 1, 0}), incline.normal)));
  }
};

/// Returns the mean speed over the last of `seconds` [m/s].
double creep(const CheckSetting& setting, double slope, double friction, double seconds) {
  BoxOnIncline box(setting, std::atan(slope), friction);
  box.rig.run(seconds - 1);
  const double before = box.place();
  box.rig.run(1);
  return box.place() - before;
}

/// A Wheel has the axial inertia b m r^2 and the radius 0.1 m.
struct Wheel {
  const char* name;
  double inertia;
  BodyDesc desc;
};

/// A WeightedWheel is a light drum with 12 heavy balls on a circle.
struct WeightedWheel {
  double ring = 0.075;  ///< Radius of the circle [m].
  double ball = 0.015;  ///< Radius of a ball [m].

  [[nodiscard]] BodyDesc desc() const;
  [[nodiscard]] double inertia() const;
};

BodyDesc WeightedWheel::desc() const {
  BodyDesc made = moving(Shape::compound(), {});
  made.parts = {{.shape = Shape::cylinder(real(0.1), real(0.05)), .density = real(1)}};
  for (int i = 0; i < 12; ++i) {
    const double angle = kTau * i / 12;
    made.parts.push_back({.shape = Shape::sphere(real(ball)),
                          .position = real(DVec3{ring * std::cos(angle), 0, ring * std::sin(angle)}),
                          .density = real(1e4)});
  }
  return made;
}

double WeightedWheel::inertia() const {
  const double balls = 12 * 1e4 * 2 * kTau / 3 * ball * ball * ball;
  const double drum = 0.5 * kTau * 0.01 * 0.1;  // Mass of the drum: 1 kg/m^3, 0.1 m in radius and length.
  return (balls * (ring * ring + 0.4 * ball * ball) + drum * 0.5 * 0.01) / ((balls + drum) * 0.01);
}

std::vector<Wheel> wheels() {
  return {{"ball", 0.4, moving(Shape::sphere(real(0.1)), {})},
          {"drum", 0.5, moving(Shape::cylinder(real(0.1), real(0.05)), {})},
          {"drum with weights", WeightedWheel{}.inertia(), WeightedWheel{}.desc()}};
}

/// Lays the wheel's axis along z.
void lay(BodyDesc& wheel, double friction) {
  wheel.rotation = quaternion_about(Vec3{Real(1), Real(0), Real(0)}, real(kTau / 4));
  wheel.contact.friction = real(friction);
  for (PartDesc& part : wheel.parts) part.contact.friction = real(friction);
}

struct Rolled {
  double speed = 0;  ///< Speed at the end [m/s].
  double slip = 0;   ///< Speed at the contact, as a share of it.
};

/// Rolls from rest on a slope of 20 degrees.
Rolled roll_down(const CheckSetting& setting, double friction, const Wheel& wheel, double seconds) {
  const Incline incline{20 * kDegree};
  Rig rig(setting, sleepless());
  rig.add(incline.ground(friction));
  BodyDesc desc = wheel.desc;
  desc.position = 0.1 * incline.normal;
  lay(desc, friction);
  const BodyId id = rig.add(desc);
  rig.run(seconds);
  const double speed = dot(rig.velocity(id), incline.down);
  return {speed, (speed + 0.1 * rig.spin(id).z) / speed};
}

/// Tells whether a ball is fast enough at the top of a loop of 1440 flat strips, radius 1 m, with `speed` at
/// the bottom. A ball that has left the track shortly before is still close to it, but slower there.
bool loops(const CheckSetting& setting, double speed, double ball) {
  constexpr int kStrips = 1440;
  Rig rig(setting, sleepless());
  MeshDesc track;
  for (std::uint32_t i = 0; i <= kStrips; ++i) {
    const double angle = kTau * 0.7 * i / kStrips - 0.05 * kTau;
    for (const double z : {-0.3, 0.3})
      track.positions.push_back(real(DVec3{std::sin(angle), 1 - std::cos(angle), z}));
    if (i == kStrips) break;
    track.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
    track.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
  }
  rig.add({.shape = Shape::of_mesh(must(rig.world().add_mesh(track))), .contact = {.friction = real(1)}});
  BodyDesc desc = moving(Shape::sphere(real(ball)), {0, ball, 0});
  desc.velocity = real(DVec3{speed, 0, 0});
  desc.angular_velocity = real(DVec3{0, 0, -speed / ball});
  desc.contact.friction = real(1);
  const BodyId id = rig.add(desc);
  bool on_track = true;
  bool over = false;
  rig.run(2, [&] {
    const DVec3 arm = rig.center(id) - DVec3{0, 1, 0};
    const bool passes = on_track && arm.x < 0 && arm.y > 0;
    over = over || (passes && length_squared(rig.velocity(id)) >= kGravity * (1 - ball));
    on_track = on_track && !passes && length(arm) > 0.97 * (1 - ball);
  });
  return over;
}

/// Tells whether a thin rod of 1 m that leans by `lean` against a smooth wall, on a rough floor, stands for 5
/// s.
bool ladder_stands(const CheckSetting& setting, double lean, double radius, double friction) {
  Rig rig(setting, sleepless());
  rig.add(level_ground(friction));
  BodyDesc wall = level_ground(0);
  wall.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(-1)}, real(kTau / 4));
  rig.add(wall);
  const DVec3 foot = {std::sin(lean) + radius, radius, 0};
  const DVec3 head = {radius, std::cos(lean) + radius, 0};
  BodyDesc desc = moving(Shape::capsule(real(radius), real(0.5)), 0.5 * (foot + head));
  desc.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, real(lean));
  desc.contact.friction = real(friction);
  const BodyId rod = rig.add(desc);
  const double start = rig.center(rod).y;
  rig.run(5);
  return rig.center(rod).y > start - 0.005;
}

}  // namespace

/// A yo-yo has a = g / (1 + I / (m r^2)) (textbook). Its string is replaced by a wall on which it cannot
/// slip, which pulls at the same point.
Rows yo_yo(const CheckSetting& setting) {
  Rows rows;
  for (const Wheel& wheel : wheels()) {
    Rig rig(setting, sleepless());
    BodyDesc wall = level_ground(1);
    wall.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(-1)}, real(kTau / 4));
    rig.add(wall);
    BodyDesc desc = wheel.desc;
    desc.position = {0.1, 0, 0};
    lay(desc, 1);
    const BodyId id = rig.add(desc);
    const double weight = static_cast<double>(rig.world().mass(id)) * kGravity;
    for (int frame = 0; frame < 24; ++frame) {
      must(rig.world().apply_force(id, real(DVec3{-weight, 0, 0})));
      rig.step();
    }
    rows.push_back(relative_row(std::string("speed of a yo-yo after 0.4 s: ") + wheel.name, "m/s",
                                0.4 * kGravity / (1 + wheel.inertia), -rig.velocity(id).y));
  }
  return rows;
}

/// A ball that slides with v0 rolls with 5/7 v0 after 2 v0 / (7 mu g), over 12 v0^2 / (49 mu g) (Coriolis).
Rows slide_to_roll(const CheckSetting& setting) {
  const double mu = 0.2;
  const double v0 = 3;
  const double radius = 0.1;
  Rig rig(setting, sleepless());
  rig.add(level_ground(mu));
  BodyDesc desc = moving(Shape::sphere(real(radius)), {0, radius, 0});
  desc.velocity = real(DVec3{v0, 0, 0});
  desc.contact.friction = real(mu);
  const BodyId ball = rig.add(desc);
  const Curve slip = record(rig, 0.4, [&] { return rig.velocity(ball).x + radius * rig.spin(ball).z; });
  const double slope = (slip.at(0.3) - slip.at(0.1)) / 0.2;  // The slip falls in a straight line.
  rig.run(0.6);
  const double duration = 2 * v0 / (7 * mu * kGravity);
  const double speed = rig.velocity(ball).x;
  return {relative_row("speed once it rolls, 3 m/s, mu = 0.2", "m/s", 5 * v0 / 7, speed),
          relative_row("time until it rolls", "s", duration, 0.1 - slip.at(0.1) / slope),
          relative_row("way until it rolls", "m", 12 * v0 * v0 / (49 * mu * kGravity),
                       rig.center(ball).x - speed * (rig.time() - duration))};
}

/// A box sticks if and only if tan theta <= mu; otherwise a = g (sin theta - mu cos theta) (textbook).
Rows box_on_slope(const CheckSetting& setting) {
  const double angle = 30 * kDegree;
  Rows rows;
  for (const double mu : {0.0, 0.3}) {
    BoxOnIncline box(setting, angle, mu);
    box.rig.run(2);
    rows.push_back(relative_row("speed after 2 s, 30 deg, mu = " + std::to_string(mu).substr(0, 3), "m/s",
                                2 * kGravity * (std::sin(angle) - mu * std::cos(angle)), box.speed()));
  }
  const double threshold =
      bisect(0.8 * 0.5, 1.2 * 0.5, 12, [&](double slope) { return creep(setting, slope, 0.5, 2) < 1e-5; });
  rows.push_back(
      relative_row("steepest slope that holds a box, tangent, mu = 0.5", "", 0.5, threshold, 0.002));
  rows.push_back(absolute_row("creep on a slope of tangent 0.49, mu = 0.5", "um/s", 0,
                              1e6 * creep(setting, 0.49, 0.5, 10), 1));
  return rows;
}

/// The stopping distance is v0^2 / (2 mu g) (textbook).
Rows stopping_distance(const CheckSetting& setting) {
  Rows rows;
  for (const double mu : {0.2, 0.5}) {
    Rig rig(setting, sleepless());
    rig.add(level_ground(mu));
    BodyDesc desc = moving(box_of({0.2, 0.1, 0.2}), {0, 0.1, 0});
    desc.velocity = real(DVec3{5, 0, 0});
    desc.contact.friction = real(mu);
    const BodyId box = rig.add(desc);
    rig.run(4);
    rows.push_back(relative_row("way of a box with 5 m/s, mu = " + std::to_string(mu).substr(0, 3), "m",
                                25 / (2 * mu * kGravity), rig.center(box).x));
    rows.push_back(absolute_row("sideways on that way", "m", 0, rig.center(box).z, 1e-3));
  }
  return rows;
}

/// A box of base b and height h tips where tan theta > b / h, and only slides where tan theta > mu comes
/// first (textbook). Gravity tilts slowly, within 4 s, because a box put on a slope would rock.
Rows toppling_box(const CheckSetting& setting) {
  const DVec3 half = {0.05, 0.15, 0.05};
  const double expected = std::atan(1.0 / 3);
  const double found = bisect(expected - 3 * kDegree, expected + 3 * kDegree, 8, [&](double angle) {
    BoxOnIncline box(setting, 0, 1, half);
    const auto weight = length(vector_cast<double>(box.rig.world().desc().gravity));
    box.rig.run(8, [&] {
      const double lean = angle * std::min(1.0, box.rig.time() / 4);
      must(box.rig.world().set_gravity(real(weight * DVec3{std::sin(lean), -std::cos(lean), 0})));
    });
    return box.tilt() < 5 * kDegree;
  });
  BoxOnIncline slippery(setting, std::atan(0.3), 0.25, half);
  slippery.rig.run(2);
  return {absolute_row("steepest slope on which a box 1 : 3 stands, mu = 1", "deg", expected / kDegree,
                       found / kDegree, 0.2),
          absolute_row("tilt of the same that slides, tangent 0.3, mu = 0.25", "deg", 0,
                       slippery.tilt() / kDegree, 0.2)};
}

/// The acceleration is a = g sin theta / (1 + b), without slip if and only if mu >= tan theta b / (1 + b)
/// (textbook).
Rows rolling_down(const CheckSetting& setting) {
  const double angle = 20 * kDegree;
  Rows rows;
  for (const Wheel& wheel : wheels()) {
    rows.push_back(relative_row(std::string("speed after 1 s on 20 deg: ") + wheel.name, "m/s",
                                kGravity * std::sin(angle) / (1 + wheel.inertia),
                                roll_down(setting, 1, wheel, 1).speed));
  }
  const WeightedWheel rim = {.ring = 0.078, .ball = 0.02};
  rows.push_back(relative_row("speed after 2 s: drum with weights 2 mm below its rim", "m/s",
                              2 * kGravity * std::sin(angle) / (1 + rim.inertia()),
                              roll_down(setting, 1, {"", rim.inertia(), rim.desc()}, 2).speed));
  const Wheel ball = wheels()[0];
  const double least = std::tan(angle) * ball.inertia / (1 + ball.inertia);
  const double found = bisect(1.2 * least, 0.8 * least, 10, [&](double mu) {
    return std::abs(roll_down(setting, mu, ball, 2).slip) < 5e-4;
  });
  rows.push_back(relative_row("least friction for a ball to roll down 20 deg", "", least, found));
  return rows;
}

/// A plate of 10 kg on 25 balls of 1 kg is pushed by 150 N along the diagonal (the rolling test of
/// SimBenchmark, Kim and Hwangbo 2018). Nothing slips, and the balls go half as fast, so that a = F / (M + 25
/// m (1 + 2/5) / 4).
Rows rolling_test(const CheckSetting& setting) {
  const double radius = 0.1;
  Rig rig(setting, sleepless());
  rig.add(level_ground(0.16));  // sqrt(0.16 x 1) = 0.4 below the balls, sqrt(1 x 0.64) = 0.8 above.
  std::vector<BodyId> balls;
  for (int i = 0; i < 25; ++i) {
    const int row = i / 5;
    BodyDesc ball = moving(Shape::sphere(real(radius)), {0.5 * (i % 5 - 2), radius, 0.5 * (row - 2)});
    ball.mass = real(1);
    ball.contact.friction = real(1);
    balls.push_back(rig.add(ball));
  }
  BodyDesc plate = moving(box_of({2, 0.01, 2}), {0, 2 * radius + 0.01, 0});
  plate.mass = real(10);
  plate.contact.friction = real(0.64);
  const BodyId id = rig.add(plate);
  rig.run(1);  // Until every ball has its share of the weight.
  // Later the plate leaves the middle, and balls without load slip.
  for (int frame = 0; frame < 6; ++frame) {
    must(rig.world().apply_force(id, real(DVec3{150 * std::sqrt(0.5), 0, 150 * std::sqrt(0.5)})));
    rig.step();
  }
  const double expected = 0.1 * 150 / (10 + 25 * 1.4 / 4);
  double error = 0;
  for (const BodyId ball : balls)
    error = std::max(error, std::abs(length(rig.velocity(ball)) / (0.5 * expected) - 1));
  const DVec3 v = rig.velocity(id);
  return {relative_row("speed of a plate on 25 balls after 0.1 s", "m/s", expected, length(v)),
          absolute_row("largest error of a ball's speed, share", "", 0, error, 0.005),
          absolute_row("turn of the plate's way off the diagonal", "deg", 0,
                       (std::atan2(v.z, v.x) - kTau / 8) / kDegree, 0.1)};
}

/// A ball rolls through a loop from 2.7 times its height above the bottom, measured on the path of its
/// center: v^2 = g R at the top, and 7/10 of v^2 is energy (textbook).
Rows loop_the_loop(const CheckSetting& setting) {
  const double ball = 0.05;
  const double way = 1 - ball;
  const double expected = std::sqrt(2.7 / 0.7 * kGravity * way);
  const double found =
      bisect(1.3 * expected, 0.9 * expected, 10, [&](double speed) { return loops(setting, speed, ball); });
  return {relative_row("lowest start for a loop, over its radius", "", 2.7,
                       0.7 * found * found / (kGravity * way), 0.01)};
}

/// For a rod that slides on its lower end with friction above 4/3 no force satisfies Coulomb's law (Painleve
/// 1895). It must stay finite and gain no energy.
Rows painleve_rod(const CheckSetting& setting) {
  double gain = 0;
  bool healthy = true;
  for (const double lean_deg : {-50.0, -30.0, 30.0, 50.0}) {
    const double lean = lean_deg * kDegree;
    Rig rig(setting, sleepless());
    rig.add(level_ground(2));
    BodyDesc desc = moving(Shape::capsule(real(0.01), real(0.5)), {0, 0.01 + 0.5 * std::cos(lean), 0});
    desc.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, real(lean));
    desc.velocity = real(DVec3{6, 0, 0});
    desc.contact.friction = real(2);
    rig.add(desc);
    const double start = rig.energy().total();
    healthy = rig.run(3, [&] { gain = std::max(gain, rig.energy().total() / start - 1); }) && healthy;
  }
  return {absolute_row("largest gain of energy of a sliding rod, mu = 2, share", "", 0, gain, 0.005),
          absolute_row("steps of it that were not finite", "", 0, healthy ? 0 : 1, 0)};
}

/// A ball with rolling friction l [m] stops rolling after v0 (7/5) r / (l g), and with spinning friction l
/// stops spinning about the vertical after (2/5) r^2 w0 / (l g); the torque is l m g (textbook).
Rows resisted_balls(const CheckSetting& setting) {
  const double radius = 0.1;
  const double lever = 0.005;
  const auto ball_with = [&](double speed, DVec3 spin) {
    BodyDesc desc = moving(Shape::sphere(real(radius)), {0, radius, 0});
    desc.velocity = real(DVec3{speed, 0, 0});
    desc.angular_velocity = real(spin);
    desc.contact.rolling_friction = real(lever);
    desc.contact.spinning_friction = real(lever);
    return desc;
  };
  Rig rig(setting, sleepless());
  rig.add(level_ground(0.5));
  const BodyId rolling = rig.add(ball_with(1, {0, 0, -1 / radius}));
  BodyDesc other = ball_with(0, {0, 10, 0});
  other.position.z = 3;
  const BodyId spinning = rig.add(other);
  rig.run(0.5);
  const double roll_brake = lever * kGravity / (1.4 * radius);
  const double spin_brake = lever * kGravity / (0.4 * radius * radius);
  return {relative_row("speed of a rolling ball after 0.5 s, lever 5 mm", "m/s", 1 - 0.5 * roll_brake,
                       rig.velocity(rolling).x),
          relative_row("spin of a ball on one point after 0.5 s, lever 5 mm", "rad/s", 10 - 0.5 * spin_brake,
                       rig.spin(spinning).y)};
}

/// Against a smooth wall a rod stands if and only if mu >= sin(lean) / (2 (cos(lean) + r / L)), with r of its
/// round ends. For a thin rod this is tan(lean) / 2, as for one card of an A-frame (statics).
Rows leaning_ladder(const CheckSetting& setting) {
  const double radius = 0.02;
  Rows rows;
  for (const double lean_deg : {20.0, 35.0}) {
    const double lean = lean_deg * kDegree;
    const double expected = 0.5 * std::sin(lean) / (std::cos(lean) + radius);
    const double found = bisect(1.4 * expected, 0.6 * expected, 8, [&](double friction) {
      return ladder_stands(setting, lean, radius, friction);
    });
    rows.push_back(
        absolute_row("least friction for a ladder, lean " + std::to_string(lean_deg).substr(0, 2) + " deg",
                     "", expected, found, 0.01));
  }
  return rows;
}

}  // namespace hooke::check
