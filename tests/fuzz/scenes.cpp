/// Valid scenes of every kind of object, stepped. All must stay finite and healthy. Calm ones, where things
/// stand apart and nothing drives them, must not gain energy; in driven ones, where they stand apart too,
/// speed must be one that something accounts for; in crowds they begin anywhere, in each other too.

#include "hooke/world.h"

#include "fuzz/exclusions.h"
#include "fuzz/mesh_maker.h"
#include "fuzz/population.h"
#include "fuzz/scene_checks.h"
#include "fuzz/target.h"

#include <algorithm>
#include <cstdio>

namespace hooke::fuzz {

namespace {

enum class Mood : std::uint8_t { kCalm, kDriven, kCrowd };

constexpr Real kStep = Real(1) / Real(60);

std::string text_of(const char* name, double value) {
  char text[80];
  std::snprintf(text, sizeof(text), "%s %.6g", name, value);
  return text;
}

void add_meshes(Random& random, World& world, Population& all) {
  const int count = random.integer(0, 2);
  for (int i = 0; i < count; ++i) {
    const MeshDesc mesh = fuzz::make_solid(random, 0.3);
    const MeshTree tree = random.chance(0.3) ? MeshTree::kPlanes : MeshTree::kBoxes;
    const Result<MeshId> id = world.add_mesh(mesh, tree);
    if (id) all.meshes.solid.push_back(*id);
  }
}

/// One object of a random kind.
void add_object(Random& random, DVec3 place, Taste taste, World& world, Population& all) {
  switch (random.below(8)) {
    case 0:
      note("rope");
      all.ropes.push_back(must(world.add_rope(make_rope(random, place, taste)), "rope"));
      break;
    case 1: {
      note("cloth");
      const Result<ClothId> id = world.add_cloth(make_cloth(random, place, all.meshes, taste));
      if (id)
        all.cloths.push_back(*id);  // meshes are no cloth where a ring of them is closed but must not be
      break;
    }
    case 2: {
      note("solid");
      const Result<SolidId> id = world.add_solid(make_solid(random, place, all.meshes));
      if (id) all.solids.push_back(*id);  // thin meshes have no cell inside
      break;
    }
    case 3: {
      note("particles");
      const Result<ParticlesId> id = world.add_particles(make_particles(random, place));
      if (id) all.particles.push_back(*id);
      break;
    }
    default: {
      note("body");
      const Result<BodyId> id = world.add_body(make_body(random, place, all.meshes, taste));
      if (id) all.bodies.push_back(*id);  // thin meshes have no mass
    }
  }
}

HookEnd pick_end(Random& random, const World& world, const Population& all, bool of_point) {
  if (of_point) return {.point = pick_point(random, world, all)};
  if (all.bodies.empty() || random.chance(0.2)) return {};
  return {.body = random.one_of(all.bodies)};
}

/// Hooks between what is there. Points that are hooked are drawn together, from any distance: only in crowds.
/// Some ends are of no use and are refused.
void add_hooks(Random& random, Mood mood, World& world, Population& all) {
  const Taste taste = {.may_drive = mood != Mood::kCalm};
  const int count = random.integer(0, 5);
  for (int i = 0; i < count; ++i) {
    Random own(random.bits());
    if (!has_next_part()) continue;
    const bool of_points = own.chance(0.4);
    const HookEnd a = pick_end(own, world, all, of_points);
    const HookEnd b = pick_end(own, world, all, of_points && own.chance(0.2) && mood == Mood::kCrowd);
    const DVec3 place = a.body ? world.center_of_mass(a.body) + own.place(0.2) : own.place(2);
    HookDesc hook = make_hook(own, place, of_points, taste);
    hook.a = a;
    hook.b = b;
    const Result<HookId> id = world.add_hook(hook);
    if (id) all.hooks.push_back(*id);
    note(id ? "hook " + std::to_string(static_cast<int>(hook.kind)) : "hook refused: " + id.error().where);
  }
}

void add_floor(Random& random, World& world, Population& all) {
  BodyDesc floor;
  floor.contact = make_contact(random);
  if (random.chance(0.3)) {
    floor.shape = Shape::box({20, 1, 20});
    floor.position = {0, -1, 0};
  }
  all.bodies.push_back(must(world.add_body(floor), "floor"));
}

/// What a scene may account for.
struct Account {
  Mood mood = Mood::kCalm;
  bool was_hooked = false;
  double energy = 0;  ///< At the start [J].
  double speed = 0;   ///< At the start [m/s].
};

void check_speed(const World& world, const Population& all, const Account& account, double fastest) {
  if (kLeftOut.speed_in_crowds && account.mood == Mood::kCrowd) return;
  if (kLeftOut.speed_of_cloths && !all.cloths.empty()) return;
  if (kLeftOut.speed_of_hooks && account.was_hooked) return;
  const double fall = 40 * world.time();  // fields and gravity [m/s]
  const double most = 3 * (account.speed + fall) + 60;
  if (fastest > most) throw Failure(text_of("too fast:", fastest) + text_of(" m/s, may be", most));
}

void check_energy(const World& world, const Population& all, const Account& account) {
  if (kLeftOut.energy_of_cloths && !all.cloths.empty()) return;
  if (kLeftOut.energy_of_ropes && !all.ropes.empty()) return;
  if (kLeftOut.energy_of_solids && !all.solids.empty()) return;
  if (kLeftOut.energy_of_hooks && account.was_hooked) return;
  const double now = world.measure().energy.total();
  const double most = account.energy + 0.02 * account.energy + 0.05;
  if (now > most) throw Failure(text_of("energy grows: from", account.energy) + text_of(" to", now));
}

bool may_be_ill(const Population& all) {
  return kLeftOut.health_of_cloths && !all.cloths.empty();
}

void step_scene(Random& random, Mood mood, World& world, Population& all) {
  const Account account = {.mood = mood,
                           .was_hooked = !all.hooks.empty(),
                           .energy = world.measure().energy.total(),
                           .speed = check_finite(world, all)};
  const int steps = random.integer(5, 60);
  std::optional<Snapshot> snapshot;
  for (int i = 0; i < steps; ++i) {
    if (i == steps / 2 && random.chance(0.2)) snapshot = world.snapshot();
    const StepReport report = world.step(kStep);
    expect(report.healthy() || may_be_ill(all), "an unhealthy step");
    check_tables(world);
    for (const HookId id : world.broken_hooks()) std::erase(all.hooks, id);
    const double fastest = check_finite(world, all);
    if (setting().verbose)
      note(text_of("speed", fastest) + text_of(" energy", world.measure().energy.total()));
    check_speed(world, all, account, fastest);
    if (account.mood == Mood::kCalm) check_energy(world, all, account);
  }
  if (!snapshot) return;
  const std::uint64_t hash = world.state_hash();
  expect(world.restore(*snapshot).has_value(), "a snapshot refused");
  (void)world.set_workers(2);
  for (int i = steps / 2; i < steps; ++i) (void)world.step(kStep);
  expect(world.state_hash() == hash, "moves differently after a restore, or on two threads");
}

}  // namespace

void try_scene(Random& random) {
  const Mood mood = random.pick<Mood>({Mood::kCalm, Mood::kCalm, Mood::kDriven, Mood::kCrowd});
  const Taste taste = {.may_drive = mood != Mood::kCalm};
  note(mood == Mood::kCalm ? "calm" : mood == Mood::kDriven ? "driven" : "crowd");
  World world = must(World::create(make_world(random, taste)), "world");
  Population all;
  if (mood == Mood::kCalm || random.chance(0.7)) add_floor(random, world, all);
  add_meshes(random, world, all);
  const int objects = random.integer(1, 12);
  const double spread = random.pick<double>({0.2, 1, 3});
  for (int i = 0; i < objects; ++i) {
    Random own(random.bits());
    const DVec3 apart = {3.0 * (i % 3), 2 + 3.0 * (i / 9), 3.0 * (i / 3 % 3)};
    const DVec3 place = mood == Mood::kCrowd ? own.place(spread) + DVec3{0, spread, 0} : apart;
    if (has_next_part()) add_object(own, place, taste, world, all);
  }
  add_hooks(random, mood, world, all);
  if (taste.may_drive && random.chance(0.4))
    all.fields.push_back(must(world.add_field(make_field(random, random.place(2))), "field"));
  step_scene(random, mood, world, all);
}

}  // namespace hooke::fuzz
