/// Jelly where it is hard to keep what touches apart: on knives, in stacks, and at a wall at a third of the
/// speed of its sound.

#include "robustness/judged_room.h"

#include <vector>

namespace hooke {

using namespace test;

namespace {

/// Jelly of the cases of IPC (Li et al. 2020).
SolidDesc soft(const Tetrahedra& shape, DVec3 at, double young_modulus) {
  SolidDesc desc = solid_of(shape, at);
  desc.young_modulus = static_cast<Real>(young_modulus);
  desc.poisson_ratio = Real(0.4);
  desc.thickness = Real(0.002);
  return desc;
}

/// An upright triangle, tip up, of a thickness.
MeshDesc knife(double height, double width, double thickness) {
  const auto h = static_cast<Real>(height);
  const auto w = static_cast<Real>(0.5 * width);
  const auto t = static_cast<Real>(0.5 * thickness);
  MeshDesc mesh;
  mesh.positions = {{-w, 0, t}, {w, 0, t}, {0, h, t}, {-w, 0, -t}, {w, 0, -t}, {0, h, -t}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
  return mesh;
}

}  // namespace

TEST_SUITE("robustness/jelly") {
  TEST_CASE("E-05: a mat of jelly that falls on nine knives drapes over them, and none goes in") {
    JudgedRoom room;
    room.add_ground();
    for (int i = 0; i < 9; ++i) {
      const DVec3 at = {0.2 * (i % 3 - 1) + 0.013, 0, 0.2 * (i / 3 - 1) + 0.007};
      const Quat turn = quaternion_about(Vec3{0, 1, 0}, static_cast<Real>(0.7 * i));
      // Hulls: of bodies with the triangles of a mesh, jelly knows only what its points touch.
      room.add_mesh({.position = at, .rotation = turn}, knife(0.3, 0.1, 0.002), ShapeKind::kHull);
    }
    const Tetrahedra shape = box_of_tetrahedra({14, 1, 14}, {Real(0.7), Real(0.04), Real(0.7)});
    const SolidId mat = room.add_cells(soft(shape, {0, 0.35, 0}, 2e4));
    const double start = room.world.measure().energy.total();
    const Verdict verdict = judge(room, 200, kFrame, 2);
    CHECK(verdict.crossing == 0);
    CHECK(verdict.least_volume > 0.3);
    CHECK(verdict.most_energy < 1.01 * start);
    CHECK(mean_of(room.world.positions(mat)).y > 0.2);
    CHECK(rms_of(room.world.velocities(mat)) < 0.5);
  }

  TEST_CASE("E-09: five cubes of jelly of 2 cm stand on each other, and of 1 m fall without crossing") {
    for (const double side : {0.02, 1.0}) {
      CAPTURE(side);
      JudgedRoom room;
      const auto s = static_cast<Real>(side);
      room.add_box({.position = {0, -side, 0}}, {10 * s, s, 10 * s});
      std::vector<SolidId> cubes;
      for (int i = 0; i < 5; ++i) {
        SolidDesc desc = soft(box_of_tetrahedra({2, 2, 2}, {s, s, s}), {0, side * (0.51 + 1.01 * i), 0}, 1e5);
        desc.thickness = s * Real(0.01);
        cubes.push_back(room.add_cells(desc));
      }
      const double start = room.world.measure().energy.total();
      const Verdict verdict = judge(room, 120, Real(0.025));
      CHECK(verdict.crossing == 0);
      CHECK(verdict.least_volume > 0.2);
      CHECK(verdict.most_energy < 1.01 * start);
      // A column of it under its own weight stands up to (7.84 E a^2 / 12 rho g)^(1/3) (Greenhill 1881):
      // 14 cm of sides of 2 cm, 1.9 m of sides of 1 m.
      const DVec3 top = mean_of(room.world.positions(cubes[4]));
      if (side < 0.1) CHECK(length(top - DVec3{0, 4.51 * side, 0}) < 0.05 * side);
    }
  }

  TEST_CASE(
      "B-27: a soft golf ball at 67 m/s is pressed flat by a wall and leaves it slower, never inside out") {
    JudgedRoom room;
    room.world = World::create({.gravity = {}, .wind = {.air_density = Real(0)}}).value();
    room.add_box({.position = {0, -0.1, 0}}, {Real(0.1), Real(0.1), Real(0.1)});
    SolidDesc desc = solid_of(ball_of_tetrahedra(6, Real(0.02)), {0, 0.021, 0});
    desc.young_modulus = Real(1e7);
    desc.poisson_ratio = Real(0.45);
    desc.density = Real(1150);
    desc.thickness = Real(0.0004);
    desc.velocity = {Real(0), Real(-67), Real(0)};
    const SolidId ball = room.add_cells(desc);
    const Measurement before = room.world.measure();
    const Verdict verdict = judge(room, 200, Real(2e-5));  // 4 ms
    CHECK(verdict.crossing == 0);
    CHECK(verdict.least_volume > 0);
    CHECK(verdict.most_energy < 1.001 * before.energy.total());
    const double rebound = -room.world.measure().momentum.y / before.momentum.y;
    CHECK(rebound > 0);
    CHECK(rebound < 1);
    CHECK(fastest_of(room.world, ball) < 67);
  }
}

}  // namespace hooke
