#pragma once

#include "hooke/drawing/drawing_style.h"
#include "hooke/result.h"
#include "hooke/session/session.h"

#include <optional>
#include <string>

namespace hooke::app {

struct ViewOptions {
  std::string title = "Hooke";
  int width = 1280;
  int height = 720;
  /// Samples per pixel. 0 stands for 4, or for 1 if a software driver draws, which takes half the time.
  int samples = 0;
  DrawingStyle style = {};
  /// Size of the panels, 1 for letters of 13 pixels; without it what fits the window.
  std::optional<double> interface_scale = {};
  /// Part of the window's width and height that is drawn, 0.25 to 1; without it what gives 20 pictures a
  /// second while things move, and 1 when they rest.
  std::optional<double> picture_scale = {};
  std::optional<double> stop_time = {};  ///< Closes the window when the simulated time reaches this [s].
  /// A .png file that gets the last picture before the window closes; empty for none.
  std::string screenshot = {};
  /// A file that gets a line of JSON for each picture: what the session and the window show. Empty for none.
  std::string log = {};
};

/// Shows a session in a window until it is closed, or until the session's scene could not be built. The keys
/// are listed by ViewInput::help. The Error is kUnsupported without a display or OpenGL 3.3, or that of a
/// file that cannot be written.
Result<void> run_view(Session& session, const ViewOptions& options = {});

}  // namespace hooke::app
