#include "solver/gas.h"

#include <algorithm>

namespace hooke::solver {

namespace {

double filled_volume(const state::Deformable& object, double volume) {
  return std::max(volume, 1e-3 * object.gas_volume);
}

}  // namespace

void measure_gas(const state::Deformable& object, const state::Triangles& triangles,
                 const state::Particles& particles, GasVolume& out) {
  const std::uint32_t first = object.particles.first;
  const DVec3 middle = vector_cast<double>(particles.position[first].x);
  const auto x = [&](std::uint32_t p) { return vector_cast<double>(particles.position[p].x) - middle; };
  out.volume = 0;
  out.gradient.assign(object.particles.count, DVec3{});
  for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
    const auto [a, b, c] = triangles.corners[i];
    const DVec3 xa = x(a);
    const DVec3 ab = x(b) - xa;
    const DVec3 ac = x(c) - xa;
    // A sixth of twice the area to each corner: over a closed surface that is the gradient.
    const DVec3 sixth = (1.0 / 6) * cross(ab, ac);
    out.volume += dot(xa, sixth);
    for (const std::uint32_t p : {a, b, c}) out.gradient[p - first] += sixth;
  }
}

double gas_pressure(const state::Deformable& object, double volume) {
  return object.gas / filled_volume(object, volume) - state::kAirPressure;
}

void press_gas(const state::Deformable& object, const state::Triangles& triangles, double h,
               GasVolume& scratch, state::Particles& particles) {
  measure_gas(object, triangles, particles, scratch);
  const std::uint32_t first = object.particles.first;
  double rate = 0;
  double inverse_mass = 0;
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    const state::VelocityLine& line = particles.velocity[first + i];
    rate += dot(scratch.gradient[i], vector_cast<double>(line.v));
    inverse_mass += static_cast<double>(line.inverse_mass) * length_squared(scratch.gradient[i]);
  }
  const double volume = filled_volume(object, scratch.volume);
  const double stiffness = object.gas / (volume * volume);
  const double impulse = h * (gas_pressure(object, scratch.volume) - h * stiffness * rate) /
                         (1 + h * h * stiffness * inverse_mass);
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    state::VelocityLine& line = particles.velocity[first + i];
    line.v += vector_cast<Real>(static_cast<double>(line.inverse_mass) * impulse * scratch.gradient[i]);
  }
}

}  // namespace hooke::solver
