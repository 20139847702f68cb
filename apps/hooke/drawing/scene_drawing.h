#pragma once

#include "hooke/drawing/figure.h"
#include "hooke/drawing/scene_camera.h"
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

  /// Copies the present state; the copy before it stays for interpolation.
  void record(const Simulation& simulation) { record(simulation, simulation.world().time()); }
  /// Copies the state with a time [s] of its own, for worlds whose points were moved by hand.
  void record(const Simulation& simulation, double time);

  /// Makes ropes and particles leave a copy of themselves behind every `interval` [s] from now on, as in a
  /// multiple exposure. `interval` is positive.
  void keep_trail(double interval) { trail_interval_ = interval; }

  /// Fills the list with the state at `time` [s]: interpolated linearly between the two copies, and the later
  /// one beyond it. Camera, bodies and ropes are relative to a point near the camera. `height_px` is the
  /// picture's; no rope gets thinner than about two pixels.
  void fill(double time, int height_px, render::DrawList& list);

  /// Returns one line for each texture that could not be read, and for what could not be painted. The call
  /// clears them.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  struct ObjectState {
    std::shared_ptr<Figure> figure;
    std::vector<DVec3> points;  ///< Set for a deformable object.
    Pose pose;                  ///< Set for a body.
  };
  struct State {
    double time = 0;
    std::vector<ObjectState> objects;
  };

  std::shared_ptr<Figure> find_figure(const Simulation& simulation, const SceneObject& object);
  std::shared_ptr<const render::Image> find_texture(const std::string& path, const ImageBytes& bytes);
  [[nodiscard]] Viewpoint viewpoint(double time) const;
  [[nodiscard]] State between(double time) const;
  void measure(const State& state);

  void add_bounds(const Figure& figure, const FigurePlace& place, std::size_t number,
                  render::DrawList& list) const;
  void add_trail(const DVec3& origin, const FigurePlace& place, render::DrawList& list) const;

  BodyGeometries geometries_;
  std::map<ObjectKey, std::shared_ptr<Figure>> figures_;
  /// By path, or by the bytes of an image that a model holds.
  std::map<std::pair<std::string, ImageBytes>, std::shared_ptr<const render::Image>> textures_;
  std::vector<std::string> warnings_;
  std::optional<SceneCamera> camera_;
  std::optional<Viewpoint> automatic_;  ///< View of the first state, for scenes without a camera.
  State previous_;
  State current_;
  DrawingStyle style_;
  std::optional<double> trail_interval_;  ///< [s]
  std::vector<State> trail_;              ///< Oldest first.
};

}  // namespace hooke::app
