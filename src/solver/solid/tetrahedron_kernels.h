#pragma once

#include "solver/solid/tetrahedron_blocks.h"
#include "state/particles.h"

#include <cstdint>
#include <span>

namespace hooke::solver::wide {

/// Blocks that share no particle, and what a pass over them needs.
struct TetrahedronRun {
  std::span<const TetrahedronBlock> blocks;
  int last_count = kTetrahedronLanes;     ///< Rows in the last block.
  const std::uint8_t* skipped = nullptr;  ///< Of each block, bit i: lane i is not solved.
  TetrahedronImpulses* done = nullptr;    ///< One per block.
  double inverse_h = 0;                   ///< [1/s]
  bool again = false;                     ///< Stiff rows alone, which take into account what they have done.
};

/// Rows of one color where something presses on a corner, copied from their blocks.
struct PressedTetrahedra {
  TetrahedronBlock rows;
  TetrahedronImpulses done;
  double answer[4][6][kTetrahedronLanes];  ///< W of each corner, see PressedPoint.
  int count = 0;
};

/// Solves one pass over a run, whose corners move alike in all directions; the formulas stand in
/// solver/solid/tetrahedron_solve.h.
void solve_free_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                           state::VelocityRecord* velocity);
/// Solves rows whose corners move more easily in some directions than in others.
void solve_pressed_tetrahedra(double inverse_h, PressedTetrahedra& rows,
                              const state::PositionRecord* position, state::VelocityRecord* velocity);
/// Damps the rows of a run.
void damp_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                     state::VelocityRecord* velocity);

// The scalar twins give the same bits, one row at a time.
void solve_free_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                                  state::VelocityRecord* velocity);
void solve_pressed_tetrahedra_scalar(double inverse_h, PressedTetrahedra& rows,
                                     const state::PositionRecord* position, state::VelocityRecord* velocity);
void damp_tetrahedra_scalar(const TetrahedronRun& run, const state::PositionRecord* position,
                            state::VelocityRecord* velocity);

}  // namespace hooke::solver::wide
