#include "solver/wide/wide.h"

#include <cmath>

// The order of every operation here is that of kernels.cpp.

namespace hooke::solver::wide {

namespace {

void solve_row(const SpringBlock& block, int lane, const SpringMaterial& material,
               const state::PositionLine* position, state::VelocityLine* velocity) {
  const std::uint32_t a = block.line_a[lane] / 4;
  const std::uint32_t b = block.line_b[lane] / 4;
  const Vec3 d = position[a].x - position[b].x;
  const Vec3 dv = velocity[a].v - velocity[b].v;
  const Real w = velocity[a].inverse_mass + velocity[b].inverse_mass;
  const Real l2 = (d.x * d.x + d.y * d.y) + d.z * d.z;
  const Real l = std::sqrt(l2);
  Real numerator =
      ((d.x * dv.x + d.y * dv.y) + d.z * dv.z) + material.bias * (l * (l - block.rest_length[lane]));
  if (material.one_sided) numerator = numerator > Real(0) ? numerator : Real(0);
  const Real denominator = l2 * (w + material.gamma);
  const Real s = denominator > Real(0) ? numerator / denominator : Real(0);
  const Vec3 p = {d.x * s, d.y * s, d.z * s};
  velocity[a].v -= velocity[a].inverse_mass * p;
  if (!material.anchored) velocity[b].v += velocity[b].inverse_mass * p;
}

}  // namespace

void solve_springs_scalar(const SpringRun& run, const SpringMaterial& material,
                          const state::PositionLine* position, state::VelocityLine* velocity) {
  for (const SpringBlock& block : run.blocks) {
    const int count = &block == &run.blocks.back() ? run.last_count : kLanes;
    for (int lane = 0; lane < count; ++lane) solve_row(block, lane, material, position, velocity);
  }
}

void accelerate_scalar(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles) {
  const Vec3 change = h * acceleration;
  const auto settled = [](Real v) { return std::abs(v) < Real(1e-20) ? Real(0) : v; };
  for (int i = rows.begin; i < rows.end; ++i) {
    const bool moves = particles.velocity[i].inverse_mass > Real(0);
    const Vec3 v = particles.velocity[i].v + (moves ? change : Vec3{});
    particles.velocity[i].v = {settled(v.x), settled(v.y), settled(v.z)};
  }
}

void move_scalar(Real h, parallel::Range rows, state::Particles& particles) {
  for (int i = rows.begin; i < rows.end; ++i) particles.position[i].x += h * particles.velocity[i].v;
}

}  // namespace hooke::solver::wide
