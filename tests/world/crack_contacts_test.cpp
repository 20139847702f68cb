/// Cloth that is cut or torn and touches itself: the sides of a crack never pass each other.

#include "validation/crossings.h"
#include "world/make.h"

#include <cstddef>
#include <cstdint>

namespace hooke {

using namespace test;

namespace {

std::size_t crossings_of(const World& world, ClothId cloth) {
  Surfaces surfaces;
  for (std::size_t i = 0; i < world.positions(cloth).size(); ++i)
    surfaces.points.push_back(world.positions(cloth)[i]);
  surfaces.triangles = world.triangles(cloth);
  return count_crossings(surfaces).crossing;
}

/// A level sheet of 1 m that touches itself.
ClothDesc sheet() {
  return {.columns = 21,
          .rows = 21,
          .row_direction = {0, 0, 1},
          .thickness = Real(0.01),
          .stretch_stiffness = 200,
          .shear_stiffness = 40,
          .damping = Real(0.05),
          .tethers = false,
          .self_contact = true};
}

/// A world with gravity and a ball below the middle of the sheet.
World over_a_ball() {
  WorldDesc setting = sleepless_space(8);
  setting.gravity = {0, -10, 0};
  World world = make_world(setting);
  take(world.add_body({.shape = Shape::sphere(Real(0.3)), .position = {0.5, -0.35, 0.5}}));
  return world;
}

}  // namespace

TEST_SUITE("world/crack_contacts") {
  TEST_CASE("the sides of a cut through a sheet on a ball do not cross") {
    World world = over_a_ball();
    const ClothId cloth = take(world.add_cloth(sheet()));
    for (int i = 0; i < 120; ++i) {
      run(world, 1);
      if (i >= 20 && i < 40) {
        const double x = -0.05 + (i - 20) * 0.06;
        take(world.cut({.from = {DVec3{x, -2, 0.4877}, DVec3{x, 2, 0.4877}},
                        .to = {DVec3{x + 0.06, -2, 0.4877}, DVec3{x + 0.06, 2, 0.4877}}}));
      }
      CHECK(crossings_of(world, cloth) == 0);
    }
    CHECK(world.splits(cloth).size() > 15);
  }

  TEST_CASE("the pieces of a sheet that is torn over a ball do not cross") {
    World world = over_a_ball();
    ClothDesc desc = sheet();
    desc.tear_strain = Real(0.05);
    for (std::uint32_t i = 0; i < 21; ++i) {
      desc.pins.push_back({.point = i});
      desc.pins.push_back(
          {.point = 420 + i,
           .motion = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {0, 0, Real(0.5)}}});
    }
    const ClothId cloth = take(world.add_cloth(desc));
    for (int i = 0; i < 120; ++i) {
      run(world, 1);
      CHECK(crossings_of(world, cloth) == 0);
    }
    CHECK(world.splits(cloth).size() > 100);
  }
}

}  // namespace hooke
