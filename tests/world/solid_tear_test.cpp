/// Solids that tear: at what stress, into what, and what is kept.

#include "constants.h"
#include "world/make.h"
#include "world/pieces.h"
#include "world/tear_bits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// A bar of 10 x 2 x 2 cells of 0.1 m along x, about the origin.
SolidDesc bar(Real modulus, std::optional<Real> strength) {
  return {.cells = {10, 2, 2},
          .size = {1, Real(0.2), Real(0.2)},
          .density = 1000,
          .young_modulus = modulus,
          .poisson_ratio = 0,
          .strength = strength};
}

/// Holds the one end of a bar and draws the other away, at a speed [m/s].
SolidDesc pulled(SolidDesc desc, double speed) {
  for (std::uint32_t i = 0; i < 11 * 3 * 3; ++i) {
    if (i % 11 == 0) desc.pins.push_back({.point = i});
    if (i % 11 == 10) {
      desc.pins.push_back({.point = i,
                           .motion = {.kind = MotionDesc::Kind::kConstantVelocity,
                                      .velocity = {static_cast<Real>(speed), 0, 0}}});
    }
  }
  return desc;
}

}  // namespace

TEST_SUITE("world/solid_tear") {
  TEST_CASE("a bar that is pulled tears at its stress, soft or stiff, and comes apart") {
    struct Case {
      Real modulus, strength;
      double speed;
    };
    // Strains of 0.2 after a second, and of 0.02 after 0.1 s; waves pass the bars in 0.3 s and 0.03 s.
    for (const Case& one : {Case{Real(1e4), Real(2e3), 0.2}, Case{Real(1e6), Real(2e4), 0.2}}) {
      World world = make_world(sleepless_space(8));
      const SolidId solid = take(world.add_solid(pulled(bar(one.modulus, one.strength), one.speed)));
      const auto mass = d(world.mass(solid));
      const std::size_t points = world.positions(solid).size();
      double first_at = 0;
      const double expected = d(one.strength / one.modulus) / one.speed;
      for (int i = 0; i < 150 * expected; ++i) {
        run(world, 1);
        for (const SolidTearEvent& tear : world.events().solid_tears) {
          if (first_at == 0) first_at = tear.time;
          CHECK(tear.solid == solid);
          CHECK(d(tear.stress) > 0.6 * d(one.strength));
          CHECK(world.splits(solid)[tear.added - points] == tear.point);
        }
      }
      CHECK(first_at > 0.5 * expected);  // Corners of a clamped end are stressed most.
      CHECK(first_at < 1.1 * expected);
      CHECK(count_pieces(world, solid) >= 2);
      CHECK(world.positions(solid).size() == points + world.splits(solid).size());
      CHECK(d(world.mass(solid)) == mass);
    }
  }

  TEST_CASE("a bar below its stress stays whole") {
    World world = make_world(sleepless_space(8));
    const SolidId solid = take(world.add_solid(pulled(bar(Real(1e4), Real(4e3)), 0.2)));
    run(world, 60);
    CHECK(world.splits(solid).empty());
  }

  TEST_CASE("a tear keeps momentum and makes no energy, soft or stiff") {
    for (const Real modulus : {Real(1e4), Real(1e6)}) {
      World world = make_world(sleepless_space(8));
      const SolidId solid = take(world.add_solid(bar(modulus, modulus * Real(0.05))));
      const PointView x = world.positions(solid);
      for (std::uint32_t i = 0; i < x.size(); ++i) {
        const auto pull = static_cast<Real>(x[i].x) * (modulus > Real(1e5) ? Real(10) : Real(3));
        REQUIRE(world.set_velocity(point(solid, i), {pull, 1, 0}).has_value());
      }
      const DVec3 before = world.measure().momentum;
      double energy = world.measure().energy.total();
      for (int i = 0; i < 60; ++i) {
        run(world, 1);
        const double now = world.measure().energy.total();
        CHECK(now < energy * 1.001);
        energy = std::max(energy, now);
      }
      CHECK(!world.splits(solid).empty());
      CHECK(length(world.measure().momentum - before) < 1e-5 * length(before));
    }
  }

  TEST_CASE("a pin, a hook and a tie follow the part that they hold") {
    World world = make_world(sleepless_space(8));
    const SolidId solid = take(world.add_solid(pulled(bar(Real(1e4), Real(1e3)), 0.3)));
    const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::sphere(Real(0.02)),
                                            .position = {0.02, 0.3, 0.01},
                                            .mass = Real(0.1)}));
    const HookId hook = take(world.add_hook({.a = {.point = point(solid, PointRef::kNearest)},
                                             .b = {.body = box},
                                             .anchor = {0.02, 0.03, 0.01}}));
    const RopeId rope = take(world.add_rope({.hook_point = {5, 0, 0}}));
    run(world, 150);
    CHECK(world.splits(solid).size() > 10);
    CHECK(world.hook_gap(hook) < Real(1e-3));
    CHECK(d(world.positions(solid)[10].x) == doctest::Approx(0.5 + 0.3 * 2.5).epsilon(1e-3));
    CHECK(d(world.positions(rope)[0].x) == doctest::Approx(5));
    REQUIRE(world.remove(solid));
    run(world, 2);
  }

  TEST_CASE("the same bits for any workers, and after a restoration in the middle of a tear") {
    check_bits_of_tear(
        16, [](int workers) { return make_world(sleepless_space(8, workers)); },
        [](World& world) {
          SolidDesc desc = pulled(bar(Real(1e4), Real(1e3)), 0.4);
          desc.self_contact = true;
          return take(world.add_solid(desc));
        });
  }

  TEST_CASE("what a solid must be to tear") {
    World world = make_world(sleepless_space(8));
    for (const Real bad : {Real(0), Real(-1), kRigid, std::numeric_limits<Real>::quiet_NaN()}) {
      const Result<SolidId> solid = world.add_solid({.strength = bad});
      REQUIRE(!solid.has_value());
      CHECK(solid.error().where == "solid.strength");
    }
    const Result<SolidId> matched =
        world.add_solid({.elasticity = SolidDesc::Elasticity::kShapeMatching, .strength = 10});
    REQUIRE(!matched.has_value());
    CHECK(matched.error().where == "solid.strength");
  }
}

}  // namespace hooke
