#pragma once

#include "hooke/shape.h"

namespace hooke::app {

/// Returns a radius of a ball about the origin of a shape that holds it [m]; `otherwise` for a mesh, a hull
/// or a half-space, whose extent it does not know.
inline double radius_of(const Shape& shape, double otherwise) {
  switch (shape.kind) {
    case ShapeKind::kBox:
      return static_cast<double>(length(shape.half_extents));
    case ShapeKind::kSphere:
      return static_cast<double>(shape.radius);
    case ShapeKind::kCapsule:
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      return static_cast<double>(shape.radius + shape.half_height);
    default:
      return otherwise;
  }
}

}  // namespace hooke::app
