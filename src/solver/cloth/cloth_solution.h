#pragma once

#include "parallel/thread_pool.h"
#include "solver/cloth/cloth_grids.h"
#include "solver/cloth/cloth_kernels.h"
#include "solver/solid/tetrahedron_blocks.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Stretch springs and limits of a cloth under loads, solved at once in each particle substep.
///
/// One pass over n rows adds a compliance of h^2 / m for each of them, so that cloth which bears loads
/// stretches, whatever its stiffness. Here the change u of velocities solves
///
///   (M + sum J^T B J) u = f,   f = -sum J^T (B J v + gain bias C n),   C = |x_a - x_b| - L
///   B = gain n n^T + s h^2 T / l (1 - n n^T)
///
/// which is one implicit Euler step of all rows: v is the velocity with all other forces, n the direction at
/// the start of the substep, and T = k C > 0 the tension. Its part across the row keeps a tight row from
/// swinging beyond all bounds. It takes energy, so s goes from 0, where such a swing is stable, to 1.
///
/// u is found by conjugate gradients (Hestenes and Stiefel 1952). A cycle over coarser and coarser grids
/// preconditions them: smoothing by the points' own blocks, and what is left solved for cells of four points,
/// which move as one (Galerkin; Vanek, Mandel and Brezina 1996). A limit is such a row where its length would
/// else be beyond it; which ones are is found anew until none changes.
///
/// The first direction is the change of the substep before: what hangs needs about the same again. Each
/// direction takes from the energy of the step, so that a solution that ends early makes none.

namespace hooke::solver {

/// How passes over grids are divided among threads. Which thread does what changes no result.
struct GridThreads {
  parallel::ThreadPool* pool = nullptr;  ///< Null: all on the calling one.
};

/// The solution of one cloth.
struct ClothSolution {
  ClothGrids grids;
  std::vector<PointVector> change, direction, image, force;
  std::vector<PointLanes> sums;  ///< By chunk of blocks.
  bool is_active = false;        ///< Whether this group's cloth is solved so.
  std::uint32_t directions = 0;  ///< Directions since the step began; read and cleared by end_step.
  bool unconverged = false;  ///< Whether directions ran out in some substep; read and cleared by end_step.
};

/// Makes the grids of a cloth.
void build_cloth_solution(const state::Deformable& object, const state::Springs& springs,
                          const state::Particles& particles, ClothSolution& solution);

/// Solves the rows of the cloth for a substep of `h` [s], and changes the velocities of its points.
void solve_cloth(GridThreads threads, Real h, state::Deformable& object, state::Particles& particles,
                 ClothSolution& solution);

}  // namespace hooke::solver
