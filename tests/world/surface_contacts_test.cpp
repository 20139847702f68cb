#include "hooke/hooke.h"

#include "world/surface_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

/// Contacts of cloths and solids with each other and with themselves.

namespace hooke {
namespace {

Room sheets_on_ball(int n) {
  Room room;
  room.add_ground();
  room.add_ball({0, 0.3, 0}, Real(0.12));
  for (int layer = 0; layer < 4; ++layer) room.add(sheet(n, {0.003 * layer, 0.45 + 0.0075 * layer, 0}));
  return room;
}

Room folding_sheet() {
  Room room;
  room.add_ground();
  ClothDesc desc = sheet(24, {0, 0, 0});
  desc.column_direction = {Real(0), Real(0), Real(1)};
  desc.row_direction = {Real(0.05), Real(-1), Real(0)};
  desc.corner = {0, static_cast<double>(desc.height) + 0.01, -0.23};
  room.add(desc);
  return room;
}

Room heap_of_jellies() {
  Room room;
  room.add_ground();
  SolidDesc desc;
  desc.cells = {3, 3, 3};
  desc.size = {Real(0.12), Real(0.12), Real(0.12)};
  desc.young_modulus = Real(2e4);
  desc.thickness = Real(0.004);
  for (int i = 0; i < 4; ++i) {
    desc.position = {0.02 * i, 0.07 + 0.15 * i, 0.02 * (i % 2)};
    room.add(desc);
  }
  return room;
}

Room jelly_on_net() {
  Room room;
  ClothDesc net = sheet(16, {0, 0.3, 0});
  net.areal_density = Real(4);
  net.self_contact = false;
  for (std::uint32_t i = 0; i < 16; ++i) {
    for (const std::uint32_t point : {i, 240 + i, 16 * i, 16 * i + 15}) net.pins.push_back({.point = point});
  }
  room.add(net);
  SolidDesc jelly;
  jelly.cells = {3, 3, 3};
  jelly.size = {Real(0.1), Real(0.1), Real(0.1)};
  jelly.young_modulus = Real(3e4);
  jelly.density = Real(200);
  jelly.position = {0.01, 0.4, 0};
  room.add(jelly);
  return room;
}

/// Two sheets that meet at 40 m/s.
Room fast_sheets() {
  Room room;
  ClothDesc upper = sheet(20, {0.004, 0.5, 0.003});
  upper.velocity = {Real(0), Real(-20), Real(0)};
  room.add(upper);
  ClothDesc lower = sheet(20, {0, -0.5, 0});
  lower.velocity = {Real(0), Real(20), Real(0)};
  room.add(lower);
  return room;
}

}  // namespace

TEST_SUITE("world/surface_contacts") {
  TEST_CASE("intersect: four sheets that fall on a ball and fold cross in none of 300 frames") {
    Room room = sheets_on_ball(20);
    const Run result = run(room, 300);
    CHECK(result.crossing == 0);
    CHECK(result.touching == 0);
    CHECK(result.held_back == 0);
  }

  TEST_CASE("intersect: a sheet that falls on its edge does not cross itself in 300 frames") {
    Room room = folding_sheet();
    const Run result = run(room, 300);
    CHECK(result.crossing == 0);
    CHECK(result.held_back == 0);
  }

  TEST_CASE("intersect: jellies in a heap do not cross in 300 frames") {
    Room room = heap_of_jellies();
    const Run result = run(room, 300);
    CHECK(result.crossing == 0);
    CHECK(result.held_back == 0);
    // Whether they lie or stand, each keeps its height over the ground and the others.
    for (const Surface& surface : room.surfaces)
      CHECK(mean_of(room.world.positions(std::get<SolidId>(surface))).y > 0.05);
  }

  TEST_CASE("intersect: a jelly stays on a net for 300 frames") {
    Room room = jelly_on_net();
    const Run result = run(room, 300);
    CHECK(result.crossing == 0);
    CHECK(result.held_back == 0);
    CHECK(mean_of(room.world.positions(std::get<SolidId>(room.surfaces.back()))).y > 0.2);
  }

  TEST_CASE("intersect: solids by shape matching rest on a net and on each other") {
    for (const bool on_net : {true, false}) {
      CAPTURE(on_net);
      Room room;
      if (on_net) {
        ClothDesc net = sheet(16, {0, 0.3, 0});
        net.areal_density = Real(4);
        net.self_contact = false;
        for (std::uint32_t i = 0; i < 16; ++i) {
          for (const std::uint32_t point : {i, 240 + i, 16 * i, 16 * i + 15})
            net.pins.push_back({.point = point});
        }
        room.add(net);
      } else {
        room.add_ground();
      }
      SolidDesc cube;
      cube.elasticity = SolidDesc::Elasticity::kShapeMatching;
      cube.cells = {3, 3, 3};
      cube.size = {Real(0.1), Real(0.1), Real(0.1)};
      cube.match_hz = Real(40);
      cube.match_damping_ratio = Real(1);
      cube.density = Real(200);
      const double floor = on_net ? 0.3 : 0;
      for (int i = 0; i < 2; ++i) {
        cube.position = {0.002 * i, floor + 0.06 + 0.11 * i, 0};
        room.add(cube);
      }
      const Run result = run(room, 180);
      CHECK(result.crossing == 0);
      const auto height = [&](std::size_t from_last) {
        const Surface& surface = room.surfaces[room.surfaces.size() - from_last];
        return mean_of(room.world.positions(std::get<SolidId>(surface))).y;
      };
      CHECK(height(2) > floor + 0.02);
      // One cube and a thickness above the other; cubes of 40 Hz give way by about g / w^2 = 0.2 mm.
      CHECK(height(1) - height(2) ==
            doctest::Approx(0.1 + static_cast<double>(cube.thickness)).epsilon(0.01));
    }
  }

  TEST_CASE("intersect: sheets that meet at 40 m/s do not pass in 300 frames, and gain no energy") {
    Room room = fast_sheets();
    const double before = room.world.measure().energy.kinetic;
    room.world.step(kFrame);
    const Run result = run(room, 299);
    CHECK(result.crossing == 0);
    const auto y = [&](int i) {
      return mean_of(room.world.positions(std::get<ClothId>(room.surfaces[i]))).y;
    };
    CHECK(y(0) > y(1));  // Both fall on, in the order in which they met.
    const Measurement after = room.world.measure();
    // They had no momentum, and both fell freely: what is left of their speed against their fall is small.
    const double mass = 2 * 0.2 * 0.38 * 0.38;
    const double fall = 9.81 * 5;
    CHECK(after.momentum.y == doctest::Approx(-mass * fall).epsilon(2e-3));
    CHECK(after.energy.kinetic - 0.5 * mass * fall * fall < 0.2 * before);
  }

  TEST_CASE("sheets that fly side by side keep their velocity to 1e-4") {
    Room room;
    for (const double y : {0.0, 0.006}) {
      ClothDesc desc = sheet(20, {0.3 * y, y, 0});
      desc.velocity = {Real(20), Real(0), Real(0)};
      room.add(desc);
    }
    REQUIRE(room.world.set_gravity({}).has_value());
    run(room, 60);
    for (const Surface& surface : room.surfaces) {
      const PointView v = room.world.velocities(std::get<ClothId>(surface));
      double worst = 0;
      for (std::size_t i = 0; i < v.size(); ++i) worst = std::max(worst, length(v[i] - DVec3{20, 0, 0}));
      CHECK(worst < 20 * 1e-4);
    }
  }

  namespace {

  /// Speed after 1 s of a sheet that slides down a pinned one of the given slope [rad].
  double speed_of_slide(double slope, Real friction) {
    Room room;
    const DVec3 down = {std::cos(slope), -std::sin(slope), 0};
    const DVec3 normal = {std::sin(slope), std::cos(slope), 0};
    room.add(ramp(down, friction));
    ClothDesc moving = sheet(8, {});
    moving.column_direction = vector_cast<Real>(down);
    moving.corner = 0.031 * down + 0.0051 * normal + DVec3{0, 0, -0.067};
    moving.contact.friction = friction;
    const ClothId id = room.add(moving);
    constexpr int kFrames = 36;
    CHECK(run(room, kFrames).crossing == 0);
    return dot(down, mean_of(room.world.velocities(id))) / (kFrames / 60.0);
  }

  }  // namespace

  TEST_CASE(
      "a sheet slides on a sheet as Coulomb's law says: g (sin a - mu cos a), without friction g sin a") {
    const double slope = 20.0 / 180 * std::numbers::pi;
    const double g = 9.81;
    CHECK(speed_of_slide(slope, Real(0)) == doctest::Approx(g * std::sin(slope)).epsilon(0.01));
    const double held = g * (std::sin(slope) - 0.3 * std::cos(slope));
    CHECK(speed_of_slide(slope, Real(0.3)) == doctest::Approx(held).epsilon(0.03));
    // tan 20 degrees is 0.364: three percent more friction holds it, and it stands.
    CHECK(std::abs(speed_of_slide(slope, Real(0.375))) < 0.02);
  }

  TEST_CASE("four layers on the ground come to rest, one thickness apart") {
    Room room;
    room.add_ground();
    for (int layer = 0; layer < 4; ++layer)
      room.add(sheet(16, {0.007 * layer, 0.003 + 0.0075 * layer, 0.005 * layer}));
    CHECK(run(room, 300).crossing == 0);
    double below = 0;
    for (const Surface& surface : room.surfaces) {
      const ClothId cloth = std::get<ClothId>(surface);
      CHECK(rms_of(room.world.velocities(cloth)) < 0.01);
      const double y = mean_of(room.world.positions(cloth)).y;
      if (below > 0) CHECK(y - below == doctest::Approx(0.25 * 0.02).epsilon(0.2));
      below = y;
    }
  }

  namespace {

  SolidDesc stiff_cube(Real young_modulus, DVec3 at) {
    SolidDesc desc;
    desc.cells = {3, 3, 3};
    desc.size = {Real(0.3), Real(0.3), Real(0.3)};
    desc.young_modulus = young_modulus;
    desc.position = at;
    return desc;
  }

  }  // namespace

  TEST_CASE("intersect: stiff cubes that hit each other in flight keep their momentum and gain no energy") {
    for (const Real young_modulus : {Real(1e6), Real(1e8), Real(1e10)}) {
      CAPTURE(young_modulus);
      Room room;
      REQUIRE(room.world.set_gravity({}).has_value());
      for (const double side : {-1.0, 1.0}) {
        SolidDesc desc = stiff_cube(young_modulus, {0.3 * side, 0.1 * side, 0.05});
        desc.velocity = {Real(-5 * side), Real(0), Real(0.2)};
        room.add(desc);
      }
      const Measurement before = room.world.measure();
      const Run result = run(room, 30);
      CHECK(result.crossing == 0);
      const Measurement after = room.world.measure();
      const double size = 27 * 5.0;  // Momentum of one of them [N s].
      // At 10 GPa directions run out in the blow, which is counted.
      CHECK((result.unconverged > 0) == (young_modulus > Real(1e9)));
      CHECK(length(after.momentum - before.momentum) < 1e-4 * size);
      // Friction acts on both surfaces, which are half a thickness away from where they touch.
      CHECK(length(after.angular_momentum - before.angular_momentum) < 0.02 * size);
      CHECK(after.energy.kinetic + after.energy.elastic < 1.001 * before.energy.kinetic);
    }
  }

  TEST_CASE("a stiff cube slides on a stiff slab as Coulomb's law says: mu g, without friction not at all") {
    for (const Real friction : {Real(0), Real(0.3)}) {
      CAPTURE(friction);
      Room room;
      REQUIRE(room.world.add_body({.kind = BodyKind::kStatic,
                                   .shape = {.kind = ShapeKind::kHalfSpace},
                                   .contact = {.friction = Real(100)}}));
      SolidDesc slab = stiff_cube(Real(1e9), {0.5, 0.052, 0});
      slab.cells = {15, 1, 4};
      slab.size = {Real(1.5), Real(0.1), Real(0.4)};
      slab.density = Real(1e4);
      slab.contact.friction = friction;
      room.add(slab);
      SolidDesc cube = stiff_cube(Real(1e9), {0, 0.26, 0});
      cube.contact.friction = friction;
      cube.velocity = {Real(2), Real(0), Real(0)};
      const SolidId id = room.add(cube);
      const auto speed = [&] { return mean_of(room.world.velocities(id)).x; };
      run(room, 6);  // It comes to lie on the slab.
      const double before = speed();
      constexpr int kFrames = 24;
      CHECK(run(room, kFrames).crossing == 0);
      const double lost = static_cast<double>(friction) * 9.81 * kFrames / 60;
      CHECK(before - speed() == doctest::Approx(lost).epsilon(0.05).scale(0.3));
    }
  }

  TEST_CASE("filters keep cloths from touching, and a group that is positive makes them touch") {
    const auto gap_after = [](FilterDesc filter) {
      Room room;
      room.add_ground();
      for (int layer = 0; layer < 2; ++layer) {
        ClothDesc desc = sheet(8, {0.003 * layer, 0.003 + 0.01 * layer, 0});
        desc.filter = filter;
        desc.self_contact = false;
        room.add(desc);
      }
      run(room, 60);
      return mean_of(room.world.positions(std::get<ClothId>(room.surfaces[1]))).y -
             mean_of(room.world.positions(std::get<ClothId>(room.surfaces[0]))).y;
    };
    CHECK(gap_after({}) > 0.004);
    CHECK(gap_after({.mask = 2}) < 0.001);
    CHECK(gap_after({.group = -3}) < 0.001);
    CHECK(gap_after({.mask = 2, .group = 3}) > 0.004);
  }

  TEST_CASE("what is 100 m away changes no bit of sheets that touch") {
    const auto heights = [](bool with_other) {
      Room room = sheets_on_ball(10);
      if (with_other) {
        ClothDesc far = sheet(12, {100, 0.4, 0});
        far.velocity = {Real(3), Real(5), Real(0)};
        room.add(far);
        far.corner.y += 0.05;
        far.velocity = {};
        room.add(far);
        // Surfaces with ropes are searched earlier in a substep than others.
        RopeDesc rope;
        rope.touches_surfaces = true;
        rope.hook_point = {100, 0.5, 0};
        room.add(rope);
        rope.hook_point.y = 0.55;
        room.add(rope);
      }
      run(room, 60);
      std::vector<DVec3> points;
      for (std::size_t i = 0; i < 4; ++i) {
        const PointView x = room.world.positions(std::get<ClothId>(room.surfaces[i]));
        for (std::size_t k = 0; k < x.size(); ++k) points.push_back(x[k]);
      }
      return points;
    };
    const std::vector<DVec3> alone = heights(false);
    const std::vector<DVec3> together = heights(true);
    REQUIRE(alone.size() == together.size());
    for (std::size_t i = 0; i < alone.size(); ++i) REQUIRE(length(alone[i] - together[i]) == 0);
  }

  // Small objects share the solver's groups; hooks of cloths are not those of stiff solids.
  TEST_CASE("whether a jelly is stiff that stands elsewhere changes no bit of a cloth that bears a weight") {
    const auto positions_beside = [](Real young_modulus) {
      Room room;
      SolidDesc jelly = stiff_cube(young_modulus, {5, 0.152, 0});
      jelly.thickness = Real(0.004);
      room.add(jelly);
      room.add_ground();
      ClothDesc desc = sheet(8, {0, 1, 0});
      desc.pins = {{.point = 0}, {.point = 7}};
      const ClothId cloth = room.add(desc);
      const DVec3 corner = room.world.positions(cloth)[60];
      const auto weight = room.world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = {.kind = ShapeKind::kSphere, .radius = Real(0.05)},
                                               .position = corner - DVec3{0, 0.05, 0},
                                               .mass = Real(0.5)});
      REQUIRE(weight);
      HookDesc hook;
      hook.a.body = weight.value();
      hook.b.point = point(cloth, 60);
      hook.anchor = corner;
      REQUIRE(room.world.add_hook(hook));
      for (int i = 0; i < 60; ++i) room.world.step(kFrame);
      std::vector<DVec3> places;
      const PointView x = room.world.positions(cloth);
      for (std::size_t i = 0; i < x.size(); ++i) places.push_back(x[i]);
      return places;
    };
    CHECK(positions_beside(Real(1e3)) == positions_beside(Real(1e9)));
  }

  TEST_CASE("a snapshot in the middle of contact goes on with the same bits") {
    Room room = sheets_on_ball(12);
    run(room, 20);
    const Snapshot snapshot = room.world.snapshot();
    run(room, 20);
    const std::uint64_t hash = room.world.state_hash();
    REQUIRE(room.world.restore(snapshot));
    run(room, 20);
    CHECK(room.world.state_hash() == hash);
  }

  TEST_CASE("every instruction set and number of workers gives the same bits") {
    std::uint64_t expected = 0;
    const auto hash_with = [](int workers) {
      Room room = sheets_on_ball(12);
      room.world = World::create({.substeps = 8, .workers = workers}).value();
      room.surfaces.clear();
      room.add_ground();
      room.add_ball({0, 0.3, 0}, Real(0.12));
      for (int stack = 0; stack < 2; ++stack) {
        for (int layer = 0; layer < 2; ++layer) room.add(sheet(12, {0.7 * stack, 0.45 + 0.0075 * layer, 0}));
      }
      run(room, 30);
      return room.world.state_hash();
    };
    for (const std::string& set : instruction_sets()) {
      REQUIRE(use_instruction_set(set));
      const std::uint64_t hash = hash_with(1);
      if (expected == 0) expected = hash;
      CHECK_MESSAGE(hash == expected, set);
    }
    REQUIRE(use_instruction_set("").has_value());
    CHECK(hash_with(3) == expected);
  }

  TEST_CASE("a cloth that is thicker than half of its edges may not touch itself") {
    Room room;
    ClothDesc desc = sheet(8, {});
    desc.thickness = kEdge;
    const auto refused = room.world.add_cloth(desc);
    REQUIRE(!refused);
    CHECK(refused.error().where == "cloth.thickness");
    desc.self_contact = false;
    CHECK(room.world.add_cloth(desc));
    desc.thickness = Real(0);
    CHECK(!room.world.add_cloth(desc));
    desc.thickness = Real(-1);
    CHECK(!room.world.add_cloth(desc));
  }

  TEST_CASE("a point that is not a number is put back, and spoils no other") {
    // The box of a light point that moves at 1e23 m/s has no bounds.
    for (const bool light : {false, true}) {
      Room room;
      room.add_ground();
      for (int layer = 0; layer < 3; ++layer) {
        ClothDesc desc = sheet(8, {0.003 * layer, 0.05 + 0.0075 * layer, 0});
        if (light) desc.areal_density = Real(1e-7);
        room.add(desc);
      }
      run(room, 5);
      const ClothId cloth = std::get<ClothId>(room.surfaces[1]);
      const Real force = light ? Real(1e15) : Real(1e6);
      REQUIRE(room.world.apply_force(point(cloth, 20), {force, Real(0), Real(0)}));
      for (int i = 0; i < 30; ++i) room.world.step(kFrame);
      for (const Surface& surface : room.surfaces) {
        const PointView x = room.world.positions(std::get<ClothId>(surface));
        for (std::size_t i = 0; i < x.size(); ++i) REQUIRE(std::isfinite(dot(x[i], x[i])));
      }
    }
  }
}

}  // namespace hooke
