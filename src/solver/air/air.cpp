#include "solver/air/air.h"

#include "base/assert.h"
#include "solver/air/air_kernels.h"
#include "state/rope_chains.h"

namespace hooke::solver {

void build_air_loads(std::span<const state::Deformable> objects, const state::Triangles& triangles,
                     AirLoads& loads) {
  const state::Rows source = rows_of(objects, &state::Deformable::triangles);
  const state::Rows particles = rows_of(objects, &state::Deformable::particles);
  const std::span corners = std::span(triangles.corners).subspan(source.first, source.count);
  loads.first_particle = particles.first;
  loads.first_triangle = source.first;
  loads.first_of.assign(std::size_t{particles.count} + 1, 0);
  for (const auto& t : corners) {
    for (const std::uint32_t p : {t.a, t.b, t.c}) ++loads.first_of[p - particles.first + 1];
  }
  for (std::size_t p = 1; p < loads.first_of.size(); ++p) loads.first_of[p] += loads.first_of[p - 1];
  HOOKE_ASSERT(loads.first_of.back() == 3 * corners.size());
  std::vector<std::uint32_t> next(loads.first_of.begin(), loads.first_of.end() - 1);
  loads.triangle_of.resize(3 * corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const auto& t = corners[i];
    for (const std::uint32_t p : {t.a, t.b, t.c}) loads.triangle_of[next[p - particles.first]++] = i;
  }
  loads.corner_impulse.assign(corners.size(), AirRecord{});
  loads.change.assign(particles.count, AirRecord{});
}

void load_triangles(const state::Deformable& object, const state::Triangles& triangles, const Air& air,
                    const state::Particles& particles, parallel::Range range, AirLoads& loads) {
  static_assert(sizeof(state::Triangles::Corners) == 3 * sizeof(std::uint32_t));
  HOOKE_ASSERT(air.wind.size() == particles.position.size());
  HOOKE_ASSERT(object.triangles.first >= loads.first_triangle);
  HOOKE_ASSERT(object.triangles.end() - loads.first_triangle <= loads.corner_impulse.size());
  const auto numbers = [](auto& records) { return reinterpret_cast<const Real*>(records.data()); };
  const wide::TriangleAir on_triangles = {
      .corners = reinterpret_cast<const std::uint32_t*>(triangles.corners.data() + loads.first_triangle),
      .mass = triangles.mass.data() + loads.first_triangle,
      .position = numbers(particles.position),
      .velocity = numbers(particles.velocity),
      .wind = numbers(air.wind),
      .corner_impulse = reinterpret_cast<Real*>(loads.corner_impulse.data()),
      .drag = object.drag_coefficient,
      .lift = object.lift_coefficient,
      .density = air.density,
      .h = air.h};
  const auto first = static_cast<int>(object.triangles.first - loads.first_triangle);
  wide::load_triangles(on_triangles, {first + range.begin, first + range.end});
}

void gather_loads(const state::Particles& particles, Real share, parallel::Range range, AirLoads& loads) {
  for (int row = range.begin; row < range.end; ++row) {
    const std::size_t p = static_cast<std::size_t>(row) - loads.first_particle;
    HOOKE_ASSERT(p < loads.change.size());
    Vec3 sum = {};
    for (std::uint32_t i = loads.first_of[p]; i < loads.first_of[p + 1]; ++i) {
      sum += loads.corner_impulse[loads.triangle_of[i]].v;
    }
    loads.change[p].v = (share * particles.velocity[row].inverse_mass) * sum;
  }
}

void push_particles(const AirLoads& loads, parallel::Range range, state::Particles& particles) {
  // Written as plain numbers, which compilers handle by the vector: the inverse masses beside the velocities
  // get zero.
  static_assert(sizeof(AirRecord) == sizeof(state::VelocityRecord));
  const Real* change = &loads.change[static_cast<std::size_t>(range.begin) - loads.first_particle].v.x;
  Real* velocity = &particles.velocity[range.begin].v.x;
  for (int i = 0; i < 4 * range.count(); ++i) velocity[i] += change[i];
}

void push_segments(const state::Deformable& object, const state::Segments& segments, const Air& air,
                   state::Particles& particles) {
  state::for_each_chain(object, segments, [&](std::uint32_t first, std::uint32_t count) {
    if (count < 2) return;
    wide::push_segments({.first_particle = object.particles.first + first,
                         .count = count - 1,
                         .rest_length = segments.rest_length.data() + object.segments.first + first,
                         .position = reinterpret_cast<const Real*>(particles.position.data()),
                         .wind = reinterpret_cast<const Real*>(air.wind.data()),
                         .velocity = reinterpret_cast<Real*>(particles.velocity.data()),
                         .strength = air.h * air.density * object.drag_coefficient});
  });
}

}  // namespace hooke::solver
