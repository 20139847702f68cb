#include "hooke/drawing/cloth_surface.h"

#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace hooke::app {

namespace {

/// Normals that agree to this part of their length are the same.
constexpr float kNormalSteps = 32;

Vec3 vector_of(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// Vertices of one point whose normals agree in the file become one vertex of the surface.
std::vector<std::uint32_t> normal_groups(const Model& model) {
  using Key = std::tuple<std::uint32_t, int, int, int>;
  std::map<Key, std::uint32_t> group_of_key;
  std::vector<std::uint32_t> groups;
  groups.reserve(model.vertices.size());
  for (std::size_t i = 0; i < model.vertices.size(); ++i) {
    const std::array<float, 3>& n = model.vertices[i].normal;
    const auto step = [](float x) { return static_cast<int>(std::lround(kNormalSteps * x)); };
    const Key key = {model.welded_of[i], step(n[0]), step(n[1]), step(n[2])};
    const auto next = static_cast<std::uint32_t>(group_of_key.size());
    groups.push_back(group_of_key.try_emplace(key, next).first->second);
  }
  return groups;
}

}  // namespace

ClothSurface make_grid_surface(std::uint32_t columns, std::uint32_t rows,
                               std::span<const std::array<std::uint32_t, 3>> triangles) {
  ClothSurface surface;
  surface.geometry = std::make_shared<render::MeshGeometry>();
  const std::size_t count = std::size_t{columns} * rows;
  surface.geometry->vertices.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = i % columns;
    const std::size_t row = i / columns;
    surface.geometry->vertices[i].u = static_cast<float>(column) / static_cast<float>(columns - 1);
    surface.geometry->vertices[i].v = 1 - static_cast<float>(row) / static_cast<float>(rows - 1);
  }
  for (const auto& triangle : triangles) {
    surface.geometry->indices.insert(surface.geometry->indices.end(), triangle.begin(), triangle.end());
  }
  surface.point_of.resize(count);
  std::iota(surface.point_of.begin(), surface.point_of.end(), 0U);
  surface.group_of = surface.point_of;
  surface.group_normals.resize(count);
  return surface;
}

void tear_surface(std::span<const std::array<std::uint32_t, 3>> triangles,
                  std::span<const std::uint32_t> splits, ClothSurface& surface) {
  std::vector<std::uint32_t>& indices = surface.geometry->indices;
  if (splits.empty() || indices.size() > 3 * triangles.size()) return;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertex_of;  // by vertex before and point
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t point = triangles[i / 3][i % 3];
    const std::uint32_t before = indices[i];
    if (surface.point_of[before] == point) continue;
    const auto next = static_cast<std::uint32_t>(surface.point_of.size());
    const auto [entry, is_new] = vertex_of.try_emplace({before, point}, next);
    indices[i] = entry->second;
    if (!is_new) continue;
    surface.geometry->vertices.push_back(render::Vertex(surface.geometry->vertices[before]));
    surface.point_of.push_back(point);
    surface.group_of.push_back(static_cast<std::uint32_t>(surface.group_normals.size()));
    surface.group_normals.emplace_back();
  }
  for (std::size_t i = indices.size(); i < 3 * triangles.size(); ++i) {
    constexpr std::uint32_t kInside = 0xFFFFFFFF;
    const std::uint32_t point = triangles[i / 3][i % 3];
    const auto next = static_cast<std::uint32_t>(surface.point_of.size());
    const auto [entry, is_new] = vertex_of.try_emplace({kInside, point}, next);
    indices.push_back(entry->second);
    if (!is_new) continue;
    surface.geometry->vertices.emplace_back();
    surface.point_of.push_back(point);
    surface.group_of.push_back(static_cast<std::uint32_t>(surface.group_normals.size()));
    surface.group_normals.emplace_back();
  }
}

std::vector<std::array<std::uint32_t, 3>> untorn(std::vector<std::array<std::uint32_t, 3>> triangles,
                                                 std::span<const std::uint32_t> splits, std::size_t points) {
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      while (corner >= points && corner - points < splits.size()) corner = splits[corner - points];
    }
  }
  return triangles;
}

std::shared_ptr<render::MeshGeometry> geometry_of(const Model& model) {
  auto geometry = std::make_shared<render::MeshGeometry>();
  geometry->vertices.reserve(model.vertices.size());
  for (const ModelVertex& vertex : model.vertices) {
    geometry->vertices.push_back(
        {vector_of(vertex.position), vector_of(vertex.normal), vertex.uv[0], vertex.uv[1]});
  }
  geometry->indices = model.indices;
  return geometry;
}

ClothSurface make_model_surface(const Model& model) {
  ClothSurface surface;
  surface.geometry = geometry_of(model);
  surface.point_of = model.welded_of;
  surface.group_of = normal_groups(model);
  surface.group_normals.resize(model.vertices.size());
  return surface;
}

ClothSurface make_solid_surface(std::span<const Vec3> points,
                                std::span<const std::array<std::uint32_t, 3>> triangles) {
  // Triangles at a point that face the same of the six directions share a vertex.
  ClothSurface surface;
  surface.geometry = std::make_shared<render::MeshGeometry>();
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> vertex_of;
  for (const auto& t : triangles) {
    const Vec3 n = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    const float size[3] = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const auto along = component(n, axis);
    for (const std::uint32_t p : t) {
      const auto next = static_cast<std::uint32_t>(surface.point_of.size());
      const auto [entry, is_new] = vertex_of.try_emplace({p, 2 * axis + (along < 0 ? 1 : 0)}, next);
      if (is_new) surface.point_of.push_back(p);
      surface.geometry->indices.push_back(entry->second);
    }
  }
  surface.geometry->vertices.resize(surface.point_of.size());
  surface.group_of.resize(surface.point_of.size());
  std::iota(surface.group_of.begin(), surface.group_of.end(), 0U);
  surface.group_normals.resize(surface.point_of.size());
  return surface;
}

void update_surface(ClothSurface& surface, std::span<const Vec3> points) {
  std::vector<render::Vertex>& vertices = surface.geometry->vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (surface.point_of[i] < points.size()) vertices[i].position = points[surface.point_of[i]];
  }
  std::vector<Vec3>& normals = surface.group_normals;
  std::fill(normals.begin(), normals.end(), Vec3{});
  const std::vector<std::uint32_t>& indices = surface.geometry->indices;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Vec3 a = vertices[indices[i]].position;
    // The normal is not normalized, so that large triangles count more.
    const Vec3 normal = cross(vertices[indices[i + 1]].position - a, vertices[indices[i + 2]].position - a);
    for (std::size_t k = 0; k < 3; ++k) normals[surface.group_of[indices[i + k]]] += normal;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 normal = normalize(normals[surface.group_of[i]]);
    if (normal != Vec3{}) vertices[i].normal = normal;
  }
  ++surface.geometry->vertex_revision;
}

}  // namespace hooke::app
