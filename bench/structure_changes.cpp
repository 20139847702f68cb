/// Measures what a change of structure beside a large cloth costs: the call that makes it, and how much
/// longer the next step takes than one without a change. The cloth has 101 x 101 points and 20 000 triangles.
/// One thread; medians of its processor time, so that what else the machine does counts little.

#include "hooke/hooke.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace {

using namespace hooke;

constexpr int kRepeats = 41;
constexpr Real kStep = Real(1) / Real(60);

double now_ms() {
  std::timespec t = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

ClothDesc large_cloth(ClothDesc::Bend bend) {
  ClothDesc cloth;
  cloth.columns = cloth.rows = 101;
  cloth.corner = {0, 3, 0};
  cloth.width = Real(2);
  cloth.height = Real(2);
  cloth.bend = bend;
  cloth.tethers = true;
  for (const std::uint32_t point : {0U, 100U}) cloth.pins.push_back({.point = point});
  return cloth;
}

struct Times {
  double call = 0, undo = 0, step = 0, step_after_call = 0, step_after_undo = 0;
};

/// One change and the one that takes it back.
struct Change {
  const char* name;
  std::function<void(World&)> make, undo;
};

double timed(const std::function<void()>& work) {
  const double start = now_ms();
  work();
  return now_ms() - start;
}

Times measure(World& world, const Change& change) {
  std::vector<double> calls, undos, steps, after_call, after_undo;
  const auto step = [&] { (void)world.step(kStep); };
  for (int i = 0; i < kRepeats; ++i) {
    steps.push_back(timed(step));
    calls.push_back(timed([&] { change.make(world); }));
    after_call.push_back(timed(step));
    steps.push_back(timed(step));
    undos.push_back(timed([&] { change.undo(world); }));
    after_undo.push_back(timed(step));
  }
  return {median(calls), median(undos), median(steps), median(after_call), median(after_undo)};
}

/// A change that adds something and removes it again.
template <class Id>
Change adding(const char* name, std::function<Id(World&)> add) {
  auto id = std::make_shared<Id>();
  return {name, [id, add](World& world) { *id = add(world); }, [id](World& world) { world.remove(*id); }};
}

ParticlesDesc free_points(std::uint32_t count) {
  ParticlesDesc points;
  for (std::uint32_t i = 0; i < count; ++i)
    points.particles.push_back({.position = {10 + 0.1 * i, 3, 0}, .mass = Real(0.1)});
  return points;
}

RopeDesc free_rope() {
  RopeDesc rope;
  rope.hook_point = {14, 3, 0};
  rope.masses = 51;
  return rope;
}

std::vector<Change> changes(BodyId a, BodyId b, ClothId cloth) {
  ParticlesDesc sprung = free_points(2);
  sprung.springs.push_back({.a = 0, .b = 1, .stiffness = Real(100)});
  ClothDesc triangle_pair;
  triangle_pair.columns = triangle_pair.rows = 2;
  triangle_pair.corner = {20, 3, 0};
  return {
      adding<ParticlesId>("particle", [](World& w) { return w.add_particles(free_points(1)).value(); }),
      adding<ParticlesId>("two particles, spring", [=](World& w) { return w.add_particles(sprung).value(); }),
      adding<ClothId>("cloth of 2 triangles", [=](World& w) { return w.add_cloth(triangle_pair).value(); }),
      adding<RopeId>("rope of 50 segments", [](World& w) { return w.add_rope(free_rope()).value(); }),
      adding<BodyId>("body",
                     [](World& w) {
                       return w
                           .add_body({.kind = BodyKind::kDynamic,
                                      .shape = Shape::sphere(Real(0.2)),
                                      .position = {20, 8, 0}})
                           .value();
                     }),
      adding<HookId>(
          "hook of two bodies",
          [=](World& w) {
            return w.add_hook({.kind = HookKind::kBall, .a = {.body = a}, .b = {.body = b}}).value();
          }),
      {"pin of the cloth", [=](World& w) { (void)w.pin(point(cloth, 5000), {}); },
       [=](World& w) { (void)w.unpin(point(cloth, 5000)); }},
      {"tethered pin of it", [=](World& w) { (void)w.unpin(point(cloth, 0)); },
       [=](World& w) { (void)w.pin(point(cloth, 0), {}); }},
  };
}

void measure_beside(ClothDesc::Bend bend, const char* name) {
  World world = World::create({.workers = 1}).value();
  const ClothId cloth = world.add_cloth(large_cloth(bend)).value();
  const BodyDesc ball = {
      .kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.2)), .position = {20, 5, 0}};
  const BodyId a = world.add_body(ball).value();
  BodyDesc other = ball;
  other.position.x += 1;
  const BodyId b = world.add_body(other).value();
  for (int i = 0; i < 5; ++i) (void)world.step(kStep);
  std::printf("\n%s: ms          call   step after  |   undo   step after\n", name);
  for (const Change& change : changes(a, b, cloth)) {
    const Times t = measure(world, change);
    std::printf("%-22s %8.3f %8.3f     | %8.3f %8.3f   (step %.2f)\n", change.name, t.call,
                t.step_after_call - t.step, t.undo, t.step_after_undo - t.step, t.step);
  }
}

}  // namespace

int main() {
  measure_beside(ClothDesc::Bend::kIsometric, "isometric bends");
  measure_beside(ClothDesc::Bend::kAngle, "bends by angle");
  measure_beside(ClothDesc::Bend::kSpring, "springs that bend");
}
