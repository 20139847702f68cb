#include "constants.h"
#include "geometry/meshes.h"
#include "solver/soft/particle_kernels.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

BodyDesc cube(DVec3 position, double half = 0.5) {
  const auto h = static_cast<Real>(half);
  BodyDesc desc;
  desc.kind = BodyKind::kDynamic;
  desc.shape = Shape::box({h, h, h});
  desc.position = position;
  return desc;
}

WorldDesc without_sleep() {
  WorldDesc desc;
  desc.sleeping = false;
  return desc;
}

/// A half-space whose surface rises along x by `angle`.
BodyId add_slope(World& world, double angle, double friction) {
  BodyDesc slope;
  slope.shape = Shape::half_space();
  slope.rotation = quaternion_about(Vec3{0, 0, 1}, static_cast<Real>(angle));
  slope.contact.friction = static_cast<Real>(friction);
  return take(world.add_body(slope));
}

double weight_on(const World& world, BodyId ground) {
  double sum = 0;
  for (const BodyContact& contact : world.body_contacts()) {
    if (contact.a == ground || contact.b == ground)
      sum += static_cast<double>(contact.normal_force) * std::abs(static_cast<double>(contact.normal.y));
  }
  return sum;
}

/// Boxes, balls, capsules and a drum that fall on a heap.
World make_heap(int workers) {
  WorldDesc desc;
  desc.workers = workers;
  World world = make_world(desc);
  add_slope(world, 0, 0.6);
  const Shape shapes[] = {Shape::box({Real(0.3), Real(0.2), Real(0.4)}), Shape::sphere(Real(0.3)),
                          Shape::capsule(Real(0.15), Real(0.3)), Shape::cylinder(Real(0.2), Real(0.25))};
  for (int i = 0; i < 60; ++i) {
    BodyDesc body;
    body.kind = BodyKind::kDynamic;
    body.shape = shapes[i % 4];
    body.contact.rolling_friction = Real(0.05);
    body.contact.spinning_friction = Real(0.02);
    body.position = {0.35 * (i % 3) - 0.3 + 0.01 * i, 0.6 + 0.35 * i, 0.3 * (i % 2)};
    body.rotation = quaternion_about(Vec3{Real(1), Real(i % 5), Real(0.5)}, Real(0.3) * static_cast<Real>(i));
    take(world.add_body(body));
  }
  return world;
}

std::vector<std::uint64_t> hashes_of(World world, int steps) {
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < steps; ++i) {
    world.step(Real(1) / Real(60));
    if (i % 10 == 9) hashes.push_back(world.state_hash());
  }
  return hashes;
}

}  // namespace

TEST_SUITE("world/bodies") {
  TEST_CASE("a body falls as gravity says, and keeps its spin") {
    World world = make_world(without_sleep());
    BodyDesc desc = cube({0, 10, 0});
    desc.velocity = {1, 0, 0};
    desc.angular_velocity = {0, 3, 0};
    const BodyId body = take(world.add_body(desc));
    run(world, 60);
    // Semi-implicit Euler is off by g t h / 2.
    const double h = 1.0 / 480;
    CHECK(world.pose(body).position.y == doctest::Approx(10 - kGravity / 2 - kGravity * h / 2).epsilon(1e-5));
    CHECK(world.pose(body).position.x == doctest::Approx(1).epsilon(1e-5));
    CHECK(world.velocity(body).y == doctest::Approx(-kGravity).epsilon(1e-5));
    CHECK(world.angular_velocity(body).y == doctest::Approx(3).epsilon(1e-5));
  }

  TEST_CASE("mass and center come from the volume of the shapes") {
    World world = make_world({});
    BodyDesc desc = cube({0, 0, 0});
    CHECK(world.mass(take(world.add_body(desc))) == doctest::Approx(1000));
    desc.shape = Shape::compound();
    desc.parts = {
        {.shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}), .density = 1000},
        {.shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}), .position = {1, 0, 0}, .density = 3000}};
    const BodyId pair = take(world.add_body(desc));
    CHECK(world.mass(pair) == doctest::Approx(4000));
    CHECK(world.center_of_mass(pair).x == doctest::Approx(0.75));
    CHECK(world.pose(pair).position.x == doctest::Approx(0));
  }

  TEST_CASE("a stack of ten stands, and its weight is on the ground") {
    World world = make_world(without_sleep());
    const BodyId ground = add_slope(world, 0, 0.6);
    std::vector<BodyId> boxes;
    for (int i = 0; i < 10; ++i) boxes.push_back(take(world.add_body(cube({0, 0.5 + i, 0}))));
    run(world, 600);
    CHECK(weight_on(world, ground) == doctest::Approx(10 * 1000 * kGravity).epsilon(1e-3));
    for (int i = 0; i < 10; ++i) {
      const DVec3 p = world.pose(boxes[i]).position;
      CHECK(p.y == doctest::Approx(0.5 + i).epsilon(0.01));
      CHECK(std::hypot(p.x, p.z) < 1e-3);
    }
  }

  TEST_CASE("a box on a slope sticks while tan(angle) <= friction and else slides with g (sin - mu cos)") {
    const double angle = 20 * 3.14159265358979 / 180;
    const double slide = kGravity * (std::sin(angle) - 0.2 * std::cos(angle));
    for (const double friction : {0.2, 0.4}) {
      World world = make_world(without_sleep());
      add_slope(world, angle, friction);
      BodyDesc desc = cube({-0.5 * std::sin(angle), 0.5 * std::cos(angle), 0});
      desc.rotation = quaternion_about(Vec3{0, 0, 1}, static_cast<Real>(angle));
      desc.contact.friction = static_cast<Real>(friction);
      const BodyId body = take(world.add_body(desc));
      run(world, 30);
      const double before = length(vector_cast<double>(world.velocity(body)));
      run(world, 60);
      const double gained = length(vector_cast<double>(world.velocity(body))) - before;
      if (friction < 0.3) CHECK(gained == doctest::Approx(slide).epsilon(2e-3));
      if (friction > 0.3) CHECK(std::abs(gained) < 1e-5);
    }
  }

  TEST_CASE("a ball that bounces fully comes back to its height and never above it") {
    World world = make_world(without_sleep());
    add_slope(world, 0, 0);
    BodyDesc desc = cube({0, 2, 0});
    desc.shape = Shape::sphere(Real(0.5));
    desc.contact.restitution = 1;
    const BodyId ball = take(world.add_body(desc));
    double highest = 0;
    double last_peak = 0;
    double before = 2;
    bool rising = false;
    for (int i = 0; i < 60 * 30; ++i) {
      run(world, 1);
      const double y = world.pose(ball).position.y;
      if (rising && y < before) last_peak = before;
      rising = y > before;
      before = y;
      if (i > 30) highest = std::max(highest, y);
    }
    CHECK(highest < 2.0005);
    CHECK(last_peak > 1.98);  // peaks between two steps are missed by up to g dt^2 / 8
  }

  TEST_CASE("a heap comes to rest and sleeps, and a push wakes it") {
    World world = make_heap(1);
    for (int i = 0; i < 60 * 20; ++i) world.step(Real(1) / Real(60));
    const Measurement at_rest = world.measure();
    CHECK(at_rest.energy.kinetic < 1e-6);
    CHECK(at_rest.largest_penetration < 0.02);
    const StepReport asleep = world.step(Real(1) / Real(60));
    CHECK(asleep.bodies_awake == 0);
    CHECK(asleep.contacts >= 60);  // each touches something
    CHECK(asleep.pairs >= 60);

    take(world.add_body(cube({0, 6, 0})));
    CHECK(world.step(Real(1) / Real(60)).bodies_awake == 1);
    std::uint32_t most = 0;
    for (int i = 0; i < 90; ++i) most = std::max(most, world.step(Real(1) / Real(60)).bodies_awake);
    CHECK(most > 3);  // what it falls on, and what that touches
  }

  TEST_CASE(
      "bodies that sleep far from moving ones keep their contacts, and fall when their ground is removed") {
    World world = make_world();
    BodyDesc ground;
    ground.shape = Shape::box({5, Real(0.5), 5});
    std::vector<BodyId> grounds, lower, upper;
    for (int i = 0; i < 20; ++i) {
      ground.position = {20.0 * i, -0.5, 0};
      grounds.push_back(take(world.add_body(ground)));
      lower.push_back(take(world.add_body(cube({20.0 * i, 0.5, 0}))));
      upper.push_back(take(world.add_body(cube({20.0 * i, 1.5, 0}))));
    }
    BodyDesc bird = cube({0, 100, 0});
    bird.gravity_scale = 0;
    bird.velocity = {1, 0, 0};
    take(world.add_body(bird));
    run(world, 120);
    CHECK(world.step(Real(1) / Real(60)).bodies_awake == 1);
    const StepReport asleep = world.step(Real(1) / Real(60));
    CHECK(asleep.contacts == 20 * 8);
    CHECK(asleep.pairs == 20 * 2);
    CHECK(world.body_contacts().size() == 20 * 8);
    CHECK(world.body_contacts(lower[7]).size() == 8);
    CHECK(world.measure().largest_penetration > 0);

    // It goes on as one that was restored when all of them slept.
    const Snapshot at_rest = world.snapshot();
    const auto strike = [&] {
      REQUIRE(world.apply_impulse(upper[3], {0, 0, 4000}));
      CHECK(world.step(Real(1) / Real(60)).pairs == 20 * 2);  // each once
      run(world, 30);
      CHECK(world.step(Real(1) / Real(60)).pairs == 20 * 2 - 1);
      return world.state_hash();
    };
    const std::uint64_t struck = strike();
    CHECK_FALSE(world.asleep(upper[3]));
    CHECK(world.pose(upper[3]).position.z > 1);
    CHECK(world.asleep(upper[4]));
    REQUIRE(world.restore(at_rest));
    CHECK(strike() == struck);

    REQUIRE(world.remove(grounds[9]));
    run(world, 30);
    CHECK(world.pose(lower[9]).position.y == doctest::Approx(0.5 - 0.5 * 9.81 * 0.25).epsilon(0.05));
    CHECK(world.pose(upper[9]).position.y == doctest::Approx(1.5 - 0.5 * 9.81 * 0.25).epsilon(0.05));
    CHECK(world.asleep(upper[10]));
    CHECK(world.body_contacts(lower[9]).size() <= 4);  // those of the two that fall together
  }

  TEST_CASE(
      "a heap has the same bits for any number of workers, on any instruction set, and after a restore") {
    const std::vector<std::uint64_t> expected = hashes_of(make_heap(1), 120);
    for (const int workers : {2, 3, 8}) CHECK(hashes_of(make_heap(workers), 120) == expected);
    for (const std::string& target : solver::wide::targets()) {
      CAPTURE(target);
      solver::wide::use_target(target);
      CHECK(hashes_of(make_heap(1), 120) == expected);
    }
    solver::wide::use_target("");
    World world = make_heap(1);
    run(world, 60);
    const Snapshot middle = world.snapshot();
    run(world, 60);
    REQUIRE(world.restore(middle));
    run(world, 60);
    CHECK(world.state_hash() == expected.back());
  }

  TEST_CASE("momentum is kept when bodies collide far from any other") {
    WorldDesc desc = without_sleep();
    desc.gravity = {};
    World world = make_world(desc);
    for (int i = 0; i < 5; ++i) {
      BodyDesc body = cube({1.6 * i, 0.13 * i, 0.07 * i * i});
      body.velocity = {Real(2 - i), Real(0.1), 0};
      body.angular_velocity = {Real(0.3), Real(i), Real(-1)};
      body.contact.restitution = Real(0.5);
      take(world.add_body(body));
    }
    const Measurement before = world.measure();
    run(world, 240);
    const Measurement after = world.measure();
    const double size = 5000 * 2;
    CHECK(length(after.momentum - before.momentum) < 1e-5 * size);
    // A hit acts where the bodies were at the start of the step: off by their way in the step, 2 cm.
    CHECK(length(after.angular_momentum - before.angular_momentum) < 5e-3 * size);
    CHECK(after.energy.total() <= before.energy.total() * (1 + 1e-6));
  }

  TEST_CASE("a tower of 4 x 4 x 20 boxes, too large to be solved directly, does not begin to tilt") {
    World world = make_world(without_sleep());
    add_slope(world, 0, 0.6);
    std::vector<BodyId> boxes;
    std::vector<DVec3> places;
    for (int i = 0; i < 320; ++i) {
      places.push_back({i % 4 - 1.5, i / 16 + 0.5, i / 4 % 4 - 1.5});
      boxes.push_back(take(world.add_body(cube(places.back()))));
    }
    run(world, 900);
    double aside = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const DVec3 way = world.pose(boxes[i]).position - places[i];
      aside = std::max(aside, std::hypot(way.x, way.z));
    }
    CHECK(aside < 0.004);
  }

  TEST_CASE("impossible bodies are refused, and the error names the field") {
    World world = make_world({});
    const auto refused = [&](const BodyDesc& desc) {
      const Result<BodyId> result = world.add_body(desc);
      return result ? std::string("accepted") : result.error().where;
    };
    BodyDesc body = cube({0, 0, 0});
    body.density = 0;
    CHECK(refused(body) == "body.density");
    body = cube({0, 0, 0});
    body.shape = Shape::half_space();
    CHECK(refused(body) == "body.shape");
    MeshDesc open = test::make_box({Real(1), Real(1), Real(1)});
    open.triangles.pop_back();
    body.shape = Shape::of_mesh(take(world.add_mesh(open)));
    CHECK(refused(body) == "body.shape.mesh");
    body = cube({0, 0, 0});
    body.shape = Shape::compound();
    CHECK(refused(body) == "body.parts");
    body.parts = {{.shape = Shape::sphere(-1)}};
    CHECK(refused(body) == "body.parts[0].shape.radius");
    body = cube({0, 0, 0});
    body.mass = Real(-1);
    CHECK(refused(body) == "body.mass");
    body = cube({0, 0, 0});
    body.shape = Shape::hull_of({});
    CHECK(refused(body) == "body.shape.mesh");
  }

  TEST_CASE("a body that flies and spins has the energy m v^2 / 2 + I w^2 / 2, and m g h") {
    World world = make_world(without_sleep());
    BodyDesc flying = cube({0, 3, 0});
    flying.velocity = {2, 0, 0};
    flying.angular_velocity = {0, 6, 0};
    const BodyId id = take(world.add_body(flying));
    const BodyId other = take(world.add_body(cube({5, 1, 0})));
    // A cube of 1 m has 1000 kg, and the moment of inertia m a^2 / 6 about an axis through its center.
    CHECK(world.energy(id).kinetic ==
          doctest::Approx(0.5 * 1000 * 4 + 0.5 * (1000.0 / 6) * 36).epsilon(1e-5));
    CHECK(world.energy(id).potential == doctest::Approx(1000 * kGravity * 3).epsilon(1e-6));
    CHECK(world.energy(id).elastic == 0);
    run(world, 30);
    const Energy sum = world.measure().energy;
    CHECK(world.energy(id).kinetic + world.energy(other).kinetic ==
          doctest::Approx(sum.kinetic).epsilon(1e-12));
    CHECK(world.energy(id).potential + world.energy(other).potential ==
          doctest::Approx(sum.potential).epsilon(1e-12));
    CHECK(world.energy(BodyId{}).total() == 0);
  }

  TEST_CASE("a concave solid of triangles falls with the mass of its inside, and does not fill its hull") {
    // 3 m^2 by 1 m; by the areas of its two arms the center is at (2 1 + 1 0.5) / 3 = 5/6 along both.
    World world = make_world();
    const MeshId ell = take(world.add_mesh(test::make_ell(Real(0.5))));
    BodyDesc corner = {.kind = BodyKind::kDynamic, .shape = Shape::of_mesh(ell), .position = {0, 4, 0}};
    corner.density = 500;
    const BodyId id = take(world.add_body(corner));
    const DVec3 center = world.center_of_mass(id);
    CHECK(length(center - DVec3{5.0 / 6, 4 + 5.0 / 6, 0}) < 1e-6);
    CHECK(world.measure().energy.potential == doctest::Approx(1500 * kGravity * center.y).epsilon(1e-6));
    // A ball falls with it, in the corner that the hull covers.
    const BodyId ball = take(world.add_body(
        {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.2)), .position = {1.25, 4 + 1.25, 0}}));
    run(world, 30);
    const double fallen = center.y - world.center_of_mass(id).y;
    CHECK(fallen == doctest::Approx(kGravity * 0.125).epsilon(0.02));
    CHECK(world.pose(ball).position.y == doctest::Approx(5.25 - fallen).epsilon(1e-6));
    CHECK(world.body_contacts().empty());
    // The arm that stands keeps what comes from aside.
    take(world.add_body({.shape = Shape::half_space(), .position = {0, -1, 0}}));
    run(world, 120);
    CHECK(world.pose(ball).position.y > -1 + 0.9);  // on the lying arm, 1 m thick
    CHECK(world.pose(ball).position.x > 1);
  }

  TEST_CASE("a flat body slides down a slope from the start as Coulomb has it") {
    constexpr double kSlope = 0.5;
    constexpr double kFriction = 0.35;
    const Quat tilt = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, Real(-kSlope));
    const DVec3 up = {std::sin(kSlope), std::cos(kSlope), 0};
    const DVec3 down = {std::cos(kSlope), -std::sin(kSlope), 0};
    const double acceleration = kGravity * (std::sin(kSlope) - kFriction * std::cos(kSlope));
    const ContactDesc contact = {.friction = Real(kFriction)};
    // Plates, whose upper corners are within the margin of contact.
    for (const DVec3 half : {DVec3{0.02, 0.0068, 0.02}, {0.1, 0.002, 0.1}}) {
      for (const double speed : {0.0, 1.2}) {
        CAPTURE(half.y);
        CAPTURE(speed);
        World world = make_world(without_air());
        take(world.add_body({.shape = Shape::half_space(), .rotation = tilt, .contact = contact}));
        const BodyId body = take(world.add_body({.kind = BodyKind::kDynamic,
                                                 .shape = Shape::box(vector_cast<Real>(half)),
                                                 .position = half.y * up,
                                                 .rotation = tilt,
                                                 .velocity = vector_cast<Real>(speed * down),
                                                 .contact = contact}));
        for (int step = 1; step <= 4; ++step) {
          run(world, 1);
          const DVec3 v = vector_cast<double>(world.velocity(body));
          CHECK(std::abs(dot(v, down) - speed - acceleration * step / 60) < 1e-3);
          CHECK(std::abs(dot(v, up)) < 2e-3);
        }
      }
    }
  }

  TEST_CASE("a kinematic body follows its path from where it is, and lifts what sleeps on it") {
    World world = make_world();
    BodyDesc lift = {.kind = BodyKind::kKinematic, .shape = Shape::box({Real(1), Real(0.25), Real(1)})};
    const BodyId id = take(world.add_body(lift));
    const BodyId box = take(world.add_body(cube({0, 0.75, 0})));
    run(world, 120);
    REQUIRE(world.asleep(box));
    MotionDesc up = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {Real(0), Real(0.5), Real(0)}};
    REQUIRE(world.set_motion(id, up).has_value());
    run(world, 60);
    CHECK(world.pose(id).position.y == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(world.pose(box).position.y == doctest::Approx(1.25).epsilon(0.01));
    // Another path begins at the place that the first one reached; none is rest.
    up = {.kind = MotionDesc::Kind::kKeyframes,
          .keyframes = {{0, {}}, {0.5, {Real(0), Real(0.25), Real(0)}}}};
    REQUIRE(world.set_motion(id, up).has_value());
    const Snapshot before = world.snapshot();
    run(world, 60);
    CHECK(world.pose(id).position.y == doctest::Approx(0.75).epsilon(1e-4));
    const std::uint64_t hash = world.state_hash();
    REQUIRE(world.restore(before).has_value());
    run(world, 60);
    CHECK(world.state_hash() == hash);
    REQUIRE(world.set_motion(id, {}).has_value());
    run(world, 30);
    CHECK(world.pose(id).position.y == doctest::Approx(0.75).epsilon(1e-4));
  }

  TEST_CASE("only a kinematic body accepts a path, and only a valid path") {
    World world = make_world();
    const BodyId box = take(world.add_body(cube({0, 1, 0})));
    const BodyId lift = take(world.add_body(
        {.kind = BodyKind::kKinematic, .shape = Shape::sphere(Real(1)), .position = {9, 0, 0}}));
    CHECK(world.set_motion(box, {}).error().code == ErrorCode::kOutOfRange);
    CHECK(world.set_motion(BodyId{}, {}).error().code == ErrorCode::kStaleId);
    CHECK_FALSE(world.set_motion(lift, {.kind = MotionDesc::Kind::kKeyframes}).has_value());
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    CHECK_FALSE(
        world.set_motion(lift, {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {nan, 0, 0}}));
  }
}

}  // namespace hooke
