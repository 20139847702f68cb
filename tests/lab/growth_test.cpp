#include "lab/scenes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>

namespace hooke {

using test::empty_space;
using test::make_run;
using test::make_world;
using test::take;

namespace {

double measured(std::string_view stepper, double omega_dt, double zeta = 0) {
  return take(lab::measured_growth(stepper, omega_dt, zeta));
}

/// A chain of two masses of 1 kg on two springs along x, its first end held.
ParticlesDesc make_chain(Real stiffness, Real damping) {
  ParticlesDesc desc;
  desc.particles = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}, {.position = {2, 0, 0}}};
  desc.springs = {{.a = 0, .b = 1, .stiffness = stiffness, .damping = damping},
                  {.a = 1, .b = 2, .stiffness = stiffness, .damping = damping}};
  desc.pins = {{}};
  return desc;
}

lab::Spectrum spectrum_of(const ParticlesDesc& desc) {
  World world = make_world(empty_space());
  take(world.add_particles(desc));
  return make_run(world, {.stepper = "rk4", .force = true}).spectra().at(0);
}

}  // namespace

TEST_SUITE("lab/growth") {
  TEST_CASE("steps of a method multiply an oscillation by the closed form of the textbooks") {
    for (const double y : {0.1, 0.5, 1.0, 1.9, 2.5, 3.0}) {
      CAPTURE(y);
      const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-9); };
      CHECK(measured("euler", y) == near(std::sqrt(1 + y * y)));
      CHECK(measured("implicit_euler", y) == near(1 / std::sqrt(1 + y * y)));
      CHECK(measured("taylor2_paper", y) == near(std::sqrt(1 + y * y / 2)));
      for (const std::string_view second : {"heun", "midpoint", "taylor2"})
        CHECK(measured(second, y) == near(std::sqrt(1 + std::pow(y, 4) / 4)));
      CHECK(measured("taylor3", y) == near(std::sqrt(1 - std::pow(y, 4) / 12 + std::pow(y, 6) / 36)));
      CHECK(measured("rk4", y) == near(std::sqrt(1 - std::pow(y, 6) / 72 + std::pow(y, 8) / 576)));
      CHECK(measured("am2", y) == near(1));
      if (y < 2) {
        CHECK(measured("symplectic_euler", y) == near(1));
        CHECK(measured("verlet", y) == near(1));
      }
      if (y < std::sqrt(2.0)) CHECK(measured("paper", y) == near(std::sqrt(1 - y * y / 2)));
      // Beyond 2 both roots of xi^2 - (2 - y^2) xi + 1 are real.
      const double half = y * y / 2 - 1;
      const double beyond = half + std::sqrt(std::max(0.0, half * half - 1));
      if (y > 2) CHECK(measured("symplectic_euler", y) == near(beyond));
      if (y > 2) CHECK(measured("verlet", y) == near(beyond));
    }
  }

  TEST_CASE("steps begin to grow at the known limits") {
    const struct {
      std::string_view stepper;
      double limit;
    } rows[] = {{"symplectic_euler", 2},
                {"verlet", 2},
                {"paper", std::sqrt(2.0)},
                {"taylor3", std::sqrt(3.0)},
                {"rk4", 2 * std::sqrt(2.0)},
                {"ab3", 0.7236},
                {"ab4", 0.4300}};
    for (const auto& row : rows) {
      CAPTURE(row.stepper);
      CHECK(measured(row.stepper, 0.999 * row.limit) <= 1 + 1e-9);
      CHECK(measured(row.stepper, 1.001 * row.limit) > 1 + 1e-6);
    }
  }

  TEST_CASE("steps of every method grow and fade as its formula says, damped or not, however stiff") {
    for (const lab::StepperInfo& info : lab::steppers()) {
      if (info.adaptive) continue;
      CAPTURE(info.name);
      for (const double y : {0.05, 0.4, 1.3, 2.9, 30.0, 900.0}) {
        for (const double zeta : {0.0, 0.1, 1.0, 3.0}) {
          CAPTURE(y);
          CAPTURE(zeta);
          const double formula = take(lab::growth_per_step(info.name, y, zeta));
          // Two equal roots split by the square root of rounding; the damping is single precision.
          CHECK(measured(info.name, y, zeta) == doctest::Approx(formula).epsilon(1e-5));
        }
      }
    }
  }

  TEST_CASE("growth in the plane of h lambda is that of the oscillation with these eigenvalues") {
    for (const double y : {0.3, 1.7}) {
      for (const double zeta : {0.0, 0.3, 1.0}) {
        const std::complex<double> z = {-zeta * y, y * std::sqrt(1 - zeta * zeta)};
        for (const std::string_view stepper : {"euler", "verlet", "rk4", "ab3", "bdf2"}) {
          CHECK(take(lab::growth_at(stepper, z)) ==
                doctest::Approx(take(lab::growth_per_step(stepper, y, zeta))).epsilon(1e-7));
          CHECK(take(lab::growth_at(stepper, z)) ==
                doctest::Approx(take(lab::growth_at(stepper, std::conj(z)))).epsilon(1e-12));
        }
      }
    }
    // The region of explicit Euler is the disk about -1, that of implicit Euler is all but the one about 1.
    for (const double angle : {0.1, 1.0, 2.0, 3.0}) {
      const std::complex<double> on = std::polar(1.0, angle);
      CHECK(take(lab::growth_at("euler", -1.0 + 0.999 * on)) < 1);
      CHECK(take(lab::growth_at("euler", -1.0 + 1.001 * on)) > 1);
      CHECK(take(lab::growth_at("implicit_euler", 1.0 + 0.999 * on)) > 1);
      CHECK(take(lab::growth_at("implicit_euler", 1.0 + 1.001 * on)) < 1);
    }
  }

  TEST_CASE("what cannot be measured is an error") {
    CHECK(lab::measured_growth("rk5", 1, 0).error().code == ErrorCode::kOutOfRange);
    CHECK(lab::measured_growth("dormand_prince", 1, 0).error().code == ErrorCode::kUnsupported);
    CHECK(lab::measured_growth("rk4", 0, 0).error().where == "omega_dt");
    CHECK(lab::measured_growth("rk4", 1, -0.1).error().where == "zeta");
    CHECK(lab::growth_at("rk5", 1).error().code == ErrorCode::kOutOfRange);
    CHECK(lab::growth_at("rk4", std::numeric_limits<double>::quiet_NaN()).error().where == "z");
  }
}

TEST_SUITE("lab/spectrum") {
  TEST_CASE("a chain of two masses swings at the square roots of (3 -+ sqrt 5)/2 k/m") {
    const lab::Spectrum spectrum = spectrum_of(make_chain(Real(400), Real(0)));
    CHECK_FALSE(spectrum.bounded);
    REQUIRE(spectrum.eigenvalues.size() == 12);
    const double fast = 20 * std::sqrt((3 + std::sqrt(5.0)) / 2);
    const double slow = 20 * std::sqrt((3 - std::sqrt(5.0)) / 2);
    for (const std::size_t i : {0, 1}) CHECK(std::abs(spectrum.eigenvalues[i]) == doctest::Approx(fast));
    for (const std::size_t i : {2, 3}) CHECK(std::abs(spectrum.eigenvalues[i]) == doctest::Approx(slow));
    for (std::size_t i = 0; i < 4; ++i) CHECK(spectrum.eigenvalues[i].real() == 0);
    // Across the springs nothing pulls while they have their length at rest.
    for (std::size_t i = 4; i < 12; ++i) CHECK(std::abs(spectrum.eigenvalues[i]) < 1e-3);
    CHECK(spectrum.stiffest.find("k = 400 N/m") != std::string::npos);
  }

  TEST_CASE("damping moves eigenvalues to the left and keeps their size") {
    // Damping in proportion to stiffness: each mode has zeta = c omega / (2 k).
    const lab::Spectrum spectrum = spectrum_of(make_chain(Real(400), Real(4)));
    const double fast = 20 * std::sqrt((3 + std::sqrt(5.0)) / 2);
    const std::complex<double> first = spectrum.eigenvalues.at(0);
    CHECK(std::abs(first) == doctest::Approx(fast).epsilon(1e-6));
    CHECK(first.real() == doctest::Approx(-4 * fast * fast / 800).epsilon(1e-6));
  }

  TEST_CASE("of a large object no eigenvalue is larger than the bound") {
    ParticlesDesc desc;
    desc.pins = {{}};
    for (std::uint32_t i = 0; i <= 120; ++i) {
      desc.particles.push_back({.position = {0.1 * i, 0, 0}});
      if (i > 0) desc.springs.push_back({.a = i - 1, .b = i, .stiffness = Real(100)});
    }
    const lab::Spectrum spectrum = spectrum_of(desc);
    CHECK(spectrum.bounded);
    // The fastest mode is 2 sqrt(k/m) sin(pi (2n - 1) / (4n + 2)); Gershgorin says 2 sqrt(k/m).
    const double fastest = 20 * std::sin(std::numbers::pi * 239 / 482);
    CHECK(std::abs(spectrum.eigenvalues.at(0)) >= fastest);
    CHECK(std::abs(spectrum.eigenvalues.at(0)) == doctest::Approx(20).epsilon(1e-6));
  }

  TEST_CASE("an unstable equilibrium has an eigenvalue to the right") {
    // A mass that stands on a compressed spring tips over: omega^2 = (1 - L/l) k/m = -100.
    ParticlesDesc desc;
    desc.particles = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}};
    desc.springs = {{.a = 0, .b = 1, .stiffness = Real(100), .rest_length = Real(2)}};
    desc.pins = {{}};
    const lab::Spectrum spectrum = spectrum_of(desc);
    const bool found = std::any_of(spectrum.eigenvalues.begin(), spectrum.eigenvalues.end(),
                                   [](const std::complex<double>& z) { return std::abs(z - 10.0) < 1e-6; });
    CHECK(found);
  }
}

TEST_SUITE("lab/replacements") {
  TEST_CASE("a rigid rope enters as springs that its weight stretches by the share that is asked for") {
    World world = make_world({});
    RopeDesc desc;
    desc.hook_point = {0, 2, 0};
    desc.direction = {Real(0), Real(-1), Real(0)};
    desc.masses = 5;
    desc.pins = {{}};
    const RopeId rope = take(world.add_rope(desc));
    CHECK(lab::Run::create(world, {.stepper = "implicit_euler"}).error().message.find("is rigid") !=
          std::string::npos);
    lab::Run run = make_run(world, {.stepper = "implicit_euler", .dt = 0.05, .rigid_stretch = 1e-3});
    test::advance(run, 400);
    const std::vector<DVec3> points = run.positions(rope);
    const auto report = run.report();
    CHECK(report.at(0).left_out.at(0).find("4 rigid segments") == 0);
    // The uppermost spring carries all but the held point's mass: 0.1 % of its length.
    const double first = points[0].y - points[1].y;
    CHECK(first == doctest::Approx(0.25 * 1.001).epsilon(1e-5));
    CHECK(points[4].y < 1);
    CHECK(points[4].y > 1 - 1e-3);
  }

  TEST_CASE("a solid stands still if that is asked for, and is an error otherwise") {
    World world = make_world({});
    SolidDesc desc;
    const SolidId solid = take(world.add_solid(desc));
    (void)solid;
    CHECK(lab::Run::create(world, {}).error().message.find("is a solid") != std::string::npos);
    lab::Run run = make_run(world, {.stepper = "rk4", .solids_stand = true});
    const std::vector<DVec3> before = run.positions();
    test::advance(run, 10);
    CHECK(run.positions() == before);
    CHECK(run.report().at(0).left_out.at(0).find("stands still") != std::string::npos);
    CHECK(run.spectra().at(0).eigenvalues.empty());
  }

  TEST_CASE("hooks at points are named as left out") {
    World world = make_world({});
    const RopeId rope = take(world.add_rope({.stiffness = Real(1000)}));
    CHECK(make_run(world, {.stepper = "rk4", .force = true}).report().at(0).left_out.empty());
    take(world.add_hook({.b = {.point = point(rope, 0)}}));
    CHECK(make_run(world, {.stepper = "rk4", .force = true})
              .report()
              .at(0)
              .left_out.at(0)
              .find("1 hooks at its points") == 0);
  }

  TEST_CASE("a share out of range is an error") {
    const World world = make_world({});
    CHECK(lab::Run::create(world, {.rigid_stretch = -1}).error().where == "rigid_stretch");
    CHECK(lab::Run::create(world, {.rigid_stretch = 0.2}).error().where == "rigid_stretch");
  }
}

}  // namespace hooke
