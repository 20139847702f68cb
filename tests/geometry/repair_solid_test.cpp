#include "hooke/geometry.h"

#include "geometry/mesh/contact_mesh.h"
#include "geometry/mesh/mesh_clean.h"
#include "geometry/meshes.h"
#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <string>
#include <utility>
#include <vector>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::repair_solid;
using hooke::SolidRepair;
using hooke::Vec3;
using hooke::geometry::compute_signed_volume;

namespace {

using Numbers = std::vector<std::uint32_t>;

SolidRepair repaired(const MeshDesc& mesh) {
  auto result = repair_solid(mesh);
  REQUIRE(result.has_value());
  // What comes out is good enough for contact.
  REQUIRE(hooke::geometry::make_contact_mesh(result.value().mesh).has_value());
  return std::move(result).value();
}

std::string refusal_of(const MeshDesc& mesh) {
  const auto result = repair_solid(mesh);
  REQUIRE_FALSE(result.has_value());
  CHECK(result.error().message.find('\n') == std::string::npos);
  return result.error().message;
}

double volume_of(const MeshDesc& mesh) {
  return compute_signed_volume(mesh.positions, mesh.triangles);
}

void append(MeshDesc& mesh, const MeshDesc& other, Vec3 shift) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back(p + shift);
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// Every triangle with corners of its own, a little beside each other.
MeshDesc soup_of(const MeshDesc& mesh, double gap) {
  std::mt19937_64 random(1);
  MeshDesc soup;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) {
      const DVec3 aside = gap * hooke::test::random_vector(random);
      soup.positions.push_back(mesh.positions[v] + hooke::vector_cast<Real>(aside));
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

const MeshDesc kCube = hooke::test::make_cube(1);

}  // namespace

TEST_SUITE("geometry/repair_solid") {
  TEST_CASE("a good solid comes back as it is") {
    for (const MeshDesc& mesh : {kCube, hooke::test::make_ell(1), hooke::test::make_sphere(2),
                                 hooke::test::make_torus(1, Real(0.3), 12, 7)}) {
      const SolidRepair repair = repaired(mesh);
      CHECK(repair.mesh.positions == mesh.positions);
      CHECK(repair.mesh.triangles == mesh.triangles);
      CHECK(repair.points_dropped == 0);
      CHECK(repair.degenerate.empty());
      CHECK(repair.duplicate.empty());
      CHECK(repair.turned.empty());
    }
  }

  TEST_CASE("triangles that share no vertex are welded") {
    const SolidRepair repair = repaired(soup_of(kCube, 1e-7));
    CHECK(repair.mesh.positions.size() == 8);
    CHECK(repair.points_dropped == 28);
    CHECK(volume_of(repair.mesh) == doctest::Approx(8));
  }

  TEST_CASE("points of no triangle go, however far or bad they are") {
    MeshDesc mesh = kCube;
    mesh.positions.insert(mesh.positions.begin(), {Real(1e30), std::nanf(""), 0});
    for (auto& t : mesh.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
    CHECK(repaired(mesh).points_dropped == 1);
  }

  TEST_CASE("triangles without height and with a corner twice go") {
    MeshDesc mesh = kCube;
    mesh.triangles.insert(mesh.triangles.begin(), {3, 3, 5});
    mesh.positions.push_back(Real(0.5) * (mesh.positions[0] + mesh.positions[1]));
    mesh.triangles.push_back({0, 8, 1});
    const SolidRepair repair = repaired(mesh);
    CHECK(repair.degenerate == Numbers{0, 13});
    CHECK(repair.mesh.triangles == kCube.triangles);
    CHECK(repair.given.front() == 1);
  }

  TEST_CASE("a triangle that is there twice stays once, on its front or its back") {
    for (const bool is_turned : {false, true}) {
      MeshDesc mesh = kCube;
      auto copy = mesh.triangles[4];
      if (is_turned) std::swap(copy[0], copy[1]);
      mesh.triangles.push_back(copy);
      const SolidRepair repair = repaired(mesh);
      CHECK(repair.duplicate == Numbers{12});
      CHECK(repair.mesh.triangles == kCube.triangles);
    }
    MeshDesc three = kCube;
    three.triangles.insert(three.triangles.end(), {three.triangles[0], three.triangles[0]});
    CHECK(repaired(three).duplicate == Numbers{12, 13});
  }

  TEST_CASE("two triangles back to back, which enclose nothing, go together") {
    MeshDesc mesh = kCube;
    mesh.positions.push_back({3, 3, 3});
    mesh.triangles.push_back({0, 1, 8});  // a fin at an edge of the cube
    mesh.triangles.push_back({1, 0, 8});
    const SolidRepair repair = repaired(mesh);
    CHECK(repair.duplicate == Numbers{12, 13});
    CHECK(repair.mesh.triangles == kCube.triangles);
    CHECK(repair.points_dropped == 1);
  }

  TEST_CASE("flipped triangles and solids inside out are turned") {
    MeshDesc some = kCube;
    std::swap(some.triangles[2][0], some.triangles[2][1]);
    std::swap(some.triangles[7][0], some.triangles[7][1]);
    CHECK(repaired(some).turned == Numbers{2, 7});
    CHECK(volume_of(repaired(some).mesh) == doctest::Approx(8));
    MeshDesc all = kCube;
    for (auto& t : all.triangles) std::swap(t[0], t[1]);
    CHECK(repaired(all).turned.size() == 12);
    CHECK(volume_of(repaired(all).mesh) == doctest::Approx(8));
    // A mirror, as the negative scale of a node makes it.
    MeshDesc mirrored = hooke::test::make_ell(1);
    for (auto& p : mirrored.positions) p.x = -p.x;
    CHECK(volume_of(repaired(mirrored).mesh) == doctest::Approx(6));
  }

  TEST_CASE("a cavity stays a cavity") {
    MeshDesc shell = hooke::test::make_cube(2);
    MeshDesc hole = kCube;
    for (auto& t : hole.triangles) std::swap(t[0], t[1]);
    append(shell, hole, {});
    const SolidRepair repair = repaired(shell);
    CHECK(repair.turned.empty());
    CHECK(volume_of(repair.mesh) == doctest::Approx(64 - 8));
  }

  TEST_CASE("an open surface is refused by the names of the triangles at the hole") {
    MeshDesc mesh = kCube;
    mesh.triangles.erase(mesh.triangles.begin() + 3);  // 1, 7, 5 of the side +x
    const std::string text = refusal_of(mesh);
    CHECK(text.find("triangles 2, ") == 0);
    CHECK(text.find("the surface is open") != std::string::npos);
    CHECK(refusal_of(hooke::test::make_grid(9, 9, 1)).find(" more have an edge without") !=
          std::string::npos);
  }

  TEST_CASE("an edge with more than two triangles is refused by their names") {
    MeshDesc mesh = kCube;
    append(mesh, kCube, {2, 2, 0});  // two cubes that share an edge
    const std::string text = refusal_of(mesh);
    CHECK(text.find("more than two triangles") != std::string::npos);
    CHECK(std::count(text.begin(), text.end(), ',') == 2);  // four of them
  }

  TEST_CASE("a closed surface without an inside is refused") {
    // The projective plane in six points: every edge has two triangles, and they cannot agree.
    MeshDesc mesh;
    mesh.positions = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, Real(0.2)}, {0, -1, Real(0.3)}, {1, 1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                      {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
    CHECK(refusal_of(mesh).find("there is no outside") != std::string::npos);
  }

  TEST_CASE("a surface that cuts itself is refused by the names of the triangles that cross") {
    MeshDesc two = kCube;
    append(two, hooke::test::make_cube(Real(0.5)), {1, Real(0.1), Real(0.2)});
    CHECK(refusal_of(two).find("cross each other") != std::string::npos);
    // A corner of a cube pulled through the opposite side.
    MeshDesc pulled = kCube;
    pulled.positions[7] = {Real(-2), Real(0.1), Real(0.2)};
    CHECK(refusal_of(pulled).find("cross each other") != std::string::npos);
    // The same solid twice lies on itself.
    MeshDesc beside = kCube;
    append(beside, kCube, {3, 0, 0});
    CHECK(volume_of(repaired(beside).mesh) == doctest::Approx(16));
  }

  TEST_CASE("what has no volume is refused") {
    MeshDesc sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
    CHECK(refusal_of(sheet) == "no triangle with an area is left");
    MeshDesc pillow;  // a tetrahedron pressed flat
    pillow.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    pillow.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    CHECK_FALSE(repair_solid(pillow).has_value());
    CHECK(refusal_of(MeshDesc{}) == "no triangle with an area is left");
    MeshDesc point = kCube;
    for (auto& p : point.positions) p = {1, 2, 3};
    CHECK(refusal_of(point) == "no triangle with an area is left");
    MeshDesc flat = kCube;  // a scale of zero
    for (auto& p : flat.positions) p.y = 0;
    CHECK_FALSE(repair_solid(flat).has_value());
  }

  TEST_CASE("numbers that are none are refused by the names of the triangles") {
    for (const Real bad : {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()}) {
      MeshDesc mesh = kCube;
      mesh.positions[2].y = bad;
      CHECK(refusal_of(mesh).find("a coordinate that is not finite") != std::string::npos);
    }
    MeshDesc mesh = kCube;
    mesh.triangles[5] = {0, 1, 800};
    CHECK(refusal_of(mesh) == "triangle 5 names a vertex beyond the positions");
    mesh.triangles[9] = {0, 0xFFFFFFFF, 8};
    CHECK(refusal_of(mesh) == "triangles 5 and 9 name a vertex beyond the positions");
  }

  TEST_CASE("everything at once, in any order of triangles") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 50; ++i) {
      MeshDesc mesh = soup_of(hooke::test::make_ell(1), 1e-7);
      mesh.triangles.push_back(mesh.triangles[random() % mesh.triangles.size()]);  // twice
      mesh.triangles.push_back({4, 4, 9});                                         // no triangle
      mesh.positions.push_back({50, 50, 50});                                      // of no triangle
      for (auto& t : mesh.triangles) {
        if (random() % 3 == 0) std::swap(t[0], t[1]);
      }
      for (std::size_t k = mesh.triangles.size() - 1; k > 0; --k) {
        std::swap(mesh.triangles[k], mesh.triangles[random() % (k + 1)]);
      }
      const SolidRepair repair = repaired(mesh);
      CHECK(volume_of(repair.mesh) == doctest::Approx(6));
      CHECK(repair.mesh.triangles.size() == 20);
      CHECK(repair.duplicate.size() == 1);
      CHECK(repair.degenerate.size() == 1);
    }
  }

  TEST_CASE("triangles that share corners cross only where they have more in common") {
    using hooke::geometry::MeshView;
    using hooke::geometry::triangles_cross;
    const std::vector<DVec3> p = {{0, 0, 0}, {4, 0, 0},  {0, 4, 0},  {0, 0, 4}, {1, 1, 0},
                                  {4, 4, 0}, {-1, 1, 0}, {2, 2, -1}, {1, 1, 1}};
    const std::vector<hooke::geometry::Triangle> t = {{0, 1, 2}, {0, 1, 3}, {0, 1, 5}, {1, 0, 4},
                                                      {0, 6, 3}, {0, 7, 8}, {2, 1, 0}};
    const MeshView mesh = {p, t};
    CHECK_FALSE(triangles_cross(mesh, 0, 1));  // a shared edge, at an angle
    CHECK(triangles_cross(mesh, 0, 3));        // a shared edge, folded back on it
    CHECK(triangles_cross(mesh, 0, 2));        // the same, only partly on it
    CHECK_FALSE(triangles_cross(mesh, 0, 4));  // a shared corner
    CHECK(triangles_cross(mesh, 0, 5));        // a shared corner, and through it
    CHECK(triangles_cross(mesh, 0, 6));        // the same three corners
    CHECK_FALSE(triangles_cross(mesh, 3, 4));
  }
}
