#include "fuzz/room.h"

#include <algorithm>

namespace hooke::fuzz {

/// Planks between two ropes that sag, and a load that falls on them.
void make_bridge(RoomMaker& maker) {
  const int planks = maker.random.integer(4, 8);
  const int between = 2;  // Segments of the rope from plank to plank.
  const int points = between * (planks + 1) + 1;
  const double pitch = 2.5 / (planks + 1);
  const double height = maker.random.between(0.8, 1.6);
  std::vector<DVec3> way;
  for (int i = 0; i < points; ++i) {
    const double x = 2.0 * i / (points - 1.0) - 1;
    way.push_back({1.25 * x, height + 0.25 * x * x, 0});
  }
  std::vector<std::string> ropes;
  for (const double z : {-0.35, 0.35}) {
    std::vector<DVec3> side = way;
    for (DVec3& place : side) place.z = z;
    ropes.push_back(maker.room->rope(side, maker.light * maker.random.pick<double>({0.3, 3})));
    maker.room->pin_both_ends();
  }
  for (int i = 1; i <= planks; ++i) {
    const auto at = static_cast<std::uint32_t>(between * i);
    const std::string plank = maker.room->box({0.4 * pitch, 0.02, 0.4}, way[at], maker.light);
    for (const std::string& rope : ropes) maker.room->tie(plank, rope, at);
  }
  (void)maker.room->box({0.2, 0.15, 0.2}, {0, height + 0.2 + maker.random.between(0, 0.8), 0}, maker.heavy);
}

/// A rope over a wheel on an axle, with a weight at each end.
void make_pulley(RoomMaker& maker) {
  const double radius = 0.25;
  const double thickness = 0.01;
  const DVec3 axle = {0, 2.2, 0};
  const std::string wheel = maker.room->roller(radius, 0.05, axle, maker.light);
  maker.room->hook(HookKind::kHinge, "", wheel, axle).desc.axis = {0, 0, 1};
  const double way = radius + thickness + 0.001;
  const double low = axle.y - 1;
  std::vector<DVec3> points = test::line({-way, low, 0}, {-way, axle.y - 0.05, 0}, 20);
  // The upper half of the circle, by the tangent of half the angle: no function of the C library.
  for (int i = 0; i <= 24; ++i) {
    const double s = i / 12.0 - 1;
    points.push_back(axle + DVec3{way * 2 * s / (1 + s * s), way * (1 - s * s) / (1 + s * s), 0});
  }
  for (const DVec3& place : test::line({way, axle.y - 0.05, 0}, {way, low, 0}, 20)) points.push_back(place);
  const std::string rope = maker.room->rope(points, 0.3 * maker.light, thickness);
  const double mass = maker.random.chance(0.5) ? maker.heavy : maker.light;
  for (const double side : {-1.0, 1.0}) {
    const std::string weight =
        maker.room->box({0.1, 0.1, 0.1}, {side * way, low - 0.1, 0}, side < 0 ? mass : maker.heavy);
    maker.room->tie(weight, rope, side < 0 ? 0 : static_cast<std::uint32_t>(points.size() - 1));
  }
}

/// A load that hangs on a rope from the ceiling and pulls another rope with a bead after it.
void make_hanging_load(RoomMaker& maker) {
  const std::string rope = maker.room->rope(test::line({0, 2.8, 0}, {0.8, 2.4, 0}, 12), 0.3 * maker.light);
  maker.room->scene.objects.ropes.back().pins = {{.point = {.index = 0}}};
  const std::string load = add_lump(maker, {0.9, 2.25, 0}, 0.3, maker.heavy);
  maker.room->tie(load, rope, 11);
  if (maker.random.chance(0.5)) return;
  const std::string string =
      maker.room->rope(test::line({-1, 1.6, 0.6}, {1, 1.2, 0.6}, 14), 0.3 * maker.light);
  maker.room->pin_both_ends();
  const std::string bead = maker.room->sphere(0.08, {0, 1.4, 0.6}, maker.heavy);
  maker.room->hook(HookKind::kRopeSlide, string, bead, {0, 1.4, 0.6});
}

/// Ropes along and across, tied where they cross, and a ball that falls on them.
void make_rope_net(RoomMaker& maker) {
  const int count = maker.random.integer(2, 4);
  const double pitch = 2.0 / (count + 1);
  std::vector<std::string> along;
  for (int i = 0; i < 2 * count; ++i) {
    const double z = -1 + pitch * (i % count + 1);
    const bool is_along = i < count;
    const DVec3 first = is_along ? DVec3{-1, 1, z} : DVec3{z, 1, -1};
    const DVec3 last = is_along ? DVec3{1, 1, z} : DVec3{z, 1, 1};
    const std::string rope = maker.room->rope(test::line(first, last, 2 * count + 3), 0.3 * maker.light);
    maker.room->pin_both_ends();
    if (is_along) along.push_back(rope);
    for (int j = 0; j < count && !is_along; ++j)
      maker.room->tie(along[static_cast<std::size_t>(j)], rope, static_cast<std::uint32_t>(2 * j + 2))
          .a_point = ScenePoint{.index = static_cast<std::uint32_t>(2 * (i - count) + 2)};
  }
  (void)maker.room->sphere(0.35, {0, 1.4 + maker.random.between(0, 1), 0}, maker.heavy);
}

/// A cloth hooked at its corners, to the world or to posts that can fall, and a load in it.
void make_hammock(RoomMaker& maker) {
  const int columns = 9;
  const std::string cloth = maker.room->cloth({0, 1.2, 0}, 1.4, columns).tag.name;
  const bool has_posts = maker.random.chance(0.3);
  int number = 0;
  for (const std::uint32_t corner : {0U, 8U, 72U, 80U}) {
    const DVec3 place = {number % 2 == 0 ? -0.78 : 0.78, 0.6, number < 2 ? -0.78 : 0.78};
    ++number;
    const std::string post = has_posts ? maker.room->box({0.06, 0.6, 0.06}, place, maker.heavy) : "";
    maker.room->tie(post, cloth, corner);
  }
  const double most = 2;  // A cloth of this stiffness bears no more [kg].
  (void)add_lump(maker, {0, 1.6, 0}, 0.3, std::min(maker.light, most));
}

/// A cloth that lies over a box, and a load on it.
void make_covered_box(RoomMaker& maker) {
  (void)maker.room->box({0.4, 0.3, 0.4}, {0, 0.3, 0}, maker.random.chance(0.5) ? 0 : maker.light);
  maker.room->cloth({0, 0.606, 0}, 1.2, 13);
  (void)maker.room->box({0.2, 0.15, 0.2}, {0, 0.762, 0}, maker.heavy);
}

/// A jelly with a plate on it that presses it together by a twentieth to a third.
void make_jelly(RoomMaker& maker) {
  const double side = maker.random.between(0.3, 0.5);
  const double strain = maker.random.pick<double>({0.05, 0.1, 0.3});
  const double stiff = std::clamp(maker.heavy * 9.81 / (side * side * strain), 3e4, 1e6);
  const double mass = std::min(maker.heavy, 0.4 * stiff * side * side / 9.81);
  maker.room->jelly({0, 0.5 * side + 0.006, 0}, side, maker.random.integer(3, 4)).desc.young_modulus =
      static_cast<Real>(stiff);
  (void)maker.room->box({0.3, 0.04, 0.3}, {0, side + 0.06, 0}, mass);
  if (maker.random.chance(0.4)) (void)add_lump(maker, {0, side + 0.4, 0}, 0.3, maker.light);
}

}  // namespace hooke::fuzz
