#pragma once

#include "solver/surface/surface_groups.h"

namespace hooke::solver {

/// Whether so many vertices of the group are about to leave their cages that contacts must be found anew.
[[nodiscard]] bool leaves_cages(const state::Tables& tables, Real h, const SurfaceContacts& contacts,
                                const SurfaceGroup& group);

/// Whether pairs of a group would come too near each other in a substep of `h` [s], as particles move now. If
/// not, it measures how far apart they are.
[[nodiscard]] bool pairs_would_meet(const state::Tables& tables, Real h, SurfaceContacts& contacts,
                                    SurfaceGroup& group);

/// Changes where vertices went in this substep, so that no pair of the group crosses between: clips them
/// to their cages, moves pairs that come too near apart along their normals, and holds back, at last, what
/// does not come apart. Stiff solids are moved as wholes where that does. A group of solids alone that
/// nothing holds keeps its momentum. A pair whose both ends are separated along the same normal does not meet
/// on straight paths between them.
void truncate_group(Real h, SurfaceContacts& contacts, SurfaceGroup& group, state::Tables& tables);

}  // namespace hooke::solver
