#include "geometry/solid/tetrahedral_hulls.h"

#include "geometry/box.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace hooke::geometry {

namespace {

struct TetrahedralSolid {
  std::span<const Vec3> points;
  std::span<const Tetrahedron> tetrahedra;
};

// These are the limits that convex parts of meshes have, too.
constexpr Real kDepth = Real(0.001);  ///< Largest depth of the surface in a hull, over the diagonal.
constexpr std::size_t kMostHulls = 64;
constexpr int kHullCorners = 64;

struct HullPart {
  std::vector<std::uint32_t> tetrahedra;
  std::shared_ptr<const ConvexHull> hull;  ///< Null if the part is too flat for one.
  Real depth = Real(0);                    ///< Largest depth of a point of the surface in the hull [m].
};

Real depth_in(const ConvexHull& hull, Vec3 p) {
  Real depth = std::numeric_limits<Real>::infinity();
  for (const ConvexHull::Face& face : hull.faces) depth = std::min(depth, face.offset - dot(face.normal, p));
  return depth;
}

std::vector<std::uint32_t> points_in(const TetrahedralSolid& solid,
                                     const std::vector<std::uint32_t>& tetrahedra) {
  std::vector<std::uint32_t> points;
  for (const std::uint32_t t : tetrahedra)
    points.insert(points.end(), solid.tetrahedra[t].begin(), solid.tetrahedra[t].end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

HullPart make_hull_part(const TetrahedralSolid& solid, std::vector<std::uint32_t> tetrahedra,
                        const std::vector<std::uint8_t>& is_outer) {
  HullPart part = {.tetrahedra = std::move(tetrahedra), .hull = nullptr};
  const std::vector<std::uint32_t> points = points_in(solid, part.tetrahedra);
  std::vector<Vec3> places;
  for (const std::uint32_t p : points) places.push_back(solid.points[p]);
  Result<ConvexHull> hull = make_convex_hull(places, kHullCorners);
  if (!hull) return part;
  part.hull = std::make_shared<const ConvexHull>(std::move(hull).value());
  for (const std::uint32_t p : points) {
    if (is_outer[p] != 0) part.depth = std::max(part.depth, depth_in(*part.hull, solid.points[p]));
  }
  return part;
}

/// Parts the tetrahedra in two halves along the longest side of the box around their middles.
std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> halve_part(
    const TetrahedralSolid& solid, std::vector<std::uint32_t> list) {
  const auto middle = [&](std::uint32_t t) {
    const auto& [a, b, c, d] = solid.tetrahedra[t];
    return solid.points[a] + solid.points[b] + solid.points[c] + solid.points[d];
  };
  Box box;
  for (const std::uint32_t t : list) box = merge(box, Box{middle(t), middle(t)});
  const Vec3 size = box.upper - box.lower;
  const Vec3 axis = size.x >= size.y && size.x >= size.z ? Vec3{Real(1), Real(0), Real(0)}
                    : size.y >= size.z                   ? Vec3{Real(0), Real(1), Real(0)}
                                                         : Vec3{Real(0), Real(0), Real(1)};
  const auto half = static_cast<std::ptrdiff_t>(list.size() / 2);
  std::sort(list.begin(), list.end(), [&](std::uint32_t s, std::uint32_t t) {
    return std::pair(dot(axis, middle(s)), s) < std::pair(dot(axis, middle(t)), t);
  });
  return {{list.begin(), list.begin() + half}, {list.begin() + half, list.end()}};
}

}  // namespace

std::vector<std::shared_ptr<const ConvexHull>> hulls_of(std::span<const Vec3> points,
                                                        std::span<const Tetrahedron> tetrahedra) {
  const TetrahedralSolid solid = {points, tetrahedra};
  std::vector<std::uint8_t> is_outer(solid.points.size(), 0);
  for (const Triangle& t : surface_of(solid.tetrahedra)) {
    for (const std::uint32_t p : t) is_outer[p] = 1;
  }
  Box box;
  for (const Vec3& p : solid.points) box = merge(box, p);
  const Real most = kDepth * length(box.upper - box.lower);
  std::vector<std::uint32_t> all(solid.tetrahedra.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<HullPart> parts = {make_hull_part(solid, std::move(all), is_outer)};
  while (parts.size() < kMostHulls) {
    const auto worst = std::max_element(
        parts.begin(), parts.end(), [](const HullPart& p, const HullPart& q) { return p.depth < q.depth; });
    if (!(worst->depth > most) || worst->tetrahedra.size() < 2) break;
    auto [first, second] = halve_part(solid, std::move(worst->tetrahedra));
    *worst = make_hull_part(solid, std::move(first), is_outer);
    parts.push_back(make_hull_part(solid, std::move(second), is_outer));
  }
  std::vector<std::shared_ptr<const ConvexHull>> hulls;
  for (const HullPart& part : parts) {
    if (part.hull) hulls.push_back(part.hull);
  }
  return hulls;
}

}  // namespace hooke::geometry
