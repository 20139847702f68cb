#pragma once

#include "hooke/result.h"
#include "hooke/session/session.h"
#include "hooke/view/eye.h"
#include "hooke/view/widget_boxes.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string>

namespace hooke::app {

/// What the window adds to a line of the log.
struct PictureFacts {
  std::uint64_t picture = 0;   ///< Number of the picture.
  std::uint64_t posted = 0;    ///< Number of the last command that was given.
  WidgetBoxes boxes = {};      ///< Parts of the panels.
  double scale = 1;            ///< Width and height of the picture in those of the window.
  float font_px = 0;           ///< Height of the font.
  std::string plot = {};       ///< What is plotted.
  std::string hint = {};       ///< What the window asks for.
  bool help = false;           ///< Whether the page of keys is shown.
  std::uint32_t gl_error = 0;  ///< Error of OpenGL since the last picture; 0 for none.
};

/// Writes what a window shows as lines of JSON, for tests and for those who wonder.
class ViewLog {
 public:
  /// Opens the file; an empty path writes nothing. The Error is kFileNotWritable.
  Result<void> open(const std::string& path);
  /// Writes one line.
  void write(const SessionView& view, const Eye& eye, const PictureFacts& facts);

 private:
  std::ofstream file_;
};

}  // namespace hooke::app
