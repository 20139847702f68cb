#pragma once

#include "hooke/session/session.h"
#include "hooke/view/view_input.h"
#include "hooke/view/widget_boxes.h"

#include <string>

namespace hooke::app {

/// A plot of figures over the last seconds, and the choice of which.
class PlotPanel {
 public:
  void build(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  /// What is plotted.
  [[nodiscard]] const std::string& chosen() const { return chosen_; }

 private:
  void build_choice(const SessionView& view, WidgetBoxes& boxes);

  std::string chosen_ = "energy";
};

}  // namespace hooke::app
