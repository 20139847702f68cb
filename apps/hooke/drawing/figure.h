#pragma once

#include "hooke/drawing/body_geometry.h"
#include "hooke/drawing/cloth_surface.h"
#include "hooke/scene_io.h"

#include "render/draw_list.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hooke::app {

/// How a surface is drawn.
struct Finish {
  render::Color color = {};
  std::shared_ptr<const render::Image> texture = {};
  float opacity = 1;
  float shininess = 16;
};

/// Consecutive triangles with one finish.
struct PaintedRange {
  std::size_t first = 0;
  std::size_t count = 0;  ///< Indices; 0 is all.
  Finish finish;
};

/// A body, or one of its parts.
struct FigureSolid {
  BodyGeometry geometry;
  Vec3 position = {};  ///< In the body's frame [m].
  Quat rotation = {};
  std::vector<PaintedRange> ranges;
  bool casts_shadow = true;
};

/// A weight that is tied to a point.
struct FigureLoad {
  std::size_t point = 0;
  float radius = 0;  ///< [m]
};

/// One object's looks and triangles: everything that stays the same from picture to picture, and the buffers
/// that are filled anew.
struct Figure {
  SceneObject::Kind kind = SceneObject::Kind::kBody;
  float radius = 0;                     ///< Of a rope's strand [m].
  std::vector<PaintedRange> ranges;     ///< Of all but bodies; at least one.
  std::vector<FigureSolid> solids;      ///< Of a body.
  bool half_space = false;              ///< The body is one.
  std::optional<ClothSurface> surface;  ///< Of a cloth or solid.
  std::vector<float> radii;             ///< Of particles [m].
  std::vector<SpringDesc> springs;      ///< Of particles.
  std::vector<FigureLoad> loads;        ///< Of ropes and cloths.
};

/// Gives the image of a path, or null.
using TextureLoader = std::function<std::shared_ptr<const render::Image>(const std::string&)>;

/// Everything that can be prepared about an object of a simulation.
Figure make_figure(const Simulation& simulation, const SceneObject& object, const TextureLoader& textures,
                   BodyGeometries& geometries);

/// A solid's frame and size, in the body's frame.
Mat4 transform_of(const FigureSolid& solid);

/// The pose of a body and the points of the others, relative to the list's origin.
struct FigurePlace {
  Vec3 position = {};
  Quat rotation = {};
  std::span<const Vec3> points = {};
  float pixel = 0;  ///< [m], what one pixel covers a meter away from `eye`.
  Vec3 eye = {};
};

/// Adds a figure to the list. A half-space becomes the list's ground if it is level and the first one.
void add_figure(Figure& figure, const FigurePlace& place, render::DrawList& list);

}  // namespace hooke::app
