#pragma once

#include "parallel/range.h"
#include "solver/soft/spring_blocks.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// 16 bends of one color. The last block of a color may hold fewer: copies of its last row fill it.
struct BendBlock {
  /// Where the records of a row's particles begin, as in SpringBlock: both ends of the edge, then both
  /// wings.
  std::uint32_t record[4][kLanes];
  Real rest_angle[kLanes];
  Real bias[kLanes];   ///< b = k / (c + h k) [1/s]; written by prepare_bends.
  Real gamma[kLanes];  ///< 1 / (h (c + h k)); written by prepare_bends.
};

/// The laws from which prepare_bends makes the coefficients of a block. Unlike springs, bends of one cloth
/// differ.
struct BendLaws {
  std::uint32_t row[kLanes];  ///< Row of the table, counted from BendBlocks::first_row; lanes that fill a
                              ///< block have that of the row they copy.
  Real stiffness[kLanes];
  Real damping[kLanes];
};

/// Blocks [first, end) hold rows of one color: no two rows share a particle.
struct BendPass {
  int first = 0;
  int end = 0;
  int last_count = kLanes;  ///< Rows in the last block.
};

struct BendBlocks {
  std::uint32_t first_particle = 0;  ///< Row of the particle that records count from.
  std::uint32_t first_row = 0;       ///< Row of the table that laws count from.
  std::vector<BendBlock> blocks;
  std::vector<BendLaws> laws;  ///< One per block.
  std::vector<BendPass> passes;
};

/// Colors the bends by angle of these objects greedily in the order of the table, 16 to a block. Isometric
/// bends are solved elsewhere, see solver/soft/isometric_bending.h.
void build_bend_blocks(std::span<const state::Deformable> objects, const state::Bends& bends,
                       BendBlocks& blocks);

/// Sets b and gamma of every row for a substep of `h` [s].
void prepare_bends(BendBlocks& bends, Real h);

/// Turns each pair of triangles towards its rest angle, as an implicit Euler step of E = k (theta -
/// theta_0)^2 / 2.
///
/// Constraint   C = theta - theta_0 in (-pi, pi], gradients G_i over the four particles (elements/dihedral.h)
/// Impulse      lambda = -(sum G_i . v_i + b C) / (sum w_i |G_i|^2 + gamma),  v_i += w_i lambda G_i
///
/// With e = x_1 - x_0, l = |e|, d_i = x_i - x_0, n_a = e x d_2, n_b = d_3 x e, u = n / |n|^2 and alpha = d_2
/// . e / l^2, beta = d_3 . e / l^2 (the places on the edge from which the wings' heights rise):
///
///     theta = atan2(-l n_a . d_3, n_a . n_b)
///     G_0 = l [(1 - alpha) u_a + (1 - beta) u_b],  G_1 = l (alpha u_a + beta u_b),
///     G_2 = -l u_a,  G_3 = -l u_b
///
/// The multiplier starts from zero each substep. Degenerate triangles are left alone. `blocks` lies within
/// one pass.
void solve_bends(const BendBlocks& bends, const BendPass& pass, parallel::Range blocks,
                 state::Particles& particles);

}  // namespace hooke::solver
