/// Cloth that lies on itself in many layers.

#include "robustness/judged_room.h"

namespace hooke {

using namespace test;

TEST_SUITE("robustness/cloth") {
  TEST_CASE(
      "E-02: a soft cloth of 625 points that is dropped on its edge folds on itself, and never crosses") {
    JudgedRoom room;
    room.world = World::create({.substeps = 1}).value();
    room.add_ground();
    ClothDesc desc = sheet(25, {});
    desc.width = desc.height = Real(1);
    desc.corner = {-0.5, 1.05, 0};
    desc.row_direction = {Real(0.02), Real(-1), Real(0.05)};
    desc.total_mass = Real(0.5);
    desc.stretch_stiffness = desc.shear_stiffness = 40;
    desc.damping = Real(0.1);
    desc.thickness = Real(0.006);
    const ClothId cloth = room.add(desc);
    const double start = room.world.measure().energy.total();
    const Verdict verdict = judge(room, 640, Real(1) / 480, 4);
    CHECK(verdict.crossing == 0);
    CHECK(verdict.most_energy < 1.01 * start);
    CHECK(rms_of(room.world.velocities(cloth)) < 0.1);
  }
}

}  // namespace hooke
