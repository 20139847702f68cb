#include "fuzz/room.h"

namespace hooke::fuzz {

namespace {

/// A lamp that hangs beside what is `width` wide, a little apart from it and lower than `top`.
void hang_beside(RoomMaker& maker, double width, double top) {
  const double gap = maker.random.pick<double>({0.003, 0.015, 0.05});
  const DVec3 place = {0.5 * width + gap + 0.06, maker.random.between(0.1, 0.9) * top, 0};
  const std::string lamp = maker.room->sphere(0.06, place, maker.light);
  maker.room->hook(HookKind::kBall, "", lamp, place + DVec3{0, 0.8, 0});
}

/// A slack rope whose first point is tied to the side of a body.
void tie_slack_rope(RoomMaker& maker, const std::string& body, DVec3 place) {
  const std::string rope =
      maker.room->rope(test::line(place, place + DVec3{0.4, 0, 0}, 8), 0.2 * maker.light, 0.005);
  maker.room->tie(body, rope, 0);
}

/// Puts up to three bodies on a place, each heavy or light.
void load(RoomMaker& maker, DVec3 place, double side) {
  const int count = maker.random.integer(1, 3);
  for (int i = 0; i < count; ++i) {
    const double mass = maker.random.chance(0.6) ? maker.heavy : maker.light;
    (void)maker.room->box({0.5 * side, 0.5 * side, 0.5 * side}, place + DVec3{0, (i + 0.5) * side, 0}, mass);
  }
}

}  // namespace

void make_stack(RoomMaker& maker) {
  const int count = maker.random.integer(2, 7);
  const double side = maker.random.between(0.2, 0.35);
  std::string middle;
  for (int i = 0; i < count; ++i) {
    const double mass = i + 1 == count ? maker.heavy : maker.light;
    const DVec3 place = {maker.random.between(-0.02, 0.02), (i + 0.5) * side,
                         maker.random.between(-0.02, 0.02)};
    const std::string body = maker.room->box({0.5 * side, 0.5 * side, 0.5 * side}, place, mass);
    if (i == count / 2) middle = body;
  }
  const double height = (count / 2 + 0.5) * side;
  switch (maker.random.below(4)) {
    case 0:
      hang_beside(maker, side + 0.04, count * side);
      break;
    case 1:
      tie_slack_rope(maker, middle, {0.5 * side + 0.03, height, 0});
      break;
    case 2: {
      const DVec3 place = {0.5 * side + 0.1, height, 0};
      const std::string knob = maker.room->sphere(0.05, place, 0.3 * maker.light);
      maker.room->hook(HookKind::kFixed, middle, knob, place);
      break;
    }
    default:
      break;
  }
}

void make_pyramid(RoomMaker& maker) {
  const int rows = maker.random.integer(3, 6);
  const DVec3 half = {0.15, 0.1, 0.15};
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i)
      (void)maker.room->box(half, {0.32 * (i - 0.5 * (rows - row - 1)), 0.1 + 0.2 * row, 0}, maker.light);
  }
  (void)maker.room->box(half, {0, 0.1 + 0.2 * rows, 0}, maker.heavy);
}

void make_table(RoomMaker& maker) {
  const double length = maker.random.between(0.4, 0.8);
  const std::string top = maker.room->box({0.5, 0.03, 0.4}, {0, length + 0.03, 0},
                                          maker.random.chance(0.5) ? maker.heavy : maker.light);
  const HookKind kind = maker.random.chance(0.8) ? HookKind::kFixed : HookKind::kHinge;
  for (const double x : {-0.42, 0.42}) {
    for (const double z : {-0.32, 0.32}) {
      const DVec3 place = {x + maker.random.between(-0.03, 0.03), 0.5 * length, z};
      const std::string leg = maker.room->box({0.03, 0.5 * length, 0.03}, place, maker.light);
      SceneHook& hook = maker.room->hook(kind, top, leg, place + DVec3{0, 0.5 * length, 0});
      hook.desc.axis = {0, 0, 1};
      hook.desc.limits = {Real(-0.1), Real(0.1)};
    }
  }
  load(maker, {0, length + 0.06, 0}, 0.25);
}

void make_rollers(RoomMaker& maker) {
  for (const double x : {-0.25, 0.25}) {
    const DVec3 place = {x, 0.4, 0};
    const std::string roller = maker.room->roller(0.08, 0.3, place, maker.light);
    maker.room->hook(HookKind::kHinge, "", roller, place).desc.axis = {0, 0, 1};
  }
  (void)maker.room->box({0.5, 0.1, 0.25}, {0, 0.581, 0}, maker.heavy);
  load(maker, {0, 0.682, 0}, 0.3);
}

void make_gripper(RoomMaker& maker) {
  const double mass = maker.light * maker.random.pick<double>({1, 10, 100});
  (void)maker.room->box({0.1, 0.1, 0.1}, {0, 0.1, 0}, mass);
  for (const Real side : {Real(-1), Real(1)}) {
    const DVec3 place = {0.14 * static_cast<double>(side), 0.12, 0};
    const std::string jaw = maker.room->box({0.02, 0.1, 0.06}, place, maker.light);
    SceneHook& hook = maker.room->hook(HookKind::kSlider, "", jaw, place);
    hook.desc.axis = {-side, 0, 0};
    hook.desc.motor = {.speed = Real(0.4), .max_force = static_cast<Real>(50 * mass)};
  }
}

}  // namespace hooke::fuzz
