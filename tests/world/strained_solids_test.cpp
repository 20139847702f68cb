/// Stiff solids where something would strain them for nothing: a hook against a contact, corrections of
/// points that came too near, the gap of a cut. None of it makes energy or momentum.

#include "world/make.h"

#include <algorithm>
#include <array>

namespace hooke {

using namespace test;

namespace {

constexpr Real kFrame = Real(1) / Real(60);

/// Runs for some frames, and returns the most energy that there was [J].
double most_energy(World& world, int frames) {
  double most = 0;
  for (int i = 0; i < frames; ++i) {
    REQUIRE(world.step(kFrame).healthy());
    most = std::max(most, world.measure().energy.total());
  }
  return most;
}

/// A plane across an axis, as the sweep of a blade through all that is within 1 m.
CutDesc cut_across(int axis, double at) {
  const auto place = [&](double a, double b) {
    return axis == 0 ? DVec3{at, a, b} : axis == 1 ? DVec3{a, at, b} : DVec3{a, b, at};
  };
  return {.from = {place(-1, -1), place(-1, 1)}, .to = {place(1, -1), place(1, 1)}};
}

/// 1 kg of 0.4 x 0.2 x 0.2 m that touches itself.
SolidDesc bar(Real young_modulus) {
  SolidDesc desc;
  desc.cells = {4, 2, 2};
  desc.size = {Real(0.4), Real(0.2), Real(0.2)};
  desc.total_mass = Real(1);
  desc.young_modulus = young_modulus;
  desc.self_contact = true;
  return desc;
}

}  // namespace

TEST_SUITE("world/strained_solids") {
  TEST_CASE("a jelly hooked to a free box that it touches meets it as an inelastic impact would") {
    // 1 kg at 3 m/s and 1 kg at rest: half of the energy stays if they move on together.
    for (const Real young_modulus : {Real(1e6), Real(1e8)}) {
      for (const double height :
           {-0.0005, 0.0001, 0.0005}) {  // of its foot above the box; its radius is 1 mm
        for (const double anchor : {0.0, 0.01}) {
          World world = make_world(sleepless_space(8));
          const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                                  .shape = Shape::box({Real(0.2), Real(0.15), Real(0.2)}),
                                                  .mass = Real(1)}));
          SolidDesc desc;
          desc.cells = {1, 2, 1};
          desc.size = {Real(0.24), Real(0.4), Real(0.16)};
          desc.position = {0, 0.35 + height, 0};
          desc.velocity = {0, -3, 0};
          desc.total_mass = Real(1);
          desc.thickness = Real(0.002);
          desc.young_modulus = young_modulus;
          desc.damping = Real(0.005);
          const SolidId jelly = take(world.add_solid(desc));
          take(world.add_hook({.a = {.body = box},
                               .b = {.point = point(jelly, PointRef::kNearest)},
                               .anchor = {0.05, 0.15 + anchor, 0.02},
                               .collide = true}));
          CHECK(most_energy(world, 30) < 0.6 * 4.5);
          CHECK(world.measure().momentum.y == doctest::Approx(-3).epsilon(1e-3));
        }
      }
    }
  }

  TEST_CASE("two yielding balls of up to 3 GPa that meet lose energy") {
    for (const Real young_modulus : {Real(3e8), Real(1e9), Real(3e9)}) {
      World world = make_world(sleepless_space(8));
      std::array<BodyId, 2> balls;
      for (int i = 0; i < 2; ++i) {
        const Real side = i == 0 ? Real(-1) : Real(1);
        balls[i] = take(world.add_body({.kind = BodyKind::kDynamic,
                                        .shape = Shape::sphere(Real(0.25)),
                                        .position = {0.6 * d(side), 0.03 * i, 0.02 * i},
                                        .velocity = {-3 * side, 0, 0},
                                        .mass = Real(1),
                                        .yields = YieldsDesc{.impulse = Real(0.1),
                                                             .cell = Real(0.15),
                                                             .young_modulus = young_modulus,
                                                             .freeze_after = 100}}));
      }
      CHECK(most_energy(world, 30) < 9 * 1.001);
      CHECK(world.soft_form(balls[0]) != SolidId{});
      CHECK(length(world.measure().momentum) < 3e-3);
    }
  }

  TEST_CASE("a bar that is cut into dice in free space keeps its momentum") {
    World world = make_world(sleepless_space(8));
    take(world.add_solid(bar(Real(1e5))));
    run(world, 1);
    for (int k = -1; k <= 1; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        take(world.cut(cut_across(axis, 0.003 + k * (axis == 0 ? 0.1 : 0.05))));
    }
    double most = 0;
    for (int i = 0; i < 60; ++i) {
      run(world, 1);
      most = std::max(most, length(world.measure().momentum));
    }
    CHECK(most < 1e-4);  // 4.4e-3 where corrections gave each side what its own cage allows
  }

  TEST_CASE("a cut through a solid of 100 MPa that touches itself strains it by nothing") {
    World world = make_world(sleepless_space(8));
    take(world.add_solid(bar(Real(1e8))));
    run(world, 3);
    const double before = world.measure().energy.elastic;
    take(world.cut(cut_across(0, 0)));
    CHECK(world.measure().energy.elastic < before + 1e-6);  // 0.77 J with the form of before
  }
}

}  // namespace hooke
