#pragma once

#include "hooke/drawing/body_geometry.h"
#include "hooke/drawing/scene_camera.h"
#include "hooke/geometry.h"
#include "hooke/scene_io.h"

#include "render/draw_list.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace hooke::app {

struct Figure;       // one object's looks and triangles; figure.h
struct FigurePlace;  // where it is; figure.h

struct DrawingStyle {
  /// Drawn around bodies: the first of these around the first body that is no half-space, and so on, over
  /// again from the first.
  std::vector<Preselection> bounds = {};
  bool painter = false;  ///< render::paint_in_order; a warning says why not, where it cannot.
};

/// Turns a simulation into what the renderer draws. Keeps copies of the last two states it was shown, so that
/// a picture may lie between two steps.
class SceneDrawing {
 public:
  explicit SceneDrawing(DrawingStyle style = {}) : style_(std::move(style)) {}

  /// Takes a copy of the present state; the copy before it stays for interpolation.
  void record(const Simulation& simulation) { record(simulation, simulation.world().time()); }
  /// The same at a time [s] that the world does not know: its points were moved by hand.
  void record(const Simulation& simulation, double time);

  /// From now on ropes and particles leave a copy of themselves behind every `interval` [s], as on a plate
  /// that is exposed again and again. Positive.
  void keep_trail(double interval) { trail_interval_ = interval; }

  /// Fills the list with the state at `time` [s]: by straight lines between the two copies, the later one
  /// beyond it. Camera, bodies and ropes are relative to a place near the camera. `height_px` is the
  /// picture's: no rope gets thinner than about two pixels.
  void fill(double time, int height_px, render::DrawList& list);

  /// One line for each texture that could not be read, and for what could not be painted; cleared by the
  /// call.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  struct ObjectState {
    std::shared_ptr<Figure> figure;
    std::vector<DVec3> points;  ///< Of a deformable object.
    Pose pose;                  ///< Of a body.
  };
  struct State {
    double time = 0;
    std::vector<ObjectState> objects;
  };
  using Key = std::tuple<SceneObject::Kind, std::uint32_t, std::uint32_t>;

  std::shared_ptr<Figure> find_figure(const Simulation& simulation, const SceneObject& object);
  std::shared_ptr<const render::Image> find_texture(const std::string& path);
  [[nodiscard]] Viewpoint viewpoint(double time) const;
  [[nodiscard]] State between(double time) const;
  void measure(const State& state);

  void add_bounds(const Figure& figure, const FigurePlace& place, std::size_t number,
                  render::DrawList& list) const;
  void add_trail(const DVec3& origin, const FigurePlace& place, render::DrawList& list) const;

  BodyGeometries geometries_;
  std::map<Key, std::shared_ptr<Figure>> figures_;
  std::map<std::string, std::shared_ptr<const render::Image>> textures_;
  std::vector<std::string> warnings_;
  std::optional<SceneCamera> camera_;
  std::optional<Viewpoint> automatic_;  ///< Frames the first state; for scenes without a camera.
  State previous_;
  State current_;
  DrawingStyle style_;
  std::optional<double> trail_interval_;  ///< [s]
  std::vector<State> trail_;              ///< Oldest first.
};

}  // namespace hooke::app
