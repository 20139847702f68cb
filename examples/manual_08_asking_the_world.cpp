/// Chapter 8 of the manual: rays, swept shapes, overlaps, a hand, forces of contacts, hits, a sensor, sleep
/// and debug pictures.

#include "hooke/hooke.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace {

constexpr double kGravity = 9.81;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

struct Scene {
  hooke::World world = hooke::World::create().value();
  hooke::BodyId ground = world.add_body({.shape = hooke::Shape::half_space()}).value();
  hooke::BodyId tower =
      world.add_body({.shape = hooke::Shape::box({1, 2, 1}), .position = {10, 2, 0}}).value();
  hooke::BodyId gate =
      world.add_body({.shape = hooke::Shape::box({1, 1, 1}), .position = {0, 3, 0}, .sensor = true}).value();
  hooke::BodyId ball = world
                           .add_body({.kind = hooke::BodyKind::kDynamic,
                                      .shape = hooke::Shape::sphere(0.5f),
                                      .position = {0, 5.5, 0},
                                      .mass = 3,
                                      .reports_contacts = true,
                                      .hit_speed = 1})
                           .value();
};

/// A ray from the ball to the tower, a box that is pushed along the same way, and a look around.
bool where_things_are(const Scene& scene) {
  const hooke::World& world = scene.world;
  const hooke::QueryFilter others = {.skip = scene.ball};
  const auto ray = world.cast_ray({0, 3, 0}, {100, 0, 0}, others);
  if (!ray || !ray.value() || ray.value()->body != scene.tower) return false;
  bool good = agrees("the ray meets the tower after [m]", ray.value()->distance, 9, 0.001);

  const hooke::Shape crate = hooke::Shape::box({0.5f, 0.5f, 0.5f});
  const auto swept = world.cast_shape(crate, {.position = {0, 3, 0}}, {100, 0, 0}, others);
  if (!swept || !swept.value()) return false;
  good = agrees("the crate may go by [m]", swept.value()->distance, 8.5, 0.001) && good;

  const auto overlaps = world.find_overlaps(crate, {.position = {9, 4, 0}});
  const auto nearest = world.find_closest({10, 7, 0}, 10);
  if (!overlaps || !nearest || !nearest.value()) return false;
  std::printf("the crate would overlap %zu body\n", overlaps.value().size());
  return agrees("nearest surface [m]", nearest.value()->distance, 3, 0.001) && overlaps.value().size() == 1 &&
         good;
}

/// A ray to a rope on a hook, and a hand that pulls it away and lets it go.
bool grabs_a_rope() {
  hooke::World world = hooke::World::create().value();
  const hooke::RopeId rope =
      world.add_rope({.hook_point = {5, 3, 0}, .direction = {0, -1, 0}, .length_at_rest = 2}).value();
  const auto touched = world.cast_ray_on_deformables({5, 2, 5}, {0, 0, -10});
  if (!touched || !touched.value()) return false;
  const hooke::DeformablePlace place = touched.value()->place;
  std::printf("the ray meets segment %u near point %u\n", place.element, place.nearest.index);

  hooke::Hand hand;
  const auto grabbed = hand.grab_along(world, {5, 2, 5}, {0, 0, -10});
  if (!grabbed || !grabbed.value()) return false;
  hand.move_to({6, 4, 0});
  for (int i = 0; i < 60; ++i) {
    const auto held = hand.before_step(world, 1.0f / 60);
    if (!held || !held.value()) return false;
    world.step(1.0f / 60);
  }
  // The rope is 1 m long from its hook to the hand, which wants to be farther away.
  const bool good =
      agrees("from the hook to the hand [m]", length(hand.place(world) - hooke::DVec3{5, 3, 0}), 1, 0.01);
  return hand.release(world) && world.mass(rope) > 0 && good;
}

/// The ball falls by 5 m through the gate onto the ground, and falls asleep there.
bool what_happens(Scene& scene) {
  hooke::World& world = scene.world;
  double hit_speed = 0;
  std::size_t entered = 0;
  std::size_t left = 0;
  std::size_t touched = 0;
  bool slept = false;
  for (int frame = 0; frame < 300 && !slept; ++frame) {
    world.step(1.0f / 60);
    const hooke::Events& events = world.events();
    for (const hooke::HitEvent& hit : events.hits) hit_speed = std::fmax(hit_speed, hit.speed);
    for (const hooke::BodyId id : events.fell_asleep) slept = slept || id == scene.ball;
    entered += events.sensor_enters.size();
    left += events.sensor_leaves.size();
    touched += events.contact_begins.size();
  }
  std::printf("entered %zu, left %zu, touched %zu, asleep %d\n", entered, left, touched, slept);
  return entered == 1 && left == 1 && touched == 1 && slept && world.asleep(scene.ball) &&
         agrees("speed of the hit [m/s]", hit_speed, std::sqrt(2 * kGravity * 5), 0.01);
}

/// What the ground carries is the weight of the ball; a push wakes it.
bool what_it_weighs(Scene& scene) {
  double force = 0;
  for (const hooke::BodyContact& contact : scene.world.body_contacts(scene.ball))
    force += contact.normal_force;
  if (!scene.world.apply_impulse(scene.ball, {0, 6, 0})) return false;
  scene.world.step(1.0f / 60);
  return agrees("force on the ground [N]", force, 3 * kGravity, 0.01) && !scene.world.asleep(scene.ball);
}

/// Hands lines to a renderer; this one only measures the longest.
class Lines : public hooke::DebugDraw {
 public:
  void line(hooke::DebugSubject subject, hooke::DVec3 from, hooke::DVec3 to,
            hooke::DebugColor color) override {
    if (subject == hooke::DebugSubject::kLoads && color == hooke::load_color(1)) reddest = to - from;
  }
  void point(hooke::DebugSubject, hooke::DVec3, hooke::DebugColor) override {}
  void triangle(hooke::DebugSubject, const std::array<hooke::DVec3, 3>&, hooke::DebugColor) override {}
  void text(hooke::DebugSubject, hooke::DVec3, std::string_view, hooke::DebugColor) override {}

  hooke::DVec3 reddest;
};

/// The topmost segment of a rope that hangs is the reddest.
bool what_is_seen() {
  hooke::World world = hooke::World::create().value();
  const auto rope =
      world.add_rope({.hook_point = {0, 3, 0}, .direction = {0, -1, 0}, .total_mass = 2, .masses = 21});
  if (!rope) return false;
  for (int i = 0; i < 120; ++i) world.step(1.0f / 60);
  Lines lines;
  const auto legend = world.debug_draw(lines, {.contacts = false, .loads = true});
  if (!legend) return false;
  // It carries all but its own upper half: 39 of 40 halves.
  return agrees("full red [N]", legend.value().tension, 2 * kGravity * 39 / 40, 0.01) &&
         agrees("length of the reddest segment [m]", length(lines.reddest), 0.05, 0.01);
}

}  // namespace

int main() {
  Scene scene;
  return where_things_are(scene) && grabs_a_rope() && what_happens(scene) && what_it_weighs(scene) &&
                 what_is_seen()
             ? 0
             : 1;
}
