#include "hooke/hooke.h"

#include <cstdio>

int main() {
  hooke::World world = hooke::World::create().value();
  hooke::RopeId rope =
      world.add_rope({.hook_point = {0, 3, 0}, .length_at_rest = 2, .air_friction = 3}).value();
  for (int i = 0; i < 600; ++i) world.step(1.0f / 60);
  hooke::DVec3 end = world.positions(rope)[15];
  std::printf("The rope's end is %.2f m below its hook.\n", 3 - end.y);
}
