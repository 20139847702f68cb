#pragma once

#include "parallel/range.h"
#include "state/particles.h"
#include "state/springs.h"

#include <vector>

namespace hooke::solver {

/// A bend row as the kernel wants it.
struct BendRow {
  state::Bends::Stencil stencil;
  Real rest_angle = Real(0);
  Real stiffness = Real(0);
  Real damping = Real(0);
  Real bias = Real(0);   ///< b = k / (c + h k) [1/s]; written by prepare_bends.
  Real gamma = Real(0);  ///< 1 / (h (c + h k)); written by prepare_bends.
};

/// Rows of one color, [color_begin[c], color_begin[c + 1]), share no particle.
struct BendRows {
  std::vector<BendRow> rows;
  std::vector<int> color_begin = {0};

  [[nodiscard]] int color_count() const { return static_cast<int>(color_begin.size()) - 1; }
};

void build_bend_rows(const state::Bends& bends, int particle_count, BendRows& rows);

void prepare_bends(BendRows& rows, Real h);

/// Turns each pair of triangles towards its rest angle, as an implicit Euler step of E = k (theta -
/// theta_0)^2 / 2.
///
/// Constraint   C = theta - theta_0 in (-pi, pi], gradients G_i over the four particles (elements/dihedral.h)
/// Impulse      lambda = -(sum G_i . v_i + b C) / (sum w_i |G_i|^2 + gamma),  v_i += w_i lambda G_i
///
/// The multiplier starts from zero each substep. Degenerate triangles are left alone. `range` lies within one
/// color.
void solve_bends(const BendRows& rows, parallel::Range range, state::Particles& particles);

}  // namespace hooke::solver
