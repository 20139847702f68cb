#include "geometry/solid/tetrahedral_mesh.h"

#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <map>
#include <numeric>

namespace hooke::geometry {

namespace {

double volume_of(const TetrahedralMesh& mesh) {
  double sum = 0;
  const auto& x = mesh.points;
  for (const Tetrahedron& t : mesh.tetrahedra) sum += volume6(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) / 6;
  return sum;
}

double least_volume(const TetrahedralMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  const auto& x = mesh.points;
  for (const Tetrahedron& t : mesh.tetrahedra)
    least = std::min(least, volume6(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) / 6);
  return least;
}

/// The outer surface as a mesh of its own.
MeshDesc skin_of(const TetrahedralMesh& mesh) {
  MeshDesc skin;
  for (const DVec3& p : mesh.points) skin.positions.push_back(vector_cast<Real>(p));
  skin.triangles = surface_of(mesh.tetrahedra);
  return skin;
}

TetrahedralMesh filled(const MeshDesc& mesh, double cell) {
  Result<TetrahedralMesh> result = fill_solid(mesh, cell);
  if (!result) FAIL(result.error().where << ": " << result.error().message);
  return std::move(result).value();
}

/// Appends a box with these corners to a mesh.
void add_box(MeshDesc& mesh, Vec3 lower, Vec3 upper) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const MeshDesc box = test::make_box(Real(0.5) * (upper - lower));
  for (const Vec3 p : box.positions) mesh.positions.push_back(Real(0.5) * (lower + upper) + p);
  for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

/// Number of pieces of tetrahedra that hang together by whole faces.
std::size_t count_pieces(const TetrahedralMesh& mesh) {
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::map<Triangle, std::size_t> seen;
  std::vector<std::size_t> parent(mesh.tetrahedra.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::size_t pieces = parent.size();
  for (std::size_t i = 0; i < parent.size(); ++i) {
    for (const auto& f : kFaces) {
      Triangle face = {mesh.tetrahedra[i][f[0]], mesh.tetrahedra[i][f[1]], mesh.tetrahedra[i][f[2]]};
      std::sort(face.begin(), face.end());
      const auto [other, is_new] = seen.try_emplace(face, i);
      if (is_new || root(i) == root(other->second)) continue;
      parent[root(i)] = root(other->second);
      --pieces;
    }
  }
  return pieces;
}

}  // namespace

TEST_SUITE("geometry/tetrahedral_mesh") {
  TEST_CASE("a table with legs far thinner than a cell becomes one piece that reaches the ground") {
    MeshDesc table;
    add_box(table, {-1, Real(0.8), -1}, {1, 1, 1});
    for (const Real x : {Real(-0.9), Real(0.87)}) {
      for (const Real z : {Real(-0.9), Real(0.87)})
        add_box(table, {x, Real(-0.8), z}, {x + Real(0.03), Real(0.81), z + Real(0.03)});
    }
    const TetrahedralMesh mesh = filled(table, 0.2);
    CHECK(count_pieces(mesh) == 1);
    double lowest = 1;
    for (const DVec3& p : mesh.points) lowest = std::min(lowest, p.y);
    CHECK(lowest < -0.7);
    const auto additions = measure_additions(table, 0.2);
    REQUIRE(additions.has_value());
    CHECK(additions.value().thin >= 4 * 6);
    CHECK(additions.value().pieces == 5);
    CHECK(additions.value().bridges >= 4);
  }

  TEST_CASE("parts of a model that do not touch are joined by as few cells as there is room for") {
    MeshDesc apart;
    add_box(apart, {0, 0, 0}, {1, 1, 1});
    add_box(apart, {Real(1.5), 0, 0}, {Real(2.5), 1, 1});
    const auto additions = measure_additions(apart, 0.25);
    REQUIRE(additions.has_value());
    CHECK(additions.value().pieces == 2);
    CHECK(additions.value().thin == 0);
    CHECK(additions.value().bridges == 2);
    CHECK(count_pieces(filled(apart, 0.25)) == 1);
  }

  TEST_CASE("nothing is added to a solid without thin parts") {
    const auto additions = measure_additions(test::make_sphere(3), 0.25);
    REQUIRE(additions.has_value());
    CHECK(additions.value().thin + additions.value().bridges == 0);
    CHECK(additions.value().pieces == 1);
  }

  TEST_CASE("a box of cells has the tetrahedra it should, none of them inside out, and its own volume") {
    CellGrid grid = {.counts = {2, 3, 4}, .cell = {0.5, 1, 2}};
    grid.filled.assign(24, 1);
    const TetrahedralMesh mesh = fill_cells(grid);
    // Corners and centers; four at each inner face, two at each outer one.
    CHECK(mesh.points.size() == 3 * 4 * 5 + 24);
    const int inner = 1 * 3 * 4 + 2 * 2 * 4 + 2 * 3 * 3;
    const int outer = 2 * (3 * 4 + 2 * 4 + 2 * 3);
    CHECK(mesh.tetrahedra.size() == 4 * inner + 2 * outer);
    CHECK(volume_of(mesh) == doctest::Approx(24));
    CHECK(least_volume(mesh) == doctest::Approx(1.0 / 12));
  }

  TEST_CASE("the surface of a solid is closed and faces outward") {
    CellGrid grid = {.counts = {3, 3, 3}, .filled = std::vector<std::uint8_t>(27, 1)};
    grid.filled[grid.index(1, 1, 1)] = 0;  // a cavity
    grid.filled[grid.index(2, 2, 2)] = 0;
    const TetrahedralMesh mesh = fill_cells(grid);
    CHECK(volume_of(mesh) == doctest::Approx(25));
    const MeshDesc skin = skin_of(mesh);
    CHECK(compute_topology(skin.positions.size(), skin.triangles).is_closed());
    CHECK(compute_signed_volume(skin.positions, skin.triangles) == doctest::Approx(25));
  }

  TEST_CASE("a cube is filled exactly, whatever the cell") {
    for (const double cell : {0.1, 0.3, 0.7, 5.0}) {
      const TetrahedralMesh mesh = filled(test::make_cube(Real(0.5)), cell);
      CHECK(volume_of(mesh) == doctest::Approx(1).epsilon(1e-5));
      CHECK(least_volume(mesh) > 0);
    }
  }

  TEST_CASE("a sphere is filled the better the smaller the cells, and its outer points lie on it") {
    const MeshDesc sphere = test::make_sphere(4);
    const double whole = compute_signed_volume(sphere.positions, sphere.triangles);
    double before = 1;
    for (const double cell : {0.5, 0.25, 0.125}) {
      const TetrahedralMesh mesh = filled(sphere, cell);
      const double error = std::abs(volume_of(mesh) / whole - 1);
      CHECK(error < 0.5 * before);
      before = error;
      CHECK(least_volume(mesh) > 0.005 * cell * cell * cell);
      double farthest = 0;
      for (const Triangle& t : surface_of(mesh.tetrahedra)) {
        for (const std::uint32_t p : t) farthest = std::max(farthest, std::abs(length(mesh.points[p]) - 1));
      }
      // Where a tetrahedron would lose nine tenths of its volume, its point stays off the sphere.
      CHECK(farthest < 0.4 * cell);
    }
    CHECK(before < 0.01);
  }

  TEST_CASE("every vertex of a mesh has its place in the lattice, inside or beside a tetrahedron") {
    const MeshDesc sphere = test::make_sphere(3);
    const TetrahedralMesh mesh = filled(sphere, 0.25);
    std::vector<DVec3> places;
    for (const Vec3& p : sphere.positions) places.push_back(vector_cast<double>(p));
    places.push_back({0.1, 0.2, 0.3});
    const std::vector<TetrahedronPlace> found = locate(mesh, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      DVec3 sum = {};
      for (int k = 0; k < 4; ++k)
        sum += found[i].weights[k] * mesh.points[mesh.tetrahedra[found[i].tetrahedron][k]];
      CHECK(length(sum - places[i]) < 1e-12);
      // A coarse flat face under a finer sphere: a little outside.
      const double least = *std::min_element(found[i].weights.begin(), found[i].weights.end());
      CHECK(least > -0.35);
    }
    CHECK(*std::min_element(found.back().weights.begin(), found.back().weights.end()) >= 0);
    // Far away there is still an answer.
    const std::vector<DVec3> far = {{100, 0, 0}};
    CHECK(std::isfinite(locate(mesh, far).front().weights[0]));
  }

  TEST_CASE("places are found beside a spike of a hundred kilometers") {
    TetrahedralMesh mesh = filled(test::make_cube(Real(0.5)), 0.25);
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), {{0, 0, 2}, {1e-3, 0, 2}, {0, 1e-3, 2}, {1e5, 1e5, 1e5}});
    mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    const std::vector<DVec3> places = {{0.1, 0.2, 0.3}};
    const auto [tetrahedron, weights] = locate(mesh, places).front();
    CHECK(tetrahedron + 1 < mesh.tetrahedra.size());
    CHECK(*std::min_element(weights.begin(), weights.end()) >= 0);
  }

  TEST_CASE("what is no solid, or no cell, is refused with one clear line") {
    MeshDesc open = test::make_cube(Real(0.5));
    open.triangles.pop_back();
    CHECK_FALSE(fill_solid(open, 0.1).has_value());
    const MeshDesc cube = test::make_cube(Real(0.5));
    for (const double cell : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-9}) {
      const auto result = fill_solid(cube, cell);
      REQUIRE_FALSE(result.has_value());
      CHECK(result.error().where == "cell");
    }
    MeshDesc flat = cube;
    for (Vec3& p : flat.positions) p.y = Real(0);
    CHECK_FALSE(fill_solid(flat, 0.1).has_value());
  }
}

}  // namespace hooke::geometry
