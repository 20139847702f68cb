#include "render/painter.h"

#include "geometry/bsp/bsp_tree.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hooke::render {

namespace {

/// A Source is a triangle of the list: its mesh, and its corners in the frame of the list.
struct Source {
  std::size_t mesh = 0;
  std::array<Vertex, 3> corners = {};
};

bool is_opaque(const DrawMesh& mesh) {
  return mesh.geometry != nullptr && mesh.alpha == AlphaMode::kOpaque && mesh.opacity >= 1;
}

Vertex placed(const Vertex& vertex, const Mat4& transform, const Mat3& normals) {
  Vertex result = vertex;
  result.position = transform_point(transform, vertex.position);
  result.normal = normalize(normals * vertex.normal);
  return result;
}

void add_sources(const DrawMesh& mesh, std::size_t number, std::vector<Source>& sources) {
  const MeshGeometry& geometry = *mesh.geometry;
  const std::size_t first = std::min(mesh.first_index, geometry.indices.size());
  const std::size_t left = geometry.indices.size() - first;
  const std::size_t count = mesh.index_count > 0 ? std::min(mesh.index_count, left) : left;
  const Mat3 normals = transpose(inverse(linear_part(mesh.transform)));
  const bool is_mirrored = determinant(linear_part(mesh.transform)) < 0;
  for (std::size_t i = first; i + 2 < first + count; i += 3) {
    Source source = {.mesh = number};
    for (std::size_t k = 0; k < 3; ++k)
      source.corners[k] = placed(geometry.vertices[geometry.indices[i + k]], mesh.transform, normals);
    if (is_mirrored) std::swap(source.corners[1], source.corners[2]);
    sources.push_back(source);
  }
}

geometry::SolidMesh triangles_of(const std::vector<Source>& sources) {
  geometry::SolidMesh mesh;
  for (const Source& source : sources) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vertex& corner : source.corners)
      mesh.positions.push_back(vector_cast<double>(corner.position));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Returns the triangle's vertex at a point, interpolated by the areas that the point and its sides enclose.
Vertex vertex_at(const Source& source, DVec3 p) {
  const auto at = [&](std::size_t k) { return vector_cast<double>(source.corners[k].position) - p; };
  const DVec3 normal = cross(at(1) - at(0), at(2) - at(0));
  const double whole = dot(normal, normal);
  Vertex vertex = {.position = vector_cast<float>(p), .normal = {}, .u = 0, .v = 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vertex& corner = source.corners[k];
    const auto weight = static_cast<float>(dot(normal, cross(at((k + 1) % 3), at((k + 2) % 3))) / whole);
    vertex.normal += weight * corner.normal;
    vertex.u += weight * corner.u;
    vertex.v += weight * corner.v;
  }
  vertex.normal = normalize(vertex.normal);
  return vertex;
}

/// Returns an empty run of triangles with the look of `mesh`, in a geometry in world coordinates.
DrawMesh run_of(const DrawMesh& mesh, const std::shared_ptr<MeshGeometry>& geometry) {
  DrawMesh run = mesh;
  run.geometry = geometry;
  run.first_index = geometry->indices.size();
  run.index_count = 0;
  run.transform = Mat4{};
  run.is_in_order = true;
  return run;
}

/// Appends a face of the tree, which is a part of the triangle of `source`, as a fan of triangles.
void add_face(const BspTree& tree, const BspFace& face, const Source& source, MeshGeometry& geometry) {
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  for (std::uint32_t k = 0; k < face.corner_count; ++k) {
    geometry.vertices.push_back(vertex_at(source, tree.corners[face.first_corner + k]));
  }
  for (std::uint32_t k = 2; k < face.corner_count; ++k) {
    geometry.indices.insert(geometry.indices.end(), {first, first + k - 1, first + k});
  }
}

}  // namespace

Result<void> paint_in_order(DrawList& list) {
  std::vector<Source> sources;
  for (std::size_t i = 0; i < list.meshes.size(); ++i)
    if (is_opaque(list.meshes[i])) add_sources(list.meshes[i], i, sources);
  if (sources.empty())
    return Error{ErrorCode::kOutOfRange, "painter", "there are no opaque triangles to order"};
  const Result<BspTree> tree = geometry::build_painters_bsp(triangles_of(sources));
  if (!tree) return tree.error();
  std::vector<std::uint32_t> faces;
  order_back_to_front(tree.value(), vector_cast<double>(list.camera.eye), faces);

  const auto ordered = std::make_shared<MeshGeometry>();
  std::vector<DrawMesh> runs;
  std::size_t mesh = list.meshes.size();
  for (const std::uint32_t f : faces) {
    const BspFace& face = tree.value().faces[f];
    const Source& source = sources[face.triangle];
    if (source.mesh != mesh) {
      mesh = source.mesh;
      runs.push_back(run_of(list.meshes[mesh], ordered));
    }
    add_face(tree.value(), face, source, *ordered);
    runs.back().index_count = ordered->indices.size() - runs.back().first_index;
  }
  for (DrawMesh& other : list.meshes)
    if (!is_opaque(other)) runs.push_back(std::move(other));
  list.meshes = std::move(runs);
  return {};
}

}  // namespace hooke::render
