#pragma once

#include "render/draw_list.h"

#include <array>
#include <vector>

namespace hooke::render {

struct TextVertex {
  float x_px = 0;  ///< Position from the top left corner.
  float y_px = 0;
  std::array<float, 3> color = {};  ///< Linear.
};

/// Adds the triangles of a text. Anything but printable ASCII and line breaks is left out, and a text is cut
/// after 2000 characters.
void add_text(const DrawText& text, std::vector<TextVertex>& triangles);

}  // namespace hooke::render
