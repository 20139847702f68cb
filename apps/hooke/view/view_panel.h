#pragma once

#include "hooke/session/session.h"
#include "hooke/view/inspector.h"
#include "hooke/view/view_input.h"
#include "hooke/view/widget_boxes.h"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

namespace hooke::app {

/// The panels of the window: buttons and figures, the timeline, the page of keys. Their buttons give
/// commands.
class ViewPanel {
 public:
  /// Notes a new view, for the plot of energies.
  void note(const SessionView& view);
  /// Builds all panels for this picture. `picture_ms` is the time that a picture takes.
  void build(const SessionView& view, ViewInput& input, double picture_ms);

  /// Where the parts of the panels were in the last picture.
  [[nodiscard]] const WidgetBoxes& boxes() const { return boxes_; }

 private:
  void build_figures(const SessionView& view, ViewInput& input, double picture_ms);
  void build_timeline(const SessionView& view, ViewInput& input);
  void draw_plot() const;

  std::deque<Energies> history_;
  std::uint64_t noted_step_ = 0;
  std::uint64_t noted_world_ = 0;             ///< SessionView::built of the history.
  std::optional<std::uint64_t> wanted_step_;  ///< While the slider is dragged.
  Inspector inspector_;
  WidgetBoxes boxes_;
};

}  // namespace hooke::app
