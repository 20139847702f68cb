#pragma once

#include "world/world_data.h"

namespace hooke::world {

/// Counts how contacts, hooks, ropes and points were solved. It is called before hooks that broke leave, and
/// before bodies fall asleep.
void count_routes(const WorldData& world, StepReport& report);

/// Ends a step of length `dt` [s]. Counts what it did and what it refused. Clears the forces on particles
/// that were given for it, and advances time.
void end_step(WorldData& world, double dt, StepReport& report);

}  // namespace hooke::world
