#include "solver/air/air.h"

#include "base/assert.h"
#include "solver/air/air_kernels.h"

namespace hooke::solver {

void build_air_loads(const state::Triangles& triangles, int particle_count, AirLoads& loads) {
  loads.first_of.assign(static_cast<std::size_t>(particle_count) + 1, 0);
  for (const auto& t : triangles.corners) {
    for (const std::uint32_t p : {t.a, t.b, t.c}) ++loads.first_of[p + 1];
  }
  for (std::size_t p = 1; p < loads.first_of.size(); ++p) loads.first_of[p] += loads.first_of[p - 1];
  HOOKE_ASSERT(loads.first_of.back() == 3 * triangles.corners.size());
  std::vector<std::uint32_t> next(loads.first_of.begin(), loads.first_of.end() - 1);
  loads.triangle_of.resize(3 * triangles.corners.size());
  for (std::uint32_t i = 0; i < triangles.corners.size(); ++i) {
    const auto& t = triangles.corners[i];
    for (const std::uint32_t p : {t.a, t.b, t.c}) loads.triangle_of[next[p]++] = i;
  }
  loads.corner_impulse.assign(triangles.corners.size(), AirRecord{});
  loads.change.assign(static_cast<std::size_t>(particle_count), AirRecord{});
}

void load_triangles(const state::Deformable& object, const state::Triangles& triangles, const Air& air,
                    const state::Particles& particles, parallel::Range range, AirLoads& loads) {
  static_assert(sizeof(state::Triangles::Corners) == 3 * sizeof(std::uint32_t));
  HOOKE_ASSERT(air.wind.size() == particles.position.size());
  HOOKE_ASSERT(loads.corner_impulse.size() == triangles.corners.size());
  const auto numbers = [](auto& records) { return reinterpret_cast<const Real*>(records.data()); };
  const wide::TriangleAir on_triangles = {
      .corners = reinterpret_cast<const std::uint32_t*>(triangles.corners.data()),
      .mass = triangles.mass.data(),
      .position = numbers(particles.position),
      .velocity = numbers(particles.velocity),
      .wind = numbers(air.wind),
      .corner_impulse = reinterpret_cast<Real*>(loads.corner_impulse.data()),
      .drag = object.drag_coefficient,
      .lift = object.lift_coefficient,
      .density = air.density,
      .h = air.h};
  const auto first = static_cast<int>(object.triangles.first);
  wide::load_triangles(on_triangles, {first + range.begin, first + range.end});
}

void gather_loads(const state::Particles& particles, Real share, parallel::Range range, AirLoads& loads) {
  HOOKE_ASSERT(loads.change.size() == particles.velocity.size());
  for (int p = range.begin; p < range.end; ++p) {
    Vec3 sum = {};
    for (std::uint32_t i = loads.first_of[p]; i < loads.first_of[p + 1]; ++i) {
      sum += loads.corner_impulse[loads.triangle_of[i]].v;
    }
    loads.change[p].v = (share * particles.velocity[p].inverse_mass) * sum;
  }
}

void push_particles(const AirLoads& loads, parallel::Range range, state::Particles& particles) {
  // Written as plain numbers, which compilers handle by the vector: the inverse masses beside the velocities
  // get zero.
  static_assert(sizeof(AirRecord) == sizeof(state::VelocityRecord));
  const Real* change = &loads.change[range.begin].v.x;
  Real* velocity = &particles.velocity[range.begin].v.x;
  for (int i = 0; i < 4 * range.count(); ++i) velocity[i] += change[i];
}

void push_segments(const state::Deformable& object, const state::Segments& segments, const Air& air,
                   state::Particles& particles) {
  wide::push_segments({.first_particle = object.particles.first,
                       .count = object.segments.count,
                       .rest_length = segments.rest_length.data() + object.segments.first,
                       .position = reinterpret_cast<const Real*>(particles.position.data()),
                       .wind = reinterpret_cast<const Real*>(air.wind.data()),
                       .velocity = reinterpret_cast<Real*>(particles.velocity.data()),
                       .strength = air.h * air.density * object.drag_coefficient});
}

}  // namespace hooke::solver
