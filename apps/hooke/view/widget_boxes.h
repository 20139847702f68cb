#pragma once

#include <array>
#include <map>
#include <string>

namespace hooke::app {

/// Where parts of the panels were in the last picture, by name: left, top, right, bottom [screen units].
/// Tests point a mouse at them.
using WidgetBoxes = std::map<std::string, std::array<double, 4>>;

/// Notes the box of the last item under this name, if its middle can be seen.
void note_box(WidgetBoxes& boxes, const std::string& name);

}  // namespace hooke::app
