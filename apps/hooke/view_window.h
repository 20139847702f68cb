#pragma once

#include "hooke/result.h"

#include "render/draw_list.h"

#include <functional>
#include <optional>
#include <string>

namespace hooke::app {

/// [J]
struct Energies {
  double kinetic = 0;
  double potential = 0;  ///< Potential energy of gravity.
  double elastic = 0;
};

/// A ViewModel is what the window shows and controls. It has no world: the caller fills in the functions. The
/// thread that calls run_view calls all of them.
struct ViewModel {
  std::function<Result<void>()> advance;  ///< Makes one step. An Error pauses the window and is shown.
  std::function<Result<void>()> reset;    ///< Goes back to the start.
  /// Fills in the state between the last two steps, see Clock::Due::blend; 1 is the present one. Its camera
  /// is used only the first time.
  std::function<void(render::DrawList&, double blend)> fill;
  std::function<Energies()> energies;  ///< May be empty for no plot.
  std::function<double()> time;        ///< Time of the simulation [s]; may be empty.
  double step_seconds = 1.0 / 60;      ///< Simulated time of one advance.
};

struct ViewOptions {
  std::string title = "Hooke";
  int width = 1280;
  int height = 720;
  /// Samples per pixel. 0 stands for 4, or for 1 if a software driver draws, which takes half the time.
  int samples = 0;
  bool start_paused = false;
  int max_frames = 0;                    ///< Closes the window after this many pictures; 0 for never.
  std::optional<double> stop_time = {};  ///< Closes the window when the model's time reaches this [s].
  /// A .png file that gets the last picture before the window closes; empty for none.
  std::string screenshot = {};
};

/// Shows the window until it is closed. Left drag orbits, right drag pans, the wheel zooms; space plays and
/// pauses, S or right arrow steps, R resets, Escape closes. The Error is kUnsupported without a display or
/// OpenGL 3.3.
Result<void> run_view(const ViewModel& model, const ViewOptions& options = {});

}  // namespace hooke::app
