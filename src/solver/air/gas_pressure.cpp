#include "solver/air/gas_pressure.h"

#include "base/assert.h"

#include <algorithm>

namespace hooke::solver {

namespace {

double filled_volume(const state::Deformable& object, double volume) {
  return std::max(volume, 1e-3 * object.gas_volume);
}

/// The rate at which the volume grows without the gas, and what a unit of the gas's impulse adds to it.
struct Response {
  double rate = 0, mobility = 0;
};

GasVolume::Push& push_on(std::uint32_t body, std::vector<GasVolume::Push>& pushes) {
  const auto known = std::find_if(pushes.begin(), pushes.end(),
                                  [body](const GasVolume::Push& push) { return push.body == body; });
  return known != pushes.end() ? *known : pushes.emplace_back(GasVolume::Push{body, {}, {}});
}

/// A particle of the cloth around a gas.
struct SkinParticle {
  DVec3 v;                  ///< [m/s]
  double inverse_mass = 0;  ///< [1/kg]
  DVec3 gradient;           ///< Of the volume by its place [m^2].
};

/// Takes account of a particle that is pressed against a body: along the normal the body decides, not the
/// particle.
void hold(const state::Contacts& contacts, std::size_t row, const SkinParticle& particle,
          std::vector<GasVolume::Push>& pushes, Response& response) {
  const DVec3 n = vector_cast<double>(contacts.normal[row]);
  const double along = dot(particle.gradient, n);
  if (!(contacts.normal_force[row] > Real(0)) || !(along < 0)) return;
  const double closing_speed = dot(n, particle.v - vector_cast<double>(contacts.surface_velocity[row]));
  if (closing_speed < 0) response.rate -= along * closing_speed;
  response.mobility -= particle.inverse_mass * along * along;
  GasVolume::Push& push = push_on(contacts.body[row], pushes);
  push.force += along * n;
  push.torque += cross(vector_cast<double>(contacts.lever[row]), along * n);
}

double mobility_of(const GasVolume::Push& push, const state::Bodies& bodies) {
  const double w = static_cast<double>(bodies.motion[push.body].inverse_mass);
  if (!(w > 0)) return 0;
  const Vec3 turn = bodies.scale[push.body] * vector_cast<Real>(push.torque);
  return w * length_squared(push.force) + static_cast<double>(length_squared(turn));
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
    HOOKE_ASSERT(std::min({a, b, c}) >= first && std::max({a, b, c}) < object.particles.end());
    const DVec3 xa = x(a);
    const DVec3 ab = x(b) - xa;
    const DVec3 ac = x(c) - xa;
    // Each corner gets a sixth of twice the area: over a closed surface that is the gradient.
    const DVec3 sixth = (1.0 / 6) * cross(ab, ac);
    out.volume += dot(xa, sixth);
    for (const std::uint32_t p : {a, b, c}) out.gradient[p - first] += sixth;
  }
}

double gas_pressure(const state::Deformable& object, double volume) {
  return object.gas / filled_volume(object, volume) - state::kAirPressure;
}

void press_gas(const state::Deformable& object, double h, GasVolume& scratch, state::Tables& tables) {
  HOOKE_ASSERT(object.gas > 0 && object.gas_volume > 0);
  const state::Contacts& contacts = tables.contacts;
  state::Particles& particles = tables.particles;
  measure_gas(object, tables.triangles, particles, scratch);
  const std::uint32_t first = object.particles.first;
  Response all;
  scratch.pushes.clear();
  auto row =
      static_cast<std::size_t>(std::lower_bound(contacts.particle.begin(), contacts.particle.end(), first) -
                               contacts.particle.begin());
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    const state::VelocityRecord& record = particles.velocity[first + i];
    const SkinParticle particle = {vector_cast<double>(record.v), static_cast<double>(record.inverse_mass),
                                   scratch.gradient[i]};
    all.rate += dot(particle.gradient, particle.v);
    all.mobility += particle.inverse_mass * length_squared(particle.gradient);
    while (row < contacts.particle.size() && contacts.particle[row] < first + i) ++row;
    const bool touches = row < contacts.particle.size() && contacts.particle[row] == first + i;
    if (touches && particle.inverse_mass > 0) hold(contacts, row, particle, scratch.pushes, all);
  }
  for (const GasVolume::Push& push : scratch.pushes) all.mobility += mobility_of(push, tables.bodies);
  const double volume = filled_volume(object, scratch.volume);
  const double stiffness = object.gas / (volume * volume);
  const double impulse = h * (gas_pressure(object, scratch.volume) - h * stiffness * all.rate) /
                         (1 + h * h * stiffness * all.mobility);
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    state::VelocityRecord& record = particles.velocity[first + i];
    record.v += vector_cast<Real>(static_cast<double>(record.inverse_mass) * impulse * scratch.gradient[i]);
  }
}

}  // namespace hooke::solver
