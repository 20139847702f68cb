#pragma once

#include "math/symmetric.h"
#include "solver/simd/lanes.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/tetrahedra.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Tetrahedra in the order of the kernels: blocks of 8 rows that share no particle, and the blocks of one
/// color after another.

namespace hooke::solver {

inline constexpr int kTetrahedronLanes = wide::kDoubleLanes;

/// 8 rows of one color. The last block of a pass may hold fewer: copies of its last row fill it. The
/// coefficients are those of one substep of length h.
struct TetrahedronBlock {
  /// 4 times the row of each corner's particle, counted from TetrahedronBlocks::first_particle: where its
  /// record begins, in numbers.
  std::uint32_t record[4][kTetrahedronLanes];
  Real b[3][3][kTetrahedronLanes];  ///< Gradients of the shape functions of corners 1 to 3 [1/m].
  // All below are written by prepare_tetrahedra.
  Real gamma_volume[kTetrahedronLanes];  ///< 1 / (h^2 lambda V).
  Real gamma_shape[kTetrahedronLanes];   ///< 1 / (2 h^2 mu V).
  Real gamma_trace[kTetrahedronLanes];   ///< 1 / (h tau (lambda - mu) V), for the rate of volume; infinite
                                         ///< without damping.
  Real gamma_rate[kTetrahedronLanes];    ///< 1 / (h tau mu V), for the rates of strain; infinite without
                                         ///< damping.
  Real implicit[kTetrahedronLanes];      ///< theta, from 0 where h^2 w^2 of its shear is at most 1, to 1 from
                                         ///< 2 on. Rows above 0 are stiff and get several sweeps.

  [[nodiscard]] bool is_stiff(int lane) const { return implicit[lane] > Real(0); }
};

/// What the stiff rows of a block have done in the sweeps of a substep.
struct TetrahedronImpulses {
  double volume[kTetrahedronLanes];       ///< L_H
  double shape[3][3][kTetrahedronLanes];  ///< T_D, by columns.
};

/// The law from which prepare_tetrahedra makes the coefficients of a row.
struct TetrahedronLaw {
  std::uint32_t row = 0;  ///< Row of the table, counted from TetrahedronBlocks::first_row.
  Real volume = Real(0);
  Real shear_modulus = Real(0);
  Real volume_modulus = Real(0);
  Real damping_time = Real(0);
  Real mobility = Real(0);  ///< sum b_i^2 / m_i with the corners' shares of their masses [1 / (m^2 kg)].
};

/// Blocks [first, end) hold rows of one color, which share no particle. Passes follow each other.
struct TetrahedronPass {
  int first = 0;
  int end = 0;
  int last_count = kTetrahedronLanes;  ///< Rows in the last block.
};

/// A point of a solid that a body presses on. While solids are solved it also has its share of the body's
/// mass, because it is as hard to move: along the normal, and across it where it does not slide.
struct PressedPoint {
  std::uint32_t particle = 0;
  std::size_t contact = 0;  ///< Row of its first contact.
  std::uint32_t held = 0;   ///< Bit i: contact i holds it along the normal.
  std::uint32_t stuck = 0;  ///< Bit i: contact i holds it across the normal, too.
  Real inverse_mass = Real(0);
  Vec3 velocity = {};                    ///< When it was noted.
  math::Symmetric3<double> answer = {};  ///< W: an impulse I changes its velocity by W I [1/kg].
};

struct TetrahedronBlocks {
  std::uint32_t first_particle = 0;  ///< Row of the particle that records count from.
  std::uint32_t first_row = 0;       ///< Row of the table that laws count from.
  std::vector<TetrahedronBlock> blocks;
  std::vector<TetrahedronLaw> laws;  ///< One per lane of the blocks.
  std::vector<TetrahedronPass> passes;
  std::vector<Real> volume_at;  ///< Volume of the tetrahedra about each particle, from the first on [m^3].
  Real inverse_h = Real(0);     ///< 1 / h [1/s]; written by prepare_tetrahedra.
  bool any_damping = false;     ///< Whether any row is damped.
  bool any_stiff = false;  ///< Whether any row was stiff when they were prepared; it may become so by flow.
  std::vector<TetrahedronImpulses> impulses;  ///< One per block. Lives for one substep.
  std::vector<PressedPoint> pressed;          ///< In the order of particles. Lives while solids are solved.
  /// 1 + the row in `pressed` of each particle, from the first one on; 0 for those that nothing presses on.
  std::vector<std::uint32_t> pressed_of;
  /// Of each block, bit i: something presses on a corner of lane i. Written by solve_tetrahedra.
  std::vector<std::uint8_t> pressed_lanes;

  /// Of a lane, counted through all blocks.
  [[nodiscard]] bool is_stiff(std::size_t lane) const {
    return blocks[lane / kTetrahedronLanes].is_stiff(static_cast<int>(lane % kTetrahedronLanes));
  }
};

/// Colors the tetrahedra of these objects greedily in the order of the table, 8 of a color to a block. Rows
/// of a color that are about as stiff as each other stand together, so that few blocks are stiff in part.
void build_tetrahedra(std::span<const state::Deformable> objects, const state::Tetrahedra& tetrahedra,
                      const state::Particles& particles, TetrahedronBlocks& blocks);

/// Takes the shape at rest of a lane, counted through all blocks, from the table, and finds how easily it
/// moves.
void take_shape(const state::Tetrahedra& tetrahedra, const state::Particles& particles, std::size_t lane,
                TetrahedronBlocks& blocks);

/// Sets the coefficients of every row for a substep of `h` [s], and finds which rows are stiff.
void prepare_tetrahedra(TetrahedronBlocks& tetrahedra, Real h);
/// Sets the coefficients of one lane, counted through all blocks.
void prepare_tetrahedron(TetrahedronBlocks& tetrahedra, std::size_t lane, Real h);

}  // namespace hooke::solver
