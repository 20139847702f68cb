#pragma once

#include "solver/surface/surface_groups.h"

namespace hooke::solver {

/// Lists what presses on ropes in a substep of `h` [s], by the rows that were found: ropes are solved with
/// it. Without that, a row would push a taut rope aside first, and its solution would throw back what lies on
/// it.
void list_rope_loads(const state::Tables& tables, Real h, SurfaceContacts& contacts);

/// Begins the rows of a group, which are prepared, with the impulses with which ropes were solved, and gives
/// the other sides what they have of them. Of two ropes that were both solved with a contact each gets the
/// mean of both impulses, so that momentum stays.
void apply_rope_loads(SurfaceContacts& contacts, SurfaceGroup& group);

}  // namespace hooke::solver
