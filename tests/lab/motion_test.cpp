#include "lab/scenes.h"

#include <algorithm>
#include <cmath>
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

constexpr double kPi = std::numbers::pi;
const double kGravity = static_cast<double>(Real(9.81));

/// The most exact method there is.
lab::Options reference(double dt, double tolerance) {
  if (has_sundials()) return {.stepper = "dormand_prince", .dt = dt, .tolerance = tolerance};
  return {.stepper = "rk4", .dt = dt};
}

/// Period of a pendulum over 2 pi sqrt(L/g): 1 / agm(1, cos(theta_0 / 2)).
double period_ratio(double angle) {
  double a = 1;
  double b = std::cos(angle / 2);
  for (int i = 0; i < 40; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

}  // namespace

TEST_SUITE("lab/motion") {
  TEST_CASE("a stone falls g t^2 / 2, and each first-order method errs by what its formula says") {
    World world = make_world();
    const ParticlesId stone = take(world.add_particles({.particles = {{.position = {0, 0, 0}}}}));
    const double h = 1.0 / 60;
    const double exact = -kGravity * 2 * 2 / 2;
    const struct {
      std::string_view stepper;
      double error;  // in units of g t h
    } rows[] = {{"euler", -0.5},      {"symplectic_euler", 0.5},
                {"taylor2_paper", 0}, {"paper", 1},
                {"taylor2", 0},       {"verlet", 0},
                {"rk4", 0},           {"implicit_euler", 0.5},
                {"heun", 0},          {"midpoint", 0},
                {"ab2", 0},           {"bdf2", 0}};
    for (const auto& row : rows) {
      CAPTURE(row.stepper);
      lab::Run run = make_run(world, {.stepper = std::string(row.stepper)});
      advance(run, 120);
      CHECK(run.positions(stone)[0].y ==
            doctest::Approx(exact - row.error * kGravity * 2 * h).epsilon(1e-10));
    }
  }

  TEST_CASE("with viscous drag it falls as m g / c (1 - e^-ct/m) says, with quadratic as tanh") {
    World viscous = make_world();
    const ParticlesId slow = take(viscous.add_particles({.particles = {{}}, .air_friction = Real(2)}));
    lab::Run run = make_run(viscous, {});
    advance(run, 60);
    CHECK(run.velocities(slow)[0].y == doctest::Approx(-kGravity / 2 * (1 - std::exp(-2.0))).epsilon(1e-6));

    World quadratic = make_world();
    ParticleDesc ball;
    ball.radius = Real(0.1);
    const ParticlesId fast =
        take(quadratic.add_particles({.particles = {ball}, .drag_coefficient = Real(0.5)}));
    lab::Run fall = make_run(quadratic, {});
    advance(fall, 600);
    const double terminal = std::sqrt(2 * kGravity / (1.225 * 0.5 * kPi * 0.01));
    CHECK(fall.velocities(fast)[0].y ==
          doctest::Approx(-terminal * std::tanh(kGravity * 10 / terminal)).epsilon(1e-5));
  }

  TEST_CASE("a mass on a spring swings with 2 pi sqrt(m/k), and damped loses 2 pi zeta / sqrt(1 - zeta^2)") {
    const double zeta = 0.05;
    for (const bool damped : {false, true}) {
      World world = make_world(empty_space());
      ParticlesDesc desc;
      desc.particles = {{.position = {0, 0, 0}}, {.position = {1.1, 0, 0}}};
      const Real damping = damped ? static_cast<Real>(2 * zeta * 10) : Real(0);
      desc.springs = {{.a = 0, .b = 1, .stiffness = Real(100), .damping = damping, .rest_length = Real(1)}};
      desc.pins = {{}};
      const ParticlesId mass = take(world.add_particles(desc));
      const double period = 2 * kPi / (10 * (damped ? std::sqrt(1 - zeta * zeta) : 1.0));
      lab::Run run = make_run(world, {.dt = period / 200});
      advance(run, 1000);  // five periods
      const double decrement = damped ? 2 * kPi * zeta / std::sqrt(1 - zeta * zeta) : 0.0;
      CHECK(run.positions(mass)[0] == DVec3{});
      CHECK(run.positions(mass)[1].x - 1 == doctest::Approx(0.1 * std::exp(-5 * decrement)).epsilon(1e-5));
    }
  }

  TEST_CASE("Verlet keeps a planet's energy to 1e-6 over a thousand orbits; Euler's planet escapes") {
    const World world = make_planet(0.6);
    constexpr int kSteps = 2000;
    const double dt = 2 * kPi / kSteps;
    lab::Run verlet = make_run(world, {.stepper = "verlet", .dt = dt});
    CHECK(verlet.energy().total() == doctest::Approx(-0.5).epsilon(1e-6));
    // Within an orbit it goes up and down with the square of the step; what counts is what stays.
    const auto mean_of_orbit = [](lab::Run& run) {
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        advance(run, 1);
        sum += run.energy().total();
      }
      return sum / kSteps;
    };
    const double first = mean_of_orbit(verlet);
    advance(verlet, 998 * kSteps);
    CHECK(std::abs(mean_of_orbit(verlet) - first) < 1e-6);
    lab::Run euler = make_run(world, {.stepper = "euler", .dt = dt});
    advance(euler, 20 * kSteps);
    CHECK(euler.energy().total() > 0.5 * first);
  }

  TEST_CASE("a pendulum's period grows with its amplitude by the arithmetic-geometric mean") {
    for (const double degrees : {30.0, 90.0, 150.0, 170.0, 179.0}) {
      CAPTURE(degrees);
      const double angle = degrees * kPi / 180;
      World world = make_world();
      const ParticlesId id = take(world.add_particles(make_pendulum(angle, Real(1e6))));
      const double quarter = 2 * kPi / std::sqrt(kGravity) * period_ratio(angle) / 4;
      const double dt = 5e-4;
      lab::Run run = make_run(world, {.dt = dt});
      // The bob crosses the vertical after a quarter: between two steps, by a straight line.
      DVec3 before = run.positions(id)[1];
      DVec3 now = before;
      while (now.x > 0 && run.time() < 10) {
        before = now;
        REQUIRE(run.advance());
        now = run.positions(id)[1];
      }
      const double crossing = run.time() - dt * now.x / (now.x - before.x);
      CHECK(crossing == doctest::Approx(quarter).epsilon(1e-4));
    }
  }

  TEST_CASE("rk4 follows a double pendulum of springs for 3 s as a tolerance of 1e-12 does") {
    World world = make_world();
    ParticlesDesc desc;
    desc.particles = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}, {.position = {1, 1, 0}}};
    desc.springs = {{.a = 0, .b = 1, .stiffness = Real(1e4)}, {.a = 1, .b = 2, .stiffness = Real(1e4)}};
    desc.pins = {{}};
    const ParticlesId id = take(world.add_particles(desc));
    lab::Run exact = make_run(world, reference(has_sundials() ? 0.1 : 2.5e-5, 1e-12));
    lab::Run run = make_run(world, {.dt = 2.5e-4});
    advance(exact, has_sundials() ? 30 : 120000);
    advance(run, 12000);
    CHECK(length(run.positions(id)[2] - exact.positions(id)[2]) < 1e-3);
    CHECK(exact.energy().total() == doctest::Approx(kGravity).epsilon(1e-8));
  }

  TEST_CASE("a pendulum stands on its head where the pivot's a omega exceeds sqrt(2 g L)") {
    const double amplitude = 0.02;
    for (const double factor : {0.98, 1.02}) {
      CAPTURE(factor);
      World world = make_world();
      ParticlesDesc desc = make_pendulum(kPi - 0.02, Real(1e7));
      const double omega = factor * std::sqrt(2 * kGravity) / amplitude;
      desc.pins[0].motion.kind = MotionDesc::Kind::kSine;
      desc.pins[0].motion.amplitude = {Real(0), static_cast<Real>(amplitude), Real(0)};
      desc.pins[0].motion.frequency_hz = static_cast<Real>(omega / (2 * kPi));
      // The pivot passes its middle: with it starts the mass.
      desc.pins[0].motion.phase = static_cast<Real>(kPi / 2);
      const ParticlesId id = take(world.add_particles(desc));
      lab::Run run = make_run(world, {.dt = 2e-4});
      double lowest = 2;
      for (int i = 0; i < 40000; ++i) {  // 8 s
        REQUIRE(run.advance());
        const std::vector<DVec3> points = run.positions(id);
        lowest = std::min(lowest, points[1].y - points[0].y);
      }
      CHECK((lowest > 0.9) == (factor > 1));
    }
  }

  TEST_CASE("a charge circles in a magnetic field with q B / m at constant speed") {
    World world = make_world(empty_space());
    take(world.add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {Real(0), Real(0), Real(2)}}));
    ParticleDesc charge;
    charge.velocity = {Real(1), Real(0), Real(0)};
    charge.charge = Real(0.5);
    charge.mass = Real(0.25);
    const ParticlesId id = take(world.add_particles({.particles = {charge}}));
    const double omega = 4;
    lab::Run run = make_run(world, {.dt = 2 * kPi / omega / 400});
    advance(run, 4000);  // ten turns
    CHECK(length(run.velocities(id)[0] - DVec3{1, 0, 0}) < 1e-6);
    CHECK(length(run.positions(id)[0]) < 1e-6);
    advance(run, 100);  // and a quarter: F = q v x B turns x towards -y
    CHECK(run.velocities(id)[0].y == doctest::Approx(-1).epsilon(1e-6));
  }

  TEST_CASE("a conical pendulum goes round with omega^2 = g / (L cos theta)") {
    const double angle = 0.6;
    const double stiffness = 1000;
    // T = m g / cos(theta) stretches the spring to L.
    const double length_now = 1 + kGravity / std::cos(angle) / stiffness;
    const double omega = std::sqrt(kGravity / (length_now * std::cos(angle)));
    World world = make_world();
    ParticlesDesc desc = make_pendulum(0, static_cast<Real>(stiffness));
    const double radius = length_now * std::sin(angle);
    desc.particles[1].position = {radius, -length_now * std::cos(angle), 0};
    desc.particles[1].velocity = {Real(0), Real(0), static_cast<Real>(omega * radius)};
    const ParticlesId id = take(world.add_particles(desc));
    lab::Run run = make_run(world, {.dt = 2 * kPi / omega / 400});
    advance(run, 2000);  // five turns
    CHECK(length(run.positions(id)[1] - desc.particles[1].position) < 1e-5);
  }

  TEST_CASE("a chain between two walls swings in its modes, omega_j = 2 sqrt(k/m) sin(j pi / 2(N + 1))") {
    constexpr int kMasses = 9;
    for (int j = 1; j <= 5; ++j) {
      CAPTURE(j);
      World world = make_world(empty_space());
      ParticlesDesc desc;
      for (int i = 0; i <= kMasses + 1; ++i) {
        const double shape = 0.01 * std::sin(i * j * kPi / (kMasses + 1));
        desc.particles.push_back({.position = {i + shape, 0, 0}});
      }
      for (std::uint32_t i = 0; i <= kMasses; ++i)
        desc.springs.push_back({.a = i, .b = i + 1, .stiffness = Real(100), .rest_length = Real(1)});
      PinDesc last;
      last.point = kMasses + 1;
      desc.pins = {{}, last};
      const ParticlesId id = take(world.add_particles(desc));
      const double omega = 20 * std::sin(j * kPi / (2 * (kMasses + 1)));
      lab::Run run = make_run(world, {.dt = 2 * kPi / omega / 400});
      advance(run, 500);  // a turn and a quarter: all pass their places at rest
      double farthest = 0;
      const std::vector<DVec3> points = run.positions(id);
      for (int i = 0; i <= kMasses + 1; ++i) farthest = std::max(farthest, std::abs(points[i].x - i));
      CHECK(farthest < 1e-6);
      advance(run, 100);
      CHECK(run.positions(id)[1].x - 1 == doctest::Approx(1 - desc.particles[1].position.x).epsilon(1e-4));
    }
  }

  TEST_CASE("a rope's stiffness is the rope's, whatever the number of its points") {
    for (const int masses : {4, 16}) {
      World world = make_world();
      const RopeId rope = take(world.add_rope({.direction = {Real(0), Real(-1), Real(0)},
                                               .masses = masses,
                                               .stiffness = Real(100),
                                               .inner_friction = Real(20),
                                               .drag_coefficient = Real(0)}));
      lab::Run run = make_run(world, {.stepper = "bdf2"});
      advance(run, 1200);
      // Its own weight stretches it by M g / 2 K.
      CHECK(run.positions(rope).back().y == doctest::Approx(-1 - kGravity / 200).epsilon(1e-5));
    }
  }
}

}  // namespace hooke
