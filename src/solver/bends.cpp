#include "solver/bends.h"

#include "elements/dihedral.h"
#include "solver/spring_blocks.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>

namespace hooke::solver {

void build_bend_rows(const state::Bends& bends, int particle_count, BendRows& rows) {
  rows = {};
  const auto count = static_cast<std::size_t>(bends.count());
  std::vector<std::uint64_t> used(static_cast<std::size_t>(particle_count), 0);
  std::vector<int> color(count);
  int lone_color = 64;
  for (std::size_t i = 0; i < count; ++i) {
    const state::Bends::Stencil& s = bends.stencil[i];
    const std::uint32_t ends[4] = {s.edge_a, s.edge_b, s.wing_a, s.wing_b};
    color[i] = take_color(used, ends, 4);
    if (color[i] >= 64) color[i] = lone_color++;
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return color[a] < color[b]; });

  rows.rows.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = order[i];
    if (i > 0 && color[row] != color[order[i - 1]]) rows.color_begin.push_back(static_cast<int>(i));
    rows.rows.push_back({.stencil = bends.stencil[row],
                         .rest_angle = bends.rest_angle[row],
                         .stiffness = bends.stiffness[row],
                         .damping = bends.damping[row]});
  }
  if (count > 0) rows.color_begin.push_back(static_cast<int>(count));
}

void prepare_bends(BendRows& rows, Real h) {
  for (BendRow& row : rows.rows) {
    const Real s = row.damping + h * row.stiffness;
    row.bias = s > Real(0) ? row.stiffness / s : Real(0);
    row.gamma = s > Real(0) ? Real(1) / (h * s) : std::numeric_limits<Real>::infinity();
  }
}

void solve_bends(const BendRows& rows, parallel::Range range, state::Particles& particles) {
  constexpr Real kPi = std::numbers::pi_v<Real>;
  for (int i = range.begin; i < range.end; ++i) {
    const BendRow& row = rows.rows[i];
    const std::uint32_t at[4] = {row.stencil.edge_a, row.stencil.edge_b, row.stencil.wing_a,
                                 row.stencil.wing_b};
    const auto x = [&](int k) { return particles.position[at[k]].x; };
    const auto d = elements::dihedral(x(0), x(1), x(2), x(3));
    if (!d.valid) continue;

    Real c = d.angle - row.rest_angle;
    if (c > kPi) c -= Real(2) * kPi;
    if (c <= -kPi) c += Real(2) * kPi;
    Real rate = Real(0);
    Real w = row.gamma;
    for (int k = 0; k < 4; ++k) {
      rate += dot(d.gradient[k], particles.velocity[at[k]].v);
      w += particles.velocity[at[k]].inverse_mass * length_squared(d.gradient[k]);
    }
    const Real lambda = w > Real(0) ? -(rate + row.bias * c) / w : Real(0);
    for (int k = 0; k < 4; ++k) {
      particles.velocity[at[k]].v += (particles.velocity[at[k]].inverse_mass * lambda) * d.gradient[k];
    }
  }
}

}  // namespace hooke::solver
