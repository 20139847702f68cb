#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"
#include "collision/manifold/manifold_tuning.h"
#include "state/manifolds.h"

#include <algorithm>
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

/// Distance of two points as seen along the normal, squared.
Real aside_squared(const ContactResultPoint& p, const ContactResultPoint& q, Vec3 normal) {
  const Vec3 apart = p.on_a - q.on_a;
  const Real along = dot(apart, normal);
  return length_squared(apart) - along * along;
}

/// Moves the point to the place `at` that is seen farthest aside of those before it, and lies at less than 45
/// degrees over them. Returns false if there is none.
bool bring_farthest(ContactResult& result, int at, Real deepest) {
  const auto begin = result.point.begin();
  auto best = begin + result.count;
  Real farthest = Real(0);
  for (auto p = begin + at; p != begin + result.count; ++p) {
    Real aside = std::numeric_limits<Real>::infinity();
    for (auto q = begin; q != begin + at; ++q) aside = std::min(aside, aside_squared(*p, *q, result.normal));
    const Real rise = p->separation - deepest;
    if (!(aside > farthest) || aside < rise * rise) continue;
    farthest = aside;
    best = p;
  }
  if (best == begin + result.count) return false;
  std::rotate(begin + at, best, best + 1);
  return true;
}

/// A small or finely faceted hull has many corners in reach. Those that span most would be far up its sides,
/// and leave out the face that it lies on. So the corners of its lowest face or edge come first, with all
/// that are about as deep. Others join an edge or a corner, but not a face: the one corner that a triangle
/// has room for would be on one of its sides, and rolling to that side would differ from rolling to the
/// other.
void prefer_lowest_feature(const Convex& hull, ContactResult& result) {
  if (result.count <= state::Manifold::kMaxPoints) return;
  const Real deepest = deepest_of(result);
  const Feature lowest = feature_along(hull, -result.normal);
  const auto belongs = [&](const ContactResultPoint& p) {
    if (p.separation <= deepest + kSameDepth) return true;
    const auto* const end = lowest.vertex.begin() + lowest.count;
    return std::any_of(lowest.vertex.begin(), end,
                       [&p](std::uint32_t v) { return p.key == (kVertexOfB | v); });
  };
  const auto begin = result.point.begin();
  int count = static_cast<int>(std::stable_partition(begin, begin + result.count, belongs) - begin);
  const int most = count < 3 ? state::Manifold::kMaxPoints : count;
  while (count < most && bring_farthest(result, count, deepest)) ++count;
  result.count = count;
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
    if (b.shape.kind == ShapeKind::kHull) prefer_lowest_feature(b, result);
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
