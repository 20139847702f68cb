#include "state/surface_triangles.h"

#include "geometry/solid/tetrahedral_mesh.h"

namespace hooke::state {

std::vector<std::array<std::uint32_t, 3>> surface_triangles(const Tables& t, const Deformable& object) {
  std::vector<std::array<std::uint32_t, 3>> found;
  for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
    const auto [a, b, c] = t.triangles.corners[i];
    found.push_back({a, b, c});
  }
  if (object.kind != PointRef::Kind::kSolid) return found;
  if (object.tetrahedra.count > 0) {
    std::vector<geometry::Tetrahedron> tetrahedra;
    for (std::uint32_t i = object.tetrahedra.first; i < object.tetrahedra.end(); ++i) {
      const auto [a, b, c, d] = t.tetrahedra.corners[i];
      tetrahedra.push_back({a, b, c, d});
    }
    return geometry::surface_of(tetrahedra);
  }
  if (!object.skin) return found;
  for (const std::array<std::uint32_t, 3>& triangle : object.skin->triangles) {
    std::array<std::uint32_t, 3> rows = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t point = object.skin->vertices[triangle[k]].points[0];
      rows[k] = object.particles.first + t.particles.row_of[object.particles.first + point];
    }
    found.push_back(rows);
  }
  return found;
}

}  // namespace hooke::state
