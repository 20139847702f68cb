#include "hooke/drawing/body_geometry.h"

#include "hooke/drawing/cloth_surface.h"

#include "render/shapes.h"

namespace hooke::app {

namespace {

constexpr int kSides[] = {render::kRoundSides, 20, 10};  ///< Of the levels of a capsule.
constexpr float kHalfSpaceSize = 50;                     ///< Size of a half-space that is not the ground [m].

/// Returns `place`, which is filled at the first call.
template <class Make>
const BodyGeometry::Geometry& once(BodyGeometry::Geometry& place, const Make& make) {
  if (place == nullptr) place = std::make_shared<const render::MeshGeometry>(make());
  return place;
}

std::array<BodyGeometry::Geometry, 3> always(const BodyGeometry::Geometry& geometry) {
  return {geometry, geometry, geometry};
}

}  // namespace

BodyGeometry BodyGeometries::find(const Shape& shape, const std::shared_ptr<const Model>& model) {
  const auto unit_box = [] { return render::make_box({1, 1, 1}); };
  const Vec3 round = {shape.radius, shape.half_height, shape.radius};
  switch (shape.kind) {
    case ShapeKind::kSphere:
      // These have 5120, 320 and 80 triangles.
      once(spheres_[0], [] { return render::make_sphere(4); });
      once(spheres_[1], [] { return render::make_sphere(2); });
      once(spheres_[2], [] { return render::make_sphere(1); });
      return {
          .levels = spheres_, .radius = shape.radius, .scale = {shape.radius, shape.radius, shape.radius}};
    case ShapeKind::kBox:
      return {.levels = always(once(box_, unit_box)), .scale = shape.half_extents};
    case ShapeKind::kHalfSpace:
      return {.levels = always(once(box_, unit_box)),
              .scale = {kHalfSpaceSize, 0.5F * kHalfSpaceSize, kHalfSpaceSize},
              .shift = {0, -0.5F * kHalfSpaceSize, 0}};
    case ShapeKind::kCylinder:
      return {.levels = always(once(cylinder_, [] { return render::make_cylinder(1, 1); })), .scale = round};
    case ShapeKind::kCone:
      return {.levels = always(once(cone_, [] { return render::make_cone(1, 1); })), .scale = round};
    case ShapeKind::kCapsule: {
      auto& levels = capsules_[{shape.radius, shape.half_height}];
      for (std::size_t i = 0; i < levels.size(); ++i)
        once(levels[i], [&] { return render::make_capsule(shape.radius, shape.half_height, kSides[i]); });
      return {.levels = levels, .radius = shape.radius};
    }
    case ShapeKind::kHull:
    case ShapeKind::kMesh:
      if (model == nullptr) return {};
      return {.levels = always(once(models_[model], [&] { return *geometry_of(*model); }))};
    case ShapeKind::kCompound:
      break;
  }
  return {};
}

}  // namespace hooke::app
