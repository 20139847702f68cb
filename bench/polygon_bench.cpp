/// Measures whether points are in a convex polygon, by each function of hooke/geometry.h: nanoseconds per
/// question, for 3 to 64 corners. Half of the points are inside.

#include "hooke/geometry.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <vector>

namespace {

using hooke::DVec3;
using hooke::Polygon;

using IsInside = bool (*)(const Polygon&, DVec3, double);

Polygon regular(std::int64_t corners) {
  std::vector<DVec3> points;
  for (std::int64_t k = 0; k < corners; ++k) {
    const double angle = 2 * std::acos(-1.0) * static_cast<double>(k) / static_cast<double>(corners);
    points.push_back({std::cos(angle), std::sin(angle), 0});
  }
  return hooke::make_polygon(points, 1e-9).value();
}

void ask(benchmark::State& state, IsInside is_inside) {
  const Polygon polygon = regular(state.range(0));
  std::vector<DVec3> points;
  // The spiral of the golden angle covers a disk of twice the polygon's area evenly.
  constexpr int kPoints = 1024;
  for (int i = 0; i < kPoints; ++i) {
    const double r = std::sqrt(2.0 * i / kPoints);
    points.push_back({r * std::cos(2.399963 * i), r * std::sin(2.399963 * i), 0});
  }
  std::size_t inside = 0;
  for ([[maybe_unused]] auto _ : state) {
    inside = 0;
    for (const DVec3& p : points) inside += is_inside(polygon, p, 1e-9) ? 1 : 0;
    benchmark::DoNotOptimize(inside);
  }
  state.SetItemsProcessed(state.iterations() * kPoints);
  state.counters["inside"] = static_cast<double>(inside);
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(3)->Arg(4)->Arg(8)->Arg(64);
}

BENCHMARK_CAPTURE(ask, cross_products, hooke::is_inside_by_cross_products)->Apply(sizes);
BENCHMARK_CAPTURE(ask, angles, hooke::is_inside_by_angles)->Apply(sizes);
BENCHMARK_CAPTURE(ask, side_planes, hooke::is_inside_by_side_planes)->Apply(sizes);
BENCHMARK_CAPTURE(ask, winding, hooke::is_inside_by_winding)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
