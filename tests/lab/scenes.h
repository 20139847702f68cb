#pragma once

#include "hooke/lab.h"

#include "world/make.h"

namespace hooke::test {

inline bool has_sundials() {
  return take(lab::find_stepper("dormand_prince")).available;
}

inline lab::Run make_run(const World& world, const lab::Options& options) {
  return take(lab::Run::create(world, options));
}

inline void advance(lab::Run& run, long long steps) {
  for (long long i = 0; i < steps; ++i) {
    const Result<void> moved = run.advance();
    if (!moved) FAIL(moved.error().where << ": " << moved.error().message);
  }
}

/// A planet of semi-major axis 1 about a sun of strength 1, from its perihelion: the period is 2 pi.
inline World make_planet(double eccentricity) {
  World world = make_world(empty_space());
  take(world.add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = 1}));
  ParticlesDesc planet;
  const double speed = std::sqrt((1 + eccentricity) / (1 - eccentricity));
  planet.particles = {{.position = {1 - eccentricity, 0, 0}, .velocity = {0, static_cast<Real>(speed), 0}}};
  take(world.add_particles(planet));
  return world;
}

/// A mass of 1 kg on a spring of 1 m, `angle` from hanging down; its first point is held.
inline ParticlesDesc make_pendulum(double angle, Real stiffness) {
  ParticlesDesc pendulum;
  pendulum.particles = {{.position = {0, 0, 0}}, {.position = {std::sin(angle), -std::cos(angle), 0}}};
  pendulum.springs = {{.a = 0, .b = 1, .stiffness = stiffness, .rest_length = Real(1)}};
  pendulum.pins = {{}};
  return pendulum;
}

}  // namespace hooke::test
