#pragma once

#include "hooke/session/session.h"
#include "hooke/view/inspector.h"
#include "hooke/view/plot_panel.h"
#include "hooke/view/view_input.h"
#include "hooke/view/widget_boxes.h"

#include <cstdint>
#include <optional>
#include <string>

namespace hooke::app {

/// Width of the panel on the left, in heights of the font.
inline constexpr float kPanelWidth = 23;

/// What the pictures of the window cost.
struct PictureCost {
  double milliseconds = 0;  ///< Of a picture; 0 before the first.
  double scale = 1;         ///< Width and height of a picture in those of the window.
};

/// The panels of the window: buttons and figures, the timeline, the page of keys. Their buttons give
/// commands.
class ViewPanel {
 public:
  /// Builds all panels for this picture. `pictures` tells what pictures cost.
  void build(const SessionView& view, ViewInput& input, const PictureCost& pictures);

  /// Name of what is plotted.
  [[nodiscard]] const std::string& plotted() const { return plot_.chosen(); }
  /// Where the parts of the panels were in the last picture.
  [[nodiscard]] const WidgetBoxes& boxes() const { return boxes_; }

 private:
  void build_figures(const SessionView& view, ViewInput& input, const PictureCost& pictures);
  /// Shows what came of the last command, in gray once it is old.
  void build_said(const SessionView& view);
  void build_timeline(const SessionView& view, ViewInput& input);

  std::uint64_t said_by_ = 0;                 ///< Number of the command whose answer is shown.
  double said_at_ = 0;                        ///< When the answer was new [s].
  std::optional<std::uint64_t> wanted_step_;  ///< While the slider is dragged.
  PlotPanel plot_;
  Inspector inspector_;
  WidgetBoxes boxes_;
};

}  // namespace hooke::app
