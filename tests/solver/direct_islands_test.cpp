#include "solver/coupled/direct_islands.h"

#include "constants.h"
#include "world/access.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hooke {
namespace {

using test::kGravity;
using test::make_world;
using test::run;
using test::take;

constexpr double kDensity = 1000;

struct Column {
  World world;
  std::vector<BodyId> boxes;
};

WorldDesc restless(int workers = 1) {
  WorldDesc desc;
  desc.sleeping = false;
  desc.workers = workers;
  return desc;
}

BodyDesc box(DVec3 center, double half, double density = kDensity) {
  const auto h = static_cast<Real>(half);
  BodyDesc desc;
  desc.kind = BodyKind::kDynamic;
  desc.shape = Shape::box({h, h, h});
  desc.position = center;
  desc.density = static_cast<Real>(density);
  desc.contact.friction = Real(0.6);
  return desc;
}

void add_ground(World& world, double friction = 0.6) {
  BodyDesc ground;
  ground.shape = Shape::half_space();
  ground.contact.friction = static_cast<Real>(friction);
  take(world.add_body(ground));
}

/// `count` cubes on the ground, each `shift` farther along x than the one below.
Column make_column(int count, double half, double shift = 0, const WorldDesc& desc = restless()) {
  Column column = {make_world(desc), {}};
  add_ground(column.world);
  for (int i = 0; i < count; ++i)
    column.boxes.push_back(take(column.world.add_body(box({shift * i, half * (2 * i + 1), 0}, half))));
  return column;
}

constexpr double kPyramidHalf = 0.25;

/// A pyramid of cubes that have the density of their row.
template <class DensityOf>
Column make_pyramid(int rows, DensityOf&& density_of) {
  Column pyramid = {make_world(restless()), {}};
  add_ground(pyramid.world);
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      const double x = 2.1 * kPyramidHalf * (i + 0.5 * row);
      pyramid.boxes.push_back(take(
          pyramid.world.add_body(box({x, kPyramidHalf * (2 * row + 1), 0}, kPyramidHalf, density_of(row)))));
    }
  }
  return pyramid;
}

bool is_direct(const World& world) {
  const std::vector<std::int8_t>& direct_state = WorldAccess::tables(world).bodies.direct_state;
  return std::any_of(direct_state.begin(), direct_state.end(), [](int h) { return h >= solver::kDirect; });
}

double force_between(const World& world, BodyId a, BodyId b) {
  double sum = 0;
  for (const BodyContact& contact : world.body_contacts()) {
    if ((contact.a == a && contact.b == b) || (contact.a == b && contact.b == a))
      sum += static_cast<double>(contact.normal_force);
  }
  return sum;
}

DVec3 place_of(const Column& column, std::size_t i) {
  return column.world.pose(column.boxes[i]).position;
}

/// Three seconds of ten cubes of 0.1 m in a flight of stairs: how far the top sinks [m].
double fall_of_stairs(double shift) {
  Column column = make_column(10, 0.05, shift);
  run(column.world, 180);
  return 0.95 - place_of(column, 9).y;
}

}  // namespace

TEST_SUITE("solver/direct_islands") {
  TEST_CASE(
      "a column above the buckling height of soft contacts stands, and each contact bears what is on it") {
    constexpr int kCount = 40;
    Column column = make_column(kCount, 0.5);
    run(column.world, 240);
    CHECK(is_direct(column.world));
    for (std::size_t i = 0; i < kCount; ++i) {
      CAPTURE(i);
      const DVec3 at = place_of(column, i);
      CHECK(std::abs(at.y - (0.5 + static_cast<double>(i))) < 1e-3);
      CHECK(std::hypot(at.x, at.z) < 1e-3);
      if (i == 0) continue;
      const double weight = kDensity * kGravity * static_cast<double>(kCount - i);
      CHECK(force_between(column.world, column.boxes[i - 1], column.boxes[i]) ==
            doctest::Approx(weight).epsilon(1e-3));
    }
  }

  TEST_CASE("a top ten thousand times as heavy is held") {
    Column column = make_column(5, 0.5);
    column.boxes.push_back(take(column.world.add_body(box({0, 5.5, 0}, 0.5, 1e4 * kDensity))));
    run(column.world, 300);
    for (std::size_t i = 0; i < 6; ++i)
      CHECK(std::abs(place_of(column, i).y - (0.5 + static_cast<double>(i))) < 1e-3);
    CHECK(column.world.measure().energy.kinetic < 1e-2);  // 1e7 kg at 0.05 mm/s
  }

  TEST_CASE("a pyramid holds a top of a thousand times the mass of a box") {
    for (const int rows : {10, 12}) {
      CAPTURE(rows);
      Column pyramid =
          make_pyramid(rows, [&](int row) { return row + 1 < rows ? kDensity : 1000 * kDensity; });
      const double top = kPyramidHalf * (2 * rows - 1);
      run(pyramid.world, 90);
      CHECK(place_of(pyramid, pyramid.boxes.size() - 1).y == doctest::Approx(top).epsilon(1e-5));
      CHECK(pyramid.world.measure().largest_penetration < 1e-5);
      CHECK(pyramid.world.step(Real(1) / Real(60)).rows_refused == 0);
    }
  }

  TEST_CASE("a flight of stairs falls when the middle of the upper boxes is beyond the edge of the lowest") {
    // The upper 9 of 10 are 5 steps off on average; the edge is half a box, 0.05 m, off. Soft contacts give
    // way in the first steps: that takes a tenth of the room.
    CHECK(std::abs(fall_of_stairs(0.009)) < 1e-3);
    CHECK(fall_of_stairs(0.0105) > 0.1);
  }

  TEST_CASE("a small box slides under a load of a thousand times its weight as one body does") {
    // Gravity aslant is a slope of tangent 0.3.
    WorldDesc desc = restless();
    desc.gravity = {Real(3), Real(-10), Real(0)};
    for (const double friction : {0.2, 0.4}) {
      CAPTURE(friction);
      World world = make_world(desc);
      add_ground(world, friction);
      BodyDesc lower = box({0, 0.5, 0}, 0.5);
      lower.contact.friction = static_cast<Real>(friction);
      BodyDesc load = box({0, 1.5, 0}, 0.5, 1000 * kDensity);
      load.contact.friction = Real(5);
      take(world.add_body(lower));
      const BodyId top = take(world.add_body(load));
      run(world, 60);
      CHECK(is_direct(world));
      const double before = static_cast<double>(world.velocity(top).x);
      run(world, 60);
      const double gained = static_cast<double>(world.velocity(top).x) - before;
      CHECK(gained == doctest::Approx(std::max(0.0, 3 - friction * 10)).epsilon(5e-3));
    }
  }

  TEST_CASE("a box that falls on a hard column adds no energy") {
    Column column = make_column(12, 0.05);
    column.boxes.push_back(take(column.world.add_body(box({0.01, 1.75, 0.02}, 0.05, 5 * kDensity))));
    const double start = column.world.measure().energy.total();
    bool was_direct = false;
    for (int i = 0; i < 120; ++i) {
      run(column.world, 1);
      was_direct = was_direct || is_direct(column.world);
      CHECK(column.world.measure().energy.total() < start * (1 + 1e-4));
    }
    CHECK(was_direct);
  }

  TEST_CASE("what soft contacts hold stays soft, and a column becomes soft again when it is taken apart") {
    Column low = make_column(4, 0.5);
    run(low.world, 120);
    CHECK(!is_direct(low.world));
    Column high = make_column(16, 0.5);
    run(high.world, 60);
    CHECK(is_direct(high.world));
    for (std::size_t i = 3; i < high.boxes.size(); ++i) REQUIRE(high.world.remove(high.boxes[i]));
    run(high.world, 60);
    CHECK(!is_direct(high.world));
  }

  TEST_CASE("what is placed in balance rests from its first step on") {
    Column column = make_column(12, 0.05);
    for (int i = 0; i < 10; ++i) {
      run(column.world, 1);
      for (const BodyId box : column.boxes) CHECK(length(column.world.velocity(box)) < Real(1e-3));
    }
    // A box that is thrown at others is not part of a balance.
    Column thrown = make_column(2, 0.05);
    BodyDesc fast = box({0, 0.25, 0}, 0.05);
    fast.velocity = {Real(0), Real(0), Real(2)};
    take(thrown.world.add_body(fast));
    run(thrown.world, 1);
    CHECK(!is_direct(thrown.world));
  }

  TEST_CASE("what an island may cost is the same after a restoration, however its bodies lie to gravity") {
    // A pyramid of 10 rows, each three times as heavy as the one below, is within the budget only while the
    // heavy box beside it is uphill.
    Column pyramid = make_pyramid(10, [](int row) { return kDensity * std::pow(3.0, row); });
    World& world = pyramid.world;
    BodyDesc heavy = box({-2 * kPyramidHalf, kPyramidHalf, 0}, kPyramidHalf, 1000 * kDensity);
    take(world.add_body(heavy));
    const auto gravity = [](double lean) {
      const auto g = static_cast<Real>(kGravity);
      return Vec3{g * static_cast<Real>(lean), -g, Real(0)};
    };
    REQUIRE(world.set_gravity(gravity(0.02)));
    run(world, 3);
    CHECK(is_direct(world));
    REQUIRE(world.set_gravity(gravity(-0.02)));
    const Snapshot snapshot = world.snapshot();
    run(world, 5);
    World other = make_world(restless());
    REQUIRE(other.restore(snapshot));
    run(other, 5);
    CHECK(other.state_hash() == world.state_hash());
  }

  TEST_CASE("hard islands give the same bits with any number of workers, and after a restoration") {
    const auto build = [](int workers) {
      Column column = make_column(14, 0.05, 0.001, restless(workers));
      for (int k = 1; k < 4; ++k) {
        for (int i = 0; i < 12 + k; ++i) take(column.world.add_body(box({1.0 * k, 0.1 * i + 0.05, 0}, 0.05)));
      }
      return column;
    };
    Column one = build(1);
    Column three = build(3);
    run(one.world, 40);
    run(three.world, 40);
    REQUIRE(is_direct(one.world));
    CHECK(one.world.state_hash() == three.world.state_hash());
    const Snapshot snapshot = one.world.snapshot();
    run(one.world, 20);
    const std::uint64_t once = one.world.state_hash();
    REQUIRE(one.world.restore(snapshot).has_value());
    run(one.world, 20);
    CHECK(one.world.state_hash() == once);
  }
}

}  // namespace hooke
