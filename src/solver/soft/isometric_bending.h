#pragma once

#include "parallel/range.h"
#include "solver/soft/spring_blocks.h"
#include "solver/soft/yarns.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// An isometric bending element is an isometric bend with the spring along its edge and the spring between
/// its wings, where there are such springs. Its up to three rows act on the same four particles, which are
/// read and written once for all of them.

namespace hooke::solver {

/// 16 elements of one color whose springs are of the same materials. The last block of a pass may hold
/// fewer: copies of its last element fill it.
struct alignas(64) IsometricBendBlock {
  std::uint32_t record[4][kLanes];  ///< Where the records of an element's particles begin, as in BendBlock.
  Real edge_length[kLanes];         ///< L of the spring along the edge [m].
  Real wing_length[kLanes];         ///< L of the spring between the wings [m].
  Real weight[3][kLanes];           ///< K_1, K_2, K_3 of elements::isometric_bend; K_0 is minus their sum.
  Real gamma[kLanes];               ///< 1 / (h^2 k) [1/kg]; written by prepare_isometric_bends.
};

/// What all bends of a pass have in common in a substep of h; written by prepare_isometric_bends.
struct IsometricBendSoftness {
  Real bias = Real(0);         ///< 1 / h [1/s]
  Real damped_bias = Real(0);  ///< 1 / (tau + h) [1/s]; equal to `bias` without damping.
  Real gamma_share = Real(1);  ///< h / (tau + h)

  [[nodiscard]] bool is_damped() const { return damped_bias != bias; }
};

/// Blocks [first, end) hold elements of one color: no two share a particle. Elements of several objects share
/// a pass only if the pass would have the same figures for each of the objects alone.
struct IsometricBendPass {
  std::uint32_t edge = 0;      ///< Material of the springs along edges, or kNoSpring.
  std::uint32_t wings = 0;     ///< Material of the springs between wings, or kNoSpring.
  Real damping = Real(0);      ///< tau of the bends [s].
  Real damped_mass = Real(0);  ///< Largest mass that tau acts on, see solver/soft/spring_solve.h [kg].
  Real stiffest = Real(0);     ///< Largest k sum |weight|^2 of its rows [N/m].
  int first = 0;
  int end = 0;
  int last_count = kLanes;  ///< Elements in the last block.
  IsometricBendSoftness softness = {};
};

/// The first of all materials stands for springs that do not exist.
inline constexpr std::uint32_t kNoSpring = 0;

struct IsometricBendBlocks {
  std::uint32_t first_particle = 0;  ///< Row of the particle that records count from.
  std::vector<IsometricBendBlock> blocks;
  std::vector<std::array<Real, kLanes>> stiffness;  ///< k of the bends [N/m], by block.
  std::vector<SpringMaterial> materials;
  std::vector<IsometricBendPass> passes;
};

/// Makes elements of the isometric bends of these objects and of the springs that lie along their edges or
/// between their wings. It leaves out bends and springs that `taken` marks, and marks the springs that it
/// takes.
void build_isometric_bend_blocks(std::span<const state::Deformable> objects, const state::Bends& bends,
                                 const state::Springs& springs, TakenRows& taken,
                                 IsometricBendBlocks& isometric_bends);

/// Sets the coefficients of every row for a substep of `h` [s].
void prepare_isometric_bends(IsometricBendBlocks& isometric_bends, Real h);

/// Solves the rows of each element one after another, the bend first, the spring along the edge last.
/// Springs are solved as in solver/soft/spring_solve.h. The bend is an implicit Euler step of E = k |q|^2 /
/// 2, where q = sum K_i x_i and r = dq/dt:
///
///     lambda = -(r + q / h) / (sum w_i K_i^2 + 1 / (h^2 k)),  v_i += w_i K_i lambda
///
/// The friction k tau d|q|/dt acts along q only, where 1 / (tau + h) and 1 / (h (tau + h) k) stand for 1 / h
/// and 1 / (h^2 k). Friction of all of r would brake a bent cloth that turns as a whole. The step itself
/// does so by a little: of a spin omega it takes 2 h E omega in each second.
///
/// `blocks` lies within one pass.
void solve_isometric_bends(const IsometricBendBlocks& isometric_bends, const IsometricBendPass& pass,
                           parallel::Range blocks, state::Particles& particles);

}  // namespace hooke::solver
