/// Random rooms at default settings, audited in every step. Those that are known to fail stand in
/// known_rooms.h.

#include "fuzz/known_rooms.h"
#include "fuzz/room.h"
#include "fuzz/target.h"
#include "scenes/scene_audit.h"

#include <algorithm>
#include <cstdio>
#include <set>

namespace hooke::fuzz {

namespace {

using test::Audit;
using test::Figure;
using test::kFigures;
using test::limit_of;
using test::Worst;

/// Leaves out the parts that are not asked for, and the hooks of what is left out.
void keep_asked_parts(Scene& scene) {
  std::set<std::string> there = {""};
  const auto keep = [&](auto& objects) {
    std::erase_if(objects, [](const auto&) { return !has_next_part(); });
    for (const auto& object : objects) there.insert(object.tag.name);
  };
  keep(scene.objects.bodies);
  keep(scene.objects.ropes);
  keep(scene.objects.cloths);
  keep(scene.objects.solids);
  std::erase_if(scene.objects.hooks, [&](const SceneHook& hook) {
    return !has_next_part() || !there.contains(hook.a) || !there.contains(hook.b);
  });
}

/// What a figure may come to in this room.
double limit_in(std::uint64_t seed, Figure figure) {
  for (const KnownRoom& room : kKnownRooms) {
    if (room.seed == seed && room.figure == figure) return 1.2 * room.value;
  }
  return limit_of(figure);
}

void say_what_is_mended(std::uint64_t seed, const Audit& audit) {
  for (const KnownRoom& room : kKnownRooms) {
    if (room.seed != seed || audit.of(room.figure).value > limit_of(room.figure)) continue;
    std::printf("room %llu is sound now, its %s is %.4g: it may leave known_rooms.h\n",
                static_cast<unsigned long long>(seed), name_of(room.figure), audit.of(room.figure).value);
    std::fflush(stdout);
  }
}

}  // namespace

void try_room(Random& random) {
  const std::uint64_t seed = random.seed();
  Scene scene = make_room(random);
  keep_asked_parts(scene);
  if (!setting().save.empty()) (void)save_scene(scene, setting().save);
  note(scene.description);
  const Audit audit = test::run_audit(scene, {}, setting().verbose ? note : nullptr);
  for (std::size_t i = 0; i < kFigures; ++i)
    keep_figure(name_of(static_cast<Figure>(i)), audit.worst[i].value);
  keep_figure("longest step [ms]", audit.milliseconds);
  std::string failed;
  for (std::size_t i = 0; i < kFigures; ++i) {
    const auto figure = static_cast<Figure>(i);
    const Worst& worst = audit.worst[i];
    const bool counts = setting().figure.empty() || setting().figure == name_of(figure);
    if (!counts || worst.value <= std::max(limit_in(seed, figure), setting().above)) continue;
    char text[200];
    std::snprintf(text, sizeof(text), "%s%s %.4g of %s at %.2f s", failed.empty() ? "" : "; ",
                  name_of(figure), worst.value, worst.where.empty() ? "all" : worst.where.c_str(),
                  worst.time);
    failed += text;
  }
  if (!failed.empty()) throw Failure(failed);
  if (setting().left_out.empty()) say_what_is_mended(seed, audit);
}

}  // namespace hooke::fuzz
