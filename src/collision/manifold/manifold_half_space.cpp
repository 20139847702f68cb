#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"

#include <limits>

namespace hooke::collision {

namespace {

struct Plane {
  Vec3 origin = {};
  Vec3 normal = {};

  [[nodiscard]] Real height_of(Vec3 p) const { return dot(normal, p - origin); }
};

/// A polyhedron rests on its lowest corners, whatever faces and edges they belong to.
void add_corners(const Plane& plane, const Convex& b, Real margin, ContactResult& result) {
  const auto add = [&](Vec3 p, std::uint32_t vertex) {
    const Real height = plane.height_of(p);
    if (height <= margin) result.add({p - height * plane.normal, p, height, kVertexOfB | vertex});
  };
  if (b.shape.kind == ShapeKind::kBox) {
    for (const int face : {0, 1}) {
      const Feature f = face_of_box(b, face);
      for (std::size_t i = 0; i < 4; ++i) add(f.point[i], f.vertex[i]);
    }
    return;
  }
  const auto& vertices = b.hull->vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    add(b.center + b.axes * vertices[i], static_cast<std::uint32_t>(i));
  }
}

}  // namespace

void collide_half_space(Vec3 origin, Vec3 normal, const Convex& b, const ContactQuery& query,
                        ContactResult& result) {
  const Plane plane = {origin, normal};
  const Real skin = skin_of(b);
  result.normal = normal;
  result.separation = plane.height_of(support_of(b, -normal)) - skin;
  if (result.separation > query.margin) return;
  if (b.shape.kind == ShapeKind::kBox || b.shape.kind == ShapeKind::kHull) {
    // Of a hull with very many corners in reach, the lowest ones are taken.
    Real reach = query.margin;
    add_corners(plane, b, reach, result);
    while (result.count == ContactResult::kMaxPoints && reach > result.separation + Real(1e-4)) {
      reach = Real(0.5) * (reach + result.separation);
      result.count = 0;
      add_corners(plane, b, reach, result);
    }
    return;
  }
  const Feature f = feature_along(b, -normal);
  for (int i = 0; i < f.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Real height = plane.height_of(f.point[k]);
    result.add(
        {f.point[k] - height * normal, f.point[k] - skin * normal, height - skin, kVertexOfB | f.vertex[k]});
  }
}

}  // namespace hooke::collision
