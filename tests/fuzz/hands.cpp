/// Rooms in which somebody plays: grabs, throws, shoots, ties, pins, cuts, removes, undoes, rewinds, edits
/// the gravity. All stays finite and told in numbers. The same calls on two threads say the same and come to
/// the same bits, as do steps that are made again.

#include "hooke/session/insight.h"
#include "hooke/session/live_scene.h"
#include "hooke/session/measured_value.h"

#include "fuzz/population.h"
#include "fuzz/room.h"
#include "fuzz/scene_checks.h"
#include "fuzz/target.h"

#include <cmath>
#include <memory>

namespace hooke::fuzz {

namespace {

using app::LiveScene;
using app::Outcome;
using app::Ray;

constexpr std::size_t kTimelineBytes = std::size_t{8} << 20;  // few: the timeline has to thin out

/// A world and the same one on two threads.
struct Twins {
  LiveScene one;
  LiveScene two;

  [[nodiscard]] const Simulation& simulation() const { return one.simulation(); }
  [[nodiscard]] const World& world() const { return one.simulation().world(); }
};

LiveScene live_scene(const Scene& scene, std::uint32_t workers) {
  app::SceneDocument document = {.file = "room.json", .text = "", .scene = scene};
  document.scene.world.workers = workers;
  Loaded<Simulation> simulation = Simulation::create(Scene(document.scene));
  if (!simulation.value) throw Failure("a room is refused: " + to_line(simulation.errors.front()));
  return {std::move(*simulation.value), kTimelineBytes,
          std::make_shared<const app::SceneDocument>(std::move(document))};
}

Population population_of(const Simulation& simulation) {
  Population all;
  for (const SceneObject& object : simulation.objects()) {
    if (object.body) all.bodies.push_back(object.body);
    if (object.rope) all.ropes.push_back(object.rope);
    if (object.cloth) all.cloths.push_back(object.cloth);
    if (object.solid) all.solids.push_back(object.solid);
  }
  return all;
}

/// Where an object of the room is now.
DVec3 place_of(Random& random, const Simulation& simulation) {
  const auto objects = simulation.objects();
  if (objects.empty()) return {};
  const SceneObject& object = objects[random.below(objects.size())];
  const World& world = simulation.world();
  const auto point_of = [&](const PointView& points) {
    return points.size() == 0 ? DVec3{} : points[random.below(points.size())];
  };
  if (object.body) return world.center_of_mass(object.body);
  if (object.rope) return point_of(world.positions(object.rope));
  if (object.cloth) return point_of(world.positions(object.cloth));
  if (object.solid) return point_of(world.positions(object.solid));
  return {};
}

/// Mostly a line of sight to an object.
Ray make_ray(Random& random, const Simulation& simulation) {
  if (random.chance(0.05))
    return {{bad_number(random), 1, bad_number(random)}, {bad_number(random), bad_number(random), 1}};
  const DVec3 eye = DVec3{0, 3, 0} + random.place(5);
  if (random.chance(0.1)) return {eye, random.place(10)};
  return {eye, 2.0 * (place_of(random, simulation) - eye)};
}

double number(Random& random, double low, double high) {
  return random.chance(0.1) ? bad_number(random) : random.between(low, high);
}

app::Action make_edit(Random& random, const LiveScene& live) {
  app::SceneDocument edited = *live.document();
  edited.scene.world.gravity = random.chance(0.1) ? Vec3{0, static_cast<Real>(bad_number(random)), 0}
                                                  : Vec3{0, random.real(-12, 2), 0};
  return app::Edit{std::make_shared<const app::SceneDocument>(std::move(edited)), "gravity"};
}

app::Action make_action(Random& random, const LiveScene& live) {
  const Simulation& simulation = live.simulation();
  switch (random.below(12)) {
    case 0:
    case 1:
      return app::Grab{make_ray(random, simulation)};
    case 2:
    case 3:
      return app::MoveHand{random.chance(0.1) ? DVec3{bad_number(random), bad_number(random), 0}
                                              : DVec3{0, 2, 0} + random.place(3)};
    case 4:
      return app::Release{};
    case 5: {
      const Ray ray = make_ray(random, simulation);
      const double speed = number(random, 0, 60);
      return app::Shoot{ray, speed, number(random, 0.02, 0.3)};
    }
    case 6: {
      const auto objects = simulation.objects();
      const std::string name = objects.empty() ? "" : objects[random.below(objects.size())].name;
      const Ray ray = make_ray(random, simulation);
      return app::Drop{name, ray, number(random, 0.5, 5)};
    }
    case 7:
      return app::Pin{make_ray(random, simulation)};
    case 8: {
      const Ray first = make_ray(random, simulation);
      return app::Tie{first, make_ray(random, simulation)};
    }
    case 9:
      return app::Remove{make_ray(random, simulation)};
    case 10: {
      const Ray first = make_ray(random, simulation);
      return app::Cut{first, {first.origin, first.motion + random.place(3)}};
    }
    default:
      return make_edit(random, live);
  }
}

void check_told(const std::vector<app::MeasuredValue>& values) {
  for (const app::MeasuredValue& value : values)
    expect(std::isfinite(value.value), value.name + " is told as no number");
}

void check_state(Random& random, const Twins& twins) {
  const Simulation& simulation = twins.simulation();
  (void)check_finite(simulation.world(), population_of(simulation));
  check_tables(simulation.world());
  check_told(app::measure(simulation, ""));
  const auto objects = simulation.objects();
  if (!objects.empty()) check_told(app::measure(simulation, objects[random.below(objects.size())].name));
  app::InsightWish wish;
  for (const app::InsightChoice& choice : app::insight_choices())
    wish.desc.*choice.shown = random.chance(0.3);
  app::InsightMaker insight;
  (void)insight.make(simulation.world(), wish, 0.1);
}

void check_same(const Twins& twins, const char* when) {
  expect(twins.world().state_hash() == twins.two.simulation().world().state_hash(),
         std::string("other bits on two threads, ") + when);
}

void say_same(const Outcome& one, const Outcome& two) {
  note(one.text);
  expect(one.done == two.done && one.text == two.text, "on two threads: " + two.text);
}

void make_steps(Random& random, Twins& twins) {
  const int count = random.integer(1, 12);
  for (int i = 0; i < count; ++i) {
    const bool one = twins.one.step().has_value();
    const bool two = twins.two.step().has_value();
    expect(one == two, "only one of two threads moves");
    if (!one) return note("a step did not move");
  }
  check_state(random, twins);
}

/// Goes back and comes again to the present.
void rewind(Random& random, Twins& twins) {
  const std::uint64_t now = twins.one.step_count();
  const std::uint64_t hash = twins.world().state_hash();
  const std::uint64_t back = random.below(now + 1);
  note("rewind to " + std::to_string(back) + " of " + std::to_string(now));
  expect(twins.one.seek(back).has_value(), "a step that was made is not reached");
  check_state(random, twins);
  expect(twins.one.seek(now).has_value(), "the present is not reached");
  expect(twins.world().state_hash() == hash, "steps that are made again come to other bits");
}

void play(Random& random, Twins& twins) {
  const std::size_t kind = random.below(20);
  if (kind < 13) {
    const app::Action action = make_action(random, twins.one);
    app::Action again = action;
    if (const auto* edit = std::get_if<app::Edit>(&action)) {
      app::SceneDocument document = *edit->document;
      document.scene.world.workers = 2;
      again = app::Edit{std::make_shared<const app::SceneDocument>(std::move(document)), edit->what};
    }
    say_same(twins.one.act(action), twins.two.act(again));
  } else if (kind < 15) {
    say_same(twins.one.undo(), twins.two.undo());
  } else if (kind < 17) {
    say_same(twins.one.redo(), twins.two.redo());
  } else if (kind < 19) {
    rewind(random, twins);
  } else {
    twins.one.restart();
    twins.two.restart();
    note("restart");
  }
}

}  // namespace

void try_hands(Random& random) {
  const Scene scene = make_room(random, 1, 1, 10);
  note(scene.description);
  Twins twins = {live_scene(scene, 1), live_scene(scene, 2)};
  const int turns = random.integer(5, 25);
  for (int i = 0; i < turns; ++i) {
    Random own(random.bits());
    if (!has_next_part()) continue;
    play(own, twins);
    make_steps(own, twins);
    check_same(twins, "after steps");
  }
  rewind(random, twins);
}

}  // namespace hooke::fuzz
