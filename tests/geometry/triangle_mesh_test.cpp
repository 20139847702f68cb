#include "geometry/triangle_mesh.h"

#include "geometry/meshes.h"

#include <doctest/doctest.h>
#include <limits>
#include <set>
#include <string>

using hooke::MeshDesc;
using hooke::Real;
namespace geometry = hooke::geometry;

namespace {

geometry::MeshTopology topology_of(const MeshDesc& mesh) {
  return geometry::compute_topology(mesh.positions.size(), mesh.triangles);
}

hooke::Error error_of(const MeshDesc& mesh) {
  const auto result = geometry::validate_mesh(mesh);
  REQUIRE_FALSE(result.has_value());
  return result.error();
}

}  // namespace

TEST_SUITE("geometry/triangle_mesh") {
  TEST_CASE("a closed surface fulfills Euler's formula and has no border") {
    const MeshDesc mesh = hooke::test::make_sphere(3);
    const auto topology = topology_of(mesh);
    CHECK(mesh.positions.size() + mesh.triangles.size() - topology.edges.size() == 2);
    CHECK(topology.is_closed());
    for (const auto& sides : topology.edge_sides) CHECK(sides.triangle_count == 2);
    for (const auto flag : topology.is_border_vertex) CHECK(flag == 0);
  }

  TEST_CASE("edges are listed once in ascending order and belong to their triangles") {
    const MeshDesc mesh = hooke::test::make_sphere(2);
    const auto topology = topology_of(mesh);
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      CHECK(topology.edges[e][0] < topology.edges[e][1]);
      if (e > 0) CHECK(topology.edges[e - 1] < topology.edges[e]);
      for (int side = 0; side < 2; ++side) {
        const auto& triangle = mesh.triangles[topology.edge_sides[e].triangles[side]];
        const std::set<std::uint32_t> corners(triangle.begin(), triangle.end());
        const std::set<std::uint32_t> expected = {topology.edges[e][0], topology.edges[e][1],
                                                  topology.edge_sides[e].opposite[side]};
        CHECK(corners == expected);
      }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& edge = topology.edges[topology.triangle_edges[t][k]];
        const std::set<std::uint32_t> ends = {edge[0], edge[1]};
        CHECK(ends == std::set<std::uint32_t>{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]});
      }
    }
  }

  TEST_CASE("the triangles at a vertex are exactly those that name it, in ascending order") {
    MeshDesc mesh = hooke::test::make_grid(5, 4, Real(1));
    mesh.positions.push_back({});  // used by no triangle
    const auto topology = topology_of(mesh);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const auto corner : mesh.triangles[t]) {
          if (corner == v) expected.push_back(t);
        }
      }
      const auto found = topology.triangles_at(v);
      CHECK(std::vector<std::uint32_t>(found.begin(), found.end()) == expected);
    }
  }

  TEST_CASE("the border of a sheet is its rim") {
    const auto topology = topology_of(hooke::test::make_grid(5, 4, Real(1)));
    CHECK(topology.border_edge_count == 14);
    CHECK_FALSE(topology.is_closed());
    for (std::uint32_t v = 0; v < 20; ++v) {
      const bool is_at_rim = v % 5 == 0 || v % 5 == 4 || v / 5 == 0 || v / 5 == 3;
      CHECK(topology.is_border_vertex[v] == (is_at_rim ? 1 : 0));
    }
  }

  TEST_CASE("an edge with three triangles is told and keeps the first two") {
    MeshDesc mesh;
    mesh.positions.resize(5);
    mesh.triangles = {{4, 0, 1}, {1, 0, 2}, {0, 1, 3}};
    const auto topology = topology_of(mesh);
    CHECK(topology.branching_edge_count == 1);
    CHECK(topology.edges[0] == geometry::Edge{0, 1});
    CHECK(topology.edge_sides[0].triangle_count == 3);
    CHECK(topology.edge_sides[0].triangles == std::array<std::uint32_t, 2>{0, 1});
    CHECK(topology.edge_sides[0].opposite == std::array<std::uint32_t, 2>{4, 2});
    CHECK_FALSE(topology.is_closed());
  }

  TEST_CASE("a triangle turned over shows at each of its three edges") {
    MeshDesc mesh = hooke::test::make_cube(Real(1));
    CHECK(topology_of(mesh).opposite_winding_edge_count == 0);
    std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
    CHECK(topology_of(mesh).opposite_winding_edge_count == 3);
    CHECK_FALSE(topology_of(mesh).is_closed());
  }

  TEST_CASE("no triangles have no edges") {
    const auto topology = geometry::compute_topology(3, {});
    CHECK(topology.edges.empty());
    CHECK(topology.triangles_at(2).empty());
  }

  TEST_CASE("vertex areas add up to the surface and an inner vertex of a sheet owns one cell") {
    const MeshDesc mesh = hooke::test::make_grid(5, 4, Real(0.5));
    const auto areas = geometry::compute_vertex_areas(mesh.positions, mesh.triangles);
    double sum = 0.0;
    for (const Real area : areas) sum += area;
    CHECK(sum == doctest::Approx(2.0 * 1.5));
    CHECK(areas[6] == doctest::Approx(0.25));
    CHECK(areas[0] == doctest::Approx(0.25 / 3.0));  // two triangles meet at this corner, one at the next
    CHECK(areas[4] == doctest::Approx(0.125 / 3.0));
  }

  TEST_CASE("edges have the lengths of their cell") {
    const MeshDesc mesh = hooke::test::make_grid(2, 2, Real(3));
    const auto topology = topology_of(mesh);
    const auto lengths = geometry::compute_edge_lengths(mesh.positions, topology.edges);
    REQUIRE(lengths.size() == 5);  // 01 02 03 13 23
    CHECK(lengths[0] == Real(3));
    CHECK(lengths[2] == doctest::Approx(3.0 * 1.4142135));
    CHECK(lengths[4] == Real(3));
  }

  TEST_CASE("the volume of a cube keeps its digits far from the origin and turns with the winding") {
    MeshDesc mesh = hooke::test::make_cube(Real(1));
    CHECK(geometry::compute_signed_volume(mesh.positions, mesh.triangles) == doctest::Approx(8.0));
    for (auto& position : mesh.positions) position += {Real(4096), Real(-8192), Real(65536)};
    CHECK(geometry::compute_signed_volume(mesh.positions, mesh.triangles) == 8.0);
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    CHECK(geometry::compute_signed_volume(mesh.positions, mesh.triangles) == -8.0);
    CHECK(geometry::compute_signed_volume(mesh.positions, {}) == 0.0);
  }

  TEST_CASE("a good mesh is accepted, with loose vertices and flat triangles") {
    MeshDesc mesh = hooke::test::make_cube(Real(1));
    mesh.positions.push_back({});
    mesh.positions[0] = mesh.positions[1];
    CHECK(geometry::validate_mesh(mesh).has_value());
  }

  TEST_CASE("what is wrong with a mesh is named by its place") {
    MeshDesc mesh = hooke::test::make_cube(Real(1));
    mesh.triangles[3][1] = 8;
    CHECK(error_of(mesh).where == "mesh.triangles[3]");
    CHECK(error_of(mesh).message.find("beyond the 8 positions") != std::string::npos);
    mesh = hooke::test::make_cube(Real(1));
    mesh.triangles[11] = {4, 5, 4};
    CHECK(error_of(mesh).where == "mesh.triangles[11]");
    CHECK(error_of(mesh).message.find("twice") != std::string::npos);
    mesh = hooke::test::make_cube(Real(1));
    mesh.positions[7].y = std::numeric_limits<Real>::infinity();
    CHECK(error_of(mesh).where == "mesh.positions[7]");
    CHECK(error_of(mesh).code == hooke::ErrorCode::kOutOfRange);
    CHECK(error_of({}).where == "mesh.triangles");
    mesh = hooke::test::make_cube(Real(1));
    mesh.positions.resize(geometry::kVertexLimit + 1);
    CHECK(error_of(mesh).code == hooke::ErrorCode::kLimitExceeded);
    CHECK(error_of(mesh).where == "mesh.positions");
  }

  TEST_CASE("a solid's surface is closed, has one side outside and faces outward") {
    const auto text_of = [](const MeshDesc& mesh) {
      const auto result = geometry::validate_solid(mesh);
      return result.has_value() ? std::string() : result.error().where + ": " + result.error().message;
    };
    const MeshDesc cube = hooke::test::make_cube(1);
    CHECK(text_of(cube).empty());
    CHECK(text_of(hooke::test::make_sphere(3)).empty());
    MeshDesc open = cube;
    open.triangles.pop_back();
    CHECK(text_of(open) ==
          "mesh.triangles[0]: has an edge without a neighbor, one of 3; a solid's surface is closed");
    MeshDesc branching = cube;
    branching.triangles.push_back({0, 1, 7});
    CHECK(text_of(branching) ==
          "mesh.triangles[4]: has an edge with 3 triangles; a solid's surface has two at each");
    MeshDesc turned = cube;
    std::swap(turned.triangles[5][0], turned.triangles[5][1]);
    CHECK(text_of(turned).find("face opposite sides") != std::string::npos);
    MeshDesc inside_out = cube;
    for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
    CHECK(
        text_of(inside_out) ==
        "mesh.triangles: enclose -8.000000 m^3; a solid's triangles are counter-clockwise seen from outside");
    MeshDesc flat = cube;
    for (hooke::Vec3& p : flat.positions) p.y = 0;
    CHECK(text_of(flat).find("enclose 0.0") != std::string::npos);
    CHECK(text_of({}) == "mesh.triangles: a mesh needs at least one triangle");
  }
}
