#include "geometry/meshes.h"
#include "world/make.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// A ball with bumps and dents of up to a third of its radius of 1 m.
MeshDesc make_star() {
  MeshDesc star = test::make_sphere(3);
  std::mt19937 random(5);
  std::uniform_real_distribution<Real> radius(Real(0.67), Real(1));
  for (Vec3& p : star.positions) p = radius(random) * p;
  return star;
}

BodyId add_mesh_body(World& world, const MeshDesc& mesh, MeshTree tree) {
  BodyDesc body;
  body.shape = Shape::of_mesh(take(world.add_mesh(mesh, tree)));
  body.contact.friction = Real(0);
  return take(world.add_body(body));
}

/// Two slopes of 80 degrees that meet in an edge along z at y = 1, on a flat bottom.
MeshDesc make_knife() {
  const Real half = Real(1 / 5.671281819617709);  // 1 m / tan 80 degrees
  return {
      .positions = {{-half, 0, -1}, {half, 0, -1}, {0, 1, -1}, {-half, 0, 1}, {half, 0, 1}, {0, 1, 1}},
      .triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
}

}  // namespace

TEST_SUITE("world/mesh_tree") {
  TEST_CASE("20 000 rays from outside meet the same place by planes as by boxes") {
    World by_boxes = make_world();
    World by_planes = make_world();
    const MeshDesc star = make_star();
    add_mesh_body(by_boxes, star, MeshTree::kBoxes);
    add_mesh_body(by_planes, star, MeshTree::kPlanes);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(-1, 1);
    const auto vector = [&](double size) {
      const double x = at(random);
      const double y = at(random);
      return DVec3{size * x, size * y, size * at(random)};
    };
    int hits = 0;
    int same_triangle = 0;
    for (int i = 0; i < 20000; ++i) {
      const double side = at(random) < 0 ? 2.0 : -2.0;
      const DVec3 from = vector(1) + DVec3{0, 0, side};
      const DVec3 motion = vector(1) - from;
      const auto a = take(by_boxes.cast_ray(from, motion));
      const auto b = take(by_planes.cast_ray(from, motion));
      REQUIRE(a.has_value() == b.has_value());
      if (!a) continue;
      ++hits;
      REQUIRE(std::abs(a->distance - b->distance) < 3e-8);
      REQUIRE(a->body.slot == b->body.slot);
      same_triangle += a->triangle == b->triangle && dot(a->normal, b->normal) > Real(0.999999);
    }
    CHECK(hits > 10000);
    CHECK(same_triangle >= hits - 2);  // a ray may meet the edge of two
  }

  TEST_CASE("a ray that begins in a mesh by planes meets it at once, by boxes where it leaves") {
    for (const MeshTree tree : {MeshTree::kBoxes, MeshTree::kPlanes}) {
      World world = make_world();
      add_mesh_body(world, test::make_cube(1), tree);
      const bool solid = tree == MeshTree::kPlanes;
      const auto hit = take(world.cast_ray({0, 0.25, 0.125}, {4, 0, 0}));
      REQUIRE(hit);
      CHECK(hit->distance == doctest::Approx(solid ? 0 : 1));
      CHECK(hit->normal == (solid ? Vec3{-1, 0, 0} : Vec3{1, 0, 0}));
      CHECK(take(world.is_ray_blocked({0, 0.25, 0.125}, {0.5, 0, 0})) == solid);
    }
  }

  TEST_CASE("the closest point of a mesh by planes has a depth inside") {
    for (const MeshTree tree : {MeshTree::kBoxes, MeshTree::kPlanes}) {
      World world = make_world();
      add_mesh_body(world, test::make_cube(1), tree);
      const auto near = take(world.find_closest({0.125, 0.75, 0.25}, 5));
      REQUIRE(near);
      CHECK(near->distance == doctest::Approx(tree == MeshTree::kPlanes ? -0.25 : 0.25));
      CHECK(length(near->point - DVec3{0.125, 1, 0.25}) < 1e-6);
      CHECK(near->normal.y == doctest::Approx(tree == MeshTree::kPlanes ? 1 : -1));
      const auto outside = take(world.find_closest({0.125, 1.5, 0.25}, 5));
      CHECK(outside->distance == doctest::Approx(0.5));
      CHECK(outside->normal.y == doctest::Approx(1));
    }
  }

  TEST_CASE("a point deep in a mesh comes out of it by planes, and is seen to be in it") {
    for (const MeshTree tree : {MeshTree::kBoxes, MeshTree::kPlanes}) {
      WorldDesc still = test::empty_space();
      World world = make_world(still);
      add_mesh_body(world, test::make_cube(1), tree);
      const ParticlesId point =
          take(world.add_particles({.particles = {{.position = {0.25, 0.5, 0.125}, .radius = Real(0.01)}}}));
      const bool solid = tree == MeshTree::kPlanes;
      CHECK(world.measure().largest_penetration == doctest::Approx(solid ? 0.51 : 0));
      run(world, 120);
      // Straight up, the shortest way.
      CHECK(world.positions(point)[0].y == doctest::Approx(solid ? 1.01 : 0.5).epsilon(1e-3));
      CHECK(world.positions(point)[0].x == doctest::Approx(0.25).epsilon(1e-3));
    }
  }

  TEST_CASE("points come to rest on a step at the same height by planes as by boxes") {
    std::vector<std::vector<double>> heights;
    for (const MeshTree tree : {MeshTree::kBoxes, MeshTree::kPlanes}) {
      World world = make_world();
      add_mesh_body(world, test::make_ell(2), tree);  // 2 m high up to x = 1 m, 1 m high beyond
      ParticlesDesc desc;
      for (int i = 0; i < 14; ++i)
        desc.particles.push_back({.position = {0.1 + 0.13 * i, 2.5, 0.1 * i - 0.7}, .radius = Real(0.02)});
      const ParticlesId points = take(world.add_particles(desc));
      run(world, 180);
      heights.emplace_back();
      for (int i = 0; i < 14; ++i)
        heights.back().push_back(world.positions(points)[static_cast<std::size_t>(i)].y);
      CHECK(world.measure().largest_penetration < 1e-4);
    }
    CHECK(heights[0].front() != doctest::Approx(heights[0].back()));
    for (std::size_t i = 0; i < 14; ++i) {
      CAPTURE(i);
      CHECK(heights[1][i] == doctest::Approx(heights[0][i]).epsilon(1e-6));
    }
  }

  TEST_CASE("a point that falls on a sharp edge stays outside by planes") {
    for (const double x : {1e-3, -1e-3, 5e-3, -5e-3, 0.02, -0.02}) {
      World world = make_world();
      add_mesh_body(world, make_knife(), MeshTree::kPlanes);
      const ParticlesId point =
          take(world.add_particles({.particles = {{.position = {x, 1.2, 0.1}, .radius = Real(0.01)}}}));
      CAPTURE(x);
      for (int i = 0; i < 30; ++i) {
        run(world, 1);
        CHECK(world.measure().largest_penetration < 2e-4);
      }
      // Down the side it began over.
      CHECK(world.positions(point)[0].x * x > 0);
      CHECK(world.positions(point)[0].y < 0.7);
    }
  }

  TEST_CASE("a mesh that is no solid has no planes, and the error says why") {
    World world = make_world();
    MeshDesc open = test::make_cube(1);
    open.triangles.pop_back();
    CHECK(world.add_mesh(open));
    const auto refused = world.add_mesh(open, MeshTree::kPlanes);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().where == "mesh.triangles[0]");
    CHECK(refused.error().message.find("has an edge without a neighbor") == 0);
    MeshDesc bad = test::make_cube(1);
    bad.positions[3].y = std::numeric_limits<Real>::quiet_NaN();
    CHECK_FALSE(world.add_mesh(bad, MeshTree::kPlanes));
    CHECK_FALSE(world.add_mesh({}, MeshTree::kPlanes));
  }
}

}  // namespace hooke
