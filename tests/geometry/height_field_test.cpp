#include "hooke/geometry.h"

#include "geometry/triangle_mesh.h"

#include <doctest/doctest.h>
#include <limits>
#include <string>
#include <vector>

using hooke::make_height_field;
using hooke::Real;
using hooke::Vec3;

namespace {

std::string error_of(int columns, int rows, Real cell, const std::vector<Real>& heights) {
  const auto field = make_height_field(columns, rows, cell, heights);
  REQUIRE_FALSE(field.has_value());
  return field.error().where + ": " + field.error().message;
}

}  // namespace

TEST_SUITE("geometry/height_field") {
  TEST_CASE("points lie on a grid at their heights, and every triangle faces up") {
    const std::vector<Real> heights = {0, 1, 2, 3, 4, -5, 6, 7, 8, 9, 10, 11};
    const auto field = make_height_field(4, 3, Real(0.5), heights);
    REQUIRE(field.has_value());
    const hooke::MeshDesc& mesh = field.value();
    REQUIRE(mesh.positions.size() == 12);
    CHECK(mesh.positions[0] == Vec3{0, 0, 0});
    CHECK(mesh.positions[3] == Vec3{Real(1.5), 3, 0});
    CHECK(mesh.positions[5] == Vec3{Real(0.5), -5, Real(0.5)});
    CHECK(mesh.positions[11] == Vec3{Real(1.5), 11, 1});
    CHECK(mesh.triangles.size() == 2 * 3 * 2);
    CHECK(hooke::geometry::validate_mesh(mesh).has_value());
    Real area_from_above = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 n = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
      CHECK(n.y > 0);
      area_from_above += n.y / 2;
    }
    CHECK(area_from_above == Real(1.5));
    const auto topology = hooke::geometry::compute_topology(12, mesh.triangles);
    CHECK(topology.border_edge_count == 10);
    CHECK(topology.branching_edge_count == 0);
    CHECK(topology.opposite_winding_edge_count == 0);
  }

  TEST_CASE("what does not fit is an error") {
    const std::vector<Real> four(4, 0);
    const Real infinity = std::numeric_limits<Real>::infinity();
    CHECK(error_of(1, 4, 1, four) == "height_field.columns: 1 is outside [2, 4096]");
    CHECK(error_of(2, -2, 1, four) == "height_field.rows: -2 is outside [2, 4096]");
    CHECK(error_of(4097, 4097, 1, four) == "height_field.columns: 4097 is outside [2, 4096]");
    CHECK(error_of(2, 3, 1, four) == "height_field.heights: 4 heights for 6 points");
    for (const Real cell : {Real(0), Real(-1), infinity, std::numeric_limits<Real>::quiet_NaN(),
                            std::numeric_limits<Real>::max()}) {
      CHECK(error_of(2, 2, cell, four) == "height_field.cell: a cell's side is positive and finite");
    }
    CHECK(error_of(2, 2, 1, {0, 0, infinity, 0}) == "height_field.heights[2]: a height is not finite");
  }
}
