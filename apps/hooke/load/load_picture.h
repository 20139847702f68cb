#pragma once

#include "hooke/load/raise.h"
#include "hooke/result.h"

#include <string>

namespace hooke::app {

/// Draws the last equilibrium before the first break, its members colored by their utilization: blue for
/// none, over green and yellow at a half, to red at 1, violet beyond it, gray without a limit. The simulation
/// is in that state then. Errors: no OpenGL, the file cannot be written.
[[nodiscard]] Result<void> draw_load(Simulation& simulation, const Raised& raised, const std::string& path);

}  // namespace hooke::app
