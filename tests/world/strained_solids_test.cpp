/// Stiff solids where something would strain them for nothing: a hook against a contact, corrections of
/// points that came too near, the gap of a cut. None of it makes energy or momentum.

#include "world/make.h"

namespace hooke {

using namespace test;

namespace {

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
