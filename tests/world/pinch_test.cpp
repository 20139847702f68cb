#include "world/surface_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <vector>

/// Two kinematic bodies that close on a cloth or a jelly: who yields, what is counted, and that the
/// deformable is as it was once they part. docs/decisions/0044-bodies-that-pass-nothing.md has the rule.

namespace hooke {
namespace {

constexpr double kHalf = 0.05;  // Half of the height of each body [m].

/// Two bodies of one shape, above and below the origin, that close at the same speed.
struct Press {
  std::array<BodyId, 2> bodies = {};
  Real speed = Real(0);

  Press(Room& room, const Shape& shape, double gap, Real closing) : speed(closing) {
    for (std::size_t k = 0; k < 2; ++k) {
      BodyDesc desc;
      desc.kind = BodyKind::kKinematic;
      desc.shape = shape;
      desc.position = {0, (k == 0 ? -1 : 1) * (kHalf + 0.5 * gap), 0};
      bodies[k] = room.world.add_body(desc).value();
    }
    move(room, 1);
  }

  /// Closes (1), opens (-1) or stops (0).
  void move(Room& room, int way) const {
    for (std::size_t k = 0; k < 2; ++k) {
      const Real v = (k == 0 ? speed : -speed) * static_cast<Real>(way);
      REQUIRE(room.world.set_velocity(bodies[k], {Real(0), v, Real(0)}));
    }
  }

  [[nodiscard]] double gap(const Room& room) const {
    return room.world.pose(bodies[1]).position.y - room.world.pose(bodies[0]).position.y - 2 * kHalf;
  }
};

struct Pinched {
  std::uint32_t counted = 0;  ///< Points held back, and places that bodies came through.
  double deepest = 0;         ///< Deepest overlap of a point with a body [m].
  double stretch = 0;         ///< Largest stretch.
};

Pinched step(Room& room, int frames) {
  Pinched result;
  for (int i = 0; i < frames; ++i) {
    const StepReport report = room.world.step(kFrame);
    CHECK(report.healthy());
    const Measurement measured = room.world.measure();
    result.counted += report.points_held_back + report.surfaces_touching;
    result.deepest = std::max(result.deepest, measured.largest_penetration);
    result.stretch = std::max(result.stretch, measured.largest_stretch);
  }
  return result;
}

/// Closes until the gap is `least` [m], waits for a second, opens, and waits again.
Pinched pinch(Room& room, const Press& press, double least) {
  Pinched all;
  const auto take = [&](const Pinched& one) {
    all.counted += one.counted;
    all.deepest = std::max(all.deepest, one.deepest);
    all.stretch = std::max(all.stretch, one.stretch);
  };
  const double open = press.gap(room);
  while (press.gap(room) > least) take(step(room, 1));
  press.move(room, 0);
  take(step(room, 60));
  press.move(room, -1);
  while (press.gap(room) < open) take(step(room, 1));
  press.move(room, 0);
  take(step(room, 60));
  return all;
}

/// A sheet that hangs by its corners.
ClothDesc hung() {
  ClothDesc desc = sheet(25, {});
  desc.self_contact = false;
  for (const std::uint32_t corner : {0U, 24U, 600U, 624U}) desc.pins.push_back({.point = corner});
  return desc;
}

const std::array kShapes = {Shape::sphere(Real(kHalf)), Shape::box({Real(kHalf), Real(kHalf), Real(kHalf)}),
                            Shape::box({Real(0.4), Real(kHalf), Real(0.4)})};

}  // namespace

TEST_SUITE("world/pinch") {
  TEST_CASE("while there is room for its thickness a cloth keeps it from both bodies, and nothing is held") {
    for (const Shape& shape : kShapes) {
      Room room;
      room.add(hung());
      const Press press(room, shape, 0.1, Real(0.2));
      const Pinched result = pinch(room, press, 0.008);  // Its thickness is 5 mm.
      CHECK(result.counted == 0);
      CHECK(result.deepest < 1e-4);
      CHECK(result.stretch < 0.1);
    }
  }

  TEST_CASE(
      "two bodies that close on a cloth by 2 cm more than there is are counted, and set it free again") {
    for (const Shape& shape : kShapes) {
      for (const Real speed : {Real(0.2), Real(2)}) {
        CAPTURE(static_cast<int>(shape.kind));
        CAPTURE(speed);
        Room calm;
        const ClothId left_alone = calm.add(hung());
        for (int i = 0; i < 240; ++i) calm.world.step(kFrame);
        Room room;
        const ClothId cloth = room.add(hung());
        const Press press(room, shape, 0.1, speed);
        const Pinched result = pinch(room, press, -0.02);
        CHECK(result.counted > 0);
        CHECK(result.deepest < 2 * kHalf);
        CHECK(room.world.crossings().empty());
        CHECK(room.world.measure().largest_penetration < 1e-3);
        CHECK(room.world.measure().largest_stretch < 0.05);
        const DVec3 moved = mean_of(room.world.positions(cloth)) - mean_of(calm.world.positions(left_alone));
        CHECK(length(moved) < 0.005);
      }
    }
  }

  TEST_CASE("in a pinch neither body is stopped, and a cloth goes into that which was created first") {
    constexpr double kRadius = 0.0025;  // Half of the thickness [m].
    for (const Shape& shape : {kShapes[1], kShapes[2]}) {
      for (const int way : {1, -1}) {
        CAPTURE(way);
        Room room;
        room.world = World::create({.gravity = {}, .substeps = 8, .workers = 1}).value();
        ClothDesc desc = hung();
        desc.pins.clear();
        const ClothId cloth = room.add(desc);
        std::array<BodyId, 2> bodies = {};
        for (std::size_t k = 0; k < 2; ++k) {
          const double side = k == 0 ? -way : way;
          BodyDesc body;
          body.kind = BodyKind::kKinematic;
          body.shape = shape;
          body.position = {0, side * (kHalf + 0.03), 0};
          body.velocity = {Real(0), static_cast<Real>(-0.2 * side), Real(0)};
          bodies[k] = room.world.add_body(body).value();
        }
        step(room, 11);
        // 0.2 m/s for 11 frames leave 3 cm - 3.67 cm on each side.
        const double overlap = 2 * (0.2 * 11 / 60 - 0.03);
        for (std::size_t k = 0; k < 2; ++k) {
          const double side = k == 0 ? -way : way;
          CHECK(std::abs(room.world.pose(bodies[k]).position.y - side * (kHalf - 0.5 * overlap)) < 1e-6);
          REQUIRE(room.world.set_velocity(bodies[k], {}));
        }
        step(room, 30);
        // The face of the later body, and how far the middle of the cloth lies behind it.
        const double face = way * -0.5 * overlap;
        const double behind = way * (face - room.world.positions(cloth)[312].y);
        CHECK(std::abs(behind - kRadius) < 0.0003);
        CHECK(std::abs(room.world.measure().largest_penetration - (overlap + 2 * kRadius)) < 0.0005);
      }
    }
  }

  TEST_CASE("a jelly that is pressed to nothing at 0.2 m/s takes its volume again when the bodies part") {
    for (const Shape& shape : kShapes) {
      CAPTURE(static_cast<int>(shape.kind));
      Room room;
      room.world = World::create({.gravity = {}, .substeps = 8, .workers = 1}).value();
      const SolidId solid = room.add(soft_cube({}, Real(0.2), 4));
      const Press press(room, shape, 0.22, Real(0.2));
      pinch(room, press, 0.0);
      CHECK(std::abs(room.world.volume(solid) - 0.008) < 0.0008);
      CHECK(room.world.measure().largest_penetration < 1e-3);
      CHECK(room.world.crossings().empty());
    }
  }

  TEST_CASE("a pinch has the same bits for any workers") {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 3}) {
      Room room;
      REQUIRE(room.world.set_workers(workers));
      room.add(hung());
      const Press press(room, kShapes[0], 0.1, Real(2));
      pinch(room, press, -0.02);
      hashes.push_back(room.world.state_hash());
    }
    CHECK(hashes[0] == hashes[1]);
  }
}

}  // namespace hooke
