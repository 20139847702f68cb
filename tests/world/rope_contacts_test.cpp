/// Ropes that touch ropes, and themselves: statics, friction, momentum, knots.

#include "hooke/world.h"

#include "constants.h"
#include "world/knots.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr double kRadius = kRopeRadius;

/// Kinetic energy and momentum of an even rope.
struct Motion {
  double energy = 0;
  DVec3 momentum;
};
Motion motion_of(const World& world, RopeId rope, double mass) {
  const PointView v = world.velocities(rope);
  Motion motion;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double m = mass / static_cast<double>(v.size() - 1) * (i == 0 || i + 1 == v.size() ? 0.5 : 1);
    motion.energy += 0.5 * m * dot(v[i], v[i]);
    motion.momentum += m * v[i];
  }
  return motion;
}

}  // namespace

TEST_CASE("rope contacts: a rope hung over a taut one pulls it down as statics say") {
  World world = make_world(without_air());
  RopeDesc taut = touching(straight({-1, 0, 0}, {1, 0, 0}, 41), 0.002, 0.3);
  taut.pins = {{.point = 0}, {.point = last_of(taut)}};
  taut.stiffness = Real(2000);
  taut.inner_friction = Real(50);
  const RopeId below = take(world.add_rope(taut));
  RopeDesc hung = touching({}, 0.002, 0.3);
  const double bend = 2.05 * kRadius;
  for (int i = 0; i < 61; ++i) {
    const double s = -0.6 + 0.02 * i;
    const double past = std::abs(s) - 0.5 * std::numbers::pi * bend;
    hung.points.push_back(past > 0 ? DVec3{0.025, -past, s > 0 ? bend : -bend}
                                   : DVec3{0.025, bend * std::cos(s / bend), bend * std::sin(s / bend)});
  }
  hung.loads = {{.point = 0, .mass = Real(1)}, {.point = last_of(hung), .mass = Real(1)}};
  const RopeId above = take(world.add_rope(hung));
  run(world, 480);

  const double weight = 2.003 * 9.80665;
  double sag = 0.01;  // 2 T sin = weight, T = k (length - 2 m)
  for (int i = 0; i < 200; ++i) {
    const double half = std::sqrt(1 + sag * sag);
    sag += 1e-4 * (weight - 2 * 2000 * (2 * half - 2) * sag / half);
  }
  double lowest = 0;
  for (std::size_t i = 0; i < 41; ++i) lowest = std::min(lowest, world.positions(below)[i].y);
  CHECK(-lowest == doctest::Approx(sag).epsilon(0.01));
  CHECK(least_distance(world.positions(below), world.positions(above), false) ==
        doctest::Approx(2 * kRadius).epsilon(0.02));
}

TEST_CASE("rope contacts: what is hung over a thick rope holds up to e^(mu pi) times the other weight") {
  constexpr double kFriction = 0.3;
  constexpr double kThick = 0.045;
  const auto slides = [&](double share) {
    World world = make_world(without_air());
    RopeDesc bar = touching({{0, 0, -0.3}, {0, 0, 0.3}}, 1, kFriction);
    bar.pins = {{.point = 0}, {.point = 1}};
    bar.radius = static_cast<Real>(kThick);
    take(world.add_rope(bar));
    RopeDesc hung = touching({}, 0.01, kFriction);
    const double bend = kThick + kRadius;
    const double half = 0.5 * std::numbers::pi * bend + 0.4;
    for (int i = 0; i < 97; ++i) {
      const double s = -half + half * i / 48;
      const double past = std::abs(s) - half + 0.4;
      hung.points.push_back(past > 0 ? DVec3{s > 0 ? bend : -bend, -past, 0}
                                     : DVec3{bend * std::sin(s / bend), bend * std::cos(s / bend), 0});
    }
    const double ratio = std::exp(kFriction * std::numbers::pi);
    hung.loads = {{.point = 0, .mass = Real(1)},
                  {.point = last_of(hung), .mass = static_cast<Real>(share * ratio)}};
    const RopeId rope = take(world.add_rope(hung));
    run(world, 60);
    const double before = world.positions(rope)[96].y;
    run(world, 30);
    return before - world.positions(rope)[96].y;
  };
  CHECK(slides(0.95) < 0.001);
  CHECK(slides(1.05) > 0.003);
}

TEST_CASE("rope contacts: momentum stays when free ropes collide, and they do not pass at 50 m/s") {
  for (const double speed : {2.0, 50.0}) {
    for (const double angle : {0.4, 0.9, 1.57}) {
      CAPTURE(speed);
      CAPTURE(angle);
      World world = make_world(empty_space());
      const DVec3 along = 0.5 * DVec3{std::cos(angle), 0, std::sin(angle)};
      RopeDesc low = touching(straight({-0.5, 0, 0}, {0.5, 0, 0}, 41), 0.1, 0.3);
      RopeDesc high =
          touching(straight(DVec3{0.007, 0.1, 0} - along, DVec3{0.007, 0.1, 0} + along, 41), 0.1, 0.3);
      low.velocity = {Real(0.3), static_cast<Real>(0.5 * speed), Real(0.1)};
      high.velocity = {Real(0.1), static_cast<Real>(-0.5 * speed), Real(0)};
      const RopeId a = take(world.add_rope(low));
      const RopeId b = take(world.add_rope(high));
      const auto all = [&] {
        const Motion of_a = motion_of(world, a, 0.1);
        const Motion of_b = motion_of(world, b, 0.1);
        return Motion{of_a.energy + of_b.energy, of_a.momentum + of_b.momentum};
      };
      const Motion start = all();
      for (int i = 0; i < 80; ++i) {
        run(world, 1, static_cast<Real>(0.1 / speed / 20));
        CHECK(least_distance(world.positions(a), world.positions(b), false) > kRadius);
        CHECK(world.positions(b)[20].y > world.positions(a)[20].y);
      }
      const Motion end = all();
      CHECK(length(end.momentum - start.momentum) < 1e-6 * 0.05 * speed);
      CHECK(end.energy < (1 - 1e-3) * start.energy);
    }
  }
}

/// An overhand knot of segments of a length, one end held and a load at the other, pulled along x.
struct PulledKnot {
  PulledKnot(double spacing, double friction, double load) {
    RopeDesc desc = overhand(spacing, friction);
    desc.pins = {{.point = 0}};
    desc.loads = {{.point = last_of(desc), .mass = static_cast<Real>(load)}};
    desc.axial_stiffness = Real(2e4);
    rope = take(world.add_rope(desc));
  }

  static World pulled_along_x() {
    WorldDesc desc = without_air();
    desc.gravity = {Real(9.80665), Real(0), Real(0)};
    return make_world(desc);
  }

  [[nodiscard]] double determinant() const { return knot_determinant(world.positions(rope)); }
  [[nodiscard]] double least_between_turns() const {
    return least_distance(world.positions(rope), world.positions(rope), true, 3.2 * kRadius);
  }

  World world = pulled_along_x();
  RopeId rope;
};

TEST_CASE("rope contacts: an overhand knot tightens, holds 10 kg and stays a knot") {
  for (const double friction : {0.1, 0.4}) {
    CAPTURE(friction);
    PulledKnot knot(2 * kRadius, friction, 10);
    for (int i = 0; i < 240; ++i) {
      run(knot.world, 1);
      CHECK(knot.determinant() == doctest::Approx(3));
      CHECK(knot.least_between_turns() > 0.4 * kRadius);
    }
    CHECK(knot.least_between_turns() > 1.8 * kRadius);
  }
}

TEST_CASE("rope contacts: a snatch of up to 100 kg does not pull a knot through itself") {
  struct Snatch {
    double spacing, friction, load;
  };
  // Without the last look at what passes each of them is plain rope after 13 to 25 steps.
  for (const Snatch snatch : {Snatch{1.5, 0.1, 30}, {2.0, 0.1, 30}, {1.0, 0.1, 100}, {1.5, 0.2, 100}}) {
    CAPTURE(snatch.spacing);
    CAPTURE(snatch.load);
    PulledKnot knot(snatch.spacing * kRadius, snatch.friction, snatch.load);
    for (int i = 0; i < 90; ++i) {
      run(knot.world, 1);
      CHECK(knot.determinant() == doctest::Approx(3));
    }
  }
}

TEST_CASE("rope contacts: turns around a rope hold a load by friction alone") {
  const auto end_falls = [](double friction) {
    World world = make_world(without_air());
    RopeDesc bar = touching({{0, 0, -0.3}, {0, 0, 0.3}}, 1, friction);
    bar.pins = {{.point = 0}, {.point = 1}};
    bar.radius = Real(0.02);
    take(world.add_rope(bar));
    RopeDesc turns = touching({}, 0.03, friction);
    const double bend = 0.02 + 1.01 * kRadius;
    const double pitch = 2.4 * kRadius / (2 * std::numbers::pi);
    std::vector<DVec3> fine = straight({bend, -0.3, 0}, {bend, 0, 0}, 1000);
    for (int i = 1; i < 20000; ++i) {
      const double turn = 5 * std::numbers::pi * i / 20000;
      fine.push_back({bend * std::cos(turn), bend * std::sin(turn), pitch * turn});
    }
    const std::vector<DVec3> tail =
        straight({-bend, 0, 5 * std::numbers::pi * pitch}, {-bend, -0.1, 5 * std::numbers::pi * pitch}, 1000);
    fine.insert(fine.end(), tail.begin(), tail.end());
    turns.points = resampled(fine, 0.01);
    turns.loads = {{.point = 0, .mass = Real(5)}};
    const RopeId rope = take(world.add_rope(turns));
    const double before = world.positions(rope)[0].y;
    run(world, 90);
    return before - world.positions(rope)[0].y;
  };
  CHECK(end_falls(0.6) < 0.05);
  CHECK(end_falls(0) > 1);
}

TEST_CASE("rope contacts: a rope dropped in a heap comes to rest without overlap") {
  constexpr double kThick = 0.01;
  World world = make_world(without_air());
  BodyDesc ground;
  ground.kind = BodyKind::kStatic;
  ground.parts = {{.shape = Shape::half_space()}};
  take(world.add_body(ground));
  RopeDesc desc = touching({}, 0.5, 0.4);
  desc.radius = static_cast<Real>(kThick);
  for (int i = 0; i < 65; ++i) {
    const double turn = 0.375 * i;
    desc.points.push_back({0.08 * std::cos(turn), 0.15 + 0.0045 * i, 0.08 * std::sin(turn)});
  }
  const RopeId rope = take(world.add_rope(desc));
  const auto energy = [&] {
    double sum = motion_of(world, rope, 0.5).energy;
    for (std::size_t i = 0; i < 65; ++i)
      sum += 0.5 / 64 * (i == 0 || i == 64 ? 0.5 : 1) * 9.80665 * world.positions(rope)[i].y;
    return sum;
  };
  const double start = energy();
  for (int i = 0; i < 300; ++i) {
    run(world, 1);
    CHECK(energy() < (1 + 1e-3) * start);
  }
  CHECK(motion_of(world, rope, 0.5).energy < 1e-3 * start);
  CHECK(least_distance(world.positions(rope), world.positions(rope), true, 3.3 * kThick) > 0.9 * 2 * kThick);
}

TEST_CASE("rope contacts: ropes have the same bits for any number of workers, and after a restore") {
  check_same_bits(without_air(), [](World& world) {
    RopeDesc taut = touching(straight({-0.5, 0, 0}, {0.5, 0, 0}, 31), 0.05, 0.4);
    taut.pins = {{.point = 0}, {.point = last_of(taut)}};
    take(world.add_rope(taut));
    for (int i = 0; i < 3; ++i) {
      const double x = 0.05 * i;
      take(world.add_rope(touching(straight({x, 0.03 + 0.02 * i, -0.2}, {x, 0.03, 0.25}, 31), 0.05, 0.4)));
    }
    RopeDesc knot = overhand(0.01, 0.4);
    for (DVec3& p : knot.points) p += DVec3{0, 0.2, 0};
    take(world.add_rope(knot));
  });
}

TEST_CASE("rope contacts: three long ropes that rush into each other take no more work than their budget") {
  World world = make_world();
  take(world.add_body({.shape = Shape::half_space()}));
  constexpr int kSegments = 120;
  for (int r = 0; r < 3; ++r) {
    const double turn = r * 2 * std::numbers::pi / 3;
    const DVec3 along = {std::cos(turn), 0, std::sin(turn)};
    RopeDesc rope{.total_mass = Real(0.3), .points = {}, .pins = {}, .radius = Real(0.01)};
    rope.touches_ropes = true;
    for (int i = 0; i <= kSegments; ++i) {
      const double s = i / static_cast<double>(kSegments) - 0.5;
      const DVec3 waves = {0.1 * std::sin(14 * s), 0.5 + 0.15 * std::sin(9 * s + r) + 0.02 * r,
                           0.1 * std::cos(11 * s)};
      rope.points.push_back(2 * s * along + waves);
    }
    const RopeId id = take(world.add_rope(rope));
    for (const int end : {0, kSegments}) {
      const DVec3 place = rope.points[static_cast<std::size_t>(end)];
      const BodyId body = take(world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = Shape::sphere(Real(0.08)),
                                               .position = place,
                                               .velocity = vector_cast<Real>((end == 0 ? 3 : -3) * along),
                                               .mass = Real(r == 1 ? 20 : 2)}));
      take(world.add_hook({.a = {.body = body},
                           .b = {.point = point(id, static_cast<std::uint32_t>(end))},
                           .anchor = place}));
    }
  }
  std::uint32_t cut_short = 0;
  for (int i = 0; i < 40; ++i) {
    const StepReport report = world.step(Real(1) / Real(60));
    REQUIRE(report.healthy());
    cut_short += report.coupled_groups_cut_short;
  }
  CHECK(cut_short > 0);
  // And what was cut short holds nonetheless.
  CHECK(world.measure().largest_stretch < 0.02);
}

TEST_CASE(
    "rope contacts: ropes so thick that each segment touches all others are solved in part, which is "
    "reported") {
  World world = make_world();
  std::uint32_t refused = 0;
  for (int r = 0; r < 2; ++r) {
    RopeDesc rope = touching(straight({-0.5, 0.1 * r, 0}, {0.5, 0.1 * r, 0}, 81), 0.3, 0.5);
    rope.radius = Real(1);
    rope.pins = {{.point = 0}};
    take(world.add_rope(rope));
  }
  for (int i = 0; i < 5; ++i) {
    const StepReport report = world.step(Real(1) / Real(60));
    CHECK(report.healthy());
    refused += report.rows_refused;
  }
  CHECK(refused > 0);
}

TEST_CASE("rope contacts: ropes that do not ask for it pass through each other") {
  World world = make_world(empty_space());
  RopeDesc low = touching(straight({-0.5, 0, 0}, {0.5, 0, 0}, 21), 0.1, 0.3);
  RopeDesc high = touching(straight({0, 0.1, -0.5}, {0, 0.1, 0.5}, 21), 0.1, 0.3);
  high.velocity = {Real(0), Real(-2), Real(0)};
  high.touches_ropes = false;
  take(world.add_rope(low));
  const RopeId rope = take(world.add_rope(high));
  run(world, 60);
  CHECK(world.positions(rope)[10].y == doctest::Approx(-1.9).epsilon(1e-4));
}

}  // namespace hooke
