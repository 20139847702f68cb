#include "lab/scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace hooke {

using test::advance;
using test::empty_space;
using test::make_run;
using test::make_world;
using test::take;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 1 kg on one spring, pushed so lightly that it stays linear while it grows a millionfold.
World make_oscillator(Real stiffness, double zeta = 0) {
  World world = make_world(empty_space());
  ParticlesDesc desc;
  desc.particles = {{.position = {0, 0, 0}},
                    {.position = {1, 0, 0}, .velocity = {Real(1e-6), Real(0), Real(0)}}};
  const double damping = 2 * zeta * std::sqrt(static_cast<double>(stiffness));
  desc.springs = {{.a = 0,
                   .b = 1,
                   .stiffness = stiffness,
                   .damping = static_cast<Real>(damping),
                   .rest_length = Real(1)}};
  desc.pins = {{}};
  take(world.add_particles(desc));
  return world;
}

/// Energy after `steps` at 60 Hz over that at the start; infinity if the state did not stay finite.
double energy_growth(std::string_view stepper, const World& world, int steps) {
  lab::Run run = make_run(world, {.stepper = std::string(stepper), .force = true});
  const double start = run.energy().total();
  for (int i = 0; i < steps; ++i) {
    if (!run.advance()) return kInfinity;
  }
  return run.energy().total() / start;
}

double energy_growth(std::string_view stepper, Real stiffness, int steps) {
  return energy_growth(stepper, make_oscillator(stiffness), steps);
}

constexpr int kPeriod = 38;  ///< Steps of 1/60 s in a period of 10 rad/s.

/// Within a period: damping and partitioned methods let the energy swing.
double largest_energy(lab::Run& run) {
  double largest = 0;
  for (int i = 0; i < kPeriod; ++i) {
    advance(run, 1);
    largest = std::max(largest, run.energy().total());
  }
  return largest;
}

}  // namespace

TEST_SUITE("lab/stability") {
  TEST_CASE("the largest stable stiffness is 2 m/h^2 for the paper's method, 4 and 8 for Verlet and rk4") {
    const struct {
      std::string_view stepper;
      double factor;  // of m / h^2
    } rows[] = {{"paper", 2}, {"symplectic_euler", 4}, {"verlet", 4}, {"rk4", 8}, {"taylor3", 3}};
    for (const auto& row : rows) {
      CAPTURE(row.stepper);
      const double theory = row.factor * 3600;
      CHECK(take(lab::stable_stiffness_in_theory(row.stepper)) == doctest::Approx(theory).epsilon(1e-5));
      const double measured = take(lab::largest_stable_stiffness(row.stepper));
      CHECK(measured == doctest::Approx(theory).epsilon(0.01));
    }
  }

  TEST_CASE("a chain is stable up to m / (2 h^2 sin^2(pi (2n - 1) / (4n + 2))) with the paper's method") {
    const struct {
      int springs;
      double stiffness;
    } rows[] = {{1, 7200}, {2, 2750}, {4, 2038}, {16, 1816}};
    for (const auto& row : rows) {
      CAPTURE(row.springs);
      CHECK(take(lab::stable_stiffness_in_theory("paper", {.springs = row.springs})) ==
            doctest::Approx(row.stiffness).epsilon(1e-3));
      const double measured = take(lab::largest_stable_stiffness("paper", {.springs = row.springs}));
      CHECK(measured == doctest::Approx(row.stiffness).epsilon(0.01));
    }
  }

  TEST_CASE("Euler, the paper's equations, Heun, midpoint, Taylor 2 and ab2 grow at any stiffness") {
    for (std::string_view stepper : {"euler", "taylor2_paper", "heun", "midpoint", "taylor2", "ab2"}) {
      CAPTURE(stepper);
      CHECK(take(lab::stable_stiffness_in_theory(stepper)) == 0);
      CHECK(take(lab::largest_stable_stiffness(stepper)) == 0);
    }
  }

  TEST_CASE("implicit Euler, the trapezoidal rule and bdf2 never grow") {
    for (std::string_view stepper : {"implicit_euler", "am2", "bdf2"}) {
      CAPTURE(stepper);
      CHECK(take(lab::stable_stiffness_in_theory(stepper)) == kInfinity);
      CHECK(energy_growth(stepper, Real(1e8), 200) <= 1.0001);
    }
  }

  TEST_CASE("rk4 bears steps 1.41 / zeta times as long as Euler's on a damped oscillation") {
    for (const double zeta : {0.01, 0.035, 0.1}) {
      CAPTURE(zeta);
      const double theory =
          take(lab::stable_step_in_theory("rk4", zeta)) / take(lab::stable_step_in_theory("euler", zeta));
      const double measured =
          take(lab::largest_stable_step("rk4", zeta)) / take(lab::largest_stable_step("euler", zeta));
      CHECK(theory == doctest::Approx(std::sqrt(2.0) / zeta).epsilon(0.05));
      CHECK(measured == doctest::Approx(std::sqrt(2.0) / zeta).epsilon(0.05));
    }
  }

  TEST_CASE("limits on a decay are those of the textbooks") {
    const struct {
      std::string_view stepper;
      double limit;
    } rows[] = {{"euler", 2}, {"heun", 2},        {"taylor3", 2.5127}, {"rk4", 2.7853},
                {"ab2", 1},   {"ab3", 6.0 / 11},  {"ab4", 0.3},        {"am3", 6},
                {"am4", 3},   {"am2", kInfinity}, {"bdf4", kInfinity}, {"implicit_euler", kInfinity}};
    for (const auto& row : rows) {
      CAPTURE(row.stepper);
      const double limit = take(lab::find_stepper(row.stepper)).real_limit;
      CHECK((limit == row.limit || limit == doctest::Approx(row.limit).epsilon(1e-4)));
    }
    CHECK(take(lab::find_stepper("ab3")).imaginary_limit == doctest::Approx(0.7236).epsilon(1e-3));
    CHECK(take(lab::find_stepper("ab4")).imaginary_limit == doctest::Approx(0.4300).epsilon(1e-3));
  }

  TEST_CASE("the growth of one step is that of the formulas") {
    const double y = 0.2;  // omega h
    CHECK(take(lab::growth_per_step("euler", y, 0)) == doctest::Approx(std::sqrt(1 + y * y)).epsilon(1e-12));
    CHECK(take(lab::growth_per_step("taylor2_paper", y, 0)) ==
          doctest::Approx(std::sqrt(1 + y * y / 2)).epsilon(1e-12));
    CHECK(take(lab::growth_per_step("paper", y, 0)) ==
          doctest::Approx(std::sqrt(1 - y * y / 2)).epsilon(1e-12));
    CHECK(take(lab::growth_per_step("heun", y, 0)) ==
          doctest::Approx(std::sqrt(1 + std::pow(y, 4) / 4)).epsilon(1e-12));
    CHECK(take(lab::growth_per_step("implicit_euler", y, 0)) ==
          doctest::Approx(1 / std::sqrt(1 + y * y)).epsilon(1e-12));
    CHECK(take(lab::growth_per_step("verlet", y, 0)) == doctest::Approx(1).epsilon(1e-12));
  }

  TEST_CASE("runs grow and decay as their method's formula says, damped or not") {
    // The energy grows by |R|^2 per step, up to where in its swing it is found.
    const double y = 10.0 / 60;
    for (const lab::StepperInfo& info : lab::steppers()) {
      if (info.adaptive) continue;
      CAPTURE(info.name);
      for (const double zeta : {0.0, 0.02}) {
        CAPTURE(zeta);
        const World world = make_oscillator(Real(100), zeta);
        const double rate = std::log(take(lab::growth_per_step(info.name, y, zeta)));
        // So many that something is left and something is seen.
        const int steps = std::abs(rate) > 0.002 ? 400 : 4000;
        lab::Run run = make_run(world, {.stepper = std::string(info.name), .force = true});
        advance(run, steps);
        const double first = largest_energy(run);
        advance(run, steps - kPeriod);
        CHECK(std::log(largest_energy(run) / first) / (2 * steps) ==
              doctest::Approx(rate).epsilon(0.03).scale(1e-4));
      }
    }
  }

  TEST_CASE("the paper's k = 10000 diverges with its method and 7100 holds; Euler diverges at any") {
    CHECK(energy_growth("paper", Real(1e4), 600) > 1e6);
    CHECK(energy_growth("paper", Real(7100), 600) < 1);
    for (const Real stiffness : {Real(0.1), Real(10), Real(1000), Real(1e5)}) {
      CHECK(energy_growth("euler", stiffness, 6000) > 1.1);
      CHECK(energy_growth("taylor2_paper", stiffness, 6000) > 1.05);
    }
    CHECK(energy_growth("implicit_euler", Real(1e5), 600) < 1e-6);
    CHECK(energy_growth("symplectic_euler", Real(1000), 60000) == doctest::Approx(1).epsilon(0.6));
  }
}

}  // namespace hooke
