#pragma once

#include "world/world_data.h"

namespace hooke::world {

/// Ends a step of length `dt` [s]. Counts what it did, how contacts and hooks were solved, and what it
/// refused. Clears the forces on particles that were given for it, and advances time.
void end_step(WorldData& world, double dt, StepReport& report);

}  // namespace hooke::world
