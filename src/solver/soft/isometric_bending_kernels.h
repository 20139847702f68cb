#pragma once

#include "solver/soft/isometric_bending.h"
#include "solver/soft/particle_kernels.h"
#include "state/particles.h"

namespace hooke::solver::wide {

using HingeRun = Run<HingeBlock>;

struct HingeMaterials {
  const HingeSoftness& bend;
  const SpringMaterial& edge;
  const SpringMaterial* wings;  ///< Null where none of the hinges has a spring there.
};

/// One pass over a run; the formulas stand in solver/soft/isometric_bending.h.
void solve_hinges(const HingeRun& run, const HingeMaterials& materials, state::Particles& particles);
void solve_hinges_scalar(const HingeRun& run, const HingeMaterials& materials, state::Particles& particles);

}  // namespace hooke::solver::wide
