#include "world/surface_room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <string>
#include <vector>

/// Objects that are added where others are: they are named, come apart where a part can go back, and nothing
/// else begins to cross.

namespace hooke {
namespace {

Room calm_room() {
  Room room;
  room.world = World::create({.gravity = {}, .substeps = 8, .workers = 1}).value();
  return room;
}

/// An upright sheet of n x n points over the place `at`, of which a part reaches below it [m].
ClothDesc upright(int n, DVec3 at, double below) {
  ClothDesc desc = sheet(n, at);
  desc.row_direction = {Real(0), Real(1), Real(0)};
  desc.corner = at + DVec3{-0.5 * static_cast<double>(desc.width), -below, 0};
  return desc;
}

SolidDesc jelly(DVec3 at) {
  SolidDesc desc = soft_cube(at, Real(0.3), 4);
  desc.young_modulus = Real(2e4);
  return desc;
}

std::size_t crossings_now(const Room& room) {
  return count_crossings(surfaces_of(room)).crossing;
}

/// Steps until nothing crosses; returns the number of frames, or `most`.
int frames_until_apart(Room& room, int most) {
  for (int i = 0; i < most; ++i) {
    if (crossings_now(room) == 0) return i;
    CHECK(room.world.step(kFrame).healthy());
  }
  return most;
}

DVec3 momentum_of(const Room& room) {
  return room.world.measure().momentum;
}

}  // namespace

TEST_SUITE("world/crossed_starts") {
  TEST_CASE("intersect: two sheets that cross are named, with as many pairs as the checker finds") {
    Room room = calm_room();
    const ClothId level = room.add(sheet(31, {}));
    const ClothId other = room.add(upright(21, {0.003, 0, 0.0037}, 0.105));
    const std::vector<Crossing> found = room.world.crossings();
    REQUIRE(found.size() == 1);
    CHECK(found[0].a == point(level, 0));
    CHECK(found[0].b == point(other, 0));
    CHECK(!found[0].body);
    CHECK(found[0].pairs == crossings_now(room));
    CHECK(length(found[0].place - DVec3{0.003, 0, 0.0037}) < 0.02);
    CHECK(room.world.step(kFrame).surfaces_crossing == found[0].pairs);
  }

  TEST_CASE("intersect: sheets whose points and edges lie exactly on each other where they cross are named") {
    Room room = calm_room();
    room.add(sheet(11, {}));
    room.add(upright(7, {0, 0, 0}, 0.05));  // Its vertical edges go through points of the first one.
    const std::vector<Crossing> found = room.world.crossings();
    REQUIRE(found.size() == 1);
    CHECK(found[0].pairs >= 7);
  }

  TEST_CASE("intersect: the smaller part of a sheet goes back through the other, and stays there") {
    for (const double below : {0.05, 0.1, 0.19}) {
      CAPTURE(below);
      Room room = calm_room();
      room.add(sheet(31, {}));
      room.add(upright(21, {0.003, 0, 0.0037}, below));
      const int frames = frames_until_apart(room, 60);
      CHECK(frames < 60);
      // Pairs are drawn back by equal and opposite impulses: 6 g of 0.1 kg/m^2 at rest keep no momentum.
      CHECK(length(momentum_of(room)) < 1e-6);
      CHECK(room.world.crossings().empty());
      CHECK(run(room, 60).crossing == 0);
      CHECK(room.world.step(kFrame).surfaces_crossing == 0);
    }
  }

  TEST_CASE("intersect: a sheet that goes back comes to lie on the other one, and does not fall through") {
    Room room;
    ClothDesc low = sheet(31, {});
    for (std::uint32_t i = 0; i < 31 * 31; ++i) {
      if (i % 31 == 0 || i % 31 == 30 || i / 31 == 0 || i / 31 == 30) low.pins.push_back({.point = i});
    }
    room.add(low);
    const ClothId fallen = room.add(upright(21, {0.003, 0, 0.0037}, 0.05));
    CHECK(frames_until_apart(room, 60) < 60);
    CHECK(run(room, 120).crossing == 0);
    CHECK(mean_of(room.world.positions(fallen)).y > -0.05);
    CHECK(rms_of(room.world.velocities(fallen)) < 0.02);
  }

  TEST_CASE("intersect: sheets that are slotted into each other stay so, and nothing new crosses") {
    Room room = calm_room();
    room.add(sheet(21, {}));
    // Its edge at the left lies within the other sheet, that at the right beyond it: neither is cut apart.
    room.add(upright(21, {0.1, 0, 0.0037}, 0.1));
    const std::size_t before = crossings_now(room);
    REQUIRE(before > 0);
    for (int i = 0; i < 60; ++i) {
      CHECK(room.world.step(kFrame).surfaces_crossing <= before);
      CHECK(crossings_now(room) <= before);
    }
  }

  TEST_CASE("intersect: what does not cross is held by the guarantee beside what does") {
    Room room = calm_room();
    room.add(sheet(31, {}));
    room.add(upright(21, {0.003, 0, 0.0037}, 0.1));
    ClothDesc shot = sheet(9, {0.2, 0.02, 0.2});  // At a corner of the first one, away from the crossing.
    shot.velocity = {Real(0), Real(-20), Real(0)};
    const ClothId fast = room.add(shot);
    const auto crosses_fast = [&] {
      const std::vector<Crossing> found = room.world.crossings();
      return std::any_of(found.begin(), found.end(),
                         [&](const Crossing& c) { return c.a == point(fast, 0) || c.b == point(fast, 0); });
    };
    for (int i = 0; i < 30; ++i) {
      room.world.step(kFrame);
      CHECK(!crosses_fast());
    }
  }

  TEST_CASE("intersect: jellies that overlap by 5 of 30 cm lose crossings, and momentum stays") {
    Room room = calm_room();
    room.add(jelly({}));
    room.add(jelly({0.25, 0.013, 0.017}));
    const std::size_t before = crossings_now(room);
    CHECK(room.world.crossings().size() == 1);
    for (int i = 0; i < 60; ++i) CHECK(room.world.step(kFrame).healthy());
    CHECK(crossings_now(room) < before / 2);
    // 27 kg each, which the overlap drives apart at about 0.3 m/s.
    CHECK(length(momentum_of(room)) < 1e-3);
    CHECK(room.world.measure().energy.kinetic < 2);
  }

  TEST_CASE("intersect: a rope through a jelly, a ball in it and a ball in a cloth are named") {
    Room room = calm_room();
    const SolidId solid = room.add(jelly({}));
    RopeDesc rope;
    rope.hook_point = {-0.4, 0.0113, 0.0127};
    rope.direction = {Real(1), Real(0), Real(0)};
    rope.masses = 20;
    rope.length_at_rest = Real(0.8);
    rope.pins = {};
    rope.touches_surfaces = true;
    const RopeId through = room.add(rope);
    BodyDesc ball;
    ball.kind = BodyKind::kDynamic;
    ball.shape = Shape::sphere(Real(0.03));
    ball.position = {0, 0.1, 0.01};
    const BodyId inside = room.world.add_body(ball).value();
    const ClothId cloth = room.add(sheet(21, {1, 0, 0}));
    ball.position = {1, 0.01, 0.01};
    const BodyId in_cloth = room.world.add_body(ball).value();
    ball.position = {1.1, 0.031, 0.01};  // It lies on the cloth.
    CHECK(room.world.add_body(ball));
    const std::vector<Crossing> found = room.world.crossings();
    REQUIRE(found.size() == 3);
    CHECK(found[0].a == point(solid, 0));
    CHECK(found[0].b == point(through, 0));
    CHECK(found[0].pairs == 2);
    CHECK(found[1].a == point(solid, 0));
    CHECK(found[1].body == inside);
    CHECK(found[1].inside);
    CHECK(found[2].a == point(cloth, 0));
    CHECK(found[2].body == in_cloth);
    CHECK(found[2].pairs > 0);
  }

  TEST_CASE("what touches but does not cross is not named, nor what filters keep from touching") {
    Room room = calm_room();
    room.add(jelly({}));
    room.add(jelly({0, 0.3, 0}));
    room.add(sheet(21, {0, 0.45, 0}));
    CHECK(room.world.crossings().empty());
    ClothDesc other = upright(21, {0, 0.45, 0}, 0.1);
    other.filter.mask = 0;
    room.add(other);
    CHECK(room.world.crossings().empty());
  }

  TEST_CASE("intersect: a crossed start goes on alike after restore and with any number of workers") {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 3}) {
      Room room = calm_room();
      REQUIRE(room.world.set_workers(workers));
      room.add(sheet(31, {}));
      room.add(upright(21, {0.003, 0, 0.0037}, 0.1));
      for (int i = 0; i < 5; ++i) room.world.step(kFrame);
      const Snapshot then = room.world.snapshot();
      for (int i = 0; i < 20; ++i) room.world.step(kFrame);
      hashes.push_back(room.world.state_hash());
      REQUIRE(room.world.restore(then));
      for (int i = 0; i < 20; ++i) room.world.step(kFrame);
      hashes.push_back(room.world.state_hash());
    }
    CHECK(std::count(hashes.begin(), hashes.end(), hashes[0]) == 4);
  }

  TEST_CASE("a point that is placed beyond another cloth is looked at, and comes back") {
    Room room = calm_room();
    room.add(sheet(21, {}));
    const ClothId above = room.add(sheet(21, {0, 0.01, 0}));
    room.world.step(kFrame);
    CHECK(room.world.step(kFrame).surfaces_crossing == 0);
    const DVec3 middle = room.world.positions(above)[220];
    REQUIRE(room.world.set_position(point(above, 220), middle - DVec3{0, 0.015, 0}));
    CHECK(room.world.step(kFrame).surfaces_crossing > 0);
    CHECK(frames_until_apart(room, 60) < 60);
  }

  TEST_CASE("thickness that is zero, negative or not finite is an error with the field's name") {
    for (const Real thickness : {Real(0), Real(-0.001), kRigid, std::numeric_limits<Real>::quiet_NaN()}) {
      World world = World::create().value();
      ClothDesc cloth = sheet(5, {});
      cloth.thickness = thickness;
      const auto added = world.add_cloth(cloth);
      REQUIRE(!added);
      CHECK(added.error().where.find("thickness") != std::string::npos);
      SolidDesc solid = jelly({});
      solid.thickness = thickness;
      const auto made = world.add_solid(solid);
      REQUIRE(!made);
      CHECK(made.error().where.find("thickness") != std::string::npos);
    }
  }

  TEST_CASE("a triangle that a mesh has twice, or the other way round, counts once in a cloth") {
    World world = World::create().value();
    MeshDesc mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 2, 0}, {0, 3, 2}};
    ClothDesc desc;
    desc.mesh = world.add_mesh(mesh).value();
    desc.areal_density = Real(0.5);
    const auto added = world.add_cloth(desc);
    REQUIRE(added);
    CHECK(world.triangles(added.value()).size() == 2);
    CHECK(static_cast<double>(world.mass(added.value())) == doctest::Approx(0.5));
  }

  TEST_CASE("three sheets that share an edge, which no surface does, hold a sheet that falls on them") {
    Room room;
    MeshDesc mesh;
    for (int k = 0; k < 11; ++k) {
      mesh.positions.push_back({Real(0), Real(0), Real(0.02 * k)});
      for (const double angle : {0.0, 2.1, 4.2})
        mesh.positions.push_back({static_cast<Real>(0.02 * std::sin(angle)),
                                  static_cast<Real>(0.02 * std::cos(angle)), Real(0.02 * k)});
    }
    for (std::uint32_t k = 0; k < 10; ++k) {
      for (std::uint32_t fin = 1; fin < 4; ++fin) {
        mesh.triangles.push_back({4 * k, 4 * k + fin, 4 * k + 4});
        mesh.triangles.push_back({4 * k + 4, 4 * k + fin, 4 * k + 4 + fin});
      }
    }
    ClothDesc desc;
    desc.mesh = room.world.add_mesh(mesh).value();
    desc.thickness = Real(0.004);
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) desc.pins.push_back({.point = i});
    room.add(desc);
    room.add(sheet(11, {0, 0.06, 0.1}));
    CHECK(room.world.crossings().empty());
    CHECK(run(room, 60).crossing == 0);
  }

  TEST_CASE(
      "thickness above half of an edge: an error for contact with itself, else half of the edge counts") {
    ClothDesc thick = sheet(11, {});
    thick.thickness = Real(3) * kEdge;
    World world = World::create().value();
    const auto refused = world.add_cloth(thick);
    REQUIRE(!refused);
    CHECK(refused.error().message.find("half of the mean edge") != std::string::npos);
    // The mean of two sides and a diagonal of a cell is (2 + sqrt 2) / 3 edges; half of it is the distance
    // that two sheets keep.
    Room room = calm_room();
    thick.self_contact = false;
    const ClothId low = room.add(thick);
    thick.corner.y = 0.005;
    const ClothId high = room.add(thick);
    for (int i = 0; i < 60; ++i) room.world.step(kFrame);
    const double apart = mean_of(room.world.positions(high)).y - mean_of(room.world.positions(low)).y;
    const double kept = 0.5 * (2 + std::sqrt(2.0)) / 3 * static_cast<double>(kEdge);
    CHECK(apart > 0.95 * kept);
  }
}

}  // namespace hooke
