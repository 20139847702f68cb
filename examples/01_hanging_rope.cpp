/// A 1 kg rope holds a load a thousand times as heavy. It stretches by less than a thousandth, and its
/// uppermost segment pulls with the weight of everything below.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

int main() {
  hooke::Result<hooke::World> made = hooke::World::create();
  if (!made) return 1;
  hooke::World& world = made.value();

  constexpr std::uint32_t kMasses = 32;
  const hooke::Result<hooke::RopeId> rope = world.add_rope({
      .hook_point = {0, 5, 0},
      .direction = {0, -1, 0},
      .total_mass = 1,
      .masses = kMasses,
      .length_at_rest = 4,
      .stiffness = hooke::kRigid,
      .loads = {{.point = kMasses - 1, .mass = 1000}},
  });
  if (!rope) {
    std::printf("%s: %s\n", rope.error().where.c_str(), rope.error().message.c_str());
    return 1;
  }

  for (int frame = 0; frame < 300; ++frame) world.step(1.0f / 60.0f);

  const double length = 5.0 - world.positions(rope.value())[kMasses - 1].y;
  const double tension = static_cast<double>(world.tensions(rope.value()).front());
  // All but the half segment that belongs to the hooked mass hangs below the first segment.
  const double weight = (1000.0 + 1.0 - 0.5 / (kMasses - 1)) * 9.81;
  std::printf("length %.5f m (4 m at rest), tension %.1f N (weight %.1f N)\n", length, tension, weight);

  const bool holds = std::abs(length - 4.0) < 0.004;
  const bool balances = std::abs(tension - weight) < 0.01 * weight;
  return holds && balances ? 0 : 1;
}
