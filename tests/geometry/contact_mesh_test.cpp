#include "geometry/mesh/contact_mesh.h"

#include "geometry/closest.h"
#include "geometry/meshes.h"
#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::geometry::closest_on_solid;
using hooke::geometry::ContactMesh;
using hooke::geometry::make_contact_mesh;
using hooke::geometry::Search;
using hooke::geometry::SolidPoint;
using hooke::geometry::SurfaceFeature;

namespace {

ContactMesh solid(const MeshDesc& mesh) {
  auto result = make_contact_mesh(mesh);
  REQUIRE(result.has_value());
  return std::move(result).value();
}

std::string where_of(const MeshDesc& mesh) {
  const auto result = make_contact_mesh(mesh);
  REQUIRE_FALSE(result.has_value());
  return result.error().where;
}

}  // namespace

TEST_SUITE("geometry/contact_mesh") {
  TEST_CASE("distances to a cube, inside and outside, and what is nearest") {
    const ContactMesh cube = solid(hooke::test::make_cube(1));
    struct Case {
      DVec3 p;
      double distance;
      SurfaceFeature feature;
    };
    const Case cases[] = {
        {{0.2, 3, 0.1}, 2, SurfaceFeature::kFace},
        {{0.2, 0.75, 0.1}, -0.25, SurfaceFeature::kFace},
        {{4, 5, 0.1}, 5, SurfaceFeature::kEdge},
        {{-2, -2, 2}, std::sqrt(3.0), SurfaceFeature::kVertex},
    };
    for (const Case& c : cases) {
      for (const Search search : {Search::kAll, Search::kTree}) {
        const SolidPoint place = closest_on_solid(cube, c.p, search);
        CHECK(place.signed_distance == doctest::Approx(c.distance));
        CHECK(place.feature == c.feature);
      }
    }
  }

  TEST_CASE("inside and outside of solids that are not convex are told right everywhere") {
    std::mt19937_64 random(1);
    const ContactMesh ell = solid(hooke::test::make_ell(1));
    const ContactMesh torus = solid(hooke::test::make_torus(1, Real(0.3), 64, 32));
    for (int i = 0; i < 5000; ++i) {
      const double x = 3 * hooke::test::signed_unit(random);
      const double y = 3 * hooke::test::signed_unit(random);
      const DVec3 p = {x, y, 2 * hooke::test::signed_unit(random)};
      const bool in_square = x > 0 && y > 0 && x < 2 && y < 2 && !(x > 1 && y > 1);
      const bool in_ell = in_square && std::fabs(p.z) < 1;
      REQUIRE((closest_on_solid(ell, p, Search::kTree).signed_distance < 0) == in_ell);
      const double from_ring = std::sqrt(x * x + p.z * p.z) - 1;
      const double exact = std::sqrt(from_ring * from_ring + y * y) - 0.3;
      REQUIRE(std::fabs(closest_on_solid(torus, p, Search::kTree).signed_distance - exact) < 0.01);
    }
  }

  TEST_CASE("a vertex with many thin triangles on one side is outside on the other side too") {
    // A wedge with its tip at (1, 0, 0), whose lower side is a fan of 20 triangles: the mean of the normals
    // there points down.
    MeshDesc wedge;
    wedge.positions = {{1, 0, 0}, {0, Real(0.05), 0}};
    for (int i = 0; i <= 20; ++i) wedge.positions.push_back({0, Real(-0.05), Real(0.1) * Real(i - 10)});
    wedge.triangles = {{0, 1, 22}, {0, 2, 1}};
    for (std::uint32_t i = 2; i < 22; ++i) {
      wedge.triangles.push_back({0, i + 1, i});
      wedge.triangles.push_back({1, i, i + 1});
    }
    const ContactMesh mesh = solid(wedge);
    const SolidPoint place = closest_on_solid(mesh, {1.01, 0.1, 0}, Search::kTree);
    CHECK(place.feature == SurfaceFeature::kVertex);
    CHECK(place.index == 0);
    CHECK(place.signed_distance == doctest::Approx(std::sqrt(0.01 * 0.01 + 0.1 * 0.1)).epsilon(1e-6));
  }

  TEST_CASE("the tree finds the same place as all triangles do, to the bit") {
    std::mt19937_64 random(2);
    const ContactMesh solids[] = {solid(hooke::test::make_cube(1)), solid(hooke::test::make_ell(1)),
                                  solid(hooke::test::make_torus(1, Real(0.3), 12, 7)),
                                  solid(hooke::test::make_sphere(3))};
    std::vector<std::uint32_t> by_tree;
    std::vector<std::uint32_t> by_all;
    for (const ContactMesh& mesh : solids) {
      for (int i = 0; i < 500; ++i) {
        DVec3 p = {2 * hooke::test::signed_unit(random), 0, 0};
        p.y = 2 * hooke::test::signed_unit(random);
        p.z = 2 * hooke::test::signed_unit(random);
        // Every other one at a place where several triangles are equally near.
        if (i % 2 == 1) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
        const SolidPoint a = closest_on_solid(mesh, p, Search::kAll);
        const SolidPoint b = closest_on_solid(mesh, p, Search::kTree);
        REQUIRE(a.triangle == b.triangle);
        REQUIRE(a.point == b.point);
        REQUIRE(a.signed_distance == b.signed_distance);
        REQUIRE(a.feature == b.feature);
        REQUIRE(a.index == b.index);
        const double reach = std::fabs(a.signed_distance) + 0.3;
        find_near_faces(mesh, p, reach, Search::kTree, by_tree);
        find_near_faces(mesh, p, reach, Search::kAll, by_all);
        REQUIRE(by_tree == by_all);
        REQUIRE(std::binary_search(by_all.begin(), by_all.end(), a.triangle));
      }
    }
  }

  TEST_CASE("edges are convex where the solid is less than half a space") {
    const ContactMesh ell = solid(hooke::test::make_ell(1));
    int convex = 0;
    for (const auto flag : ell.is_convex_edge) convex += flag;
    // Six edges on each lid and six between them, but for the one in the notch. Diagonals are flat.
    CHECK(convex == 17);
  }

  TEST_CASE("what is not the surface of a solid is refused by the name of a triangle") {
    MeshDesc open = hooke::test::make_cube(1);
    open.triangles.pop_back();
    CHECK(where_of(open).starts_with("mesh.triangles["));
    MeshDesc turned = hooke::test::make_cube(1);
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    CHECK(where_of(turned).starts_with("mesh.triangles["));
    MeshDesc inside_out = hooke::test::make_cube(1);
    for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
    CHECK(where_of(inside_out) == "mesh.triangles");
    MeshDesc flat = hooke::test::make_cube(1);
    // The two halves of a side become one half and a triangle without height.
    flat.positions.push_back(Real(0.5) * (flat.positions[0] + flat.positions[6]));
    flat.triangles[0] = {0, 4, 8};
    flat.triangles.insert(flat.triangles.begin() + 1, {4, 6, 8});
    flat.triangles.push_back({0, 8, 6});
    CHECK(where_of(flat) == "mesh.triangles[13]");
    MeshDesc not_finite = hooke::test::make_cube(1);
    not_finite.positions[2].y = std::nanf("");
    CHECK(where_of(not_finite) == "mesh.positions[2]");
    MeshDesc far = hooke::test::make_cube(1);
    for (auto& p : far.positions) p.x += Real(4e9);
    for (auto& p : far.positions) p.y *= Real(1e6), p.x += p.y;
    CHECK_FALSE(make_contact_mesh(far).has_value());
    CHECK(where_of(MeshDesc{}) == "mesh.triangles");
  }

  TEST_CASE("slivers have a normal") {
    MeshDesc needle = hooke::test::make_box({1, Real(1e-7), Real(1e-7)});
    const ContactMesh mesh = solid(needle);
    for (const DVec3& n : mesh.face_normals) CHECK(length(n) == doctest::Approx(1));
    CHECK(closest_on_solid(mesh, {0.1, 1, 0.2e-7}, Search::kTree).signed_distance == doctest::Approx(1));
  }
}
