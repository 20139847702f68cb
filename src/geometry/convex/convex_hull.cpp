#include "geometry/convex/convex_hull.h"

#include "base/assert.h"
#include "base/sort_unique.h"
#include "geometry/box.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/convex/quickhull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kExtentMin = 1e-9;  // [m]
constexpr double kExtentMax = 1e9;   // [m]
// The unit is that of the grid; the extent of the points is 2^20 of them.
constexpr double kToleranceOnGrid = ConvexHull::kTolerance * 2.0 * static_cast<double>(kGridHalf);
constexpr double kThicknessOnGrid = ConvexHull::kThicknessMin * 2.0 * static_cast<double>(kGridHalf);

using Loops = std::vector<std::vector<std::uint32_t>>;

Error hull_error(ErrorCode code, std::string where, std::string message) {
  return {.code = code, .where = std::move(where), .message = std::move(message)};
}

/// Points on the grid in ascending order, each once, and the points that they came from.
struct GriddedPoints {
  std::vector<GridPoint> grid;
  std::vector<Vec3> original;
};

std::int64_t nearest_whole(double value) {
  return static_cast<std::int64_t>(std::floor(value + 0.5));
}

Result<GriddedPoints> put_on_grid(std::span<const Vec3> points) {
  DVec3 lower = vector_cast<double>(points[0]);
  DVec3 upper = lower;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) {
      return hull_error(ErrorCode::kOutOfRange, "points[" + std::to_string(i) + "]",
                        "a coordinate is not finite");
    }
    lower = min_of(lower, vector_cast<double>(points[i]));
    upper = max_of(upper, vector_cast<double>(points[i]));
  }
  const DVec3 size = upper - lower;
  const double extent = std::max({size.x, size.y, size.z});
  if (!(extent >= kExtentMin && extent <= kExtentMax)) {
    return hull_error(ErrorCode::kOutOfRange, "points",
                      "the points are " + std::to_string(extent) + " m across; a hull is 1e-9 to 1e9 m");
  }
  const double scale = 2.0 * static_cast<double>(kGridHalf) / extent;
  const DVec3 middle = lower + 0.5 * size;
  std::vector<std::pair<GridPoint, Vec3>> all;
  all.reserve(points.size());
  for (const Vec3& p : points) {
    const DVec3 q = scale * (vector_cast<double>(p) - middle);
    all.push_back({{nearest_whole(q.x), nearest_whole(q.y), nearest_whole(q.z)}, p});
  }
  // Points are sorted by position alone, so that the hull does not depend on their order.
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.x, a.first.y, a.first.z, a.second.x, a.second.y, a.second.z) <
           std::tie(b.first.x, b.first.y, b.first.z, b.second.x, b.second.y, b.second.z);
  });
  GriddedPoints result;
  for (const auto& [grid, original] : all) {
    if (!result.grid.empty() && result.grid.back() == grid) continue;
    result.grid.push_back(grid);
    result.original.push_back(original);
  }
  return result;
}

/// The smallest distance between a face and the point farthest below it [grid units].
double thickness_of(std::span<const HullTriangle> triangles, std::span<const GridPoint> points) {
  std::vector<std::uint32_t> corners;
  for (const HullTriangle& t : triangles) corners.insert(corners.end(), t.vertex.begin(), t.vertex.end());
  base::sort_unique(corners);
  double thickness = std::numeric_limits<double>::infinity();
  for (const HullTriangle& face : triangles) {
    std::int64_t lowest = 0;
    for (const std::uint32_t v : corners) lowest = std::min(lowest, scaled_height(face, points, points[v]));
    thickness = std::min(thickness, -static_cast<double>(lowest) * face.inverse_length);
  }
  return thickness;
}

/// For each point, the number of loops that contain it.
std::vector<std::uint32_t> count_loops(const Loops& loops, std::size_t point_count) {
  std::vector<std::uint32_t> count(point_count, 0);
  for (const auto& loop : loops) {
    for (const std::uint32_t v : loop) ++count[v];
  }
  return count;
}

/// Keeps the points for which `is_kept` is not zero.
void keep(const std::vector<std::uint8_t>& is_kept, GriddedPoints& points) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (is_kept[i] == 0) continue;
    points.grid[end] = points.grid[i];
    points.original[end++] = points.original[i];
  }
  points.grid.resize(end);
  points.original.resize(end);
}

/// Faces of the hull, after all points but its corners have been left out. A point at which fewer than three
/// faces meet lies inside the hull, a face or an edge; without it, others may stop being corners. Returns no
/// faces if the hull is too thin.
Loops find_faces(GriddedPoints& points, int vertex_limit) {
  for (;;) {
    const auto triangles = triangulate_hull(points.grid, kToleranceOnGrid, vertex_limit);
    if (triangles.empty() || thickness_of(triangles, points.grid) < kThicknessOnGrid) return {};
    const Loops rough = join_triangles(triangles, points.grid, kToleranceOnGrid, false);
    const auto loop_counts = count_loops(rough, points.grid.size());
    std::vector<std::uint8_t> is_corner(loop_counts.size());
    std::transform(loop_counts.begin(), loop_counts.end(), is_corner.begin(),
                   [](std::uint32_t count) { return count >= 3 ? 1 : 0; });
    if (std::ranges::all_of(is_corner, [](std::uint8_t corner) { return corner != 0; })) {
      return join_triangles(triangles, points.grid, kToleranceOnGrid, true);
    }
    keep(is_corner, points);
  }
}

/// Twice the area of the face, along its normal.
DVec3 area_vector(const ConvexHull& hull, const ConvexHull::Face& face) {
  const auto corner = [&](std::size_t k) {
    return vector_cast<double>(hull.vertices[hull.loop[face.first + k % face.count]]);
  };
  const DVec3 origin = corner(0);
  DVec3 sum = {};
  for (std::size_t k = 1; k + 1 < face.count; ++k) sum += cross(corner(k) - origin, corner(k + 1) - origin);
  return sum;
}

/// Fits the plane with the offset of the outermost corner, so that no corner of the face is outside.
void fit_plane(const ConvexHull& hull, ConvexHull::Face& face) {
  face.normal = vector_cast<Real>(normalize(area_vector(hull, face)));
  double offset = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < face.count; ++k) {
    const Vec3 corner = hull.vertices[hull.loop[face.first + k]];
    offset = std::max(offset, dot(vector_cast<double>(face.normal), vector_cast<double>(corner)));
  }
  face.offset = static_cast<Real>(offset);
}

/// A side of an edge.
struct HullSide {
  std::uint16_t low = 0, high = 0;
  bool is_backward = false;  // its face runs from the higher to the lower vertex
  std::uint16_t face = 0;
};

std::vector<ConvexHull::Edge> edges_of(const ConvexHull& hull) {
  std::vector<HullSide> sides;
  sides.reserve(hull.loop.size());
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const ConvexHull::Face& face = hull.faces[f];
    for (std::size_t k = 0; k < face.count; ++k) {
      const std::uint16_t a = hull.loop[face.first + k];
      const std::uint16_t b = hull.loop[face.first + (k + 1) % face.count];
      sides.push_back({std::min(a, b), std::max(a, b), a > b, static_cast<std::uint16_t>(f)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const HullSide& a, const HullSide& b) {
    return std::tie(a.low, a.high, a.is_backward) < std::tie(b.low, b.high, b.is_backward);
  });
  std::vector<ConvexHull::Edge> edges;
  edges.reserve(sides.size() / 2);
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    HOOKE_ASSERT(sides[i].low == sides[i + 1].low && sides[i].high == sides[i + 1].high);
    HOOKE_ASSERT(!sides[i].is_backward && sides[i + 1].is_backward);
    const auto& [low, high, backward, face] = sides[i];
    const Vec3 direction = normalize(hull.vertices[high] - hull.vertices[low]);
    edges.push_back({low, high, face, sides[i + 1].face, direction});
  }
  return edges;
}

/// Makes the hull from these corners and faces; planes, edges, center and radii follow from them.
ConvexHull assemble(std::vector<Vec3> vertices, const Loops& loops) {
  ConvexHull hull;
  hull.vertices = std::move(vertices);
  for (const auto& loop : loops) {
    ConvexHull::Face face;
    face.first = static_cast<std::uint16_t>(hull.loop.size());
    face.count = static_cast<std::uint16_t>(loop.size());
    for (const std::uint32_t v : loop) hull.loop.push_back(static_cast<std::uint16_t>(v));
    fit_plane(hull, face);
    hull.faces.push_back(face);
  }
  hull.edges = edges_of(hull);
  hull.center = vector_cast<Real>(mass_of(hull).center);
  const auto center = vector_cast<double>(hull.center);
  double inner = std::numeric_limits<double>::infinity();
  for (const ConvexHull::Face& face : hull.faces) {
    inner = std::min(inner, static_cast<double>(face.offset) - dot(vector_cast<double>(face.normal), center));
  }
  double outer = 0;
  for (const Vec3& v : hull.vertices) outer = std::max(outer, length(vector_cast<double>(v) - center));
  hull.inner_radius = static_cast<Real>(std::max(inner, 0.0));
  hull.outer_radius = static_cast<Real>(outer);
  return hull;
}

}  // namespace

Result<ConvexHull> make_convex_hull(std::span<const Vec3> points, int vertex_limit) {
  HOOKE_ASSERT(vertex_limit >= 4 && vertex_limit <= ConvexHull::kMaxVertices);
  if (points.size() < 4) {
    return hull_error(ErrorCode::kOutOfRange, "points",
                      std::to_string(points.size()) + " points; a hull needs at least four");
  }
  Result<GriddedPoints> gridded = put_on_grid(points);
  if (!gridded) return gridded.error();
  const Loops faces = find_faces(gridded.value(), vertex_limit);
  if (faces.empty()) {
    return hull_error(ErrorCode::kOutOfRange, "points",
                      "the points lie in a plane; a hull is at least 1e-4 of its extent thick");
  }
  return assemble(std::move(gridded.value().original), faces);
}

ConvexHull make_box_hull(Vec3 half_extents) {
  std::vector<Vec3> vertices;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const auto [x, y, z] = half_extents;
    vertices.push_back({(i & 1u) != 0 ? x : -x, (i & 2u) != 0 ? y : -y, (i & 4u) != 0 ? z : -z});
  }
  return assemble(std::move(vertices),
                  {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
}

MeshDesc mesh_of(const ConvexHull& hull) {
  MeshDesc mesh = {.positions = hull.vertices};
  for (const ConvexHull::Face& face : hull.faces) {
    const std::uint16_t* loop = hull.loop.data() + face.first;
    for (std::size_t k = 1; k + 1 < face.count; ++k) {
      mesh.triangles.push_back({loop[0], loop[k], loop[k + 1]});
    }
  }
  return mesh;
}

}  // namespace hooke::geometry
