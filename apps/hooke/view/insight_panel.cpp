#include "hooke/view/insight_panel.h"

#include <cstdio>
#include <imgui.h>
#include <string>

namespace hooke::app {

namespace {

ImU32 color_of(DebugColor color) {
  return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, 1});
}

/// A bar of all colors of loads, with what blue and red stand for.
void draw_bar(const char* name, double full, const char* unit) {
  if (!(full > 0)) return;
  const float height = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  constexpr int kParts = 64;
  const float width = 8 * height / kParts;
  for (int i = 0; i < kParts; ++i) {
    const double share = 2 * (i + 0.5) / kParts - 1;
    const float x = corner.x + width * static_cast<float>(i);
    ImGui::GetWindowDrawList()->AddRectFilled({x, corner.y}, {x + width + 1, corner.y + height},
                                              color_of(load_color(share)));
  }
  ImGui::Dummy({8 * height, height});
  ImGui::SameLine();
  ImGui::Text("%s -%.3g .. %.3g %s", name, full, full, unit);
}

template <std::size_t N>
void list_routes(const char* title, const std::array<DebugRoute, N>& routes) {
  ImGui::TextUnformatted(title);
  const float wide = ImGui::GetContentRegionMax().x;
  for (const DebugRoute& route : routes) {
    const std::string name(route.name);
    ImGui::SameLine();
    if (ImGui::GetCursorPosX() + ImGui::CalcTextSize(name.c_str()).x > wide) ImGui::NewLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color_of(route.color)), "%s", name.c_str());
  }
}

void build_legend(const DebugDrawDesc& shown, const Insight& insight) {
  const DebugDrawLegend& legend = insight.legend;
  if (shown.contacts) {
    ImGui::Text("%u contacts, the largest force %.4g N", legend.contacts, legend.force);
    ImGui::TextDisabled("normal green, force red, friction yellow");
    if (insight.arrow_force > 0) ImGui::TextDisabled("the longest arrow is %.4g N", insight.arrow_force);
  }
  if (shown.velocities) ImGui::Text("arrows: the way in 0.1 s; up to %.4g m/s", legend.speed);
  if (shown.loads) {
    draw_bar("tension", legend.full_tension, "N");
    draw_bar("strain", 100 * legend.full_strain, "%");
  }
  if (shown.sleep) ImGui::Text("%u bodies sleep", legend.asleep);
  if (shown.routes) {
    list_routes("contacts:", debug_routes_of_contacts());
    list_routes("hooks:", debug_routes_of_hooks());
  }
}

}  // namespace

void build_insight(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  if (!ImGui::CollapsingHeader("insight (keys 1 to 8)", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (std::size_t i = 0; i < insight_choices().size(); ++i) {
    const InsightChoice& choice = insight_choices()[i];
    if (i % 3 > 0) ImGui::SameLine(static_cast<float>(i % 3) * 7.6F * ImGui::GetFontSize());
    bool shown = input.insight().*choice.shown;
    if (ImGui::Checkbox(choice.name, &shown)) input.key(ViewInput::insight_key(i));
    note_box(boxes, std::string("show ") + choice.name);
  }
  if (view.insight) build_legend(input.insight(), *view.insight);
}

}  // namespace hooke::app
