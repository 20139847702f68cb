#include "hooke/view/inspector.h"

#include "render/image.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <imgui.h>
#include <utility>

namespace hooke::app {

namespace {

/// Widths in heights of the font.
constexpr float kInspectorWidth = 29;
constexpr float kFieldWidth = 11;
constexpr float kPictureWidth = 12;

const ImVec4 kSaid = {0.95F, 0.95F, 0.95F, 1};
const ImVec4 kDefault = {0.62F, 0.62F, 0.62F, 1};

void show_help(const SceneKey& key) {
  if (!ImGui::IsItemHovered() || key.help.empty()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 30);
  ImGui::TextUnformatted(key.help.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// What a field shows of a value: without the brackets of a vector and the quotes of a word.
std::string shown_text(const SceneKey& key) {
  const bool is_enclosed = key.value.size() >= 2 && (key.value.front() == '[' || key.value.front() == '"');
  if (!is_enclosed) return key.value;
  return key.value.substr(1, key.value.size() - 2);
}

/// The JSON of what was typed.
std::string typed_value(const SceneKey& key, const std::string& text) {
  const bool has_letters = text.find_first_not_of("+-.0123456789eE ") != std::string::npos;
  switch (key.type) {
    case SceneKey::Type::kVector:
      return "[" + text + "]";
    case SceneKey::Type::kText:
      return "\"" + text + "\"";
    case SceneKey::Type::kNumber:
      return has_letters ? "\"" + text + "\"" : text;
    default:
      return text;
  }
}

/// The path of the material that an object's keys name, or nothing.
std::string material_path(const std::vector<SceneKey>& keys) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [](const SceneKey& key) { return key.key == "material"; });
  const bool is_said = found != keys.end() && found->said && found->value.size() > 2;
  return is_said ? "materials." + found->value.substr(1, found->value.size() - 2) : std::string();
}

/// Whether three figures from the `i`-th on are those of one vector.
bool is_vector(const std::vector<MeasuredValue>& values, std::size_t i) {
  return i + 2 < values.size() && values[i].name.ends_with(" x") && values[i + 2].name.ends_with(" z");
}

/// A number of up to three digits in at most seven characters, fewer digits where they would not do.
std::string short_text(double number) {
  std::array<char, 32> text = {};
  for (int digits = 3; digits > 0; --digits) {
    const int size = std::snprintf(text.data(), text.size(), "%.*g", digits, number);
    if (size <= 7) break;
  }
  return text.data();
}

void show_measured(const std::vector<MeasuredValue>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const MeasuredValue& value = values[i];
    if (!is_vector(values, i)) {
      ImGui::Text("%-16s %12.5g %s", value.name.c_str(), value.value, value.unit.c_str());
      continue;
    }
    const std::string name = value.name.substr(0, value.name.size() - 2);
    ImGui::Text("%-16s%8s%8s%8s %s", name.c_str(), short_text(value.value).c_str(),
                short_text(values[i + 1].value).c_str(), short_text(values[i + 2].value).c_str(),
                value.unit.c_str());
    i += 2;
  }
}

template <std::size_t N>
void copy_to(std::array<char, N>& buffer, const std::string& text) {
  std::snprintf(buffer.data(), N, "%s", text.c_str());
}

}  // namespace

void Inspector::build(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  if (view.stage != SessionView::Stage::kReady || !view.document) return;
  if (std::exchange(opened_, view.opened) != view.opened) {
    const std::filesystem::path path = view.document->scene.path;
    const bool is_model = is_model_file(view.document->file);
    const std::filesystem::path name = is_model ? std::filesystem::path(view.document->file) : path;
    copy_to(save_name_, name.stem().string() + (is_model ? ".json" : "-edited.json"));
  }
  const float unit = ImGui::GetFontSize();
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x - 12, 12}, ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSize(
      {std::min(kInspectorWidth * unit, screen.x / 2), std::max(screen.y - 7.5F * unit, 8 * unit)},
      ImGuiCond_Always);
  ImGui::SetNextWindowBgAlpha(0.88F);
  ImGui::Begin("Inspector", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoNav);
  if (ImGui::BeginTabBar("tabs")) {
    const auto tab = [&](const char* title,
                         void (Inspector::*fill)(const SessionView&, ViewInput&, WidgetBoxes&)) {
      const bool is_open = ImGui::BeginTabItem(title);
      note_box(boxes, std::string("tab ") + title);
      if (!is_open) return;
      ImGui::BeginChild("content", {0, 0}, false, ImGuiWindowFlags_NoNav);
      (this->*fill)(view, input, boxes);
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("Objects", &Inspector::build_objects);
    tab("Scenes", &Inspector::build_scenes);
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void Inspector::build_objects(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  build_save(view, input, boxes);
  ImGui::Separator();
  const float height = ImGui::GetContentRegionAvail().y;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##find", "find an object", find_.data(), find_.size());
  note_box(boxes, "find");
  ImGui::BeginChild("tree", {0, 0.35F * height}, false, ImGuiWindowFlags_NoNav);
  build_object_list(view, input, boxes);
  ImGui::EndChild();
  ImGui::Separator();
  ImGui::BeginChild("values", {0, 0}, false, ImGuiWindowFlags_NoNav);
  build_selected(view, input, boxes);
  ImGui::EndChild();
}

void Inspector::build_save(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  ImGui::SetNextItemWidth(1.4F * kFieldWidth * ImGui::GetFontSize());
  ImGui::InputText("##save name", save_name_.data(), save_name_.size());
  note_box(boxes, "save name");
  ImGui::SameLine();
  if (ImGui::Button("Save")) input.post(Save{save_name_.data()});
  note_box(boxes, "save");
  ImGui::SameLine();
  if (ImGui::Button("Reload")) input.post(Reload{});
  ImGui::SameLine();
  ImGui::TextDisabled(view.edited ? "edited" : "");
}

void Inspector::build_object_list(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  if (ImGui::Selectable("world", view.selected.empty())) input.post(Select{});
  note_box(boxes, "object ");
  using Kind = SceneObject::Kind;
  build_kind(view, Kind::kBody, "bodies", input, boxes);
  build_kind(view, Kind::kRope, "ropes", input, boxes);
  build_kind(view, Kind::kCloth, "cloths", input, boxes);
  build_kind(view, Kind::kSolid, "solids", input, boxes);
  build_kind(view, Kind::kParticles, "particles", input, boxes);
  build_kind(view, Kind::kField, "fields", input, boxes);
  build_kind(view, Kind::kHook, "hooks and joints", input, boxes);
}

void Inspector::build_kind(const SessionView& view, SceneObject::Kind kind, const char* title,
                           ViewInput& input, WidgetBoxes& boxes) {
  if (!view.listed) return;
  std::vector<const ListedObject*> objects;
  for (const ListedObject& object : *view.listed) {
    if (object.kind == kind) objects.push_back(&object);
  }
  if (objects.empty()) return;
  const std::vector<ObjectRow> rows = object_rows(objects, find_.data(), open_arrays_, view.selected);
  if (rows.empty()) return;
  ImGui::SetNextItemOpen(true, ImGuiCond_Once);
  if (!ImGui::TreeNode(title, "%s (%zu)", title, objects.size())) return;
  // A heap of ten thousand bodies is as quick to show as one: only what is in sight is built.
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      ImGui::PushID(i);
      build_row(rows[static_cast<std::size_t>(i)], view, input, boxes);
      ImGui::PopID();
    }
  }
  ImGui::TreePop();
}

void Inspector::build_row(const ObjectRow& row, const SessionView& view, ViewInput& input,
                          WidgetBoxes& boxes) {
  if (row.members == 0) {
    if (ImGui::Selectable(row.name.c_str(), row.name == view.selected)) input.post(Select{row.name});
    note_box(boxes, "object " + row.name);
    return;
  }
  ImGui::SetNextItemOpen(row.is_open);
  constexpr ImGuiTreeNodeFlags kFlags = ImGuiTreeNodeFlags_NoTreePushOnOpen;
  const bool is_open = ImGui::TreeNodeEx("array", kFlags, "%s (%zu)", row.name.c_str(), row.members);
  note_box(boxes, "array " + row.name);
  if (is_open == row.is_open) return;
  if (is_open) open_arrays_.insert(row.name);
  if (is_open) return;
  open_arrays_.erase(row.name);
  // What is selected would keep its array open.
  if (view.selected.starts_with(row.name + "[")) input.post(Select{});
}

void Inspector::build_selected(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  ImGui::TextUnformatted(view.selected.empty() ? "world" : view.selected.c_str());
  if (ImGui::CollapsingHeader("now", ImGuiTreeNodeFlags_DefaultOpen)) {
    show_measured(view.measured);
    if (view.measured.empty()) ImGui::TextDisabled("it has nothing to measure");
  }
  if (view.selected.empty()) {
    if (ImGui::CollapsingHeader("the scene says", ImGuiTreeNodeFlags_DefaultOpen))
      build_keys(view, "world", input, boxes);
    return;
  }
  if (!view.listed) return;
  const auto found = std::find_if(view.listed->begin(), view.listed->end(),
                                  [&](const ListedObject& object) { return object.name == view.selected; });
  if (found == view.listed->end()) return;
  const bool is_added = found->path.starts_with("added");
  if (!ImGui::CollapsingHeader("the scene says", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (is_added) {
    ImGui::TextDisabled("nothing: it came by hand");
    return;
  }
  build_keys(view, found->path, input, boxes);
  const std::string material = material_path(keys_[found->path]);
  if (material.empty() || !ImGui::CollapsingHeader(material.c_str())) return;
  build_keys(view, material, input, boxes);
}

void Inspector::build_keys(const SessionView& view, const std::string& path, ViewInput& input,
                           WidgetBoxes& boxes) {
  if (std::exchange(keys_document_, view.document) != view.document) keys_.clear();
  const auto [found, is_new] = keys_.try_emplace(path);
  if (is_new) found->second = keys_of(*view.document, path);
  for (const SceneKey& key : found->second) build_key(key, input, boxes);
}

void Inspector::build_key(const SceneKey& key, ViewInput& input, WidgetBoxes& boxes) {
  ImGui::PushID(key.path.c_str());
  if (key.type == SceneKey::Type::kGroup) {
    if (!key.keys.empty() &&
        ImGui::TreeNodeEx(key.key.c_str(), key.said ? ImGuiTreeNodeFlags_DefaultOpen : 0)) {
      for (const SceneKey& inner : key.keys) build_key(inner, input, boxes);
      ImGui::TreePop();
    }
    show_help(key);
    note_box(boxes, "key " + key.path);
    ImGui::PopID();
    return;
  }
  ImGui::SetNextItemWidth(kFieldWidth * ImGui::GetFontSize());
  if (key.type == SceneKey::Type::kBoolean) {
    bool value = key.value == "true";
    if (ImGui::Checkbox("##value", &value)) input.post(Change{key.path, value ? "true" : "false"});
  } else if (key.type == SceneKey::Type::kWord) {
    if (ImGui::BeginCombo("##value", shown_text(key).c_str())) {
      for (const std::string& word : key.words) {
        if (ImGui::Selectable(word.c_str(), word == shown_text(key)))
          input.post(Change{key.path, "\"" + word + "\""});
      }
      ImGui::EndCombo();
    }
  } else {
    build_text(key, input);
  }
  note_box(boxes, "key " + key.path);
  ImGui::SameLine();
  ImGui::TextColored(key.said ? kSaid : kDefault, "%s %s", key.key.c_str(), key.unit.c_str());
  show_help(key);
  ImGui::PopID();
}

/// A text counts when Enter is pressed or when one clicks elsewhere, so that half a number starts nothing.
void Inspector::build_text(const SceneKey& key, ViewInput& input) {
  std::array<char, 512> text = {};
  const std::string shown = shown_text(key);
  const bool is_typed = typed_path_ == key.path;
  copy_to(text, is_typed ? typed_.data() : shown);
  const bool entered =
      ImGui::InputText("##value", text.data(), text.size(),
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const bool left = ImGui::IsItemDeactivated();
  if (ImGui::IsItemActive()) {
    typed_path_ = key.path;
    typed_ = text;
  }
  if (!entered && !left) return;
  if (is_typed || entered) typed_path_.clear();
  const bool escaped = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
  const bool is_new = !escaped && text[0] != '\0' && shown != text.data();
  if (is_new) input.post(Change{key.path, typed_value(key, text.data())});
}

unsigned Inspector::find_picture(const std::string& file) {
  const auto [found, is_new] = pictures_.try_emplace(file);
  if (!is_new) return found->second.name();
  const auto image = render::load_image(file);
  if (!image) return 0;
  found->second = render::make_texture();
  glBindTexture(GL_TEXTURE_2D, found->second.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const GLenum format = image.value().channels == 4 ? GL_RGBA : GL_RGB;
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.value().width, image.value().height, 0, format,
               GL_UNSIGNED_BYTE, image.value().pixels.data());
  glBindTexture(GL_TEXTURE_2D, 0);
  return found->second.name();
}

void Inspector::build_scenes(const SessionView& view, ViewInput& input, WidgetBoxes& boxes) {
  if (!scenes_) scenes_ = std::make_unique<SceneList>(view.document->file);
  const auto groups = scenes_->groups();
  if (!groups) {
    ImGui::TextDisabled("reading scenes ...");
    return;
  }
  for (const SceneGroup& group : *groups) {
    const bool is_open = ImGui::CollapsingHeader(group.title.c_str(), ImGuiTreeNodeFlags_DefaultOpen);
    note_box(boxes, "group " + group.title);
    if (!is_open) continue;
    for (const ListedScene& scene : group.scenes) build_scene(scene, input, boxes);
  }
}

void Inspector::build_scene(const ListedScene& scene, ViewInput& input, WidgetBoxes& boxes) {
  ImGui::PushID(scene.file.c_str());
  const float width = kPictureWidth * ImGui::GetFontSize();
  ImGui::BeginGroup();
  if (!scene.picture.empty()) {
    const ImVec2 size = {width, width * 9 / 16};
    // Pictures are read when they come in sight.
    const bool is_seen = ImGui::IsRectVisible(size);
    const unsigned picture = is_seen ? find_picture(scene.picture) : 0;
    if (picture != 0) {
      ImGui::Image(reinterpret_cast<void*>(static_cast<std::uintptr_t>(picture)), size);
    } else {
      ImGui::Dummy(size);
    }
    ImGui::SameLine();
  }
  ImGui::BeginGroup();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(scene.title.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, kDefault);
  ImGui::TextUnformatted(scene.description.c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  ImGui::EndGroup();
  ImGui::EndGroup();
  if (ImGui::IsItemClicked()) input.post(Open{scene.file});
  if (ImGui::IsItemHovered()) {
    ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                        IM_COL32(120, 180, 255, 200), 4);
  }
  note_box(boxes, "scene " + std::filesystem::path(scene.file).filename().string());
  ImGui::Spacing();
  ImGui::PopID();
}

}  // namespace hooke::app
