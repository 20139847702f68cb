#include "hooke/view/view_panel.h"

#include "hooke/view/insight_panel.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <imgui.h>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace hooke::app {

namespace {

constexpr float kTimelineHeight =
    6.5F;                            ///< Of the bar below, with what lies around it, in heights of the font.
constexpr double kFreshSeconds = 6;  ///< For which the answer to a command is bright [s].
const ImVec4 kWarningColor = {1, 0.45F, 0.35F, 1};
const ImVec4 kEngineWarningColor = {1, 0.75F, 0.35F, 1};

void write_wrapped(const std::string& text, ImVec4 color) {
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + kPanelWidth * ImGui::GetFontSize());
  ImGui::TextColored(color, "%s", text.c_str());
  ImGui::PopTextWrapPos();
}

void build_buttons(const SessionView& view, ViewInput& input) {
  const ImVec2 button = {5.2F * ImGui::GetFontSize(), 0};
  if (ImGui::Button(view.playing ? "Pause" : "Play", button)) input.key(ViewInput::Key::kPlay);
  ImGui::SameLine();
  if (ImGui::Button("Step", button)) input.key(ViewInput::Key::kStep);
  ImGui::SameLine();
  if (ImGui::Button("Restart", button)) input.key(ViewInput::Key::kRestart);
  ImGui::SameLine();
  ImGui::BeginDisabled(view.undo_count == 0);
  if (ImGui::Button("Undo", button)) input.key(ViewInput::Key::kUndo);
  ImGui::EndDisabled();
}

void build_choice(const SessionView& view, ViewInput& input) {
  if (view.droppable.empty()) return;
  ImGui::SetNextItemWidth(12 * ImGui::GetFontSize());
  if (!ImGui::BeginCombo("drop by D", input.chosen().c_str())) return;
  for (const std::string& name : view.droppable) {
    if (ImGui::Selectable(name.c_str(), name == input.chosen())) input.choose(name);
  }
  ImGui::EndCombo();
}

/// What a model that is shown by itself is made of.
void build_forms(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  if (!view.document) return;
  const std::optional<ModelForm> now = form_of_model(*view.document);
  if (!now) return;
  constexpr std::tuple<const char*, ModelForm, ViewInput::Key> kForms[] = {
      {"rigid", ModelForm::kRigid, ViewInput::Key::kRigid},
      {"jelly", ModelForm::kJelly, ViewInput::Key::kJelly},
      {"cloth", ModelForm::kCloth, ViewInput::Key::kCloth}};
  for (const auto& [name, form, key] : kForms) {
    bool is_form = form == *now;
    if (ImGui::Checkbox(name, &is_form)) input.key(key);
    note_box(boxes, std::string("form ") + name);
    ImGui::SameLine();
  }
  ImGui::TextUnformatted("model");
}

/// What is wrong with the file, and what is being done.
void build_messages(const SessionView& view) {
  constexpr std::size_t kMost = 5;
  for (std::size_t i = 0; i < std::min(view.file_errors.size(), kMost); ++i)
    write_wrapped(to_line(view.file_errors[i]), kWarningColor);
  if (view.file_errors.size() > kMost)
    write_wrapped("and " + std::to_string(view.file_errors.size() - kMost) + " more mistakes", kWarningColor);
  if (!view.progress.empty()) write_wrapped("loading " + view.progress, {0.7F, 0.85F, 1, 1});
}

/// What the engine had to give up, and what helps.
void build_warnings(const SessionView& view) {
  if (view.warnings.empty()) return;
  const std::string title = std::to_string(view.warnings.size()) + " warnings###warnings";
  if (!ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
  constexpr std::size_t kMost = 6;
  for (std::size_t i = 0; i < std::min(view.warnings.size(), kMost); ++i)
    write_wrapped(view.warnings[i], kEngineWarningColor);
  if (view.warnings.size() > kMost)
    write_wrapped("and " + std::to_string(view.warnings.size() - kMost) + " more", kEngineWarningColor);
}

void build_help() {
  const ImVec2 center = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(center, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::Begin("Keys", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoCollapse);
  if (ImGui::BeginTable("keys", 2)) {
    for (const ViewInput::KeyHelp& line : ViewInput::help()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line.keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line.what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void build_cost(const PictureCost& pictures) {
  const double rate = pictures.milliseconds > 0 ? 1000 / pictures.milliseconds : 0.0;
  const std::string part =
      pictures.scale < 1 ? ", drawn at " + std::to_string(std::lround(100 * pictures.scale)) + " %" : "";
  ImGui::Text("pictures %10.1f /s%s", rate, part.c_str());
}

/// Moves a panel back whose title was dragged out of the window, or is left outside of a smaller one.
void keep_in_sight() {
  const ImVec2 place = ImGui::GetWindowPos();
  const ImVec2 size = ImGui::GetWindowSize();
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const ImVec2 kept = {std::max(std::min(place.x, screen.x - size.x), 0.0F),
                       std::max(std::min(place.y, screen.y - ImGui::GetFrameHeight()), 0.0F)};
  if (kept.x != place.x || kept.y != place.y) ImGui::SetWindowPos(kept);
}

double in_mebibytes(std::size_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace

void ViewPanel::build_figures(const SessionView& view, ViewInput& input, const PictureCost& pictures) {
  ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kPanelWidth * ImGui::GetFontSize(), 0}, ImGuiCond_FirstUseEver);
  // What does not fit above the timeline is rolled: in a small window half of it would lie outside.
  const float highest = ImGui::GetIO().DisplaySize.y - kTimelineHeight * ImGui::GetFontSize() - 12;
  ImGui::SetNextWindowSizeConstraints({0, 0}, {FLT_MAX, std::max(highest, 8 * ImGui::GetFontSize())});
  ImGui::SetNextWindowBgAlpha(0.82F);
  ImGui::Begin("Simulation", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav);
  keep_in_sight();
  if (view.stage == SessionView::Stage::kLoading) {
    ImGui::Text("loading %s", view.progress.c_str());
    ImGui::End();
    return;
  }
  build_buttons(view, input);
  build_choice(view, input);
  build_forms(view, input, boxes_);
  ImGui::Text("time     %10.3f s, speed %g", view.time, view.speed);
  ImGui::Text("step     %10.3f ms", view.step_ms);
  build_cost(pictures);
  plot_.build(view, input, boxes_);
  build_insight(view, input, boxes_);
  if (!view.held.empty()) ImGui::Text("holding '%s'", view.held.c_str());
  const std::string hint(input.hint());
  if (!hint.empty()) write_wrapped(hint, {1, 0.9F, 0.5F, 1});
  build_said(view);
  if (!view.problem.empty()) write_wrapped(view.problem, kWarningColor);
  build_messages(view);
  build_warnings(view);
  ImGui::TextDisabled("keys: ? or F1");
  ImGui::End();
}

void ViewPanel::build_said(const SessionView& view) {
  if (!view.said) return;
  if (std::exchange(said_by_, view.said_by) != view.said_by) said_at_ = ImGui::GetTime();
  const ImVec4 color = view.said->done ? ImVec4{0.7F, 0.85F, 1, 1} : kWarningColor;
  const bool is_old = ImGui::GetTime() > said_at_ + kFreshSeconds;
  write_wrapped(view.said->text, is_old ? ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled) : color);
}

void ViewPanel::build_timeline(const SessionView& view, ViewInput& input) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({12, screen.y - 12}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({std::max(screen.x - 24, 100.0F), 0}, ImGuiCond_Always);
  ImGui::SetNextWindowBgAlpha(0.82F);
  ImGui::Begin("Timeline", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoNav);
  std::uint64_t step = wanted_step_.value_or(view.step);
  const std::uint64_t first = 0;
  const std::uint64_t last = std::max(view.last_step, std::uint64_t{1});
  ImGui::SetNextItemWidth(-1);
  const bool moved = ImGui::SliderScalar("##timeline", ImGuiDataType_U64, &step, &first, &last, "step %llu");
  note_box(boxes_, "timeline");
  if (moved) {
    wanted_step_ = std::min(step, view.last_step);
    input.post(Seek{*wanted_step_});
  }
  if (!ImGui::IsItemActive()) wanted_step_.reset();
  ImGui::TextDisabled("%zu states of %.0f of %.0f MiB, one in %llu steps; %zu to undo", view.moments,
                      in_mebibytes(view.timeline_bytes), in_mebibytes(view.timeline_budget),
                      static_cast<unsigned long long>(view.timeline_interval), view.undo_count);
  ImGui::End();
}

void ViewPanel::build(const SessionView& view, ViewInput& input, const PictureCost& pictures) {
  boxes_.clear();
  build_figures(view, input, pictures);
  if (input.shows_inspector()) inspector_.build(view, input, boxes_);
  if (view.stage == SessionView::Stage::kReady) build_timeline(view, input);
  if (input.shows_help()) build_help();
}

}  // namespace hooke::app
