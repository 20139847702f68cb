#include "geometry/point_grid.h"

#include <doctest/doctest.h>
#include <limits>
#include <random>

namespace hooke::geometry {

namespace {

std::vector<DVec3> scattered(std::size_t count, double size) {
  std::mt19937 random(7);
  std::vector<DVec3> points;
  const auto next = [&] { return size * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  for (std::size_t i = 0; i < count; ++i) {
    const double x = next();
    const double y = next();
    points.push_back({x, y, next()});
  }
  return points;
}

std::vector<int> visits(const PointGrid& grid, DVec3 place, std::size_t count) {
  std::vector<int> times(count);
  grid.for_each_near(place, [&](std::uint32_t i) { ++times[i]; });
  return times;
}

}  // namespace

TEST_CASE("point grid: visits all that are nearer than a cell once, and no point twice") {
  for (const double size : {0.5, 3.0, 1e7}) {
    CAPTURE(size);
    constexpr double kCell = 0.25;
    std::vector<DVec3> points = scattered(400, size);
    points.push_back(points.front());
    PointGrid grid;
    grid.build(points, kCell);
    for (const DVec3& place : points) {
      const std::vector<int> times = visits(grid, place, points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK(times[i] <= 1);
        if (length(points[i] - place) < kCell) CHECK(times[i] == 1);
      }
    }
  }
}

TEST_CASE("point grid: of points all over it visits few that are far") {
  const std::vector<DVec3> points = scattered(4000, 4);
  PointGrid grid;
  grid.build(points, 0.25);
  double sum = 0;
  for (const DVec3& place : points) {
    for (const int times : visits(grid, place, points.size())) sum += times;
  }
  CHECK(sum / 4000 < 30);  // 27 cells of 0.25 m have 26.4 of them in the mean
}

TEST_CASE("point grid: takes what is not finite, nothing, and fewer points than before") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  PointGrid grid;
  CHECK(visits(grid, {}, 0).empty());
  const std::vector<DVec3> points = {{kNan, 0, 0}, {0, kInfinite, 0}, {0, 0, -1e300}, {0.1, 0, 0}};
  grid.build(points, 0.25);
  CHECK(visits(grid, {}, points.size()) == std::vector<int>{0, 0, 0, 1});
  for (const DVec3& place : points) {
    for (const int times : visits(grid, place, points.size())) CHECK(times <= 1);
  }
  grid.build({}, 0.25);
  CHECK(visits(grid, {0.1, 0, 0}, points.size()) == std::vector<int>{0, 0, 0, 0});
}

}  // namespace hooke::geometry
