#pragma once

#include "hooke/math.h"

#include "state/tables.h"

namespace hooke::solver {

/// Decides which cloths are solved at once in the next step (solver/cloth/cloth_solution.h): those of which a
/// row that substeps of `h` [s] do not carry is too long. Only cloths with pins, and without gas and hooks,
/// are. It ends once sweeps would have done for kCalmTime, or when a body that moves presses on the cloth,
/// which the solution does not know. `dt` [s] is the length of the step. A cloth that is solved otherwise
/// than before counts as changed.
void choose_stretch_solutions(Real h, Real dt, state::Tables& tables);

}  // namespace hooke::solver
