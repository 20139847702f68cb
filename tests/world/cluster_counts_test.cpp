#include "hooke/hooke.h"

#include <algorithm>
#include <cstdint>
#include <doctest/doctest.h>
#include <vector>

/// What a step says of the groups that it solved as a whole, and of what was beyond its budgets.

using hooke::BodyDesc;
using hooke::BodyId;
using hooke::BodyKind;
using hooke::DVec3;
using hooke::Real;
using hooke::Shape;
using hooke::StepReport;
using hooke::World;

namespace {

constexpr Real kStep = Real(1) / Real(60);
constexpr double kMesh = 0.2;  ///< [m]

BodyDesc body(Shape shape, DVec3 position, double mass) {
  BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = shape, .position = position};
  desc.mass = static_cast<Real>(mass);
  return desc;
}

struct Net {
  World world = World::create({.sleeping = false}).value();
  std::uint32_t hooks = 0;
};

/// A net of n x n balls of 0.1 kg, which hangs on its rim, with a box of 200 kg a little above its middle.
Net net_under_box(int n) {
  Net net;
  std::vector<BodyId> balls;
  const auto place = [](int column, int row) { return DVec3{kMesh * column, 2, kMesh * row}; };
  const auto hook = [&](hooke::HookEnd a, BodyId b, DVec3 anchor) {
    (void)net.world.add_hook({.a = a, .b = {.body = b}, .anchor = anchor}).value();
    ++net.hooks;
  };
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      const DVec3 at = place(column, row);
      const BodyId ball = net.world.add_body(body(Shape::sphere(Real(0.05)), at, 0.1)).value();
      if (column > 0) hook({.body = balls.back()}, ball, at - DVec3{kMesh / 2, 0, 0});
      if (row > 0)
        hook({.body = balls[balls.size() - static_cast<std::size_t>(n)]}, ball, at - DVec3{0, 0, kMesh / 2});
      const bool is_rim = row == 0 || column == 0 || row == n - 1 || column == n - 1;
      balls.push_back(ball);
      if (is_rim) hook({}, ball, at);
    }
  }
  const double middle = kMesh * (n - 1) / 2;
  (void)net.world.add_body(body(Shape::box({Real(0.3), Real(0.1), Real(0.3)}), {middle, 2.2, middle}, 200))
      .value();
  return net;
}

}  // namespace

TEST_SUITE("world/cluster counts") {
  TEST_CASE("a net beyond the budget says how many of its rows are refused, and how far it gapes") {
    Net net = net_under_box(30);
    StepReport report;
    double most = 0;
    for (int i = 0; i < 30; ++i) {
      report = net.world.step(kStep);
      CHECK(report.rows_refused == 3 * net.hooks);
      CHECK(report.worst_error ==
            doctest::Approx(static_cast<double>(net.world.measure().largest_gap)).epsilon(0.01));
      most = std::max(most, report.worst_error);
    }
    CHECK(most > 0.04);
    CHECK(report.clusters == 0);
    CHECK(report.rows_direct == 0);
  }

  TEST_CASE("a net within the budget is one cluster, and nothing is refused") {
    Net net = net_under_box(6);
    for (int i = 0; i < 30; ++i) {
      const StepReport report = net.world.step(kStep);
      CHECK(report.clusters == 1);
      CHECK(report.rows_direct >= 3 * net.hooks);
      CHECK(report.rows_refused == 0);
      CHECK(report.worst_error == 0);
    }
    CHECK(static_cast<double>(net.world.measure().largest_gap) < 1e-3);
  }

  TEST_CASE("a stack of eleven cubes is one cluster of 77 rows") {
    // A contact of two faces has four points, two rows of friction and one of twist.
    World world = World::create({.sleeping = false}).value();
    (void)world.add_body({.shape = Shape::half_space()}).value();
    const Shape cube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});
    for (int i = 0; i <= 10; ++i)
      (void)world.add_body(body(cube, {0, 0.5 + i, 0}, i == 10 ? 1e5 : 1e3)).value();
    StepReport report;
    for (int i = 0; i < 5; ++i) report = world.step(kStep);
    CHECK(report.clusters == 1);
    CHECK(report.rows_direct == 77);
    CHECK(report.rows_refused == 0);
  }

  TEST_CASE("a pyramid of too many boxes under a heavy one is refused until it is evaluated again") {
    // 300 boxes are more than a direct island may have.
    World world = World::create({.sleeping = false}).value();
    (void)world.add_body({.shape = Shape::half_space()}).value();
    const Shape cube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});
    constexpr int kRows = 24;
    for (int row = 0; row < kRows; ++row) {
      for (int i = 0; i < kRows - row; ++i)
        (void)world.add_body(body(cube, {1.0 * i + 0.5 * row, 0.5 + row, 0}, row == kRows - 1 ? 1e5 : 1e3))
            .value();
    }
    double most = 0;
    (void)world.step(kStep);  // Its islands are evaluated at the end of this step.
    for (int i = 0; i < 100; ++i) {
      const StepReport report = world.step(kStep);
      if (i < 59) CHECK(report.rows_refused >= 7 * 300);
      most = std::max(most, report.worst_error);
    }
    CHECK(most > 0.005);  // Half a percent of a box is what soft contacts may sink.
  }
}
