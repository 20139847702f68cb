/// What a game asks: which box is under the cursor, how many balls are in the goal, how hard was the hit.

#include "hooke/hooke.h"

#include <cstdio>

int main() {
  hooke::Result<hooke::World> made = hooke::World::create();
  if (!made) return 1;
  hooke::World& world = made.value();
  const auto ground = world.add_body({.shape = hooke::Shape::half_space()});
  const auto crate = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                     .shape = hooke::Shape::box({0.5f, 0.5f, 0.5f}),
                                     .position = {3, 0.5, 0}});
  const auto goal =
      world.add_body({.shape = hooke::Shape::box({1, 1, 1}), .position = {-3, 1, 0}, .sensor = true});
  if (!ground || !crate || !goal) return 1;
  for (int i = 0; i < 3; ++i) {
    const auto ball = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                      .shape = hooke::Shape::sphere(0.2f),
                                      .position = {-3, 3.0 + i, 0.1 * i},
                                      .hit_speed = 2});
    if (!ball) return 1;
  }

  // A ray from the eye through the cursor, 100 m long.
  const hooke::DVec3 eye = {0, 3, 4};
  const auto picked = world.cast_ray(eye, 20.0 * (hooke::DVec3{3, 0.5, 0} - eye));
  if (!picked || !picked.value()) return 1;
  const hooke::CastHit hit = *picked.value();
  std::printf("picked %s at %.2f m\n", hit.body == crate.value() ? "the crate" : "something else",
              hit.distance);

  int entered = 0;
  double hardest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    world.step(1.0f / 60);
    entered += static_cast<int>(world.events().sensor_enters.size());
    for (const hooke::HitEvent& event : world.events().hits)
      hardest = event.speed > hardest ? event.speed : hardest;
  }
  std::printf("%d balls entered the goal, %zu are in it, the hardest hit was %.1f m/s\n", entered,
              world.visitors(goal.value()).size(), hardest);
  return hit.body == crate.value() && entered >= 3 && hardest > 5 ? 0 : 1;
}
