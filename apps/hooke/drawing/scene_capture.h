#pragma once

#include "hooke/drawing/figure.h"
#include "hooke/drawing/scene_camera.h"
#include "hooke/scene_io.h"

#include "render/draw_list.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace hooke::app {

/// Where one object of a picture is.
struct ObjectState {
  std::shared_ptr<Figure> figure;
  std::vector<DVec3> points;        ///< Set for a deformable object.
  std::vector<std::uint32_t> gaps;  ///< Segments of a rope that have broken.
  Pose pose;                        ///< Set for a body.
};

/// What a picture shows of a simulation at one time. It is free of the simulation, so that another thread may
/// draw it. Figures belong to who draws.
struct SceneState {
  double time = 0;  ///< [s]
  std::vector<ObjectState> objects;
  std::optional<SceneCamera> camera;  ///< Camera of the scene.
  SceneSky sky;
  std::vector<SceneLight> lights;
  Viewpoint automatic;  ///< View of the first state, for scenes without a camera.
};

/// Copies what pictures show out of a simulation. It reads textures and prepares the look of each object
/// once, and of a figure that it has given away it reads only splits and reshaped, which who draws must not
/// change.
class SceneCapture {
 public:
  /// Draws the objects of these names in plain colors, in place of their own look.
  void paint(std::map<std::string, render::Color> colors) { colors_ = std::move(colors); }

  /// Copies the present state, and gives it the time [s].
  SceneState capture(const Simulation& simulation, double time);

  /// Returns one line for each texture that could not be read. The call clears them.
  [[nodiscard]] std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 private:
  std::shared_ptr<Figure> find_figure(const Simulation& simulation, const SceneObject& object);
  std::shared_ptr<const render::Image> find_texture(const std::string& path, const ImageBytes& bytes,
                                                    ImageUse use);

  BodyGeometries geometries_;
  std::map<ObjectKey, std::shared_ptr<Figure>> figures_;
  /// By path, or by the bytes of an image that a model holds.
  std::map<std::tuple<std::string, ImageBytes, ImageUse>, std::shared_ptr<const render::Image>> textures_;
  std::map<std::string, render::Color> colors_;
  std::vector<std::string> warnings_;
  std::optional<Viewpoint> automatic_;
};

}  // namespace hooke::app
