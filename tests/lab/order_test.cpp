#include "lab/scenes.h"

#include <cmath>

namespace hooke {

using test::make_pendulum;
using test::make_planet;
using test::make_world;
using test::take;

namespace {

/// Two masses on springs below a point that is shaken, with friction inside and out: forces that depend on
/// place, velocity and time, none of them linear.
World make_shaken_pendulum() {
  World world = make_world();
  ParticlesDesc desc;
  desc.particles = {{.position = {0, 0, 0}}, {.position = {0.8, -0.6, 0}}, {.position = {1.4, 0.2, 0.3}}};
  for (ParticleDesc& particle : desc.particles) particle.radius = Real(0.2);
  desc.springs = {{.a = 0, .b = 1, .stiffness = Real(30), .damping = Real(0.4)},
                  {.a = 1, .b = 2, .stiffness = Real(20), .damping = Real(0.3)}};
  desc.air_friction = Real(0.2);
  desc.drag_coefficient = Real(1);
  PinDesc pin;
  pin.motion.kind = MotionDesc::Kind::kSine;
  pin.motion.amplitude = {Real(0.1), Real(0.2), Real(0)};
  pin.motion.frequency_hz = Real(0.7);
  desc.pins = {pin};
  WindDesc wind;
  wind.velocity = {Real(2), Real(0), Real(1)};
  REQUIRE(world.set_wind(wind));
  take(world.add_particles(desc));
  return world;
}

}  // namespace

TEST_SUITE("lab/order") {
  TEST_CASE("each method has its order on a planet's orbit and on a damped, driven, nonlinear pendulum") {
    const World planet = make_planet(0.3);
    const World pendulum = make_shaken_pendulum();
    for (const lab::StepperInfo& info : lab::steppers()) {
      if (info.adaptive) continue;
      CAPTURE(info.name);
      const std::string name(info.name);
      // Low orders need smaller steps before their leading error is all that one sees.
      const double fine = info.order <= 2 ? 0.1 : 1;
      const auto orbit = take(lab::measure_order(planet, {.stepper = name, .dt = 0.02 * fine}, 2.0, 3));
      CHECK(orbit.order == doctest::Approx(info.order).epsilon(0.1 / info.order));
      const auto swing = take(lab::measure_order(pendulum, {.stepper = name, .dt = 0.02 * fine}, 1.0, 3));
      CHECK(swing.order == doctest::Approx(info.order).epsilon(0.1 / info.order));
    }
  }
}

}  // namespace hooke
