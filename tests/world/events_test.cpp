#include "constants.h"
#include "world/make.h"

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace hooke {

using namespace test;

namespace {

const Shape kBall = Shape::sphere(Real(0.5));

BodyDesc ball_at(DVec3 position) {
  BodyDesc desc;
  desc.kind = BodyKind::kDynamic;
  desc.shape = kBall;
  desc.position = position;
  desc.mass = Real(2);
  return desc;
}

BodyId add_ground(World& world) {
  return take(world.add_body({.shape = Shape::half_space()}));
}

BodyId add_sensor(World& world, DVec3 position, Vec3 half_extents, BodyKind kind = BodyKind::kStatic) {
  BodyDesc desc;
  desc.kind = kind;
  desc.shape = Shape::box(half_extents);
  desc.position = position;
  desc.sensor = true;
  return take(world.add_body(desc));
}

/// All that was listed in some steps, with the step.
struct Log {
  std::vector<std::pair<int, ContactEvent>> begins, ends;
  std::vector<std::pair<int, HitEvent>> hits;
  std::vector<std::pair<int, SensorEvent>> enters, leaves;
  std::vector<std::pair<int, BodyId>> asleep, awake;

  void watch(World& world, int steps) {
    for (int i = 0; i < steps; ++i) {
      run(world, 1);
      const Events& events = world.events();
      const auto step = static_cast<int>(world.step_count());
      const auto append = [&](const auto& from, auto& to) {
        for (const auto& event : from) to.emplace_back(step, event);
      };
      append(events.contact_begins, begins);
      append(events.contact_ends, ends);
      append(events.hits, hits);
      append(events.sensor_enters, enters);
      append(events.sensor_leaves, leaves);
      append(events.fell_asleep, asleep);
      append(events.woke_up, awake);
    }
  }

  /// In numbers, to compare to the last bit.
  [[nodiscard]] std::vector<double> figures() const {
    std::vector<double> all;
    for (const auto* contacts : {&begins, &ends}) {
      for (const auto& [step, e] : *contacts) {
        for (const std::uint32_t x : {e.a.body.slot, e.a.part, e.b.body.slot, e.b.part}) all.push_back(x);
        all.push_back(step);
      }
    }
    for (const auto& [step, e] : hits) {
      for (const double x : {double(step), double(e.a.body.slot), double(e.b.body.slot), d(e.speed),
                             d(e.impulse), e.point.x, e.point.y, d(e.normal.x)}) {
        all.push_back(x);
      }
    }
    for (const auto* visits : {&enters, &leaves}) {
      for (const auto& [step, e] : *visits) {
        for (const int x : {step, int(e.sensor.slot), int(e.visitor.slot)}) all.push_back(x);
      }
    }
    for (const auto* sleepers : {&asleep, &awake}) {
      for (const auto& [step, id] : *sleepers) all.push_back(1000.0 * step + id.slot);
    }
    return all;
  }
};

/// Balls and boxes that fall through a sensor onto a floor, and ask for everything.
World make_rain(int workers) {
  WorldDesc desc;
  desc.workers = workers;
  World world = make_world(desc);
  add_ground(world);
  add_sensor(world, {0, 2, 0}, {2, 1, 2});
  for (int i = 0; i < 40; ++i) {
    BodyDesc body = ball_at({0.9 * (i % 4) - 1.3, 1.5 + 0.8 * (i / 4), 0.6 * (i % 3)});
    if (i % 2 == 0) body.shape = Shape::box({Real(0.3), Real(0.3), Real(0.3)});
    body.contact.restitution = Real(0.3);
    body.reports_contacts = i % 3 != 0;
    body.hit_speed = i % 4 == 0 ? Real(0.5) : kRigid;
    take(world.add_body(body));
  }
  return world;
}

}  // namespace

TEST_SUITE("world/events") {
  TEST_CASE("a contact begins once, lasts, and ends once") {
    World world = make_world();
    const BodyId ground = add_ground(world);
    BodyDesc desc = ball_at({0, 1.5, 0});
    desc.reports_contacts = true;
    const BodyId ball = take(world.add_body(desc));
    take(world.add_body(ball_at({5, 0.5, 0})));  // touches too, and does not ask
    Log log;
    log.watch(world, 120);
    REQUIRE(log.begins.size() == 1);
    CHECK(log.begins[0].second == ContactEvent{{ground, 0}, {ball, 0}});
    // It falls 1 m in sqrt(2 / g) = 0.4515 s, 27.09 steps; contacts look one substep ahead.
    CHECK(std::abs(log.begins[0].first - 27.5) < 1);
    CHECK(log.ends.empty());
    REQUIRE(world.apply_impulse(ball, {0, 10, 0}));
    log.watch(world, 2);
    REQUIRE(log.ends.size() == 1);
    CHECK(log.ends[0].second == ContactEvent{{ground, 0}, {ball, 0}});
    CHECK(world.events().contact_begins.empty());
  }

  TEST_CASE("a body that is removed ends its contacts and its visits") {
    World world = make_world();
    add_ground(world);
    const BodyId sensor = add_sensor(world, {0, 0.5, 0}, {1, 1, 1});
    BodyDesc desc = ball_at({0, 0.5, 0});
    desc.reports_contacts = true;
    const BodyId ball = take(world.add_body(desc));
    Log log;
    log.watch(world, 3);
    CHECK(log.begins.size() == 1);
    REQUIRE(log.enters.size() == 1);
    CHECK(log.enters[0].second == SensorEvent{sensor, ball});
    CHECK(world.visitors(sensor) == std::vector<BodyId>{ball});
    CHECK(world.remove(ball));
    const BodyId next = take(world.add_body(desc));  // in the same rows
    log.watch(world, 1);
    REQUIRE(log.ends.size() == 1);
    CHECK(log.ends[0].second.b.body == ball);
    REQUIRE(log.begins.size() == 2);
    CHECK(log.begins[1].second.b.body == next);
    REQUIRE(log.leaves.size() == 1);
    CHECK(log.leaves[0].second == SensorEvent{sensor, ball});
    CHECK(world.visitors(sensor) == std::vector<BodyId>{next});
  }

  TEST_CASE("a hit tells the speed of the fall, the place, and the impulse that stops or returns the body") {
    for (const double restitution : {0.0, 1.0}) {
      CAPTURE(restitution);
      World world = make_world();
      const BodyId ground = add_ground(world);
      BodyDesc desc = ball_at({3, 2.5, 1});
      desc.velocity = {Real(1), Real(0), Real(0)};
      desc.contact.friction = 0;
      desc.contact.restitution = static_cast<Real>(restitution);
      desc.hit_speed = Real(1);
      const BodyId ball = take(world.add_body(desc));
      Log log;
      log.watch(world, 60);
      REQUIRE(log.hits.size() == 1);
      const HitEvent& hit = log.hits[0].second;
      CHECK(hit.a.body == ground);
      CHECK(hit.b.body == ball);
      CHECK(hit.normal == Vec3{0, 1, 0});
      const double speed = std::sqrt(2 * kGravity * 2);
      CHECK(d(hit.speed) == doctest::Approx(speed).epsilon(2e-3));
      // Resting on within the substep adds up to m g h = 0.04 N s.
      CHECK(d(hit.impulse) == doctest::Approx(2 * speed * (1 + restitution)).epsilon(0.01));
      CHECK(hit.point.x == doctest::Approx(3 + std::sqrt(4 / kGravity)).epsilon(5e-3));
      CHECK(std::abs(hit.point.y) < 0.01);
      CHECK(hit.point.z == doctest::Approx(1));
    }
  }

  TEST_CASE("slower hits than asked for are not listed, and the threshold of either body counts") {
    for (const double threshold : {6.0, 6.5}) {
      World world = make_world();
      BodyDesc ground;
      ground.shape = Shape::half_space();
      ground.hit_speed = static_cast<Real>(threshold);
      take(world.add_body(ground));
      take(world.add_body(ball_at({0, 2.5, 0})));  // arrives with 6.264 m/s
      Log log;
      log.watch(world, 90);
      CHECK(log.hits.size() == (threshold < 6.264 ? 1 : 0));
    }
  }

  TEST_CASE("a sensor counts a ball that flies through it once in and once out, and does not slow it") {
    World world = make_world(test::empty_space());
    const BodyId sensor = add_sensor(world, {0, 0, 0}, {1, 1, 1});
    BodyDesc desc = ball_at({-5, 0, 0});
    desc.velocity = {Real(6), Real(0), Real(0)};
    const BodyId ball = take(world.add_body(desc));
    Log log;
    log.watch(world, 120);
    // In from x = -1.5 to x = 1.5: after 3.5 m and until 6.5 m, at 0.1 m a step.
    REQUIRE(log.enters.size() == 1);
    REQUIRE(log.leaves.size() == 1);
    CHECK(log.enters[0].second == SensorEvent{sensor, ball});
    CHECK(std::abs(log.enters[0].first - 35) <= 1);
    CHECK(log.leaves[0].second == SensorEvent{sensor, ball});
    CHECK(std::abs(log.leaves[0].first - 65) <= 1);
    CHECK(world.pose(ball).position.x == doctest::Approx(7));
    CHECK(world.body_contacts().empty());
  }

  TEST_CASE("sensors see kinematic bodies and no other sensors, and move with what they are") {
    World world = make_world(test::empty_space());
    const BodyId still = add_sensor(world, {0, 0, 0}, {1, 1, 1});
    BodyDesc lift;
    lift.kind = BodyKind::kKinematic;
    lift.shape = kBall;
    lift.position = {-3, 0, 0};
    lift.motion = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {Real(3), Real(0), Real(0)}};
    const BodyId moved = take(world.add_body(lift));
    lift.shape = Shape::box({Real(0.6), Real(0.6), Real(0.6)});
    lift.sensor = true;
    const BodyId carried = take(world.add_body(lift));
    const BodyId stone = take(world.add_body(ball_at({0, 0, 2})));
    run(world, 60);  // all at x = 0
    CHECK(world.visitors(still) == std::vector<BodyId>{moved});
    CHECK(world.visitors(carried) == std::vector<BodyId>{moved});
    REQUIRE(world.set_pose(stone, {{0, 0.9, 0}}));
    run(world, 1);
    CHECK(world.visitors(still) == std::vector<BodyId>{moved, stone});
    CHECK(world.visitors(carried) == std::vector<BodyId>{moved, stone});
  }

  TEST_CASE("a sensor keeps a visitor that sleeps, and a floor holds what stands in a sensor") {
    World world = make_world();
    BodyDesc floor;
    floor.shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)});
    floor.position = {0, -0.5, 0};
    take(world.add_body(floor));
    const BodyId sensor = add_sensor(world, {4.45, 0.4, 0}, {5, 6, 6});  // the floor is behind its near face
    BodyDesc desc = ball_at({0, 0.5, 0});
    desc.shape = Shape::box({Real(0.4), Real(0.4), Real(0.4)});
    desc.position.y = 0.4;
    const BodyId box = take(world.add_body(desc));
    Log log;
    log.watch(world, 120);
    CHECK(world.asleep(box));
    CHECK(world.center_of_mass(box).y == doctest::Approx(0.4).epsilon(0.01).scale(0));
    CHECK(log.enters.size() == 1);
    CHECK(log.leaves.empty());
    CHECK(world.visitors(sensor) == std::vector<BodyId>{box});
    REQUIRE(log.asleep.size() == 1);
    CHECK(log.asleep[0].second == box);
    CHECK(log.awake.empty());
    REQUIRE(world.set_pose(sensor, {{50, 0, 0}}));
    log.watch(world, 1);
    CHECK(log.leaves.size() == 1);
    REQUIRE(log.awake.size() == 1);  // what was near wakes
    CHECK(log.awake[0].second == box);
  }

  TEST_CASE("events are the same for any number of workers and after a restoration") {
    World world = make_rain(1);
    Log first;
    first.watch(world, 40);
    const Snapshot middle = world.snapshot();
    Log later;
    later.watch(world, 160);
    CHECK(first.begins.size() > 5);
    CHECK(later.begins.size() + later.ends.size() > 20);
    CHECK(first.hits.size() + later.hits.size() > 10);
    CHECK(later.leaves.size() > 5);
    for (const int workers : {2, 3, 8}) {
      World other = make_rain(workers);
      Log log;
      log.watch(other, 40);
      CHECK(log.figures() == first.figures());
      Log rest;
      rest.watch(other, 160);
      CHECK(rest.figures() == later.figures());
    }
    REQUIRE(world.restore(middle));
    CHECK(world.events().contact_begins.empty());
    Log again;
    again.watch(world, 160);
    CHECK(again.figures() == later.figures());
  }

  TEST_CASE("contacts of a body carry its weight, in order, and pull back where it slides") {
    World world = make_world();
    const BodyId ground = add_ground(world);
    BodyDesc desc = ball_at({0, 0.3, 0});
    desc.shape = Shape::box({Real(0.4), Real(0.3), Real(0.4)});
    desc.contact.friction = Real(0.5);
    const BodyId box = take(world.add_body(desc));
    take(world.add_body(ball_at({5, 0.5, 0})));
    run(world, 60);
    REQUIRE(world.set_velocity(box, {Real(4), Real(0), Real(0)}));
    run(world, 10);
    const std::vector<BodyContact> contacts = world.body_contacts(box);
    CHECK(contacts.size() == 4);
    CHECK(world.body_contacts().size() == 5);
    Vec3 force = {};
    for (const BodyContact& contact : contacts) {
      CHECK(contact.a == ground);
      CHECK(contact.b == box);
      force += contact.normal_force * contact.normal + contact.friction_force;
    }
    CHECK(d(force.y) == doctest::Approx(2 * kGravity).epsilon(0.01));
    CHECK(d(force.x) == doctest::Approx(-0.5 * 2 * kGravity).epsilon(0.01));  // both have friction 0.5
    CHECK(world.body_contacts(BodyId{}).empty());
  }

  TEST_CASE("a kinematic body follows its path exactly and carries what stands on it") {
    World world = make_world();
    BodyDesc lift;
    lift.kind = BodyKind::kKinematic;
    lift.shape = Shape::box({Real(1), Real(0.1), Real(1)});
    lift.motion = {.kind = MotionDesc::Kind::kSine,
                   .amplitude = {Real(0.5), Real(0.3), Real(0)},
                   .frequency_hz = Real(0.25)};
    const BodyId id = take(world.add_body(lift));
    BodyDesc desc = ball_at({0, 0.4, 0});
    desc.shape = Shape::box({Real(0.3), Real(0.3), Real(0.3)});
    desc.contact.friction = 1;
    const BodyId load = take(world.add_body(desc));
    for (int i = 1; i <= 240; ++i) {
      run(world, 1);
      const double sine = std::sin(2 * 3.14159265358979 * 0.25 * i / 60.0);
      CHECK(std::abs(world.pose(id).position.x - 0.5 * sine) < 1e-5);
      CHECK(std::abs(world.pose(id).position.y - 0.3 * sine) < 1e-5);
    }
    CHECK(length(world.pose(load).position - DVec3{0, 0.4, 0}) < 0.02);
  }

  TEST_CASE("a force law over bodies holds an orbit, turns, and stops when it is removed") {
    World world = make_world(test::empty_space());
    // F = -m w^2 x with w = 2 rad/s: the circle of radius 1 at 2 m/s takes pi seconds.
    BodyDesc desc = ball_at({1, 0, 0});
    desc.velocity = {Real(0), Real(2), Real(0)};
    const BodyId ball = take(world.add_body(desc));
    std::size_t seen = 0;
    const ForceLawId law = take(world.add_force_law([&](BodyForceView& bodies) {
      seen = bodies.size();
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        bodies.add_force(i, -4 * bodies.mass(i) * vector_cast<Real>(bodies.center_of_mass(i)));
        bodies.add_torque(i, {Real(0), Real(0.02), Real(0)});
      }
      bodies.add_force(bodies.size(), {Real(1e9), Real(0), Real(0)});
    }));
    take(world.add_body({.shape = kBall, .position = {9, 9, 9}}));
    const int steps = 377;  // two turns: 2 pi seconds
    run(world, steps);
    CHECK(seen == 1);
    CHECK(length(world.pose(ball).position - DVec3{1, 0, 0}) < 0.02);
    // I = 2/5 m r^2 = 0.2 kg m^2.
    CHECK(d(world.angular_velocity(ball).y) == doctest::Approx(0.1 * steps / 60).epsilon(1e-3).scale(0));
    CHECK(world.remove(law));
    const Vec3 v = world.velocity(ball);
    run(world, 60);
    CHECK(length(world.velocity(ball) - v) < 1e-6);
    CHECK_FALSE(world.add_force_law(BodyForceLaw{}));
  }

  TEST_CASE("a force law over bodies sees them turn from substep to substep") {
    // Whose inertia in world axes changes much in a step turns steadily while it touches something.
    for (const bool touching : {false, true}) {
      CAPTURE(touching);
      World world = make_world(test::empty_space());
      BodyDesc plank;
      plank.kind = BodyKind::kDynamic;
      plank.shape = Shape::box({Real(0.05), Real(0.5), Real(0.3)});
      plank.angular_velocity = {Real(0), Real(0), Real(30)};
      plank.contact.friction = Real(0);
      take(world.add_body(plank));
      BodyDesc wall = {.shape = Shape::box({Real(1), Real(1), Real(0.1)}), .position = {0, 0, 0.4}};
      wall.contact.friction = Real(0);
      if (touching) take(world.add_body(wall));
      std::vector<double> angles;
      take(world.add_force_law([&](BodyForceView& bodies) {
        const Quat q = bodies.rotation(0);
        angles.push_back(2 * std::atan2(d(q.z), d(q.w)));
      }));
      run(world, 3);
      REQUIRE(angles.size() > 10);
      for (std::size_t i = 1; i < angles.size(); ++i)
        CHECK(angles[i] - angles[i - 1] == doctest::Approx(0.5 / 8).epsilon(0.02).scale(0));
    }
  }

  TEST_CASE("a hit speed that is negative or not a number is refused by name") {
    World world = make_world();
    for (const Real bad : {Real(-1), std::numeric_limits<Real>::quiet_NaN()}) {
      BodyDesc desc = ball_at({0, 0, 0});
      desc.hit_speed = bad;
      const Result<BodyId> result = world.add_body(desc);
      REQUIRE_FALSE(result);
      CHECK(result.error().where == "body.hit_speed");
    }
  }
}

}  // namespace hooke
