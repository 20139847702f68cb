#pragma once

#include "hooke/body_geometry.h"
#include "hooke/scene_camera.h"
#include "hooke/scene_io.h"

#include "render/draw_list.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace hooke::app {

struct Figure;  // one object's looks and triangles; figure.h

/// Turns a simulation into what the renderer draws. Keeps copies of the last two states it was shown, so that
/// a picture may lie between two steps.
class SceneDrawing {
 public:
  /// Takes a copy of the present state; the copy before it stays for interpolation.
  void record(const Simulation& simulation);

  /// Fills the list with the state at `time` [s]: by straight lines between the two copies, the later one
  /// beyond it. Camera, bodies and ropes are relative to a place near the camera. `height_px` is the
  /// picture's: no rope gets thinner than about two pixels.
  void fill(double time, int height_px, render::DrawList& list);

  /// One line for each texture that could not be read; cleared by the call.
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

  BodyGeometries geometries_;
  std::map<Key, std::shared_ptr<Figure>> figures_;
  std::map<std::string, std::shared_ptr<const render::Image>> textures_;
  std::vector<std::string> warnings_;
  std::optional<SceneCamera> camera_;
  std::optional<Viewpoint> automatic_;  ///< Frames the first state; for scenes without a camera.
  State previous_;
  State current_;
};

}  // namespace hooke::app
