#pragma once

#include "solver/joint/joints.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Which articulations are not solved by themselves. An articulation is part of a coupled group
/// (solver/coupled/coupled_groups.h) if one of its members is hooked to a point, touches a rope or a point,
/// or has a load-bearing contact. Solved before the group and alone, its joints would not know the load, and
/// the group would then move its bodies as if they were free. A brake would yield to what hangs on its drum
/// by a rope, however strong it is.

namespace hooke::solver {

/// Gives the hooks of these articulations the way "coupled" (state::Hook::route) for one step. It is called
/// after choose_joint_routes, and once particle contacts and load-bearing contacts are known. `body_marks` is
/// scratch, by body row.
void couple_articulations(const Joints& joints, std::vector<std::uint8_t>& body_marks, state::Tables& tables);

}  // namespace hooke::solver
