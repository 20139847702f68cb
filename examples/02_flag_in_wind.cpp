/// A flag on a pole, in gusty wind and in a light breeze. The wind carries it; in the breeze it hangs.

#include "hooke/hooke.h"

#include <cstdio>

namespace {

/// Mean distance of the flag's points from the pole, sideways, over the last of six seconds [m].
double reach(hooke::Vec3 wind) {
  hooke::Result<hooke::World> made = hooke::World::create(
      {.workers = 2, .wind = {.velocity = wind, .gust = 0.5f, .side_gust = 0.3f, .seed = 7}});
  if (!made) return -1;
  hooke::World& world = made.value();

  constexpr std::uint32_t kColumns = 16;
  constexpr std::uint32_t kRows = 11;
  hooke::ClothDesc flag = {.columns = kColumns,
                           .rows = kRows,
                           .corner = {0, 3, 0},
                           .width = 1.5f,
                           .height = 1,
                           .areal_density = 0.1f,
                           .tethers = true};
  for (std::uint32_t row = 0; row < kRows; ++row) flag.pins.push_back({.point = row * kColumns});
  const hooke::Result<hooke::ClothId> cloth = world.add_cloth(flag);
  if (!cloth) return -1;

  double sum = 0;
  for (int frame = 0; frame < 360; ++frame) {
    if (!world.step(1.0f / 60.0f).healthy()) return -1;
    const hooke::PointView points = world.positions(cloth.value());
    for (std::size_t i = 0; frame >= 300 && i < points.size(); ++i) sum += points[i].x;
  }
  return sum / (60.0 * kColumns * kRows);
}

}  // namespace

int main() {
  const double windy = reach({12, 0, 2});
  const double calm = reach({0.5f, 0, 0.5f});  // without any, a perfectly flat flag stays in its plane
  std::printf("mean distance from the pole: %.2f m in wind, %.2f m in a breeze\n", windy, calm);
  return windy > 0.4 && calm >= 0 && calm < 0.7 * windy ? 0 : 1;
}
