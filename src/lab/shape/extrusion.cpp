#include "lab/shape/extrusion.h"

#include "geometry/closest.h"

#include <algorithm>
#include <cmath>

namespace hooke::geometry {

namespace {

double farthest_along(const ConvexSolid& solid, DVec3 n) {
  double farthest = dot(n, solid.vertices[0]);
  for (const DVec3 v : solid.vertices) farthest = std::max(farthest, dot(n, v));
  return farthest;
}

/// Returns a segment along `edge` shifted by `displacement`: a parallelogram with its rims, or a longer
/// segment where they are parallel.
ConvexSolid plate_of(const ConvexSolid& segment, DVec3 displacement) {
  const DVec3 a = segment.vertices[0], b = segment.vertices[1];
  const DVec3 along = direction_or(b - a, {});
  const DVec3 ahead = direction_or(displacement, {});
  const DVec3 n = cross(along, ahead);
  if (length(n) < 1e-9) {
    const DVec3 far = dot(along, displacement) > 0 ? b + displacement : a + displacement;
    const DVec3 back = dot(along, displacement) > 0 ? a : b;
    return {.vertices = {back, far}, .edges = {{0, 1}}, .directions = {{0, 1}}, .skin = segment.skin};
  }
  ConvexSolid plate = solid_triangle(a, b, b + displacement);
  plate.vertices.push_back(a + displacement);
  plate.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  plate.directions = {{0, 1}, {1, 2}};
  const DVec3 up = normalize(n);
  plate.faces = {{up, dot(up, a), {0, 1, 2, 3}}, {-up, -dot(up, a), {0, 3, 2, 1}}};
  for (const auto [from, to] : plate.edges) {
    const DVec3 side = normalize(cross(plate.vertices[to] - plate.vertices[from], up));
    plate.faces.push_back({side, farthest_along(plate, side)});
  }
  plate.skin = segment.skin;
  return plate;
}

bool faces_forward(const ConvexSolid::Face& face, DVec3 displacement) {
  return dot(face.normal, displacement) > 0;
}

/// Tells whether the edge runs from `from` to `to` in the loop of the face.
bool has_edge(const ConvexSolid::Face& face, std::uint32_t from, std::uint32_t to) {
  for (std::size_t i = 0; i < face.loop.size(); ++i) {
    if (face.loop[i] == from && face.loop[(i + 1) % face.loop.size()] == to) return true;
  }
  return false;
}

/// Appends a face at each edge of the silhouette, between the solid and its moved copy. Such an edge has a
/// face on either side: it is in the loop of one that faces forward, and reversed in that of one that does
/// not.
void add_silhouette(const ConvexSolid& solid, DVec3 displacement, ConvexSolid& result) {
  const auto count = static_cast<std::uint32_t>(solid.vertices.size());
  for (const ConvexSolid::Face& face : solid.faces) {
    if (!faces_forward(face, displacement)) continue;
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
      const std::uint32_t from = face.loop[i];
      const std::uint32_t to = face.loop[(i + 1) % face.loop.size()];
      const bool inner = std::any_of(solid.faces.begin(), solid.faces.end(), [&](const auto& other) {
        return faces_forward(other, displacement) && has_edge(other, to, from);
      });
      if (inner) continue;
      const DVec3 n = direction_or(cross(solid.vertices[to] - solid.vertices[from], displacement), {});
      if (n == DVec3{}) continue;
      result.faces.push_back({n, farthest_along(result, n), {from + count, from, to, to + count}});
    }
  }
}

}  // namespace

ConvexSolid extruded(const ConvexSolid& solid, DVec3 displacement) {
  if (displacement == DVec3{}) return solid;
  const auto count = static_cast<std::uint32_t>(solid.vertices.size());
  if (count == 1) {
    return {.vertices = {solid.vertices[0], solid.vertices[0] + displacement},
            .edges = {{0, 1}},
            .directions = {{0, 1}},
            .skin = solid.skin};
  }
  if (count == 2) return plate_of(solid, displacement);
  ConvexSolid result = solid;
  for (std::uint32_t i = 0; i < count; ++i) result.vertices.push_back(solid.vertices[i] + displacement);
  // Faces that face forward are those of the moved copy.
  for (ConvexSolid::Face& face : result.faces) {
    if (!faces_forward(face, displacement)) continue;
    face.offset += dot(face.normal, displacement);
    for (std::uint32_t& corner : face.loop) corner += count;
  }
  add_silhouette(solid, displacement, result);
  for (const auto [from, to] : solid.edges) result.edges.push_back({from + count, to + count});
  for (std::uint32_t i = 0; i < count; ++i) result.edges.push_back({i, i + count});
  result.directions.push_back({0, count});
  return result;
}

}  // namespace hooke::geometry
