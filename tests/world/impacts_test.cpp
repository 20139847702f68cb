#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr double kRadius = 0.1;

BodyDesc bouncing(const Shape& shape, DVec3 position, double restitution, double friction = 0) {
  BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = shape, .position = position, .can_sleep = false};
  desc.contact = {.friction = static_cast<Real>(friction), .restitution = static_cast<Real>(restitution)};
  return desc;
}

BodyDesc ball(DVec3 position, double restitution, double friction = 0) {
  return bouncing(Shape::sphere(static_cast<Real>(kRadius)), position, restitution, friction);
}

void add_floor(World& world, double restitution = 0, double friction = 0) {
  BodyDesc desc = bouncing(Shape::half_space(), {}, restitution, friction);
  desc.kind = BodyKind::kStatic;
  take(world.add_body(desc));
}

DVec3 velocity(const World& world, BodyId id) {
  return vector_cast<double>(world.velocity(id));
}

double energy_of(const World& world) {
  return world.measure().energy.kinetic;
}

/// How high the lowest point of a body comes after each of its bounces, by its energy.
std::vector<double> tops_of(World& world, BodyId id, double low, int count) {
  std::vector<double> tops;
  double top = 0;
  bool rises = false;
  for (int step = 0; static_cast<int>(tops.size()) < count && step < 100000; ++step) {
    run(world, 1);
    // The velocity is that of half a substep before.
    const double v = velocity(world, id).y - 0.5 * kGravity / 480;
    if (v > 0) top = world.pose(id).position.y - low + v * v / (2 * kGravity);
    if (rises && v < 0) tops.push_back(top);
    rises = v > 0;
  }
  return tops;
}

/// A closed box of six planes, 2 m wide, with balls and cubes of restitution `e` that fly about in it.
World make_room(double e, int workers) {
  WorldDesc desc = empty_space();
  desc.workers = workers;
  World world = make_world(desc);
  const Vec3 x = {Real(1), Real(0), Real(0)};
  const Vec3 z = {Real(0), Real(0), Real(1)};
  const Real right = static_cast<Real>(0.5 * M_PI);
  const auto add_wall = [&](DVec3 place, Quat turn) {
    BodyDesc wall = bouncing(Shape::half_space(), place, e, 0.3);
    wall.kind = BodyKind::kStatic;
    wall.rotation = turn;
    take(world.add_body(wall));
  };
  add_wall({0, -1, 0}, {});
  add_wall({0, 1, 0}, quaternion_about(x, Real(2) * right));
  add_wall({-1, 0, 0}, quaternion_about(z, -right));
  add_wall({1, 0, 0}, quaternion_about(z, right));
  add_wall({0, 0, -1}, quaternion_about(x, right));
  add_wall({0, 0, 1}, quaternion_about(x, -right));
  for (int i = 0; i < 27; ++i) {
    const DVec3 place = {0.5 * (i % 3 - 1), 0.5 * (i / 3 % 3 - 1), 0.5 * (i / 9 - 1)};
    const Real h = Real(0.08);
    BodyDesc body = i % 2 == 0 ? ball(place, e, 0.3) : bouncing(Shape::box({h, h, h}), place, e, 0.3);
    body.velocity =
        vector_cast<Real>(4.0 * DVec3{std::sin(1.0 + i), std::sin(2.0 + 3 * i), std::sin(5.0 + 7 * i)});
    body.angular_velocity = vector_cast<Real>(DVec3{2.0 - i % 5, 1.0 * (i % 3), -1});
    take(world.add_body(body));
  }
  return world;
}

}  // namespace

TEST_SUITE("world/impacts") {
  TEST_CASE("an impact goes through a row of balls within one step") {
    World world = make_world(empty_space());
    std::vector<BodyId> row;
    for (int i = 0; i < 5; ++i) {
      BodyDesc desc = ball({(2 * kRadius + 1e-4) * i, 0, 0}, 1);
      if (i == 0) desc.velocity = {Real(2), Real(0), Real(0)};
      row.push_back(take(world.add_body(desc)));
    }
    run(world, 1);
    for (int i = 0; i < 5; ++i)
      CHECK(velocity(world, row[i]).x == doctest::Approx(i == 4 ? 2 : 0).epsilon(1e-5));
  }

  TEST_CASE("a ball that rebounds moves on for the rest of the step") {
    WorldDesc desc = empty_space();
    desc.substeps = 1;
    World world = make_world(desc);
    add_floor(world);
    BodyDesc falling = ball({0, 0.3, 0}, 1);
    falling.velocity = {Real(0), Real(-18), Real(0)};
    const BodyId id = take(world.add_body(falling));
    run(world, 1);  // 0.2 m down, then 0.1 m up
    CHECK(velocity(world, id).y == doctest::Approx(18));
    CHECK(world.pose(id).position.y == doctest::Approx(kRadius + 0.1).epsilon(1e-5));
  }

  TEST_CASE("a ball that bounces fully keeps its energy at one substep of a thirtieth of a second, too") {
    WorldDesc desc;
    desc.substeps = 1;
    World world = make_world(desc);
    add_floor(world);
    const BodyId id = take(world.add_body(ball({0, 1 + kRadius, 0}, 1)));
    const double h = 1.0 / 30;
    double highest = 0;
    double lowest_top = 2;
    double before = 1;
    bool rising = false;
    for (int i = 0; i < 600; ++i) {
      run(world, 1, static_cast<Real>(h));
      const double y = world.pose(id).position.y - kRadius;
      if (rising && y < before) lowest_top = std::min(lowest_top, before);
      rising = y > before;
      before = y;
      highest = std::max(highest, y);
    }
    // The parabola through the places at the steps has its top g h^2 / 8 above the start, and steps miss it.
    const double aside = kGravity * h * h / 8;
    CHECK(highest < 1 + 1.01 * aside);
    CHECK(lowest_top > 1 - 1.01 * aside);
  }

  TEST_CASE("each bounce is e^2 as high as the one before, and flat boxes stay flat") {
    for (const double e : {1.0, 0.5}) {
      for (const bool is_box : {false, true}) {
        World world = make_world();
        add_floor(world);
        const double low = is_box ? 0.2 : kRadius;
        const Shape shape =
            is_box ? Shape::box({Real(0.3), Real(0.2), Real(0.5)}) : Shape::sphere(Real(kRadius));
        const BodyId id = take(world.add_body(bouncing(shape, {0, 2 + low, 0}, e, 0.5)));
        const std::vector<double> tops = tops_of(world, id, low, e == 1.0 ? 70 : 3);
        for (std::size_t i = 0; i < tops.size(); ++i)
          CHECK(tops[i] == doctest::Approx(2 * std::pow(e * e, 1.0 + i)).epsilon(1e-3));
        CHECK(*std::max_element(tops.begin(), tops.end()) < 2 * e * e * (1 + 1e-4));
        CHECK(length(world.angular_velocity(id)) < Real(0.01));
      }
    }
  }

  TEST_CASE("a rough ball that does not slide takes up a spin of 2/7 of the speed at its surface") {
    WorldDesc desc = empty_space();
    World world = make_world(desc);
    add_floor(world, 1, 1);
    BodyDesc thrown = ball({0, 0.3, 0}, 1, 1);
    thrown.velocity = {Real(3), Real(-6), Real(0)};
    const BodyId id = take(world.add_body(thrown));
    run(world, 10);
    // m dv = J, 2/5 m r^2 dw = J r, until v = r w; mu (1 + e) 6 > 2/7 3 (textbook).
    CHECK(velocity(world, id).x == doctest::Approx(3 * 5.0 / 7).epsilon(1e-5));
    CHECK(velocity(world, id).y == doctest::Approx(6).epsilon(1e-5));
    CHECK(d(world.angular_velocity(id).z) == doctest::Approx(-3 * 5.0 / 7 / kRadius).epsilon(1e-5));
  }

  TEST_CASE("a rough ball that slides is slowed by mu (1 + e) of its speed") {
    World world = make_world(empty_space());
    add_floor(world, 0.5, 0.1);
    BodyDesc thrown = ball({0, 0.3, 0}, 0.5, 0.1);
    thrown.velocity = {Real(5), Real(-4), Real(0)};
    const BodyId id = take(world.add_body(thrown));
    run(world, 10);
    CHECK(velocity(world, id).x == doctest::Approx(5 - 0.1 * 1.5 * 4).epsilon(1e-5));
    CHECK(velocity(world, id).y == doctest::Approx(2).epsilon(1e-5));
  }

  TEST_CASE("rotating boxes that collide keep momentum, angular momentum and, with e = 1, energy") {
    World world = make_world(empty_space());
    for (int i = 0; i < 6; ++i) {
      BodyDesc box =
          bouncing(Shape::box({Real(0.3), Real(0.1), Real(0.2)}), {0.7 * i, 0.05 * i, 0.03 * i * i}, 1);
      box.velocity = {Real(2.5 - i), Real(0), Real(0)};
      box.angular_velocity = {Real(1), Real(i - 3), Real(2)};
      take(world.add_body(box));
    }
    const Measurement before = world.measure();
    run(world, 120);
    const Measurement after = world.measure();
    const double momentum = std::sqrt(2 * before.energy.kinetic * 24);  // of 24 kg with this energy
    CHECK(length(after.momentum - before.momentum) < 1e-6 * momentum);
    CHECK(length(after.angular_momentum - before.angular_momentum) < 1e-5 * length(before.angular_momentum));
    CHECK(after.energy.kinetic == doctest::Approx(before.energy.kinetic).epsilon(5e-4));
  }

  TEST_CASE("a ball bounces off a tile that lies on the floor as off the floor") {
    World world = make_world();
    add_floor(world, 0, 0.5);
    BodyDesc tile = bouncing(Shape::box({Real(0.3), Real(0.02), Real(0.3)}), {0, 0.02, 0}, 0, 0.5);
    tile.mass = Real(1);
    take(world.add_body(tile));
    run(world, 30);
    BodyDesc falling = ball({0, 0.04 + kRadius + 0.5, 0}, 0.8);
    falling.mass = Real(1);
    const BodyId id = take(world.add_body(falling));
    double top = 0;
    bool down = true;
    for (int i = 0; i < 60; ++i) {
      run(world, 1);
      const double speed = velocity(world, id).y;
      if (speed > 0) down = false;
      if (!down) top = std::max(top, world.pose(id).position.y - 0.04 - kRadius);
    }
    CHECK(top == doctest::Approx(0.64 * 0.5).epsilon(0.03));
  }

  TEST_CASE(
      "a tile on the floor takes the impact of a ball ten thousand million times heavier, however they lie") {
    for (int i = 0; i < 20; ++i) {
      WorldDesc desc = empty_space();
      World world = make_world(desc);
      const Quat turn =
          quaternion_about(normalize(Vec3{Real(1), Real(0.3) * i, Real(2 - i)}), Real(0.37) * i);
      const auto place = [&](double y) { return vector_cast<double>(rotate(turn, Vec3{0, Real(y), 0})); };
      BodyDesc floor = bouncing(Shape::half_space(), {}, 0);
      floor.kind = BodyKind::kStatic;
      floor.rotation = turn;
      take(world.add_body(floor));
      BodyDesc tile = bouncing(Shape::box({Real(0.3), Real(0.1), Real(0.3)}), place(0.1), 0, 0.5);
      tile.rotation = turn;
      tile.mass = Real(0.3);
      const BodyId low = take(world.add_body(tile));
      BodyDesc heavy = bouncing(Shape::sphere(1), place(1.45), 0.5, 0.5);
      heavy.mass = Real(3e9);
      heavy.velocity = rotate(turn, Vec3{0, -1, 0});
      const BodyId high = take(world.add_body(heavy));
      for (int step = 0; step < 60; ++step) CHECK(world.step(Real(1) / 60).healthy());
      CHECK(dot(velocity(world, high), place(1)) == doctest::Approx(0.5).epsilon(0.02));
      CHECK(length(velocity(world, low)) < 3);
    }
  }

  TEST_CASE("a body between a floor that does not bounce and a ceiling that does is not torn apart") {
    World world = make_world();
    add_floor(world);
    BodyDesc ceiling = bouncing(Shape::half_space(), {0, 0.2, 0}, 1);
    ceiling.kind = BodyKind::kStatic;
    ceiling.rotation = quaternion_about(Vec3{Real(1), Real(0), Real(0)}, static_cast<Real>(M_PI));
    take(world.add_body(ceiling));
    BodyDesc cube = bouncing(Shape::box({Real(0.1), Real(0.1), Real(0.1)}), {0, 0.1, 0}, 0, 0.5);
    cube.velocity = {Real(0.2), Real(3), Real(0)};
    const BodyId id = take(world.add_body(cube));
    run(world, 120);
    CHECK(length(velocity(world, id)) < 0.3);
    CHECK(world.pose(id).position.y == doctest::Approx(0.1).epsilon(0.02));
  }

  TEST_CASE("what bounces on a rail at an angle to the wall gains no energy, and does not pass") {
    for (const int substeps : {4, 8, 16}) {
      CAPTURE(substeps);
      for (const double tilt : {0.0, 0.3, 1.0}) {
        CAPTURE(tilt);
        for (const Shape& shape : {Shape::sphere(Real(0.04)), Shape::cone(Real(0.03), Real(0.02))}) {
          WorldDesc desc = empty_space();
          desc.substeps = substeps;
          World world = make_world(desc);
          add_floor(world, 0.9, 0.25);
          const Vec3 along = {static_cast<Real>(std::sin(tilt)), static_cast<Real>(-std::cos(tilt)), 0};
          BodyDesc bead = bouncing(shape, {0, 1, 0}, 0.9, 0.25);
          bead.velocity = Real(10) * along;
          const BodyId id = take(world.add_body(bead));
          take(world.add_hook({.kind = HookKind::kSlider, .a = {.body = id}, .axis = along}));
          const double start = energy_of(world);
          double most = 0;
          double lowest = 1;
          for (int i = 0; i < 120; ++i) {
            run(world, 1);
            most = std::max(most, energy_of(world));
            lowest = std::min(lowest, world.center_of_mass(id).y);
          }
          CHECK(most < 1.001 * start);
          CHECK(lowest > 0);
        }
      }
    }
  }

  TEST_CASE("a ball on a thread that bounces fully off a wall keeps its energy") {
    World world = make_world(without_air());
    BodyDesc wall = bouncing(Shape::half_space(), {}, 1);
    wall.kind = BodyKind::kStatic;
    const Real half = std::sqrt(Real(0.5));
    wall.rotation = {0, 0, -half, half};  // its normal along x
    take(world.add_body(wall));
    const BodyId bob = take(world.add_body(ball({kRadius + 0.5, 0.5, 0}, 1)));
    take(world.add_hook({.kind = HookKind::kDistance,
                         .a = {.body = bob},
                         .anchor = {kRadius + 0.5, 0.5, 0},
                         .anchor_b = DVec3{kRadius, 0.5, 0}}));
    const double start = world.measure().energy.total();
    double off = 0;
    for (int i = 0; i < 1800; ++i) {
      run(world, 1);
      off = std::max(off, std::abs(world.measure().energy.total() - start));
    }
    const double swing = world.mass(bob) * kGravity * 0.5;
    CHECK(off < 0.005 * swing);
  }

  TEST_CASE("in a room full of rough balls and boxes energy is kept, or lost") {
    World lossless = make_room(1, 1);
    const double before = energy_of(lossless);
    double most = before;
    for (int i = 0; i < 300; ++i) {
      run(lossless, 1);
      most = std::max(most, energy_of(lossless));
    }
    CHECK(most < 1.001 * before);
    World lossy = make_room(0.5, 1);
    run(lossy, 300);
    CHECK(energy_of(lossy) < 0.5 * before);
  }

  TEST_CASE("the bits of impacts do not depend on the number of workers, nor on a restore") {
    const auto hash = [](int workers, bool restored) {
      World world = make_room(0.9, workers);
      run(world, 40);
      if (restored) {
        const Snapshot snapshot = world.snapshot();
        run(world, 5);
        REQUIRE(world.restore(snapshot).has_value());
      }
      run(world, 40);
      return world.state_hash();
    };
    CHECK(hash(1, false) == hash(3, false));
    CHECK(hash(1, false) == hash(1, true));
  }
}

}  // namespace hooke
