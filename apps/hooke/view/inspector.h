#pragma once

#include "hooke/session/scene_keys.h"
#include "hooke/session/session.h"
#include "hooke/view/object_rows.h"
#include "hooke/view/scene_list.h"
#include "hooke/view/view_input.h"
#include "hooke/view/widget_boxes.h"

#include "render/gl/gl_objects.h"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace hooke::app {

/// The panel at the right: the objects of the scene, what the scene says of them and how it can be changed,
/// and the scenes that can be opened. It gives commands. An OpenGL context must be current, for pictures of
/// scenes.
class Inspector {
 public:
  /// Builds the panel for this picture.
  void build(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);

 private:
  void build_objects(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  void build_object_list(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  void build_kind(const SessionView& view, SceneObject::Kind kind, const char* title, ViewInput& input,
                  WidgetBoxes& boxes);
  void build_row(const ObjectRow& row, const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  void build_selected(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  void build_keys(const SessionView& view, const std::string& path, ViewInput& input, WidgetBoxes& boxes);
  void build_key(const SceneKey& key, ViewInput& input, WidgetBoxes& boxes);
  void build_text(const SceneKey& key, ViewInput& input);
  void build_save(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  void build_scenes(const SessionView& view, ViewInput& input, WidgetBoxes& boxes);
  void build_scene(const ListedScene& scene, ViewInput& input, WidgetBoxes& boxes);
  /// Returns the name of the texture of a picture's file; 0 if it cannot be read.
  unsigned find_picture(const std::string& file);

  /// Keys by path, for the document that they were read from: reading takes longer than a picture.
  std::map<std::string, std::vector<SceneKey>> keys_;
  SharedDocument keys_document_;
  std::string typed_path_;            ///< Key whose value is being typed; empty for none.
  std::array<char, 512> typed_ = {};  ///< What was typed so far.
  std::array<char, 256> save_name_ = {};
  std::array<char, 64> find_ = {};  ///< Text that the names of the objects shown have.
  std::set<std::string> open_arrays_;
  std::uint64_t opened_ = 0;  ///< SessionView::opened of the last picture.
  std::unique_ptr<SceneList> scenes_;
  std::map<std::string, render::GlName> pictures_;
};

}  // namespace hooke::app
