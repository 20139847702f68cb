/// Measures queries of a world of 10 000 boxes, balls and capsules that lie about on 100 x 100 m, in one
/// thread: time per query. Paths are 50 m long, from 10 m above to the ground or level at 1 m; the counter
/// `found` is the share that hits something.

#include "hooke/hooke.h"

#include <benchmark/benchmark.h>
#include <vector>

namespace {

using namespace hooke;

/// This is a step of the generator of Numerical Recipes, in [0, 1), which gives the same figures on every
/// machine.
double next(std::uint32_t& state) {
  state = 1664525u * state + 1013904223u;
  return static_cast<double>(state >> 8) / static_cast<double>(1 << 24);
}

World make_field() {
  World world = World::create().value();
  (void)world.add_body({.shape = Shape::half_space()}).value();
  const Shape shapes[] = {Shape::box({Real(0.4), Real(0.3), Real(0.4)}), Shape::sphere(Real(0.4)),
                          Shape::capsule(Real(0.2), Real(0.3))};
  std::uint32_t state = 1;
  for (int i = 0; i < 10'000; ++i) {
    const double x = 100 * next(state) - 50;
    (void)world
        .add_body({.kind = BodyKind::kDynamic,
                   .shape = shapes[i % 3],
                   .position = {x, 0.6 + 2.4 * next(state), 100 * next(state) - 50}})
        .value();
  }
  for (int i = 0; i < 30; ++i) world.step(Real(1) / Real(60));
  return world;
}

struct Way {
  DVec3 from, motion;
};

std::vector<Way> make_ways() {
  std::vector<Way> ways;
  std::uint32_t state = 7;
  for (int i = 0; i < 4096; ++i) {
    const bool level = i % 2 == 0;
    const double x = 60 * next(state) - 30;
    const DVec3 from = {x, level ? 1.0 : 10.0, 60 * next(state) - 30};
    const DVec3 towards = {next(state) - 0.5, level ? 0.0 : -0.2, next(state) - 0.5};
    ways.push_back({from, 50.0 * normalize(towards)});
  }
  return ways;
}

template <class Ask>
void run(benchmark::State& state, Ask&& ask) {
  static const World world = make_field();
  static const std::vector<Way> ways = make_ways();
  std::size_t i = 0;
  std::size_t found = 0;
  for (auto _ : state) found += ask(world, ways[i++ % ways.size()]) ? 1 : 0;
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(i);
  state.SetItemsProcessed(state.iterations());
}

void cast_ray(benchmark::State& state) {
  run(state, [](const World& world, const Way& way) {
    return world.cast_ray(way.from, way.motion).value().has_value();
  });
}
BENCHMARK(cast_ray);

void is_ray_blocked(benchmark::State& state) {
  run(state,
      [](const World& world, const Way& way) { return world.is_ray_blocked(way.from, way.motion).value(); });
}
BENCHMARK(is_ray_blocked);

void cast_ball(benchmark::State& state) {
  run(state, [](const World& world, const Way& way) {
    return world.cast_shape(Shape::sphere(Real(0.3)), {way.from}, 0.2 * way.motion).value().has_value();
  });
}
BENCHMARK(cast_ball);

void find_overlaps_of_ball(benchmark::State& state) {
  run(state, [](const World& world, const Way& way) {
    return !world.find_overlaps(Shape::sphere(Real(1)), {way.from}).value().empty();
  });
}
BENCHMARK(find_overlaps_of_ball);

void find_closest(benchmark::State& state) {
  run(state, [](const World& world, const Way& way) {
    return world.find_closest(way.from, Real(20)).value().has_value();
  });
}
BENCHMARK(find_closest);

}  // namespace

BENCHMARK_MAIN();
