#include "hooke/bsp.h"
#include "hooke/geometry.h"

#include "geometry/meshes.h"
#include "world/make.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// A floor of 8 x 8 m whose upper side is outside, with a defect or without.
MeshDesc make_floor() {
  MeshDesc floor = test::make_grid(9, 9, 1);
  for (Vec3& p : floor.positions) p = {p.x - 4, 0, 4 - p.y};
  return floor;
}

struct Defect {
  const char* name;
  std::function<void(MeshDesc&)> spoil;
};

/// Adds a triangle with corners of its own.
void add_triangle(MeshDesc& mesh, Vec3 a, Vec3 b, Vec3 c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void add_copies(MeshDesc& mesh, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) mesh.triangles.push_back(mesh.triangles[i]);
}

void add_backs(MeshDesc& mesh) {
  for (std::size_t i = 60; i < 70; ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({a, c, b});
  }
}

void add_own_copies(MeshDesc& mesh) {
  for (std::size_t i = 50; i < 80; ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    add_triangle(mesh, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
  }
}

/// A third triangle at an edge, hanging down.
void add_branch(MeshDesc& mesh) {
  mesh.positions.push_back({0, -1, 0});
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  mesh.triangles.push_back({mesh.triangles[64][0], mesh.triangles[64][1], last});
}

/// Cuts one triangle, but not its neighbor.
void add_t_junction(MeshDesc& mesh) {
  const auto [a, b, c] = mesh.triangles[66];
  mesh.positions.push_back(Real(0.5) * (mesh.positions[a] + mesh.positions[b]));
  const auto middle = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  mesh.triangles[66] = {a, middle, c};
  mesh.triangles.push_back({middle, b, c});
}

/// What files hold that no one meant: none takes the floor away or puts anything above it.
std::vector<Defect> make_defects() {
  return {{"no area",
           [](MeshDesc& m) {
             add_triangle(m, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
           }},
          {"copies", [](MeshDesc& m) { add_copies(m, 0, 60); }},
          {"copies with corners of their own", add_own_copies},
          {"back to back", add_backs},
          {"an edge of three triangles", add_branch},
          {"a T-junction", add_t_junction},
          {"a point of no triangle",
           [](MeshDesc& m) {
             m.positions.push_back({0, 5, 0});
           }},
          {"far away", [](MeshDesc& m) {
             add_triangle(m, {50, 0, 50}, {51, 0, 50}, {50, 0, 49});
           }}};
}

/// 100 balls dropped on the floor at random places: where the lowest and the highest come to rest.
std::pair<double, double> heights_of_rest(const MeshDesc& floor) {
  World world = make_world();
  take(world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(floor)))}));
  std::mt19937 random(8);
  std::uniform_real_distribution<double> at(-3.5, 3.5);
  std::vector<BodyId> balls;
  for (int i = 0; i < 100; ++i) {
    BodyDesc ball = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.1))};
    const double x = at(random);
    // Each in a layer of its own would take long; what falls on another is pushed aside.
    ball.position = {x, 0.15 + 0.25 * (i % 4), at(random)};
    ball.contact.restitution = Real(0);
    ball.filter = {.category = 2, .mask = 1};
    balls.push_back(take(world.add_body(ball)));
  }
  run(world, 90);
  std::pair<double, double> heights = {1e9, -1e9};
  for (const BodyId ball : balls) {
    const double y = world.pose(ball).position.y;
    heights = {std::min(heights.first, y), std::max(heights.second, y)};
  }
  return heights;
}

/// What each of the ways into a solid says of a mesh: the error's place, or "good".
struct Verdicts {
  std::string repair, tree, combination, parts, world;
};

Verdicts verdicts_of(const MeshDesc& mesh) {
  const auto of = [](const auto& result) { return result ? std::string("good") : result.error().where; };
  World world = make_world();
  return {of(repair_solid(mesh)), of(build_bsp(mesh)),
          of(combine_solids(mesh, test::make_cube(3), SolidOperation::kUnion)),
          of(decompose_convex(mesh, Real(0.05), 8)), of(world.add_mesh(mesh, MeshTree::kPlanes))};
}

bool names_triangle(const std::string& where) {
  return where.find("triangles") != std::string::npos;
}

}  // namespace

TEST_SUITE("world/bad_mesh") {
  TEST_CASE("a floor with any defect that mesh files have, or with all of them, holds what falls on it") {
    MeshDesc all = make_floor();
    for (const Defect& defect : make_defects()) {
      CAPTURE(defect.name);
      MeshDesc floor = make_floor();
      defect.spoil(floor);
      defect.spoil(all);
      const auto [lowest, highest] = heights_of_rest(floor);
      CHECK(lowest == doctest::Approx(0.1).epsilon(1e-2));
      CHECK(highest == doctest::Approx(0.1).epsilon(1e-2));
    }
    const auto [lowest, highest] = heights_of_rest(all);
    CHECK(lowest == doctest::Approx(0.1).epsilon(1e-2));
    CHECK(highest == doctest::Approx(0.1).epsilon(1e-2));
  }

  TEST_CASE(
      "a mesh that is open, branched, crossing, flat, empty or not finite is refused wherever a solid is "
      "needed") {
    const MeshDesc cube = test::make_cube(1);
    MeshDesc open = cube;
    open.triangles.pop_back();
    MeshDesc branched = cube;
    branched.positions.push_back({3, 0, 0});
    branched.triangles.push_back({cube.triangles[0][0], cube.triangles[0][1], 8});
    MeshDesc crossing = cube;
    for (const auto& t : cube.triangles) crossing.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    for (const Vec3 p : cube.positions)
      crossing.positions.push_back(p + Vec3{Real(0.5), Real(0.25), Real(0.125)});
    for (const MeshDesc& mesh : {open, branched, crossing}) {
      const Verdicts verdicts = verdicts_of(mesh);
      for (const std::string& where :
           {verdicts.repair, verdicts.tree, verdicts.combination, verdicts.world}) {
        CAPTURE(where);
        CHECK(names_triangle(where));
      }
    }
    CHECK(names_triangle(verdicts_of(open).parts));

    MeshDesc flat = cube;
    for (Vec3& p : flat.positions) p.y = 0;
    MeshDesc bad = cube;
    bad.positions[3].z = std::numeric_limits<Real>::quiet_NaN();
    MeshDesc beyond = cube;
    beyond.triangles[5][1] = 8;
    World world = make_world();
    for (const MeshDesc& mesh : {bad, beyond}) CHECK_FALSE(world.add_mesh(mesh));
    MeshDesc twice = make_floor();
    twice.triangles[9][1] = twice.triangles[9][0];
    CHECK(world.add_mesh(twice).error().where == "mesh.triangles[9]");
    for (const MeshDesc& mesh : {MeshDesc{}, flat, bad, beyond}) {
      const Verdicts verdicts = verdicts_of(mesh);
      for (const std::string& where :
           {verdicts.repair, verdicts.tree, verdicts.combination, verdicts.parts, verdicts.world}) {
        CHECK(where != "good");
        CHECK_FALSE(where.empty());
      }
    }
  }

  TEST_CASE("a mesh that is flipped, double or inside out is mended and is then the same solid") {
    const MeshDesc cube = test::make_cube(1);
    MeshDesc inside_out = cube;
    for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
    MeshDesc doubled = cube;
    doubled.triangles.insert(doubled.triangles.end(), cube.triangles.begin(), cube.triangles.begin() + 4);
    MeshDesc flipped = cube;
    std::swap(flipped.triangles[7][0], flipped.triangles[7][1]);
    for (const MeshDesc& mesh : {inside_out, doubled, flipped}) {
      const auto repaired = repair_solid(mesh);
      REQUIRE(repaired);
      CHECK(repaired.value().mesh.triangles.size() == 12);
      const auto tree = build_bsp(repaired.value().mesh);
      REQUIRE(tree);
      CHECK(is_solid_at(tree.value(), {0.9, 0.9, 0.9}));
      CHECK_FALSE(is_solid_at(tree.value(), {1.1, 0, 0}));
    }
    // The tree mends by itself what leaves no doubt; one triangle that faces wrongly it names.
    CHECK(verdicts_of(inside_out).tree == "good");
    CHECK(verdicts_of(doubled).tree == "good");
    CHECK(names_triangle(verdicts_of(flipped).tree));
  }

  TEST_CASE("a ring with a corner pulled far out, through itself, falls as a body does") {
    World world = make_world();
    take(world.add_body({.shape = Shape::half_space(), .contact = {.restitution = Real(0.3)}}));
    MeshDesc ring = test::make_torus(1, Real(0.2), 12, 6);
    ring.positions[2].z = 64;
    const MeshId mesh = take(world.add_mesh(ring));
    const BodyId id = take(
        world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::of_mesh(mesh), .position = {0, 40, 0}}));
    // Its signed volume is positive, but has negative moments: it would speed up by itself. The tip meets the
    // floor with one point, and what turns about it with more.
    for (int i = 0; i < 600; ++i) {
      CHECK(world.step(Real(1) / 60).healthy());
      CHECK(length(world.velocity(id)) < 28.1);  // of a fall by 40 m
      CHECK(length(world.angular_velocity(id)) < 60);
    }
    CHECK(length(world.velocity(id)) < 1);
  }

  TEST_CASE("shapes without size are refused by name") {
    World world = make_world();
    const auto refused = [&](const Shape& shape) {
      const auto added = world.add_body({.shape = shape});
      return added ? std::string("accepted") : added.error().where;
    };
    for (const Real bad :
         {Real(0), Real(-1), std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()}) {
      CHECK(refused(Shape::sphere(bad)) == "body.shape.radius");
      CHECK(refused(Shape::box({1, bad, 1})) == "body.shape.half_extents.y");
      CHECK(refused(Shape::capsule(bad, 1)) == "body.shape.radius");
      CHECK(refused(Shape::capsule(1, bad)) == "body.shape.half_height");
      CHECK(refused(Shape::cylinder(1, bad)) == "body.shape.half_height");
      CHECK(refused(Shape::cone(bad, 1)) == "body.shape.radius");
    }
  }
}

}  // namespace hooke
