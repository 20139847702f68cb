#include "world/make.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <vector>

using hooke::BodyDesc;
using hooke::BodyId;
using hooke::BodyKind;
using hooke::Quat;
using hooke::Real;
using hooke::Shape;
using hooke::StepReport;
using hooke::World;
using hooke::test::d;
using hooke::test::empty_space;
using hooke::test::make_world;
using hooke::test::take;

namespace {

constexpr Real kDt = Real(1) / Real(60);

std::vector<BodyId> add_at_one_place(World& world, std::uint32_t count, const Shape& shape) {
  std::vector<BodyId> ids;
  for (std::uint32_t i = 0; i < count; ++i)
    ids.push_back(take(world.add_body({.kind = BodyKind::kDynamic, .shape = shape, .position = {1, 2, 3}})));
  return ids;
}

double fastest_of(const World& world, const std::vector<BodyId>& ids) {
  double fastest = 0;
  for (const BodyId id : ids) fastest = std::max(fastest, d(length(world.velocity(id))));
  return fastest;
}

}  // namespace

TEST_SUITE("world/dense_piles") {
  TEST_CASE(
      "each of 250 bodies at one place has contacts with the eight nearest, and none is pushed faster than "
      "one contact pushes") {
    constexpr std::uint32_t kCount = 250;
    for (const Shape& shape : {Shape::sphere(Real(0.4)), Shape::box({Real(0.3), Real(0.5), Real(0.4)})}) {
      World world = make_world(empty_space());
      const std::vector<BodyId> ids = add_at_one_place(world, kCount, shape);
      const double energy_of_one = 0.5 * d(world.mass(ids[0])) * 9;
      for (int i = 0; i < 20; ++i) {
        const StepReport report = world.step(kDt);
        REQUIRE(report.healthy());
        if (i == 0) CHECK(report.pairs + report.pairs_left_out == kCount * (kCount - 1) / 2);
        if (i < 10) CHECK(report.pairs_left_out > 0);
        if (i < 10) CHECK(report.pairs <= kCount * 3 * 8);
        CHECK(fastest_of(world, ids) < 3.5);
        CHECK(world.measure().energy.kinetic <= kCount * energy_of_one);
      }
      // They do come apart.
      CHECK(length(world.pose(ids[0]).position - world.pose(ids[kCount - 1]).position) > 0.5);
    }
  }

  TEST_CASE("fast bodies that stand in each other keep their momentum") {
    World world = make_world(empty_space());
    const std::vector<BodyId> ids = add_at_one_place(world, 30, Shape::sphere(Real(0.5)));
    for (const BodyId id : ids) REQUIRE(world.set_velocity(id, {0, 0, 20}));
    for (int i = 0; i < 20; ++i) REQUIRE(world.step(kDt).healthy());
    double momentum = 0;
    for (const BodyId id : ids) momentum += d(world.velocity(id).z) / 30;
    CHECK(momentum == doctest::Approx(20).epsilon(0.001));
    CHECK(fastest_of(world, ids) < 23.5);
  }

  TEST_CASE("bodies that touch without deep overlap are no dense pile") {
    World world = make_world();
    take(world.add_body({}));
    for (int i = 0; i < 48; ++i) {
      const BodyDesc body = {
          .kind = BodyKind::kDynamic,
          .shape = i % 3 == 0 ? Shape::sphere(Real(0.25)) : Shape::box({Real(0.25), Real(0.2), Real(0.25)}),
          .position = {0.45 * (i % 4), 0.3 + 0.45 * (i / 16), 0.45 * (i / 4 % 4)},
          .rotation = hooke::quaternion_about(hooke::Vec3{1, Real(i), 2}, Real(0.3 * i))};
      take(world.add_body(body));
    }
    for (int i = 0; i < 60; ++i) CHECK(world.step(kDt).pairs_left_out == 0);
  }

  TEST_CASE("a dense pile has the same bits with any number of workers, and after a restore") {
    hooke::test::check_same_bits({}, [](World& world) {
      take(world.add_body({}));
      add_at_one_place(world, 40, Shape::box({Real(0.3), Real(0.2), Real(0.4)}));
      add_at_one_place(world, 30, Shape::capsule(Real(0.1), Real(0.5)));
    });
  }
}
