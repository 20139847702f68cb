#pragma once

#include "hooke/model_io.h"
#include "hooke/shape.h"

#include "render/draw_list.h"

#include <map>
#include <memory>
#include <utility>

namespace hooke::app {

/// The triangles of a shape: a geometry that many shapes share, and its size along each axis.
struct BodyGeometry {
  std::shared_ptr<const render::MeshGeometry> fine;           ///< Null for a model that is not there.
  std::shared_ptr<const render::MeshGeometry> coarse = fine;  ///< Enough for a small picture.
  Vec3 scale = {1, 1, 1};
  Vec3 shift = {};  ///< [m], in the shape's frame.
};

/// Makes the triangles of shapes, each once: bodies of one geometry are drawn by one call, however many.
class BodyGeometries {
 public:
  /// `model` is that of a mesh or a hull; unused for other shapes.
  BodyGeometry find(const Shape& shape, const std::shared_ptr<const Model>& model);

 private:
  using Geometry = std::shared_ptr<const render::MeshGeometry>;

  Geometry sphere_, coarse_sphere_, box_, cylinder_, cone_;
  std::map<std::pair<Real, Real>, Geometry> capsules_;  ///< By radius and half height: they do not scale.
  std::map<std::shared_ptr<const Model>, Geometry> models_;
};

}  // namespace hooke::app
