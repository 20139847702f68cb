#pragma once

#include "hooke/drawing/body_geometry.h"
#include "hooke/drawing/cloth_surface.h"
#include "hooke/scene_io.h"

#include "render/draw_list.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace hooke::app {

/// A Finish says how a surface is drawn.
struct Finish {
  render::Color color = {};
  std::shared_ptr<const render::Image> texture = {};
  float opacity = 1;
  float shininess = 16;
  float metalness = 0;
  float roughness = 0.6F;
  float transmission = 0;
  float sheen = 0.35F;
  float thread_pitch = 0;                             ///< [m]; 0 shows no threads.
  std::shared_ptr<const render::Image> normals = {};  ///< See render::DrawMesh.
  std::shared_ptr<const render::Image> finish = {};   ///< See render::DrawMesh.
  float relief = 1;                                   ///< Strength of the normals.
  bool hair = false;                                  ///< Whether ropes are tufts of hair.
  float tiles = 1;                                    ///< Width of tiles of a ground [m]; 0 for none.
};

/// Returns the finish of loads.
const Finish& iron_finish();

/// These are consecutive triangles with one finish.
struct PaintedRange {
  std::size_t first = 0;
  std::size_t count = 0;  ///< Number of indices; 0 stands for all.
  Finish finish;
};

/// This is a body, or one of its parts.
struct FigureSolid {
  BodyGeometry geometry;
  Vec3 position = {};  ///< Position in the body's frame [m].
  Quat rotation = {};
  std::vector<PaintedRange> ranges;
};

/// This is a weight that is tied to a point.
struct FigureLoad {
  std::size_t point = 0;
  float radius = 0;  ///< [m]
};

/// A Figure holds the look and the triangles of one object, which stay the same from picture to picture, and
/// buffers that are filled anew.
struct Figure {
  SceneObject::Kind kind = SceneObject::Kind::kBody;
  float radius = 0;                     ///< Radius of a rope [m].
  std::size_t splits = 0;               ///< Points that a cloth or a solid has got by tearing.
  bool reshaped = false;                ///< A body that is drawn by its surface, as a solid is.
  std::vector<PaintedRange> ranges;     ///< Set for all but bodies; at least one.
  std::vector<FigureSolid> solids;      ///< Set for a body.
  bool half_space = false;              ///< Whether the body is a half-space.
  float width = 0;                      ///< Width of a grid of cloth [m].
  std::optional<ClothSurface> surface;  ///< Set for a cloth, a solid, or a body that is reshaped.
  std::vector<float> radii;             ///< Radii of particles [m].
  std::vector<SpringDesc> springs;      ///< Springs of particles.
  std::vector<FigureLoad> loads;        ///< Weights of ropes and cloths.
};

/// What an image says.
enum class ImageUse : std::uint8_t {
  kColor,
  kNormals,  ///< An image of heights is turned into one of normals.
  kFinish,
};

/// Returns the image of a path, or of the bytes if there are any, or null.
using TextureLoader = std::function<std::shared_ptr<const render::Image>(
    const std::string& path, const ImageBytes& bytes, ImageUse use)>;

/// Tells objects of a simulation apart: its kind, and the slot and generation of its id.
using ObjectKey = std::tuple<SceneObject::Kind, std::uint32_t, std::uint32_t>;
ObjectKey key_of(const SceneObject& object);

/// Prepares everything about an object of a simulation that does not change.
Figure make_figure(const Simulation& simulation, const SceneObject& object, const TextureLoader& textures,
                   BodyGeometries& geometries);

/// Prepares a body with BodyDesc::yields by its surface, as it is drawn once it has a dent; it may have none.
Figure make_reshaped_figure(const Simulation& simulation, const SceneObject& object,
                            const TextureLoader& textures);

/// Returns the sRGB color of a linear one.
render::Color srgb_color_of(const std::array<float, 3>& linear);

/// Returns a solid's frame and size, in the body's frame.
Mat4 transform_of(const FigureSolid& solid);

/// This is the pose of a body and the points of other objects, relative to the list's origin.
struct FigurePlace {
  Vec3 position = {};
  Quat rotation = {};
  std::span<const Vec3> points = {};
  std::span<const std::uint32_t> gaps = {};  ///< Segments of a rope that have broken, in ascending order.
  float pixel = 0;  ///< Size that one pixel covers at a distance of one meter from `eye` [m].
  Vec3 eye = {};
};

/// Adds a figure to the list. The first half-space that is level becomes the list's ground.
void add_figure(Figure& figure, const FigurePlace& place, render::DrawList& list);

}  // namespace hooke::app
