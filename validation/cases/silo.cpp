/// Tests balls in a bin, and what keeps a ball on a slope.

#include "validation/cases.h"
#include "validation/rig.h"

#include <cmath>
#include <cstdint>

namespace hooke::check {

namespace {

/// These are loads in [N], means over the time of measuring.
struct BinLoads {
  double weight = 0;  ///< Weight of the balls.
  double floor = 0;
  double walls = 0;  ///< Friction of the walls that carries balls.
};

/// This is a square bin of 0.45 m, open above, on a floor that can go down. All friction is 0.5.
struct Bin {
  static constexpr double kWidth = 0.45;
  Rig rig;
  std::vector<BodyId> walls;
  BodyId floor;
  BinLoads sum;

  Bin(const CheckSetting& setting, int balls, std::uint32_t seed) : rig(setting, without_air()) {
    for (int i = 0; i < 4; ++i) {
      const double side = i % 2 == 0 ? 1 : -1;
      BodyDesc wall = level_ground(0.5);
      if (i < 2) {
        wall.position.x = 0.5 * side * kWidth;
        wall.rotation = quaternion_about(Vec3{Real(0), Real(0), real(side)}, real(kTau / 4));
      } else {
        wall.position.z = 0.5 * side * kWidth;
        wall.rotation = quaternion_about(Vec3{real(-side), Real(0), Real(0)}, real(kTau / 4));
      }
      walls.push_back(rig.add(wall));
    }
    BodyDesc plate = moving(box_of({kWidth, 0.1, kWidth}), {0, -0.1, 0});
    plate.kind = BodyKind::kKinematic;
    floor = rig.add(plate);
    fill(balls, seed);
  }

  /// Fills in balls with radii of 45 to 55 mm, in loose layers of 16.
  void fill(int balls, std::uint32_t seed) {
    const auto random = [&] {
      seed = seed * 1664525U + 1013904223U;
      return (seed >> 8U) / 16777216.0;
    };
    for (int i = 0; i < balls; ++i) {
      const int row = i % 16 / 4;
      const int layer = i / 16;
      const double radius = 0.045 + 0.01 * random();
      DVec3 place = {kWidth * (i % 4 - 1.5) / 4, 0.06 + 0.11 * layer, kWidth * (row - 1.5) / 4};
      place.x += 0.005 * (random() - 0.5);
      place.z += 0.005 * (random() - 0.5);
      const BodyId ball = rig.add(moving(Shape::sphere(real(radius)), place));
      sum.weight += static_cast<double>(rig.world().mass(ball)) * kGravity;
    }
  }

  /// Adds what the balls exert on floor and walls at this moment.
  void measure() {
    for (const BodyContact& contact : rig.world().body_contacts()) {
      for (const BodyId wall : walls)
        if (contact.a == wall) sum.walls += static_cast<double>(contact.friction_force.y);
      if (contact.a == floor) sum.floor += static_cast<double>(contact.normal_force);
    }
  }
};

/// Lowers the floor by 3 cm/s for 4 s, until the walls' friction is fully in use, and takes means over the
/// last 2.7 s.
BinLoads loads(const CheckSetting& setting, int balls, std::uint32_t seed) {
  Bin bin(setting, balls, seed);
  bin.rig.run(1.5);
  must(bin.rig.world().set_velocity(bin.floor, real(DVec3{0, -0.03, 0})));
  int count = 0;
  for (int frame = 0; frame < 240; ++frame) {
    bin.rig.step();
    if (frame < 80 || frame % 4 != 0) continue;
    bin.measure();
    ++count;
  }
  return {bin.sum.weight, bin.sum.floor / count, bin.sum.walls / count};
}

/// Returns means of two packings, which differ by up to 10 %.
BinLoads mean_loads(const CheckSetting& setting, int balls) {
  const BinLoads one = loads(setting, balls, 1);
  const BinLoads two = loads(setting, balls, 2);
  return {0.5 * (one.weight + two.weight), 0.5 * (one.floor + two.floor), 0.5 * (one.walls + two.walls)};
}

double janssen(double weight, double most) {
  return most * (1 - std::exp(-weight / most));
}

/// Tells whether a ball at rest on a slope of this tangent stays. Its rolling friction is 20 mm.
bool ball_rests(const CheckSetting& setting, double slope) {
  const double angle = std::atan(slope);
  const double radius = 0.1;
  Rig rig(setting, sleepless());
  BodyDesc ground = level_ground(1);
  ground.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(-1)}, real(angle));
  rig.add(ground);
  BodyDesc desc =
      moving(Shape::sphere(real(radius)), {radius * std::sin(angle), radius * std::cos(angle), 0});
  desc.contact = {.friction = real(1), .rolling_friction = real(0.02)};
  const BodyId ball = rig.add(desc);
  rig.run(1);
  const double before = rig.center(ball).x;
  rig.run(1);
  return rig.center(ball).x - before < 1e-3;
}

}  // namespace

/// Walls with friction carry a part of what stands in a bin. Of a weight W the load F = F1 (1 - exp(-W / F1))
/// is left for the floor (Janssen, Z. Ver. Dt. Ing. 39, 1895, p. 1045), where F1 depends on the bin's width,
/// friction and ratio of stresses. The lowest filling gives F1, which predicts the others. Floor and walls
/// together still carry the whole weight.
///
/// A ball with rolling friction l [m] stays on a slope if and only if tan theta <= l / r, by the moments
/// about its lowest point, where friction is no less than that. This is the angle of repose of one ball.
Rows silo(const CheckSetting& setting) {
  const BinLoads low = mean_loads(setting, 60);
  const BinLoads middle = mean_loads(setting, 120);
  const BinLoads high = mean_loads(setting, 180);
  const double most =
      bisect(low.floor, 1000 * low.floor, 60, [&](double f) { return janssen(low.weight, f) < low.floor; });
  return {
      known_miss_turned(setting,
                        relative_row("load on a bin's floor, 120 balls, by that of 60", "N",
                                     janssen(middle.weight, most), middle.floor, 0.1),
                        "in a bin four balls wide, each packing carries another load, by up to 12 %"),
      known_miss(relative_row("load on a bin's floor, 180 balls, by that of 60", "N",
                              janssen(high.weight, most), high.floor, 0.1),
                 "in a bin four balls wide, packings carry 8 to 17 % less than the law; why is open"),
      relative_row("load on floor and walls, 180 balls", "N", high.weight, high.floor + high.walls, 0.01),
      relative_row("steepest slope on which a ball rests, tangent, lever 0.2 r", "", 0.2,
                   bisect(0.15, 0.25, 10, [&](double slope) { return ball_rests(setting, slope); }), 0.01)};
}

}  // namespace hooke::check
