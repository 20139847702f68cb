#pragma once

#include "hooke/model_io.h"
#include "hooke/shape.h"

#include "render/draw_list.h"

#include <array>
#include <map>
#include <memory>
#include <utility>

namespace hooke::app {

/// A BodyGeometry is the triangles of a shape: a geometry that many shapes share, and its size along each
/// axis.
struct BodyGeometry {
  using Geometry = std::shared_ptr<const render::MeshGeometry>;

  /// Levels from fine to coarse, for smaller and smaller pictures. They are the same where fewer triangles
  /// would not be faster, and null for a model that is missing.
  std::array<Geometry, 3> levels;
  float radius = 1;  ///< Of what has levels [m].
  Vec3 scale = {1, 1, 1};
  Vec3 shift = {};  ///< Offset [m], in the shape's frame.
};

/// Makes the triangles of shapes, each once. All bodies of one geometry are then drawn by one call.
class BodyGeometries {
 public:
  /// Returns the geometry of a shape. `model` is that of a mesh or a hull; other shapes do not use it.
  BodyGeometry find(const Shape& shape, const std::shared_ptr<const Model>& model);

 private:
  using Geometry = BodyGeometry::Geometry;

  std::array<Geometry, 3> spheres_;
  Geometry box_, cylinder_, cone_;
  /// By radius and half height, because capsules cannot be scaled.
  std::map<std::pair<Real, Real>, std::array<Geometry, 3>> capsules_;
  std::map<std::shared_ptr<const Model>, Geometry> models_;
};

}  // namespace hooke::app
