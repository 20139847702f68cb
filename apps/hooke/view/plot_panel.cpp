#include "hooke/view/plot_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <imgui.h>
#include <vector>

namespace hooke::app {

namespace {

constexpr double kSeconds = 10;        ///< Time that a plot shows [s].
constexpr float kPlotHeight = 10;      ///< In heights of the font; in a small window less, down to
constexpr float kLeastHeight = 4;      ///< this, and
constexpr float kHeightShare = 0.18F;  ///< at most this share of the window.
constexpr float kChoiceWidth = 15;     ///< The same.

/// Figures of the world that belong into one plot.
struct Group {
  const char* name = "";
  std::array<const char*, 4> columns = {};
};
constexpr std::array kGroups = {
    Group{"energy", {"kinetic energy", "potential energy", "elastic energy", "energy"}},
    Group{"momentum", {"momentum x", "momentum y", "momentum z"}},
    Group{"angular momentum", {"angular momentum x", "angular momentum y", "angular momentum z"}},
    Group{"time of a step", {"detect", "prepare", "substeps", "finish"}}};

constexpr std::array kColors = {IM_COL32(90, 170, 255, 255), IM_COL32(120, 210, 120, 255),
                                IM_COL32(240, 150, 80, 255), IM_COL32(240, 240, 240, 255)};

struct Curve {
  History::Column column = {};
  History::Curve points = {};
};

std::vector<std::string> columns_of(const std::string& chosen) {
  const auto* const group =
      std::find_if(kGroups.begin(), kGroups.end(), [&](const Group& one) { return chosen == one.name; });
  if (group == kGroups.end()) return {chosen};
  std::vector<std::string> names;
  for (const char* name : group->columns) {
    if (name != nullptr) names.emplace_back(name);
  }
  return names;
}

std::vector<Curve> curves_of(const History& history, const std::string& chosen) {
  std::vector<Curve> curves;
  const std::vector<History::Column> columns = history.columns();
  for (const std::string& name : columns_of(chosen)) {
    for (const History::Column& column : columns) {
      if (column.name == name) curves.push_back({column, history.curve(name, kSeconds)});
    }
  }
  return curves;
}

/// Least and largest finite value of all curves, with zero.
std::array<double, 2> range_of(const std::vector<Curve>& curves) {
  std::array<double, 2> range = {0, 0};
  for (const Curve& curve : curves) {
    for (const auto& [time, value] : curve.points) {
      if (std::isfinite(value)) range = {std::min(range[0], value), std::max(range[1], value)};
    }
  }
  if (!(range[1] > range[0])) range[1] = range[0] + 1;
  return range;
}

/// All curves share one scale, so that one sees energy move from one form to another.
void draw_curves(const std::vector<Curve>& curves, double now) {
  const std::array<double, 2> range = range_of(curves);
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = {
      ImGui::GetContentRegionAvail().x,
      std::clamp(kHeightShare * ImGui::GetIO().DisplaySize.y, kLeastHeight * unit, kPlotHeight * unit)};
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 end = {corner.x + size.x, corner.y + size.y};
  ImDrawList* canvas = ImGui::GetWindowDrawList();
  canvas->AddRectFilled(corner, end, IM_COL32(0, 0, 0, 110), 4);
  const auto height_of = [&](double value) {
    return end.y - size.y * static_cast<float>((value - range[0]) / (range[1] - range[0]));
  };
  canvas->AddLine({corner.x, height_of(0)}, {end.x, height_of(0)}, IM_COL32(255, 255, 255, 60));
  canvas->PushClipRect(corner, end, true);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<ImVec2> points;
    for (const auto& [time, value] : curves[i].points) {
      const auto along = static_cast<float>(1 - (now - time) / kSeconds);
      if (std::isfinite(value)) points.emplace_back(corner.x + along * size.x, height_of(value));
    }
    canvas->AddPolyline(points.data(), static_cast<int>(points.size()), kColors.at(i % kColors.size()), 0,
                        1.5F);
  }
  canvas->PopClipRect();
  ImGui::Dummy(size);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (curves[i].points.empty()) continue;
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kColors.at(i % kColors.size())), "%-18s %12.5g %s",
                       curves[i].column.name.c_str(), curves[i].points.back()[1],
                       curves[i].column.unit.c_str());
  }
}

}  // namespace

void PlotPanel::build_choice(const SessionView& view, WidgetBoxes& boxes) {
  ImGui::SetNextItemWidth(kChoiceWidth * ImGui::GetFontSize());
  const bool is_open = ImGui::BeginCombo("##plot", chosen_.c_str());
  if (!is_open) {
    note_box(boxes, "plot");
    return;
  }
  const auto offer = [&](const std::string& name) {
    if (ImGui::Selectable(name.c_str(), name == chosen_)) chosen_ = name;
    note_box(boxes, "plot " + name);
  };
  for (const Group& group : kGroups) offer(group.name);
  ImGui::Separator();
  for (const History::Column& column : view.history->columns()) {
    const bool is_grouped = std::any_of(kGroups.begin(), kGroups.end(), [&](const Group& group) {
      return std::any_of(group.columns.begin(), group.columns.end(),
                         [&](const char* name) { return name != nullptr && column.name == name; });
    });
    if (!is_grouped) offer(column.name);
  }
  ImGui::EndCombo();
}

void PlotPanel::build(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  if (!view.history || view.history->size() == 0) return;
  std::vector<Curve> curves = curves_of(*view.history, chosen_);
  // A figure of an object that is no longer selected is known no more.
  if (curves.empty()) {
    chosen_ = "energy";
    curves = curves_of(*view.history, chosen_);
  }
  build_choice(view, boxes);
  ImGui::SameLine();
  if (ImGui::Button("save CSV")) input.post(SaveFigures{});
  note_box(boxes, "save CSV");
  draw_curves(curves, view.time);
}

}  // namespace hooke::app
