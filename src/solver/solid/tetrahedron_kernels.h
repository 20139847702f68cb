#pragma once

#include "solver/solid/tetrahedron_blocks.h"
#include "state/particles.h"

#include <cstdint>
#include <span>

namespace hooke::solver::wide {

/// Blocks that share no particle, and what a pass over them needs.
struct TetrahedronRun {
  std::span<const TetrahedronBlock> blocks;
  int last_count = kTetrahedronLanes;  ///< Rows in the last block.
  double inverse_h = 0;                ///< [1/s]
  // Of a StiffSolution.
  StressBlock* stress = nullptr;  ///< One per block.
  double* force = nullptr;
  double* diagonal = nullptr;
  const double* direction = nullptr;
  double* image = nullptr;
};

/// Solves one pass over a run; the formulas stand in solver/solid/tetrahedron_solve.h.
void solve_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                      state::VelocityRecord* velocity);
/// Finds the linear law of each row, and adds up the impulses that rows give at these velocities.
void linearize_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                          const state::VelocityRecord* velocity);
/// Adds the impulses by which rows resist `direction` to `image`.
void resist_tetrahedra(const TetrahedronRun& run);
/// Damps the rows of a run.
void damp_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                     state::VelocityRecord* velocity);

// The scalar twins give the same bits, one row at a time.
void solve_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                             state::VelocityRecord* velocity);
void linearize_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                                 const state::VelocityRecord* velocity);
void resist_tetrahedra_scalar(const TetrahedronRun& run);
void damp_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                            state::VelocityRecord* velocity);

}  // namespace hooke::solver::wide
