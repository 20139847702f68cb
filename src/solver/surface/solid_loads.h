#pragma once

#include "solver/surface/surface_groups.h"

namespace hooke::solver {

/// Whether a group has both a cloth and a solid, which may load it.
[[nodiscard]] bool may_load_cloths(const state::Tables& tables, const SurfaceContacts& contacts,
                                   const SurfaceGroup& group);

/// Lists what of solids presses on cloths in a substep of `h` [s], by the rows that were found
/// (solver/cloth/cloth_loads.h).
void list_solid_loads(const state::Tables& tables, Real h, SurfaceContacts& contacts);

/// Notes how the solids move where they press, as they were solved since they were listed.
void note_solid_motion(const state::Tables& tables, SurfaceContacts& contacts);

/// Begins the rows of a group, which are prepared, with the impulses with which cloths were solved, and gives
/// them to the solids; those that are whole have them already.
void apply_solid_loads(SurfaceContacts& contacts, SurfaceGroup& group);

}  // namespace hooke::solver
