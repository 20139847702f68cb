#pragma once

#include "hooke/model_io.h"
#include "hooke/shape.h"

#include "render/draw_list.h"

#include <array>
#include <map>
#include <memory>
#include <utility>

namespace hooke::app {

/// The triangles of a shape: a geometry that many shapes share, and its size along each axis.
struct BodyGeometry {
  using Geometry = std::shared_ptr<const render::MeshGeometry>;

  /// From fine to coarse, for smaller and smaller pictures; the same where less would not be faster. Null for
  /// a model that is not there.
  std::array<Geometry, 3> levels;
  Vec3 scale = {1, 1, 1};
  Vec3 shift = {};  ///< [m], in the shape's frame.
};

/// Makes the triangles of shapes, each once: bodies of one geometry are drawn by one call, however many.
class BodyGeometries {
 public:
  /// `model` is that of a mesh or a hull; unused for other shapes.
  BodyGeometry find(const Shape& shape, const std::shared_ptr<const Model>& model);

 private:
  using Geometry = BodyGeometry::Geometry;

  std::array<Geometry, 3> spheres_;
  Geometry box_, cylinder_, cone_;
  std::map<std::pair<Real, Real>, Geometry> capsules_;  ///< By radius and half height: they do not scale.
  std::map<std::shared_ptr<const Model>, Geometry> models_;
};

}  // namespace hooke::app
