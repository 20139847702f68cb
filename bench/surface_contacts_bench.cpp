/// Measures what contacts of cloths with each other and with themselves cost: four square sheets, one above
/// the other, with a thickness of a quarter of an edge and 8 particle substeps. They lie, slide, fall on a
/// ball, or stand on their edges and fold. Prints times of single steps, which must grow as the number of
/// points does and have no spikes.
///
///     surface_contacts_bench [WORKERS [FRAMES [LARGEST [SCENE]]]]
///
/// LARGEST is the largest number of points of a scene, SCENE the name of the only one. Times of one worker
/// are of the processor, so that other programs count less; those of several are of the clock, since threads
/// share the work. The hash of the last state must not depend on workers or on how fast it is found.

#include "hooke/hooke.h"

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

namespace {

using namespace hooke;

constexpr Real kFrame = Real(1) / Real(60);  // [s]
constexpr Real kEdge = Real(0.02);           // [m]
constexpr int kLayers = 4;
constexpr double kGap = 1.5 * 0.25 * 0.02;  // Between layers [m].

ClothDesc sheet(int n) {
  ClothDesc desc;
  desc.columns = desc.rows = n;
  desc.width = desc.height = kEdge * static_cast<Real>(n - 1);
  desc.row_direction = {Real(0), Real(0), Real(1)};
  desc.thickness = Real(0.25) * kEdge;
  desc.bend_stiffness = Real(1e-5);
  desc.drag_coefficient = desc.lift_coefficient = Real(0);
  desc.self_contact = true;
  return desc;
}

void add_layers(int n, double height, World& world) {
  for (int layer = 0; layer < kLayers; ++layer) {
    ClothDesc desc = sheet(n);
    const double half = 0.5 * static_cast<double>(desc.width);
    desc.corner = {-half + 0.003 * layer, height + kGap * layer, -half};
    (void)world.add_cloth(desc).value();
  }
}

World make_world(int workers, Vec3 gravity) {
  World world = World::create({.gravity = gravity, .substeps = 8, .workers = workers}).value();
  (void)world.add_body({.kind = BodyKind::kStatic, .shape = {.kind = ShapeKind::kHalfSpace}}).value();
  return world;
}

World lying(int n, int workers) {
  World world = make_world(workers, {Real(0), Real(-9.81), Real(0)});
  add_layers(n, 0.004, world);
  return world;
}

/// On a slope of 40 degrees, by gravity; the sheets begin at rest.
World sliding(int n, int workers) {
  World world = make_world(workers, {Real(6.306), Real(-7.515), Real(0)});
  add_layers(n, 0.004, world);
  return world;
}

World falling(int n, int workers) {
  World world = make_world(workers, {Real(0), Real(-9.81), Real(0)});
  const Real width = kEdge * static_cast<Real>(n - 1);
  const Real radius = Real(0.2) * width;
  const double middle = 0.5 * static_cast<double>(width);
  (void)world
      .add_body({.kind = BodyKind::kStatic,
                 .shape = {.kind = ShapeKind::kSphere, .radius = radius},
                 .position = {0, middle, 0}})
      .value();
  add_layers(n, middle + static_cast<double>(radius) + 0.03, world);
  return world;
}

World folding(int n, int workers) {
  World world = make_world(workers, {Real(0), Real(-9.81), Real(0)});
  for (int layer = 0; layer < kLayers; ++layer) {
    ClothDesc desc = sheet(n);
    desc.column_direction = {Real(0), Real(0), Real(1)};
    desc.row_direction = {Real(0.05), Real(-1), Real(0)};
    const auto height = static_cast<double>(desc.height);
    desc.corner = {kGap * layer, height + 0.01, -0.5 * height};
    (void)world.add_cloth(desc).value();
  }
  return world;
}

struct Scene {
  const char* name;
  World (*make)(int n, int workers);
};

/// Largest of what steps report, and their times in ascending order [ms].
struct Figures {
  std::vector<double> times;
  std::uint32_t contacts = 0, pairs = 0, held_back = 0;
  double searches = 0;

  /// The time that `share` of the steps stay under [ms].
  [[nodiscard]] double time_of(double share) const {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  }
};

Figures measure(World& world, int workers, int frames) {
  using Clock = std::chrono::steady_clock;
  const auto processor_ms = [] { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  (void)world.step(kFrame);  // It makes what is kept from step to step.
  Figures figures;
  for (int i = 0; i < frames; ++i) {
    const Clock::time_point start = Clock::now();
    const double start_ms = processor_ms();
    const StepReport report = world.step(kFrame);
    const double taken_ms = processor_ms() - start_ms;
    const double passed_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    figures.times.push_back(workers == 1 ? taken_ms : passed_ms);
    figures.contacts = std::max(figures.contacts, report.contacts);
    figures.pairs = std::max(figures.pairs, report.surface_pairs);
    figures.held_back += report.points_held_back;
    figures.searches += static_cast<double>(report.surface_searches) / frames;
  }
  std::sort(figures.times.begin(), figures.times.end());
  return figures;
}

int argument(int count, char** arguments, int i, int otherwise) {
  return count > i ? std::max(1, std::atoi(arguments[i])) : otherwise;
}

}  // namespace

int main(int argc, char** argv) {
  const int workers = std::min(64, argument(argc, argv, 1, 1));
  const int frames = argument(argc, argv, 2, 120);
  const int largest = argument(argc, argv, 3, 40000);
  constexpr Scene kScenes[] = {
      {"lying", lying}, {"sliding", sliding}, {"falling on a ball", falling}, {"folding", folding}};
  std::printf("%d workers, %d frames; times in ms\n", workers, frames);
  std::printf("%-18s %8s %9s %9s %9s %8s %8s %8s %13s %9s %17s\n", "scene", "points", "contacts", "pairs",
              "searches", "median", "95 %", "worst", "worst/median", "held back", "state");
  const std::string only = argc > 4 ? argv[4] : "";
  for (const Scene& scene : kScenes) {
    for (const int n : {25, 50, 100}) {
      if (!only.empty() && only != scene.name) continue;
      if (kLayers * n * n > largest) continue;
      World world = scene.make(n, workers);
      const Figures f = measure(world, workers, frames);
      std::printf("%-18s %8d %9u %9u %9.2f %8.2f %8.2f %8.2f %13.2f %9u %17" PRIx64 "\n", scene.name,
                  kLayers * n * n, f.contacts, f.pairs, f.searches, f.time_of(0.5), f.time_of(0.95),
                  f.times.back(), f.times.back() / f.time_of(0.5), f.held_back, world.state_hash());
      std::fflush(stdout);
    }
  }
}
