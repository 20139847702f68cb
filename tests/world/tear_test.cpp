/// Cloth that tears: where, into what, and what is kept.

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

WorldDesc space(int workers = 1) {
  WorldDesc desc = empty_space();
  desc.substeps = 8;
  desc.workers = workers;
  return desc;
}

/// A sheet of 11 x 11 points, 1 m wide, that is pulled apart at 1 m/s along x.
ClothDesc pulled(std::optional<Real> tear_strain) {
  ClothDesc desc = {.columns = 11,
                    .rows = 11,
                    .stretch_stiffness = 100,
                    .shear_stiffness = 20,
                    .damping = Real(0.05),
                    .tear_strain = tear_strain,
                    .tethers = false};
  for (std::uint32_t row = 0; row < 11; ++row) {
    desc.pins.push_back({.point = 11 * row});
    desc.pins.push_back({.point = 11 * row + 10,
                         .motion = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {1, 0, 0}}});
  }
  return desc;
}

}  // namespace

TEST_SUITE("world/tear") {
  TEST_CASE("a sheet that is pulled tears at its strain, across the pull, and comes apart") {
    World world = make_world(space());
    const ClothId cloth = take(world.add_cloth(pulled(Real(0.3))));
    const auto mass = d(world.mass(cloth));
    double first_at = 0;
    for (int i = 0; i < 120; ++i) {
      run(world, 1);
      for (const ClothTearEvent& tear : world.events().tears) {
        if (first_at == 0) first_at = tear.time;
        CHECK(tear.cloth == cloth);
        CHECK(d(tear.strain) > 0.6 * 0.3);
        CHECK(world.splits(cloth)[tear.added - 121] == tear.point);
      }
    }
    CHECK(first_at > 0.1);   // Rims are strained up to three times as much as the mean,
    CHECK(first_at < 0.32);  // which is 0.3 after 0.3 s.
    CHECK(count_pieces(world, cloth) >= 2);
    CHECK(world.triangles(cloth).size() == 200);
    CHECK(world.positions(cloth).size() == 121 + world.splits(cloth).size());
    CHECK(d(world.mass(cloth)) == doctest::Approx(mass).epsilon(1e-6));
    // What has come off the moving side swings back to its length.
    run(world, 300);
    CHECK(world.measure().largest_stretch < 0.6);
  }

  TEST_CASE("a sheet below its strain stays whole, and one without any never tears") {
    World world = make_world(space());
    const ClothId strong = take(world.add_cloth(pulled(Real(2))));
    const ClothId plain = take(world.add_cloth(pulled({})));
    run(world, 30);
    CHECK(world.splits(strong).empty());
    CHECK(world.splits(plain).empty());
  }

  TEST_CASE("a force per width is a strain times the stiffness") {
    std::array<std::uint64_t, 2> hashes = {};
    for (std::size_t k = 0; k < 2; ++k) {
      World world = make_world(space());
      ClothDesc desc = pulled({});
      if (k == 0) desc.tear_strain = Real(0.25);
      if (k == 1) desc.strength = 25;
      take(world.add_cloth(desc));
      run(world, 60);
      hashes[k] = world.state_hash();
    }
    CHECK(hashes[0] == hashes[1]);
  }

  TEST_CASE("a tear keeps momentum and makes no energy") {
    World world = make_world(space());
    ClothDesc desc = pulled(Real(0.2));
    desc.pins.clear();
    const ClothId cloth = take(world.add_cloth(desc));
    for (std::uint32_t i = 0; i < 121; ++i) {
      const auto x = static_cast<Real>(i % 11) / 10 - Real(0.5);
      REQUIRE(world.set_velocity(point(cloth, i), {30 * x, 1, 0}).has_value());
    }
    const DVec3 before = world.measure().momentum;
    double energy = world.measure().energy.total();
    for (int i = 0; i < 60; ++i) {
      run(world, 1);
      const double now = world.measure().energy.total();
      CHECK(now < energy * 1.001);
      energy = std::max(energy, now);
    }
    CHECK(!world.splits(cloth).empty());
    CHECK(length(world.measure().momentum - before) < 1e-5 * length(before));
  }

  TEST_CASE("a pin and a hook at a point that splits stay with it, and later objects move up") {
    World world = make_world(space());
    const ClothId cloth = take(world.add_cloth(pulled(Real(0.3))));
    RopeDesc hanging = {.hook_point = {5, 0, 0}, .direction = {0, -1, 0}};
    const RopeId rope = take(world.add_rope(hanging));
    const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::sphere(Real(0.02)),
                                            .position = {0.5, -0.5, 0},
                                            .mass = Real(0.01)}));
    const HookId hook = take(
        world.add_hook({.a = {.point = point(cloth, 60)}, .b = {.body = box}, .anchor = {0.5, -0.5, 0}}));
    const ClothId other = take(world.add_cloth({.columns = 3, .rows = 3, .corner = {9, 0, 0}}));
    run(world, 120);
    CHECK(world.splits(cloth).size() > 5);
    for (std::uint32_t row = 0; row < 11; ++row) {
      CHECK(world.is_pinned(point(cloth, 11 * row)));
      CHECK(d(world.positions(cloth)[11 * row + 10].x) == doctest::Approx(3).epsilon(1e-3));
    }
    CHECK(world.hook_gap(hook) < Real(1e-3));
    CHECK(world.positions(rope).size() == 16);
    CHECK(d(world.positions(rope)[0].x) == doctest::Approx(5));
    CHECK(world.positions(other).size() == 9);
    REQUIRE(world.remove(cloth));
    run(world, 2);
    CHECK(d(world.positions(rope)[0].x) == doctest::Approx(5));
  }

  TEST_CASE("cloth with tethers, or with bends by springs, tears, and nothing holds the pieces together") {
    for (const ClothDesc::Bend bend : {ClothDesc::Bend::kSpring, ClothDesc::Bend::kAngle}) {
      World world = make_world(space());
      ClothDesc desc = pulled(Real(0.3));
      desc.bend = bend;
      desc.bend_stiffness = bend == ClothDesc::Bend::kSpring ? Real(2) : Real(1e-4);
      desc.tethers = true;  // To both sides, which go apart.
      const ClothId cloth = take(world.add_cloth(desc));
      run(world, 180);
      REQUIRE(!world.splits(cloth).empty());
      CHECK(count_pieces(world, cloth) >= 2);
      // The held side is at 0, the other at 4, and each has its pieces with it.
      std::size_t between = 0;
      for (std::size_t i = 0; i < world.positions(cloth).size(); ++i) {
        const double x = world.positions(cloth)[i].x;
        between += x > 1.2 && x < 2.8 ? 1 : 0;
      }
      CHECK(between < 10);
      CHECK(world.measure().largest_stretch < 0.6);
    }
  }

  TEST_CASE("a closed cloth that is filled too much bursts, and its gas is gone") {
    World world = make_world(space());
    MeshDesc mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const ClothId ball = take(world.add_cloth({.mesh = take(world.add_mesh(mesh)),
                                               .stretch_stiffness = 2000,
                                               .damping = 2,
                                               .tear_strain = Real(0.005),
                                               .pressure = Real(3000)}));
    CHECK(d(world.pressure(ball)) == doctest::Approx(3000).epsilon(0.01));
    std::size_t tears = 0;
    std::size_t bursts = 0;
    for (int i = 0; i < 30; ++i) {
      run(world, 1);
      for (const ClothTearEvent& tear : world.events().tears) {
        CHECK(tear.burst == (tears == 0));
        ++tears;
        bursts += tear.burst ? 1 : 0;
      }
    }
    CHECK(tears == world.splits(ball).size());
    CHECK(bursts == 1);
    CHECK(world.pressure(ball) == Real(0));
  }

  TEST_CASE(
      "a heavy ball goes through a sheet that tears, and the sheet touches itself and others after it") {
    WorldDesc desc = space(2);
    desc.gravity = {0, -10, 0};
    World world = make_world(desc);
    take(world.add_body({.shape = Shape::half_space()}));
    ClothDesc sheet = {.columns = 21,
                       .rows = 21,
                       .corner = {-1, 1, -1},
                       .row_direction = {0, 0, 1},
                       .width = 2,
                       .height = 2,
                       .thickness = Real(0.01),
                       .stretch_stiffness = 500,
                       .shear_stiffness = 100,
                       .damping = Real(0.05),
                       .tear_strain = Real(0.2),
                       .self_contact = true};
    for (std::uint32_t i = 0; i < 21; ++i)
      sheet.pins.insert(sheet.pins.end(), {{.point = i}, {.point = 420 + i}});
    const ClothId cloth = take(world.add_cloth(sheet));
    take(world.add_cloth({.columns = 9, .rows = 9, .corner = {-0.5, 1.2, -0.5}, .row_direction = {0, 0, 1}}));
    const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::sphere(Real(0.2)),
                                             .position = {0, 2, 0},
                                             .velocity = {0, -12, 0},
                                             .mass = 30}));
    run(world, 120);
    CHECK(world.splits(cloth).size() > 10);
    CHECK(world.pose(ball).position.y < 0.3);
    CHECK(world.measure().energy.kinetic < 100);
  }

  TEST_CASE("the same bits for any workers, and after a restoration in the middle of a tear") {
    check_bits_of_tear(
        60, [](int workers) { return make_world(space(workers)); },
        [](World& world) { return take(world.add_cloth(pulled(Real(0.25)))); });
  }

  TEST_CASE("what a cloth must be to tear") {
    World world = make_world(space());
    for (const Real bad : {Real(0), Real(-1), kRigid, std::numeric_limits<Real>::quiet_NaN()}) {
      const Result<ClothId> strength = world.add_cloth({.strength = bad});
      REQUIRE(!strength.has_value());
      CHECK(strength.error().where == "cloth.strength");
      const Result<ClothId> strain = world.add_cloth({.tear_strain = bad});
      REQUIRE(!strain.has_value());
      CHECK(strain.error().where == "cloth.tear_strain");
    }
    CHECK(!world.add_cloth({.stretch_stiffness = kRigid, .strength = 10}).has_value());
    CHECK(world.add_cloth({.strength = 10, .bend = ClothDesc::Bend::kSpring}).has_value());
    CHECK(world.add_cloth({.strength = 10, .tethers = true}).has_value());
  }
}

}  // namespace hooke
