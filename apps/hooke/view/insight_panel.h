#pragma once

#include "hooke/session/session.h"
#include "hooke/view/view_input.h"
#include "hooke/view/widget_boxes.h"

namespace hooke::app {

/// Builds the choices of what is shown besides objects, and the legend of what is.
void build_insight(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);

}  // namespace hooke::app
