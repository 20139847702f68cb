#include "solver/air.h"

#include <algorithm>

namespace hooke::solver {

void build_air_loads(const state::Triangles& triangles, int particle_count, AirLoads& loads) {
  loads.first_of.assign(static_cast<std::size_t>(particle_count) + 1, 0);
  for (const auto& t : triangles.corners) {
    for (const std::uint32_t p : {t.a, t.b, t.c}) ++loads.first_of[p + 1];
  }
  for (std::size_t p = 1; p < loads.first_of.size(); ++p) loads.first_of[p] += loads.first_of[p - 1];
  std::vector<std::uint32_t> next(loads.first_of.begin(), loads.first_of.end() - 1);
  loads.triangle_of.resize(3 * triangles.corners.size());
  for (std::uint32_t i = 0; i < triangles.corners.size(); ++i) {
    const auto& t = triangles.corners[i];
    for (const std::uint32_t p : {t.a, t.b, t.c}) loads.triangle_of[next[p]++] = i;
  }
  loads.corner_impulse.assign(triangles.corners.size(), Vec3{});
}

void load_triangles(const state::Deformable& object, const state::Triangles& triangles, const Air& air,
                    const state::Particles& particles, parallel::Range range, AirLoads& loads) {
  const std::vector<Vec3>& wind = air.wind;
  const Real third = Real(1) / Real(3);
  for (int i = range.begin; i < range.end; ++i) {
    const std::size_t row = object.triangles.first + static_cast<std::size_t>(i);
    const auto [a, b, c] = triangles.corners[row];
    const Vec3 flow = third * ((wind[a] - particles.velocity[a].v) + (wind[b] - particles.velocity[b].v) +
                               (wind[c] - particles.velocity[c].v));
    const Vec3 normal = cross(particles.position[b].x - particles.position[a].x,
                              particles.position[c].x - particles.position[a].x);
    const Real area2 = length(normal);
    const Real speed = length(flow);
    loads.corner_impulse[row] = {};
    if (!(area2 > Real(0)) || !(speed > Real(0))) continue;

    const Real along = dot(normal, flow) / area2;  // n . u
    const Vec3 n = ((along < Real(0) ? Real(-1) : Real(1)) / area2) * normal;
    const Real cosine = (along < Real(0) ? -along : along) / speed;
    const Vec3 lift = n - (cosine / speed) * flow;
    const Real pressure = Real(0.5) * air.density * speed * cosine;  // force per area and velocity
    const Vec3 per_area =
        pressure * (object.drag_coefficient * flow + (object.lift_coefficient * speed) * lift);
    const Real stiffening =
        air.h * pressure * (object.drag_coefficient + object.lift_coefficient) / triangles.areal_density[row];
    loads.corner_impulse[row] =
        (third * air.h * Real(0.5) * area2 / std::max(Real(1), stiffening)) * per_area;
  }
}

void push_particles(const AirLoads& loads, parallel::Range range, state::Particles& particles) {
  for (int p = range.begin; p < range.end; ++p) {
    Vec3 sum = {};
    for (std::uint32_t i = loads.first_of[p]; i < loads.first_of[p + 1]; ++i) {
      sum += loads.corner_impulse[loads.triangle_of[i]];
    }
    particles.velocity[p].v += particles.velocity[p].inverse_mass * sum;
  }
}

void push_segments(const state::Deformable& object, const state::Segments& segments, const Air& air,
                   state::Particles& particles) {
  const std::vector<Vec3>& wind = air.wind;
  const Real h = air.h;
  // Every segment sees the velocities from before, so that none waits for the one before it.
  const auto first = particles.velocity.begin() + object.particles.first;
  Vec3 v_a = first->v;
  Vec3 on_a = {};  // the change by the segment before
  for (std::uint32_t i = 0; i < object.segments.count; ++i) {
    const std::size_t a = object.particles.first + i;
    const std::size_t b = a + 1;
    const Vec3 v_b = particles.velocity[b].v;
    const Vec3 line = particles.position[b].x - particles.position[a].x;
    const Real square = length_squared(line);
    const Vec3 flow = Real(0.5) * ((wind[a] - v_a) + (wind[b] - v_b));
    const Vec3 across = square > Real(0) ? flow - (dot(flow, line) / square) * line : flow;
    const Real diameter = Real(2) * particles.position[a].radius;
    const Real drag = Real(0.5) * air.density * object.drag_coefficient * diameter *
                      segments.rest_length[object.segments.first + i] * length(across);  // [kg/s]
    const auto change_of = [&](std::size_t p) {
      const Real w = particles.velocity[p].inverse_mass;
      return (Real(0.5) * std::min(w * h * drag, Real(1))) * across;
    };
    particles.velocity[a].v = v_a + (on_a + change_of(a));
    on_a = change_of(b);
    v_a = v_b;
  }
  first[object.segments.count].v += on_a;
}

}  // namespace hooke::solver
