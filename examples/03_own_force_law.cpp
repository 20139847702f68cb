/// A force of one's own in a few lines: a hovering controller lifts a particle to 2 m and holds it there.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

int main() {
  hooke::Result<hooke::World> made = hooke::World::create();
  if (!made) return 1;
  hooke::World& world = made.value();

  const auto drone =
      world.add_particles({.particles = {{.position = {0, 0.5, 0}, .velocity = {1, 0, 0}, .mass = 1.2f}}});
  const auto thrust = world.add_force_law([](hooke::ForceView& object) {
    for (std::size_t i = 0; i < object.size(); ++i) {
      const hooke::Vec3 v = object.velocity(i);
      const auto height = static_cast<float>(object.position(i).y);
      const float acceleration = 9.81f + 9.0f * (2.0f - height) - 6.0f * v.y;  // critically damped at 3 rad/s
      object.add_force(i, object.mass(i) * hooke::Vec3{-0.5f * v.x, acceleration, -0.5f * v.z});
    }
  });
  if (!drone || !thrust) return 1;

  for (int frame = 0; frame < 600; ++frame) world.step(1.0f / 60.0f);
  const hooke::DVec3 place = world.positions(drone.value())[0];
  std::printf("after 10 s: height %.4f m, drifted %.4f m\n", place.y, place.x);
  // The law sees the velocity after gravity's share of the substep, which lifts it by g h (6 / 9) = 14 mm.
  // Braked by 0.5 v per second from 1 m/s, it comes to rest 1 / 0.5 = 2 m away.
  const bool hovers = std::abs(place.y - 2.0) < 0.02 && std::abs(place.x - 2.0 * (1 - std::exp(-5.0))) < 0.01;

  world.remove(thrust.value());
  for (int frame = 0; frame < 30; ++frame) world.step(1.0f / 60.0f);
  const double fall = place.y - world.positions(drone.value())[0].y;
  std::printf("without thrust it falls %.3f m in 0.5 s\n", fall);
  return hovers && std::abs(fall - 0.5 * 9.81 * 0.25) < 0.02 ? 0 : 1;
}
