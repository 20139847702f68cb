#include "elements/dihedral.h"
#include "math/trig.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Every operation here has the order of solver/soft/particle_kernels.cpp.

namespace hooke::solver::wide {

namespace {

void solve_row(const SpringBlock& block, int lane, const SpringMaterial& material,
               const state::PositionRecord* position, state::VelocityRecord* velocity) {
  const std::uint32_t a = block.record_a[lane] / 4;
  const std::uint32_t b = block.record_b[lane] / 4;
  const Vec3 d = position[a].x - position[b].x;
  const Vec3 dv = velocity[a].v - velocity[b].v;
  const Real w = velocity[a].inverse_mass + velocity[b].inverse_mass;
  const Real l2 = (d.x * d.x + d.y * d.y) + d.z * d.z;
  const Real l = std::sqrt(l2);
  const Real rate = (d.x * dv.x + d.y * dv.y) + d.z * dv.z;
  Real error = l * (l - block.rest_length[lane]);
  if (material.is_rigid()) {
    const Real whole = l * material.recovery;
    const Real most = whole + material.recovery_time * std::max(rate, Real(0));
    const Real least = material.recovery_time * std::min(rate, Real(0)) - whole;
    // What only pulls has no error to take back while it is slack.
    if (!material.one_sided) error = std::max(error, least);
    error = std::min(error, most);
  }
  Real numerator = rate + material.bias * error;
  if (material.one_sided) numerator = numerator > Real(0) ? numerator : Real(0);
  const Real denominator = l2 * (w + material.gamma);
  const Real s = denominator > Real(0) ? numerator / denominator : Real(0);
  const Vec3 p = {d.x * s, d.y * s, d.z * s};
  velocity[a].v -= velocity[a].inverse_mass * p;
  if (!material.anchored) velocity[b].v += velocity[b].inverse_mass * p;
}

/// The names are those of solver/soft/bending.h.
void solve_row(const BendBlock& block, int lane, const state::PositionRecord* position,
               state::VelocityRecord* velocity) {
  const auto at = [&](int k) { return block.record[k][lane] / 4; };
  state::VelocityRecord* v[4] = {velocity + at(0), velocity + at(1), velocity + at(2), velocity + at(3)};
  const Vec3 x0 = position[at(0)].x;
  const Vec3 e = position[at(1)].x - x0;
  const Vec3 d2 = position[at(2)].x - x0;
  const Vec3 d3 = position[at(3)].x - x0;
  const Vec3 na = cross(e, d2);
  const Vec3 nb = cross(d3, e);
  const Real l2 = dot(e, e);
  const Real aa = dot(na, na);
  const Real bb = dot(nb, nb);
  constexpr Real kLeast = std::numeric_limits<Real>::min();
  const bool has_extent = l2 >= kLeast && aa >= kLeast && bb >= kLeast;
  const auto inverse = [has_extent](Real size) { return has_extent ? Real(1) / size : Real(0); };

  const Real l = std::sqrt(l2);
  const Real angle = math::quick_atan2(-(l * dot(na, d3)), dot(na, nb));
  const Real inverse_l2 = inverse(l2);
  const Real alpha = dot(d2, e) * inverse_l2;
  const Real beta = dot(d3, e) * inverse_l2;
  const Real inverse_aa = inverse(aa);
  const Real inverse_bb = inverse(bb);
  const Vec3 ua = inverse_aa * na;
  const Vec3 ub = inverse_bb * nb;
  const Vec3 g[4] = {(Real(1) - alpha) * ua + (Real(1) - beta) * ub, alpha * ua + beta * ub, ua, ub};
  const Real rate = (dot(g[0], v[0]->v) + dot(g[1], v[1]->v)) - (dot(g[2], v[2]->v) + dot(g[3], v[3]->v));
  const Real w = (v[0]->inverse_mass * dot(g[0], g[0]) + v[1]->inverse_mass * dot(g[1], g[1])) +
                 (v[2]->inverse_mass * inverse_aa + v[3]->inverse_mass * inverse_bb);
  const Real numerator = l * rate + block.bias[lane] * elements::wrapped(angle - block.rest_angle[lane]);
  const Real denominator = l2 * w + block.gamma[lane];
  const Real s = denominator > Real(0) ? l * (numerator / denominator) : Real(0);
  v[0]->v -= (v[0]->inverse_mass * s) * g[0];
  v[1]->v -= (v[1]->inverse_mass * s) * g[1];
  v[2]->v += (v[2]->inverse_mass * s) * g[2];
  v[3]->v += (v[3]->inverse_mass * s) * g[3];
}

/// Calls `solve(block, lane)` for each row.
template <class Block, class Solve>
void for_each_row(const Run<Block>& run, Solve&& solve) {
  for (const Block& block : run.blocks) {
    const int count = &block == &run.blocks.back() ? run.last_count : kLanes;
    for (int lane = 0; lane < count; ++lane) solve(block, lane);
  }
}

}  // namespace

void solve_springs_scalar(const SpringRun& run, const SpringMaterial& material,
                          const state::PositionRecord* position, state::VelocityRecord* velocity) {
  for_each_row(
      run, [&](const SpringBlock& block, int lane) { solve_row(block, lane, material, position, velocity); });
}

void solve_bends_scalar(const BendRun& run, const state::PositionRecord* position,
                        state::VelocityRecord* velocity) {
  for_each_row(run, [&](const BendBlock& block, int lane) { solve_row(block, lane, position, velocity); });
}

void accelerate_scalar(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles) {
  const Vec3 change = h * acceleration;
  const auto flushed = [](Real v) { return std::abs(v) < Real(1e-20) ? Real(0) : v; };
  for (int i = rows.begin; i < rows.end; ++i) {
    const bool moves = particles.velocity[i].inverse_mass > Real(0);
    const Vec3 v = particles.velocity[i].v + (moves ? change : Vec3{});
    particles.velocity[i].v = {flushed(v.x), flushed(v.y), flushed(v.z)};
  }
}

void move_scalar(Real h, parallel::Range rows, state::Particles& particles) {
  for (int i = rows.begin; i < rows.end; ++i) particles.position[i].x += h * particles.velocity[i].v;
}

}  // namespace hooke::solver::wide
