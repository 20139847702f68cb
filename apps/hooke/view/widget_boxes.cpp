#include "hooke/view/widget_boxes.h"

#include <imgui.h>

namespace hooke::app {

void note_box(WidgetBoxes& boxes, const std::string& name) {
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const ImVec2 middle = {0.5F * (low.x + high.x), 0.5F * (low.y + high.y)};
  const ImVec2 from = ImGui::GetWindowDrawList()->GetClipRectMin();
  const ImVec2 to = ImGui::GetWindowDrawList()->GetClipRectMax();
  if (middle.x < from.x || middle.x > to.x || middle.y < from.y || middle.y > to.y) return;
  boxes[name] = {static_cast<double>(low.x), static_cast<double>(low.y), static_cast<double>(high.x),
                 static_cast<double>(high.y)};
}

}  // namespace hooke::app
