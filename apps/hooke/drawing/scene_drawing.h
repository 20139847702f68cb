#pragma once

#include "hooke/drawing/scene_capture.h"
#include "hooke/geometry.h"
#include "hooke/scene_io.h"

#include "render/draw_list.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hooke::app {

struct FigurePlace;  // Where an object is; see figure.h.

struct DrawingStyle {
  /// These volumes are drawn around bodies. The first is drawn around the first body that is no half-space,
  /// and so on, starting again from the first volume.
  std::vector<Preselection> bounds = {};
  /// Whether render::paint_in_order is used; where it cannot, a warning gives the reason.
  bool painter = false;
};

/// Turns a simulation into what the renderer draws. It keeps copies of the last two states, so that a picture
/// may lie between two steps.
class SceneDrawing {
 public:
  explicit SceneDrawing(DrawingStyle style = {}) : style_(std::move(style)) {}

  /// Draws the objects of these names in plain colors; to be called before the first record().
  void paint(std::map<std::string, render::Color> colors) { capture_.paint(std::move(colors)); }

  /// Copies the present state; the copy before it stays for interpolation.
  void record(const Simulation& simulation) { record(simulation, simulation.world().time()); }
  /// Copies the state with a time [s] of its own, for worlds whose points were moved by hand.
  void record(const Simulation& simulation, double time);
  /// Takes a state that was captured elsewhere; `step` is the length of a step [s].
  void record(SceneState state, double step);

  /// Makes ropes and particles leave a copy of themselves behind every `interval` [s] from now on, as in a
  /// multiple exposure. `interval` is positive.
  void keep_trail(double interval) { trail_interval_ = interval; }

  /// Fills the list with the state at `time` [s]: interpolated linearly between the two copies, and the later
  /// one beyond it. Camera, bodies and ropes are relative to a point near the camera. `height_px` is the
  /// picture's; no rope gets thinner than about two pixels.
  void fill(double time, int height_px, render::DrawList& list);

  /// The point of the world that was the origin of the last list [m].
  [[nodiscard]] DVec3 origin() const { return origin_; }

  /// Returns one line for each texture that could not be read, and for what could not be painted. The call
  /// clears them.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  [[nodiscard]] Viewpoint viewpoint(double time) const;
  [[nodiscard]] SceneState between(double time) const;

  void add_bounds(const Figure& figure, const FigurePlace& place, std::size_t number,
                  render::DrawList& list) const;
  void add_trail(const DVec3& origin, const FigurePlace& place, render::DrawList& list) const;

  SceneCapture capture_;
  std::vector<std::string> warnings_;
  SceneState previous_;
  SceneState current_;
  DVec3 origin_ = {};
  DrawingStyle style_;
  std::optional<double> trail_interval_;  ///< [s]
  std::vector<SceneState> trail_;         ///< Oldest first.
};

}  // namespace hooke::app
