#include "geometry/fracture/convex_cell.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::geometry {

namespace {

using RimEdge = std::array<std::uint32_t, 2>;

constexpr std::uint32_t kNoPoint = 0xFFFFFFFF;

/// Finds the heights of all points over the plane; those within `on_plane` are 0. Returns the least and the
/// largest.
std::array<double, 2> find_heights(const ConvexCell& cell, const Plane& plane, double on_plane,
                                   std::vector<double>& height) {
  height.clear();
  std::array<double, 2> range = {0, 0};
  for (const DVec3& p : cell.points) {
    double h = signed_distance(plane, p);
    if (std::abs(h) <= on_plane) h = 0;
    height.push_back(h);
    range = {std::min(range[0], h), std::max(range[1], h)};
  }
  return range;
}

/// The point of the result where the plane crosses the edge from a to b.
std::uint32_t crossing_point(const ConvexCell& cell, std::uint32_t a, std::uint32_t b,
                             CellCutScratch& scratch) {
  const std::array<std::uint32_t, 2> edge = {std::min(a, b), std::max(a, b)};
  for (const CellCutScratch::Crossing& known : scratch.crossings) {
    if (known.edge == edge) return known.point;
  }
  const double low = scratch.height[edge[0]];
  const double high = scratch.height[edge[1]];
  const DVec3 from = cell.points[edge[0]];
  const auto point = static_cast<std::uint32_t>(scratch.result.points.size());
  scratch.result.points.push_back(from + low / (low - high) * (cell.points[edge[1]] - from));
  scratch.crossings.push_back({edge, point});
  return point;
}

/// The point of the result for a point that is kept.
std::uint32_t kept_point(const ConvexCell& cell, std::uint32_t point, CellCutScratch& scratch) {
  std::uint32_t& name = scratch.renamed[point];
  if (name == kNoPoint) {
    name = static_cast<std::uint32_t>(scratch.result.points.size());
    scratch.result.points.push_back(cell.points[point]);
  }
  return name;
}

/// Cuts a face, and notes which of its edges lie in the plane.
void cut_face(const ConvexCell& cell, const ConvexCell::Face& face, CellCutScratch& scratch) {
  const auto corner = [&](std::uint32_t k) { return cell.loop[face.first + k % face.count]; };
  bool has_inside = false;
  for (std::uint32_t k = 0; k < face.count; ++k) has_inside = has_inside || scratch.height[corner(k)] < 0;
  if (!has_inside) return;
  const auto first = static_cast<std::uint32_t>(scratch.result.loop.size());
  std::vector<std::uint32_t>& on_plane = scratch.corners;
  on_plane.clear();
  for (std::uint32_t k = 0; k < face.count; ++k) {
    const std::uint32_t a = corner(k);
    const std::uint32_t b = corner(k + 1);
    const double height_a = scratch.height[a];
    const double height_b = scratch.height[b];
    if (height_a <= 0) {
      scratch.result.loop.push_back(kept_point(cell, a, scratch));
      on_plane.push_back(height_a < 0 ? 0 : 1);
    }
    if ((height_a < 0 && height_b > 0) || (height_a > 0 && height_b < 0)) {
      scratch.result.loop.push_back(crossing_point(cell, a, b, scratch));
      on_plane.push_back(1);
    }
  }
  const auto count = static_cast<std::uint32_t>(scratch.result.loop.size()) - first;
  HOOKE_ASSERT(count >= 3 && on_plane.size() == count);
  scratch.result.faces.push_back({first, count, face.cut});
  for (std::uint32_t k = 0; k < count; ++k) {
    if (on_plane[k] == 0 || on_plane[(k + 1) % count] == 0) continue;
    scratch.rim.push_back({scratch.result.loop[first + k], scratch.result.loop[first + (k + 1) % count]});
  }
}

/// Closes the hole by faces around its rim: one, unless rounding has made a pinch.
void close_hole(std::uint32_t cut, CellCutScratch& scratch) {
  std::vector<RimEdge>& rim = scratch.rim;
  // An edge between two faces that are both kept is no rim.
  std::erase_if(rim, [whole = rim](const RimEdge& edge) {
    return std::find(whole.begin(), whole.end(), RimEdge{edge[1], edge[0]}) != whole.end();
  });
  while (!rim.empty()) {
    const auto first = static_cast<std::uint32_t>(scratch.result.loop.size());
    const std::uint32_t end = rim.back()[1];
    std::uint32_t at = rim.back()[0];
    rim.pop_back();
    scratch.result.loop.insert(scratch.result.loop.end(), {end, at});
    while (at != end) {
      const auto next = std::find_if(rim.begin(), rim.end(), [&](const RimEdge& e) { return e[1] == at; });
      HOOKE_ASSERT(next != rim.end());  // Each point of a rim has as many edges to it as from it.
      at = (*next)[0];
      rim.erase(next);
      if (at != end) scratch.result.loop.push_back(at);
    }
    const auto count = static_cast<std::uint32_t>(scratch.result.loop.size()) - first;
    scratch.result.faces.push_back({first, count, cut});
  }
}

}  // namespace

ConvexCell cell_of(const MeshDesc& mesh, DVec3 origin) {
  ConvexCell cell;
  for (const Vec3& p : mesh.positions) cell.points.push_back(vector_cast<double>(p) - origin);
  for (const auto& t : mesh.triangles) {
    cell.faces.push_back({static_cast<std::uint32_t>(cell.loop.size()), 3, ConvexCell::kUncut});
    cell.loop.insert(cell.loop.end(), t.begin(), t.end());
  }
  return cell;
}

bool cut_cell(const Plane& plane, double on_plane, std::uint32_t cut, CellCutScratch& scratch,
              ConvexCell& cell) {
  const auto [lowest, highest] = find_heights(cell, plane, on_plane, scratch.height);
  if (!(highest > 0)) return false;
  scratch.result.points.clear();
  scratch.result.faces.clear();
  scratch.result.loop.clear();
  scratch.crossings.clear();
  scratch.rim.clear();
  scratch.renamed.assign(cell.points.size(), kNoPoint);
  if (lowest < 0) {
    for (const ConvexCell::Face& face : cell.faces) cut_face(cell, face, scratch);
    close_hole(cut, scratch);
  }
  std::swap(cell, scratch.result);
  return true;
}

void append_triangles(const ConvexCell& cell, const ConvexCell::Face& face,
                      std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto corner = [&](std::uint32_t k) { return cell.loop[face.first + k % face.count]; };
  // The fan starts where its smallest triangle is largest: corners on one line make flat ones elsewhere.
  std::uint32_t apex = 0;
  double best = -1;
  for (std::uint32_t k = 0; k < face.count; ++k) {
    double least = 1e300;
    for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
      const DVec3 origin = cell.points[corner(k)];
      const DVec3 u = cell.points[corner(k + i)] - origin;
      const DVec3 v = cell.points[corner(k + i + 1)] - origin;
      least = std::min(least, length_squared(cross(u, v)));
    }
    if (!(least > best)) continue;
    best = least;
    apex = k;
  }
  for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
    triangles.push_back({corner(apex), corner(apex + i), corner(apex + i + 1)});
  }
}

}  // namespace hooke::geometry
