#include "lab/scenes.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace hooke {

using test::advance;
using test::empty_space;
using test::has_sundials;
using test::make_pendulum;
using test::make_planet;
using test::make_run;
using test::make_world;
using test::take;

namespace {

std::string refusal(const World& world, const lab::Options& options) {
  const Result<lab::Run> run = lab::Run::create(world, options);
  return run ? "accepted" : run.error().where + ": " + run.error().message;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A net of which spring 3 is much stiffer than the others.
World make_net() {
  World world = make_world();
  ParticlesDesc net;
  for (int i = 0; i < 6; ++i) net.particles.push_back({.position = {1.0 * i, 0, 0}});
  for (std::uint32_t i = 0; i < 5; ++i) net.springs.push_back({.a = i, .b = i + 1});
  net.springs[3].stiffness = Real(1e5);
  net.pins = {{}};
  take(world.add_particles(net));
  return world;
}

/// A ball of 0.1 m at rest on a slope, with a friction of 0.5.
World make_slope(double angle) {
  World world = make_world();
  BodyDesc slope;
  slope.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, static_cast<Real>(angle));
  slope.contact.friction = Real(0.5);
  take(world.add_body(slope));
  ParticlesDesc ball;
  ball.particles = {{.position = {-0.1 * std::sin(angle), 0.1 * std::cos(angle), 0}, .radius = Real(0.1)}};
  ball.contact.friction = Real(0.5);
  take(world.add_particles(ball));
  return world;
}

}  // namespace

TEST_SUITE("lab/run") {
  TEST_CASE("an unknown stepper is refused with the list of those there are") {
    const std::string said = refusal(make_world(), {.stepper = "rk5"});
    CHECK(contains(said, "\"rk5\""));
    CHECK(contains(said, "auto, euler, symplectic_euler, taylor2_paper, paper"));
    CHECK(contains(said, "dormand_prince"));
  }

  TEST_CASE("a step, a tolerance or an accuracy that is zero, negative or not a number is refused") {
    const World world = make_world();
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      CHECK(contains(refusal(world, {.dt = bad}), "dt: is "));
      CHECK(contains(refusal(world, {.tolerance = bad}), "tolerance: is "));
      CHECK(
          contains(refusal(world, {.accuracy = lab::Accuracy{.max_error = bad}}), "accuracy.max_error: is "));
      CHECK(contains(refusal(world, {.accuracy = lab::Accuracy{.seconds = bad}}), "accuracy.seconds: is "));
    }
    CHECK(!lab::growth_per_step("rk4", std::nan(""), 0));
    CHECK(!lab::largest_stable_stiffness("paper", {.springs = 0}));
    CHECK(!lab::largest_stable_step("paper", -1));
    CHECK(!lab::measure_order(world, {}, 0));
  }

  TEST_CASE("an explicit method beyond its limit is refused by the name of the spring, unless forced") {
    const World world = make_net();
    // Both ends have k and 100 N/m: omega^2 <= 2 (1e5 + 100), dt = 2 sqrt(2) / omega.
    CHECK(refusal(world, {.stepper = "rk4"}) ==
          "stepper: spring 3 of particles 1 (k = 1e+05 N/m) is stable below dt = 0.00632 s with rk4; dt is "
          "0.0167 s");
    CHECK(contains(refusal(world, {.stepper = "verlet"}), "below dt = 0.00447 s with verlet"));
    CHECK(refusal(world, {.stepper = "rk4", .dt = 0.0063}) == "accepted");
    CHECK(refusal(world, {.stepper = "rk4", .dt = 0.0064}) != "accepted");
    CHECK(refusal(world, {.stepper = "rk4", .force = true}) == "accepted");
    CHECK(refusal(world, {.stepper = "implicit_euler"}) == "accepted");
  }

  TEST_CASE("the limit of one spring is exact, and damping moves it") {
    const auto oscillator = [](Real stiffness, Real damping) {
      World world = make_world(empty_space());
      ParticlesDesc desc = make_pendulum(1, stiffness);
      desc.springs[0].damping = damping;
      take(world.add_particles(desc));
      return world;
    };
    CHECK(refusal(oscillator(Real(7190), Real(0)), {.stepper = "paper"}) == "accepted");
    CHECK(refusal(oscillator(Real(7210), Real(0)), {.stepper = "paper"}) != "accepted");
    // Euler: omega dt < 2 zeta, or k dt = 1.67 N s/m < c; with 1.4 it grows by less than 10 % per period.
    CHECK(refusal(oscillator(Real(100), Real(1.3)), {.stepper = "euler"}) != "accepted");
    CHECK(refusal(oscillator(Real(100), Real(1.4)), {.stepper = "euler"}) == "accepted");
    CHECK(contains(refusal(oscillator(Real(100), Real(0)), {.stepper = "euler"}), "with euler"));
    // Heun always grows, but by omega dt = 1/60 nobody sees it.
    CHECK(refusal(oscillator(Real(1), Real(0)), {.stepper = "heun"}) == "accepted");
    CHECK(refusal(oscillator(Real(3000), Real(0)), {.stepper = "heun"}) != "accepted");
  }

  TEST_CASE("a rigid spring is refused, limits and tethers are reported as left out") {
    World rigid = make_world();
    take(rigid.add_rope({}));
    CHECK(contains(refusal(rigid, {}), "rope 1: segment 0 is rigid"));
    World limited = make_world();
    take(limited.add_rope({.stiffness = Real(100), .extension_max = Real(0.05)}));
    const lab::Run run = make_run(limited, {.stepper = "implicit_euler"});
    REQUIRE(run.report().size() == 1);
    REQUIRE(run.report()[0].left_out.size() == 1);
    CHECK(contains(run.report()[0].left_out[0], "limits of extension"));
  }

  TEST_CASE("auto takes taylor2 for a stone, verlet, rk4 or implicit_euler for springs, object by object") {
    World world = make_world(empty_space());
    take(world.add_particles({.particles = {{}}}));
    take(world.add_particles(make_pendulum(1, Real(50))));
    take(world.add_particles(make_pendulum(1, Real(10000))));
    take(world.add_particles(make_pendulum(1, Real(1e6))));
    ParticlesDesc damped = make_pendulum(1, Real(50));
    damped.springs[0].damping = Real(1);
    take(world.add_particles(damped));
    const lab::Run run = make_run(world, {.stepper = "auto"});
    std::vector<std::string> chosen;
    for (const lab::ObjectReport& report : run.report()) chosen.push_back(report.stepper);
    CHECK(chosen == std::vector<std::string>{"taylor2", "verlet", "rk4", "implicit_euler", "rk4"});
  }

  TEST_CASE("objects may have methods of their own, and each goes as if it were alone") {
    World both = make_world();
    const ParticlesId first = take(both.add_particles(make_pendulum(1, Real(100))));
    const ParticlesId second = take(both.add_particles(make_pendulum(2, Real(100))));
    World alone = make_world();
    const ParticlesId only = take(alone.add_particles(make_pendulum(2, Real(100))));
    lab::Run pair = make_run(both, {.stepper = "verlet", .object_steppers = {{point(second, 0), "rk4"}}});
    lab::Run single = make_run(alone, {.stepper = "rk4"});
    advance(pair, 100);
    advance(single, 100);
    CHECK(pair.positions(second)[1] == single.positions(only)[1]);
    CHECK(pair.positions().size() == 4);
    CHECK(pair.positions()[1] == pair.positions(first)[1]);
    CHECK(pair.report()[0].stepper == "verlet");
    CHECK(pair.report()[1].stepper == "rk4");
    // Verlet keeps its acceleration for the next step, unless it was seen at a velocity that was predicted.
    CHECK(pair.report()[0].evaluations == 101);
    CHECK(pair.report()[1].evaluations == 400);
    World damped = make_world();
    ParticlesDesc desc = make_pendulum(1, Real(100));
    desc.springs[0].damping = Real(1);
    take(damped.add_particles(desc));
    lab::Run twice = make_run(damped, {.stepper = "verlet"});
    advance(twice, 100);
    CHECK(twice.evaluations() == 200);
  }

  TEST_CASE("a declared accuracy is kept, and the report says by what") {
    const World world = make_planet(0.3);
    const double seconds = 2 * std::numbers::pi;
    lab::Run exact = make_run(world, {.stepper = "rk4", .dt = seconds / 20000});
    advance(exact, 20000);
    double least_dt = 1;
    for (const double wanted : {1e-2, 1e-5, 1e-8}) {
      CAPTURE(wanted);
      lab::Run run = make_run(world, {.dt = seconds / 20, .accuracy = lab::Accuracy{wanted, seconds}});
      advance(run, 20);
      CHECK(length(run.positions()[0] - exact.positions()[0]) <= 1.2 * wanted);
      const lab::ObjectReport report = run.report()[0];
      CHECK(report.error.value() <= wanted);
      CHECK(report.dt < least_dt);
      least_dt = report.dt;
      CHECK(run.time() == doctest::Approx(seconds));
    }
    World rough = make_slope(0.5);
    CHECK(contains(refusal(rough, {.accuracy = lab::Accuracy{1e-12, 1}}),
                   "accuracy: 1e-12 m over 1 s was not"));
  }

  TEST_CASE("methods by tolerance come closer with it, or say that SUNDIALS is missing") {
    const World world = make_planet(0.5);
    const double period = 2 * std::numbers::pi;
    for (const std::string stepper : {"adams_moulton", "bdf", "dormand_prince"}) {
      CAPTURE(stepper);
      if (!has_sundials()) {
        CHECK(contains(refusal(world, {.stepper = stepper}), "needs SUNDIALS"));
        continue;
      }
      lab::Run exact = make_run(world, {.stepper = "rk4", .dt = period / 20000});
      advance(exact, 20000);
      double before = 1;
      for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
        lab::Run run = make_run(world, {.stepper = stepper, .dt = period, .tolerance = tolerance});
        advance(run, 1);
        const double error = length(run.positions()[0] - exact.positions()[0]);
        CHECK(error < 1e4 * tolerance);  // of a step, not of the orbit
        CHECK(error < 0.2 * before);
        before = error;
        CHECK(run.report()[0].steps > 20);
      }
    }
  }

  TEST_CASE("a diverging run ends with an error and stays where it was") {
    World world = make_world(empty_space());
    ParticlesDesc desc = make_pendulum(1, Real(1e6));
    desc.springs[0].rest_length = Real(0.9);
    const ParticlesId id = take(world.add_particles(desc));
    lab::Run run = make_run(world, {.stepper = "euler", .force = true});
    std::string said;
    for (int i = 0; i < 10000 && said.empty(); ++i) {
      const DVec3 before = run.positions(id)[1];
      const double time = run.time();
      const Result<void> moved = run.advance();
      if (moved) continue;
      said = moved.error().message;
      CHECK(run.positions(id)[1] == before);
      CHECK(run.time() == time);
    }
    CHECK(contains(said, "particles 1 diverged"));
  }

  TEST_CASE("where one object fails, all stay") {
    World world = make_world(empty_space());
    ParticlesDesc calm = make_pendulum(1, Real(10));
    calm.particles[1].velocity = {Real(1), Real(0), Real(0)};
    take(world.add_particles(calm));
    ParticlesDesc wild = make_pendulum(1, Real(1e6));
    wild.springs[0].rest_length = Real(0.9);
    take(world.add_particles(wild));
    lab::Run run = make_run(world, {.stepper = "euler", .force = true});
    for (int i = 0; i < 10000; ++i) {
      const std::vector<DVec3> before = run.positions();
      if (run.advance()) continue;
      CHECK(run.positions() == before);
      CHECK(run.report()[0].steps == run.report()[1].steps);
      return;
    }
    FAIL("Euler did not diverge");
  }

  TEST_CASE("a force law acts as the field that it imitates") {
    World with_law = make_world(empty_space());
    const ParticlesId pushed = take(with_law.add_particles(make_pendulum(1, Real(100))));
    take(with_law.add_force_law([](ForceView& view) {
      for (std::size_t i = 0; i < view.size(); ++i)
        view.add_force(i, view.mass(i) * Vec3{Real(0.25), Real(-4), Real(0)});
    }));
    World with_field = make_world(empty_space());
    const ParticlesId pulled = take(with_field.add_particles(make_pendulum(1, Real(100))));
    take(with_field.add_field({.vector = {Real(0.25), Real(-4), Real(0)}}));
    for (const std::string stepper : {"rk4", "implicit_euler", "verlet"}) {
      CAPTURE(stepper);
      lab::Run one = make_run(with_law, {.stepper = stepper});
      lab::Run other = make_run(with_field, {.stepper = stepper});
      advance(one, 120);
      advance(other, 120);
      CHECK(length(one.positions(pushed)[1] - other.positions(pulled)[1]) < 1e-4);
    }
    CHECK(contains(refusal(with_law, {.stepper = "taylor2"}), "taylor2 needs derivatives"));
  }

  TEST_CASE("a ball on a slope slides if the slope is steeper than the friction, and never sinks in") {
    for (const double degrees : {20.0, 35.0}) {
      CAPTURE(degrees);
      const double angle = degrees * std::numbers::pi / 180;
      const World world = make_slope(angle);
      const double r = 0.1;
      const ParticlesId id = {1, 1};
      const DVec3 start = world.positions(id)[0];
      lab::Run run = make_run(world, {.dt = 1e-3});
      advance(run, 1000);
      const DVec3 x = run.positions(id)[0];
      const double way = length(x - start);
      CHECK(-std::sin(angle) * x.x + std::cos(angle) * x.y == doctest::Approx(r).epsilon(1e-4));
      const double a = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
      CHECK(way == doctest::Approx(std::max(0.0, a / 2)).epsilon(0.01));
      lab::Run through = make_run(world, {.dt = 1e-3, .contacts = false});
      advance(through, 1000);
      CHECK(through.positions(id)[0].y < -4);
    }
  }

  TEST_CASE("a ball comes to rest on the triangles of a mesh") {
    World world = make_world();
    MeshDesc plate;
    plate.positions = {{Real(-1), Real(0), Real(-1)},
                       {Real(-1), Real(0), Real(1)},
                       {Real(1), Real(0), Real(1)},
                       {Real(1), Real(0), Real(-1)}};
    plate.triangles = {{0, 1, 2}, {0, 2, 3}};
    BodyDesc body;
    body.shape = Shape::of_mesh(take(world.add_mesh(plate)));
    take(world.add_body(body));
    const ParticlesId id =
        take(world.add_particles({.particles = {{.position = {0.3, 0.5, 0.2}, .radius = Real(0.1)}}}));
    lab::Run run = make_run(world, {});
    advance(run, 120);
    CHECK(run.positions(id)[0].y == doctest::Approx(0.1).epsilon(1e-4));
    CHECK(std::abs(run.velocities(id)[0].y) < 1e-6);
  }

  TEST_CASE("an object whose points are all held follows its motion, with any method") {
    World world = make_world();
    ParticlesDesc desc;
    desc.particles = {{}};
    PinDesc pin;
    pin.motion.kind = MotionDesc::Kind::kConstantVelocity;
    pin.motion.velocity = {Real(2), Real(0), Real(0)};
    desc.pins = {pin};
    const ParticlesId id = take(world.add_particles(desc));
    for (const lab::StepperInfo& info : lab::steppers()) {
      if (!info.available) continue;
      CAPTURE(info.name);
      lab::Run run = make_run(world, {.stepper = std::string(info.name)});
      advance(run, 60);
      CHECK(run.positions(id)[0].x == doctest::Approx(2));
      CHECK(run.velocities(id)[0].x == 2);
      CHECK(run.energy().total() == 0);
    }
  }

  TEST_CASE("ids that are not of the world give nothing") {
    const World world = make_net();
    const lab::Run run = make_run(world, {.stepper = "implicit_euler"});
    CHECK(run.positions(RopeId{}).empty());
    CHECK(run.velocities(ClothId{3, 1}).empty());
    CHECK(run.positions(ParticlesId{1, 1}).size() == 6);
    CHECK(contains(refusal(world, {.object_steppers = {{PointRef{}, "rk4"}}}), "object_steppers"));
    lab::Run empty = make_run(make_world(), {});
    CHECK(empty.advance());
    CHECK(empty.positions().empty());
  }
}

}  // namespace hooke
