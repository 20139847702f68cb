#pragma once

#include "hooke/scene_io.h"

#include <string>
#include <string_view>
#include <vector>

namespace hooke::app {

/// A figure of an object or of the world, as it is now.
struct MeasuredValue {
  std::string name = {};
  std::string unit = {};
  double value = 0;
};

/// Measures the object of that name, or the world if the name is empty. An object that is gone has none.
std::vector<MeasuredValue> measure(const Simulation& simulation, std::string_view name);

}  // namespace hooke::app
