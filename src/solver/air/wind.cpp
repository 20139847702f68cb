#include "solver/air/wind.h"

#include "base/splitmix.h"

#include <cmath>

namespace hooke::solver {

namespace {

struct Gust {
  double along = 0, across = 0;  ///< Independent, each in [-1, 1].
};

Gust gust_of(std::uint64_t bits) {
  constexpr double kScale = 2.0 / 4294967295.0;
  return {static_cast<double>(bits & 0xFFFFFFFFU) * kScale - 1.0,
          static_cast<double>(bits >> 32) * kScale - 1.0};
}

double smooth(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

/// Cell number, and place in the cell, of one coordinate. A coordinate that is far away or not finite gets
/// the cell at zero.
struct Cell {
  std::int64_t index = 0;
  double weight = 0;

  explicit Cell(double coordinate) {
    if (!(std::abs(coordinate) < 1e15)) return;
    const double whole = std::floor(coordinate);
    index = static_cast<std::int64_t>(whole);
    weight = smooth(coordinate - whole);
  }
};

Gust smooth_gust(const WindDesc& wind, DVec3 place, double time) {
  const double length = static_cast<double>(wind.correlation_length);
  const Cell cells[4] = {Cell(place.x / length), Cell(place.y / length), Cell(place.z / length),
                         Cell(time / static_cast<double>(wind.correlation_time))};
  Gust sum;
  for (int corner = 0; corner < 16; ++corner) {
    std::uint64_t key = wind.seed;
    double weight = 1.0;
    for (int axis = 0; axis < 4; ++axis) {
      const int up = (corner >> axis) & 1;
      key = base::splitmix(key * base::kSplitmixStep + static_cast<std::uint64_t>(cells[axis].index + up));
      weight *= up != 0 ? cells[axis].weight : 1.0 - cells[axis].weight;
    }
    const Gust gust = gust_of(key);
    sum.along += weight * gust.along;
    sum.across += weight * gust.across;
  }
  return sum;
}

/// The paper's eq. 9: rand(1..100) drawn for each step, here divided by 100.
Gust paper_gust(const WindDesc& wind, std::uint64_t step) {
  const std::uint64_t bits = base::splitmix(base::splitmix(wind.seed) + step);
  return {0.01 * static_cast<double>(1 + bits % 100), 0.01 * static_cast<double>(1 + (bits >> 32) % 100)};
}

}  // namespace

DVec3 side_of(Vec3 velocity) {
  const DVec3 main = vector_cast<double>(velocity);
  const DVec3 side = normalize(cross(main, DVec3{0, 1, 0}));
  return side == DVec3{} ? DVec3{1, 0, 0} : side;
}

bool has_gusts(const WindDesc& wind) {
  return wind.gust != Real(0) || wind.side_gust != Real(0);
}

Vec3 wind_at(const WindDesc& wind, DVec3 place, double time, std::uint64_t step) {
  if (!has_gusts(wind)) return wind.velocity;
  const Gust gust =
      wind.gusts == WindDesc::Gusts::kPaper ? paper_gust(wind, step) : smooth_gust(wind, place, time);
  const DVec3 main = vector_cast<double>(wind.velocity);
  const double across = length(main) * static_cast<double>(wind.side_gust) * gust.across;
  const double along = 1.0 + static_cast<double>(wind.gust) * gust.along;
  return vector_cast<Real>(along * main + across * side_of(wind.velocity));
}

}  // namespace hooke::solver
