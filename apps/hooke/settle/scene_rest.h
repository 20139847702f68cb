#pragma once

#include "hooke/commands.h"
#include "hooke/settle.h"

#include <string>
#include <vector>

namespace hooke {
class Simulation;
}

namespace hooke::app {

/// Runs `hooke settle SCENE.json`: brings a scene to rest, and tells where things are then.
int settle_scene(Arguments arguments);

/// Says in words how a scene came to rest or why it did not, without its end of line.
[[nodiscard]] std::string settle_text(const Simulation& simulation, const SettleReport& report);

}  // namespace hooke::app
