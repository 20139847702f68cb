#pragma once

#include "world/world_data.h"

namespace hooke::world {

/// Counts what the step did, the ways that contacts and hooks went and what was refused among it; ends the
/// forces that were set for this step.
void end_step(WorldData& world, double dt, StepReport& report);

}  // namespace hooke::world
