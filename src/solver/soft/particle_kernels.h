#pragma once

#include "parallel/range.h"
#include "solver/simd/dispatch.h"
#include "solver/simd/lanes.h"
#include "solver/soft/bending.h"
#include "solver/soft/spring_blocks.h"
#include "state/particles.h"

#include <cstddef>
#include <span>

/// \file
/// Kernels over many lanes. One source serves all instruction sets (Highway), and the set is chosen at run
/// time. Every set gives the bits of the scalar twin, because each lane does the same operations in the same
/// order, with no fused multiply-add and no approximate division. The double twin of the engine runs the
/// scalar twins.

namespace hooke::solver::wide {

using SpringRun = Run<SpringBlock>;
using BendRun = Run<BendBlock>;

/// Solves one pass over a run; the formula stands in solver/soft/spring_solve.h.
void solve_springs(const SpringRun& run, const SpringMaterial& material,
                   const state::PositionRecord* position, state::VelocityRecord* velocity);

/// Solves one pass over a run; the formula stands in solver/soft/bending.h.
void solve_bends(const BendRun& run, const state::PositionRecord* position, state::VelocityRecord* velocity);

/// Applies v += h a to particles that can move. Components below 1e-20 m/s become zero, so that nothing
/// decays into denormals.
void accelerate(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles);

/// Applies x += h v.
void move(Real h, parallel::Range rows, state::Particles& particles);

// The scalar twins give the same bits, one row at a time.
void solve_springs_scalar(const SpringRun& run, const SpringMaterial& material,
                          const state::PositionRecord* position, state::VelocityRecord* velocity);
void solve_bends_scalar(const BendRun& run, const state::PositionRecord* position,
                        state::VelocityRecord* velocity);
void accelerate_scalar(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles);
void move_scalar(Real h, parallel::Range rows, state::Particles& particles);

}  // namespace hooke::solver::wide
