#pragma once

#include "hooke/drawing/scene_drawing.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hooke::app {

/// These are the options of a user on how a scene is drawn.
struct StyleWords {
  std::vector<std::string> bounds;
  bool painter = false;
};

/// Adds --bounds and --painter.
void add_style(CLI::App& app, StyleWords& words);

/// Makes the style. The Error tells of a name that is no bounding volume's.
Result<DrawingStyle> style_of(const StyleWords& words);

}  // namespace hooke::app
