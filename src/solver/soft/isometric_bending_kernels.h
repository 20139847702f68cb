#pragma once

#include "solver/soft/isometric_bending.h"
#include "solver/soft/particle_kernels.h"
#include "state/particles.h"

namespace hooke::solver::wide {

using IsometricBendRun = Run<IsometricBendBlock>;

struct IsometricBendMaterials {
  const IsometricBendSoftness& bend;
  const SpringMaterial& edge;
  const SpringMaterial* wings;  ///< Null where no element of the run has a spring there.
};

/// Solves one pass over a run; the formulas stand in solver/soft/isometric_bending.h.
void solve_isometric_bends(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                           const state::PositionRecord* position, state::VelocityRecord* velocity);
void solve_isometric_bends_scalar(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                                  const state::PositionRecord* position, state::VelocityRecord* velocity);

}  // namespace hooke::solver::wide
