#include "hooke/geometry.h"

#include "constants.h"
#include "geometry/mesh/bvh.h"
#include "geometry/mesh/simplify.h"
#include "geometry/mesh/winding_number.h"
#include "geometry/meshes.h"
#include "geometry/solid/surface_nets.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <utility>
#include <vector>

namespace hooke {

namespace {

SolidRemesh remeshed(const MeshDesc& mesh, double voxel) {
  Result<SolidRemesh> result = remesh_solid(mesh, Real(voxel));
  if (!result) FAIL(result.error().where << ": " << result.error().message);
  REQUIRE(geometry::validate_solid(result.value().mesh).has_value());
  return std::move(result).value();
}

double volume_of(const MeshDesc& mesh) {
  return geometry::compute_signed_volume(mesh.positions, mesh.triangles);
}

/// The unit sphere without its triangles above this height.
MeshDesc open_sphere(Real height) {
  MeshDesc mesh = test::make_sphere(4);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.positions[t[0]].y + mesh.positions[t[1]].y + mesh.positions[t[2]].y > 3 * height;
  });
  return mesh;
}

}  // namespace

TEST_SUITE("geometry/solid_remesh") {
  TEST_CASE("the winding number is one inside a closed surface, none outside, and a half in an open mouth") {
    const MeshDesc sphere = test::make_sphere(4);
    const auto tree = geometry::build_winding_tree(sphere.positions, sphere.triangles);
    for (const double r : {0.0, 0.3, 0.7, 0.9})
      CHECK(geometry::winding_number(tree, {r, 0.1 * r, 0}) == doctest::Approx(1).epsilon(0.03));
    for (const double r : {1.1, 1.5, 4.0}) CHECK(std::abs(geometry::winding_number(tree, {0, r, 0})) < 0.03);
    // Half a sphere fills half of all directions about its center.
    const MeshDesc half = open_sphere(0);
    const auto open = geometry::build_winding_tree(half.positions, half.triangles);
    CHECK(geometry::winding_number(open, {}) == doctest::Approx(0.5).epsilon(0.05));
  }

  TEST_CASE("a closed sphere that is remeshed keeps its place and its volume") {
    const MeshDesc sphere = test::make_sphere(4);
    const SolidRemesh made = remeshed(sphere, 0.05);
    CHECK(volume_of(made.mesh) == doctest::Approx(volume_of(sphere)).epsilon(0.01));
    CHECK(double(made.moved_max) < 0.01);
    CHECK(double(made.bridged) < 0.01);
    CHECK(double(made.moved_mean) < 0.003);
  }

  TEST_CASE("a hole is closed, and the surface beside it stays where it was") {
    const SolidRemesh made = remeshed(open_sphere(Real(0.8)), 0.05);
    // A cap of height 0.2 is missing; its mouth is closed between flat and round.
    const double whole = 4.0 / 3 * test::kPi;
    const double cap = test::kPi * 0.04 * (1 - 0.2 / 3);
    CHECK(volume_of(made.mesh) > whole - cap - 0.06);
    CHECK(volume_of(made.mesh) < whole);
    CHECK(double(made.moved_mean) < 0.005);
    CHECK(double(made.bridged) > 0.1);  // The middle of the mouth is far from all that was given.
  }

  TEST_CASE("a sheet without a back becomes a plate of the thickness that is promised") {
    const MeshDesc sheet = test::make_grid(11, 11, Real(0.1));
    // Whether a layer of nodes lies in the sheet, where both sides are wound about a half, or beside it.
    for (const double voxel : {0.04, 0.037, 0.05}) {
      const SolidRemesh made = remeshed(sheet, voxel);
      CHECK(volume_of(made.mesh) == doctest::Approx(2 * 0.87 * voxel).epsilon(0.25));
      CHECK(double(made.moved_mean) == doctest::Approx(0.87 * voxel).epsilon(0.1));
      CHECK(double(made.moved_max) < voxel);
    }
  }

  TEST_CASE("triangles in any order that face any way, each with corners of its own, become a solid") {
    MeshDesc soup;
    std::mt19937 random(5);
    const MeshDesc torus = test::make_torus(Real(1), Real(0.4), 40, 20);
    for (const auto& [a, b, c] : torus.triangles) {
      const auto first = static_cast<std::uint32_t>(soup.positions.size());
      for (const std::uint32_t v : {a, b, c}) soup.positions.push_back(torus.positions[v]);
      if (random() % 3 == 0) {
        soup.triangles.push_back({first, first + 2, first + 1});
      } else {
        soup.triangles.push_back({first, first + 1, first + 2});
      }
    }
    const SolidRemesh made = remeshed(soup, 0.05);
    // The surface has a thickness, and nothing inside is hollow.
    CHECK(volume_of(made.mesh) > 0.98 * volume_of(torus));
    CHECK(volume_of(made.mesh) < 1.3 * volume_of(torus));
  }

  TEST_CASE("a mouth that is wound about twice is closed in its plane") {
    MeshDesc half = open_sphere(0);
    const auto count = static_cast<std::uint32_t>(half.positions.size());
    const MeshDesc other = half;
    for (const Vec3 p : other.positions) half.positions.push_back(Real(0.9) * p);
    for (const auto& [a, b, c] : other.triangles) half.triangles.push_back({a + count, b + count, c + count});
    CHECK(volume_of(remeshed(half, 0.05).mesh) == doctest::Approx(2 * test::kPi / 3).epsilon(0.1));
  }

  TEST_CASE("two balls that cross become one surface, and a cavity of a closed mesh stays") {
    MeshDesc balls = test::make_sphere(4);
    const auto count = static_cast<std::uint32_t>(balls.positions.size());
    const MeshDesc other = balls;
    for (const Vec3 p : other.positions) balls.positions.push_back(p + Vec3{1, 0, 0});
    for (const auto& [a, b, c] : other.triangles)
      balls.triangles.push_back({a + count, b + count, c + count});
    // Two unit balls a unit apart share a lens of 5 pi / 12.
    CHECK(volume_of(remeshed(balls, 0.05).mesh) ==
          doctest::Approx(8 * test::kPi / 3 - 5 * test::kPi / 12).epsilon(0.01));
    MeshDesc hollow = other;
    for (const Vec3 p : other.positions) hollow.positions.push_back(Real(0.5) * p);
    for (const auto& [a, b, c] : other.triangles)
      hollow.triangles.push_back({a + count, c + count, b + count});
    CHECK(volume_of(remeshed(hollow, 0.05).mesh) == doctest::Approx(4 * test::kPi / 3 * 7 / 8).epsilon(0.01));
  }

  TEST_CASE("nodes at random become a closed surface once they are well-composed") {
    std::mt19937 random(11);
    geometry::NodeGrid grid = {.counts = {20, 20, 20}, .spacing = 0.1};
    grid.value.assign(8000, 1.0);
    for (int z = 2; z < 18; ++z) {
      for (int y = 2; y < 18; ++y) {
        for (int x = 2; x < 18; ++x) grid.value[grid.index(x, y, z)] = random() % 4 == 0 ? -1.0 : 1.0;
      }
    }
    geometry::NodeGrid mended = grid;
    geometry::make_well_composed(mended, -0.5);
    CHECK_FALSE(geometry::validate_solid(geometry::make_surface_net(grid)).has_value());
    CHECK(geometry::validate_solid(geometry::make_surface_net(mended)).has_value());
  }

  TEST_CASE("what cannot be remeshed is refused with its reason") {
    const MeshDesc sphere = test::make_sphere(2);
    CHECK(remesh_solid({}, Real(0.1)).error().where.starts_with("mesh"));
    CHECK(remesh_solid(sphere, Real(0)).error().where == "voxel");
    CHECK(remesh_solid(sphere, Real(1e-4)).error().message.find("too small") != std::string::npos);
    CHECK(double(default_voxel(sphere)) == doctest::Approx(2.0 / 64).epsilon(0.01));
  }

  TEST_CASE("a fine sphere of a tenth of its triangles stays closed and round") {
    const MeshDesc sphere = test::make_sphere(5);
    const MeshDesc coarse = geometry::simplify(sphere, sphere.triangles.size() / 10);
    CHECK(coarse.triangles.size() <= sphere.triangles.size() / 10);
    REQUIRE(geometry::validate_solid(coarse).has_value());
    CHECK(volume_of(coarse) == doctest::Approx(volume_of(sphere)).epsilon(0.01));
    for (const Vec3 p : coarse.positions) CHECK(double(length(p)) == doctest::Approx(1).epsilon(0.02));
    // A mesh of few triangles is left as it is.
    CHECK(geometry::simplify(sphere, sphere.triangles.size()).positions == sphere.positions);
  }

  TEST_CASE("the flat faces of a remeshed cube become a few triangles and lose nothing") {
    const SolidRemesh fine = remeshed(test::make_cube(1), 0.1);
    const MeshDesc made = geometry::simplify(fine.mesh, 300);
    CHECK(geometry::validate_solid(made).has_value());
    CHECK(volume_of(made) == doctest::Approx(volume_of(fine.mesh)).epsilon(0.002));
  }

  TEST_CASE("the parts of a mesh of many triangles lie as near to it as those of few") {
    const MeshDesc torus = test::make_torus(Real(1), Real(0.3), 120, 60);  // 14 400 triangles.
    const auto parts = decompose_convex(torus, Real(0.02), 32);
    REQUIRE(parts.has_value());
    CHECK(parts.value().size() > 6);
    double sum = 0;
    for (const MeshDesc& part : parts.value()) sum += volume_of(part);
    CHECK(sum > 0.98 * volume_of(torus));
    CHECK(sum < 1.15 * volume_of(torus));
    double deepest = 0;  // Of all vertices, how far the one that is covered worst is from all parts.
    std::vector<geometry::WindingTree> trees;
    for (const MeshDesc& part : parts.value())
      trees.push_back(geometry::build_winding_tree(part.positions, part.triangles));
    for (const Vec3 p : torus.positions) {
      double least = 1;
      for (const geometry::WindingTree& tree : trees) {
        const bool is_inside = geometry::winding_number(tree, vector_cast<double>(p)) > 0.5;
        const auto closest = geometry::find_closest(tree.bvh, p);
        least = is_inside ? 0 : std::min(least, std::sqrt(static_cast<double>(closest->distance_squared)));
      }
      deepest = std::max(deepest, least);
    }
    CHECK(deepest < 0.004);
  }
}

}  // namespace hooke
