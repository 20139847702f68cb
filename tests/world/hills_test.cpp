#include "math/random.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace hooke {

using namespace test;

namespace {

double height_of_hills(double x, double z) {
  return 0.6 * std::sin(0.9 * x) * std::cos(0.7 * z);
}

/// 12 m x 12 m, in triangles of 20 cm.
MeshDesc make_hills() {
  constexpr std::uint32_t kCells = 60;
  MeshDesc hills;
  for (std::uint32_t i = 0; i <= kCells; ++i) {
    for (std::uint32_t j = 0; j <= kCells; ++j) {
      const double x = 0.2 * i - 6;
      const double z = 0.2 * j - 6;
      hills.positions.push_back({Real(x), Real(height_of_hills(x, z)), Real(z)});
    }
  }
  for (std::uint32_t i = 0; i < kCells; ++i) {
    for (std::uint32_t j = 0; j < kCells; ++j) {
      const std::uint32_t k = i * (kCells + 1) + j;
      const std::uint32_t next = k + kCells + 1;
      hills.triangles.push_back({k, k + 1, next + 1});
      hills.triangles.push_back({k, next + 1, next});
    }
  }
  return hills;
}

/// Six-sided, 90 cm long. Its triangle counts for nothing in a hull.
MeshDesc make_prism() {
  MeshDesc prism;
  for (int i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi / 3 * (i % 6);
    prism.positions.push_back(
        {Real(0.4 * std::cos(angle)), Real(0.4 * std::sin(angle)), i < 6 ? Real(-0.45) : Real(0.45)});
  }
  prism.triangles = {{0, 1, 2}};
  return prism;
}

/// How far corners of the hull at this pose are below the hills, away from their border [m].
double depth_in_hills(const MeshDesc& hull, const Pose& pose) {
  double deepest = 0;
  for (const Vec3& corner : hull.positions) {
    const DVec3 at = pose.position + vector_cast<double>(rotate(pose.rotation, corner));
    if (std::max(std::fabs(at.x), std::fabs(at.z)) < 5)
      deepest = std::max(deepest, height_of_hills(at.x, at.z) - at.y);
  }
  return deepest;
}

}  // namespace

TEST_SUITE("world/hills") {
  TEST_CASE("hulls that are pressed onto hills stay out of them") {
    // A flat side lies on dozens of triangles, most of them covered by others, some in a ring. With five
    // times their weight hulls that lose a contact are gone within a few steps.
    for (const int substeps : {4, 8}) {
      CAPTURE(substeps);
      World world = World::create({.substeps = substeps, .sleeping = false}).value();
      const ContactDesc rough = {.friction = Real(0.8)};
      const MeshId hills = take(world.add_mesh(make_hills()));
      take(world.add_body({.shape = Shape::of_mesh(hills), .contact = rough}));
      const MeshDesc prism = make_prism();
      const MeshId hull = take(world.add_mesh(prism));
      std::mt19937_64 random(7);
      std::vector<BodyId> bodies;
      for (int i = 0; i < 60; ++i) {
        const DVec3 place = random_vector(random);
        const DVec3 turn = random_vector(random);
        const double x = 4 * place.x;
        const double z = 4 * place.z;
        bodies.push_back(take(
            world.add_body({.kind = BodyKind::kDynamic,
                            .shape = Shape::hull_of(hull),
                            .position = {x, height_of_hills(x, z) + 0.5, z},
                            .rotation = normalize(Quat{Real(turn.x), Real(turn.y), Real(turn.z), Real(0.5)}),
                            .velocity = {Real(0), Real(-3), Real(0)},
                            .gravity_scale = Real(5),
                            .contact = rough,
                            .filter = {.category = 2, .mask = 1}})));  // hulls do not meet each other
      }
      run(world, 30);
      double deepest = 0;
      for (int step = 0; step < 60; ++step) {
        run(world, 1);
        for (const BodyId body : bodies) deepest = std::max(deepest, depth_in_hills(prism, world.pose(body)));
      }
      CHECK(deepest < (substeps == 4 ? 0.08 : 0.03));
    }
  }
}

}  // namespace hooke
