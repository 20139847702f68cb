/// Measures the broad phase alone in one thread: milliseconds per step of scenes in which only boxes move.
///
/// `pile` has 20 x 20 x 20 cubes of 1 m, 1 m apart; each moves by up to 2 mm a step about its position.
/// `spheres` has 5000 boxes of 1 m, 1.1 m apart, which fall freely from rest, with a step of 1/60 s.
/// `large_world` has 1000 x 1000 boxes of 10 x 0.5 x 10 m that stand in a grid, and one that falls over them.
/// `first/N` is the cost of the first step of N cubes of the pile, `standing/N` that of N cubes that stand.
///
/// The counter `pairs` is how many pairs overlap in the last step.

#include "collision/broad_phase/broad_phase.h"

#include <benchmark/benchmark.h>
#include <cmath>

namespace {

using namespace hooke;
using collision::BroadPhase;
using geometry::Box;

Box cube_at(Vec3 center) {
  const Vec3 half = {Real(0.5), Real(0.5), Real(0.5)};
  return {center - half, center + half};
}

/// This is a step of the generator of Numerical Recipes, in [-1, 1], which gives the same figures on every
/// machine.
struct Noise {
  std::uint32_t state = 12345;

  Real next() {
    state = 1664525u * state + 1013904223u;
    return static_cast<Real>(state >> 8) / static_cast<Real>(1 << 23) - Real(1);
  }
  Vec3 next_vector(Real size) {
    const Real x = next();
    const Real y = next();
    return {size * x, size * y, size * next()};
  }
};

std::vector<Vec3> lattice(int count, int columns, Real spacing) {
  std::vector<Vec3> centers;
  for (int i = 0; i < count; ++i) {
    const int layer = i / (columns * columns);
    const int row = i / columns % columns;
    centers.push_back({spacing * Real(i % columns), spacing * Real(layer), spacing * Real(row)});
  }
  return centers;
}

void add_ground(BroadPhase& broad_phase, std::uint32_t collider) {
  constexpr Real kFar = Box::kFar;
  broad_phase.set(collider, {{-kFar, -kFar, -kFar}, {kFar, Real(0), kFar}}, false);
}

void pile(benchmark::State& state) {
  const std::vector<Vec3> centers = lattice(8000, 20, Real(1));
  BroadPhase broad_phase;
  parallel::ThreadPool pool(1);
  std::vector<collision::ColliderPair> pairs;
  Noise noise;
  add_ground(broad_phase, 8000);
  for (auto _ : state) {
    for (std::uint32_t c = 0; c < centers.size(); ++c) {
      broad_phase.set(c, cube_at(centers[c] + noise.next_vector(Real(0.002))), true);
    }
    broad_phase.find_pairs(pool, pairs);
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
}

void spheres(benchmark::State& state) {
  const std::vector<Vec3> centers = lattice(5000, 20, Real(1.1));
  parallel::ThreadPool pool(1);
  std::vector<collision::ColliderPair> pairs;
  BroadPhase broad_phase;
  int step = 0;
  for (auto _ : state) {
    if (step == 120) {
      state.PauseTiming();
      broad_phase.clear();
      step = 0;
      state.ResumeTiming();
    }
    const Real fall = Real(0.5 * 9.81) * Real(step * step) / Real(3600);
    for (std::uint32_t c = 0; c < centers.size(); ++c) {
      broad_phase.set(c, cube_at(centers[c] - Vec3{Real(0), fall, Real(0)}), true);
    }
    broad_phase.find_pairs(pool, pairs);
    ++step;
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
}

void add_tiles(BroadPhase& broad_phase, int count) {
  const Vec3 half = {Real(5), Real(0.25), Real(5)};
  for (int i = 0; i < count; ++i) {
    const Vec3 center = {Real(10 * (i % 1000)), Real(0), Real(10 * (i / 1000))};
    broad_phase.set(static_cast<std::uint32_t>(i), {center - half, center + half}, false);
  }
}

void large_world(benchmark::State& state) {
  BroadPhase broad_phase;
  parallel::ThreadPool pool(1);
  std::vector<collision::ColliderPair> pairs;
  add_tiles(broad_phase, 1000000);
  int step = 0;
  for (auto _ : state) {
    const auto way = static_cast<Real>(++step % 100000);
    broad_phase.set(1000000, cube_at({Real(4000) + Real(0.02) * way, Real(0.5), Real(5000)}), true);
    broad_phase.find_pairs(pool, pairs);
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
}

void first(benchmark::State& state) {
  const std::vector<Vec3> centers = lattice(static_cast<int>(state.range(0)), 20, Real(1.25));
  parallel::ThreadPool pool(1);
  std::vector<collision::ColliderPair> pairs;
  for (auto _ : state) {
    BroadPhase broad_phase;
    for (std::uint32_t c = 0; c < centers.size(); ++c) broad_phase.set(c, cube_at(centers[c]), true);
    broad_phase.find_pairs(pool, pairs);
  }
}

void standing(benchmark::State& state) {
  for (auto _ : state) {
    BroadPhase broad_phase;
    add_tiles(broad_phase, static_cast<int>(state.range(0)));
    broad_phase.update();
  }
}

BENCHMARK(pile)->Unit(benchmark::kMillisecond);
BENCHMARK(spheres)->Unit(benchmark::kMillisecond)->Iterations(1200);
BENCHMARK(large_world)->Unit(benchmark::kMillisecond);
BENCHMARK(first)->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(standing)->Arg(10000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
