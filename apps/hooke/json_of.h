#pragma once

#include "hooke/world.h"

#include <nlohmann/json.hpp>

namespace hooke::app {

inline nlohmann::ordered_json json_of(const Energy& energy) {
  return {{"kinetic", energy.kinetic}, {"potential", energy.potential}, {"elastic", energy.elastic}};
}

}  // namespace hooke::app
