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
  double potential = 0;  ///< Of gravity.
  double elastic = 0;
};

/// What the window shows and steers. It knows no world: the caller fills in the functions. All of them are
/// called by the thread that calls run_view.
struct ViewModel {
  std::function<Result<void>()> advance;  ///< One step. An Error pauses and is shown.
  std::function<Result<void>()> reset;    ///< Back to the start.
  /// The state between the last two, see Clock::Due::blend; 1 is the present one. Its camera counts only the
  /// first time.
  std::function<void(render::DrawList&, double blend)> fill;
  std::function<Energies()> energies;  ///< May be empty: no plot.
  std::function<double()> time;        ///< Of the simulation [s]; may be empty.
  double step_seconds = 1.0 / 60;      ///< Simulated time of one advance.
};

struct ViewOptions {
  std::string title = "Hooke";
  int width = 1280;
  int height = 720;
  int samples = 0;  ///< Per pixel; 0 is 4, or 1 if a software driver draws, which takes half the time.
  bool start_paused = false;
  int max_frames = 0;                    ///< Closes after so many pictures; 0 never does.
  std::optional<double> stop_time = {};  ///< Closes when the model's time reaches it [s].
  std::string screenshot = {};  ///< A .png that gets the last picture before it closes; empty for none.
};

/// Shows the window until it is closed. Left drag orbits, right drag pans, the wheel zooms; space plays and
/// pauses, S or right arrow steps, R resets, Escape closes. kUnsupported without a display or OpenGL 3.3.
Result<void> run_view(const ViewModel& model, const ViewOptions& options = {});

}  // namespace hooke::app
