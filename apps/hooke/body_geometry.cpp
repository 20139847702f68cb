#include "hooke/body_geometry.h"

#include "hooke/cloth_surface.h"

#include "render/shapes.h"

namespace hooke::app {

namespace {

constexpr float kHalfSpaceSize = 50;  ///< [m], of a half-space that is not the ground.

/// `place`, filled at the first call.
template <class Make>
const std::shared_ptr<const render::MeshGeometry>& once(std::shared_ptr<const render::MeshGeometry>& place,
                                                        const Make& make) {
  if (place == nullptr) place = std::make_shared<const render::MeshGeometry>(make());
  return place;
}

}  // namespace

BodyGeometry BodyGeometries::find(const Shape& shape, const std::shared_ptr<const Model>& model) {
  const Vec3 round = {shape.radius, shape.half_height, shape.radius};
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return {.fine = once(sphere_, [] { return render::make_sphere(4); }),
              .coarse = once(coarse_sphere_, [] { return render::make_sphere(2); }),
              .scale = {shape.radius, shape.radius, shape.radius}};
    case ShapeKind::kBox:
      return {.fine = once(box_, [] { return render::make_box({1, 1, 1}); }), .scale = shape.half_extents};
    case ShapeKind::kCylinder:
      return {.fine = once(cylinder_, [] { return render::make_cylinder(1, 1); }), .scale = round};
    case ShapeKind::kCone:
      return {.fine = once(cone_, [] { return render::make_cone(1, 1); }), .scale = round};
    case ShapeKind::kCapsule:
      return {.fine = once(capsules_[{shape.radius, shape.half_height}],
                           [&] { return render::make_capsule(shape.radius, shape.half_height); })};
    case ShapeKind::kHull:
    case ShapeKind::kMesh:
      if (model == nullptr) return {};
      return {.fine = once(models_[model], [&] { return *geometry_of(*model); })};
    case ShapeKind::kHalfSpace:
      return {.fine = once(box_,
                           [] {
                             return render::make_box({1, 1, 1});
                           }),
              .scale = {kHalfSpaceSize, 0.5F * kHalfSpaceSize, kHalfSpaceSize},
              .shift = {0, -0.5F * kHalfSpaceSize, 0}};
    case ShapeKind::kCompound:
      break;
  }
  return {};
}

}  // namespace hooke::app
