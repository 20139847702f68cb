#pragma once

#include "solver/joint/joints.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Which articulations are not solved by themselves. One of which a member is tied to a point, or touches a
/// rope, a point or what it bears, is part of their bundle (solver/coupled/coupled_groups.h): solved before
/// it, alone, its joints know nothing of the load, and the bundle then moves its bodies as if they were free.
/// A brake would yield to what hangs on its drum by a rope, however strong it is.

namespace hooke::solver {

/// Marks the hooks of these articulations, state::Hook::coupled, for a step: after prepare_joints, which
/// takes the marks of the last step away, and once contacts of points and borne contacts are known. `touched`
/// is scratch, by body row.
void couple_articulations(const Joints& joints, std::vector<std::uint8_t>& body_marks, state::Tables& tables);

}  // namespace hooke::solver
