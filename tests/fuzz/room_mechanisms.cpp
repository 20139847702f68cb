#include "fuzz/room.h"

namespace hooke::fuzz {

namespace {

/// A capsule, along y or along x.
std::string add_limb(RoomMaker& maker, Shape shape, DVec3 place, bool is_level) {
  SceneBody& limb = maker.room->body(shape, place, maker.light);
  if (is_level) limb.desc.rotation = test::quarter_turn({0, 0, 1});
  return limb.tag.name;
}

}  // namespace

/// Links that hang from a wall or the ceiling by hooks of several kinds, with a load at the end.
void make_chain(RoomMaker& maker) {
  const int count = maker.random.integer(2, 6);
  const bool is_level = maker.random.chance(0.3);  // It begins stretched out, and swings down.
  const DVec3 along = is_level ? DVec3{0.3, 0, 0} : DVec3{0, -0.3, 0};
  const DVec3 first = is_level ? DVec3{-0.9, 2.3, 0} : DVec3{0, 2.6, 0};
  std::string before;
  for (int i = 0; i <= count; ++i) {
    const DVec3 anchor = first + static_cast<double>(i) * along;
    const bool is_load = i == count;
    const DVec3 place = anchor + (is_load ? 0.6 : 0.5) * along;
    const std::string link = is_load
                                 ? maker.room->sphere(0.15, place, maker.heavy)
                                 : add_limb(maker, Shape::capsule(Real(0.03), Real(0.1)), place, is_level);
    const HookKind kind = maker.random.pick<HookKind>(
        {HookKind::kBall, HookKind::kBall, HookKind::kHinge, HookKind::kSixDegrees, HookKind::kFixed});
    SceneHook& hook = maker.room->hook(kind, before, link, anchor);
    hook.desc.axis = {0, 0, 1};
    for (std::size_t k = 0; k < 3; ++k) hook.desc.freedoms[k].locked = true;
    before = link;
  }
}

/// Driven hinges from the ground on, with a load at the end.
void make_arm(RoomMaker& maker) {
  const int count = maker.random.integer(2, 8);
  const double length = 1.8 / count;
  const double weight = 9.81 * (count * maker.light + maker.heavy) * 2;
  (void)maker.room->box({0.1, 0.4, 0.1}, {-1.1, 0.4, 0}, 0);
  std::string before;
  for (int i = 0; i < count; ++i) {
    const DVec3 anchor = {-0.95 + i * length, 1.2, 0};
    const std::string link =
        maker.room->box({0.48 * length, 0.03, 0.03}, anchor + DVec3{0.5 * length, 0, 0}, maker.light);
    SceneHook& hook = maker.room->hook(HookKind::kHinge, before, link, anchor);
    hook.desc.axis = {0, 0, 1};
    hook.desc.motor.speed = maker.random.pick<Real>({Real(0), Real(0.2), Real(-0.2)});
    hook.desc.motor.max_force = static_cast<Real>(weight * maker.random.pick<double>({0.3, 1.5, 10}));
    before = link;
  }
  const std::string end = maker.room->box({0.08, 0.08, 0.08}, {-0.95 + 1.8 + 0.1, 1.2, 0}, maker.heavy);
  maker.room->hook(HookKind::kFixed, before, end, {-0.95 + 1.8, 1.2, 0});
}

void make_seesaw(RoomMaker& maker) {
  const std::string board = maker.room->box({1, 0.03, 0.25}, {0, 0.4, 0}, maker.light);
  SceneHook& hook = maker.room->hook(HookKind::kHinge, "", board, {0, 0.4, 0});
  hook.desc.axis = {0, 0, 1};
  (void)maker.room->box({0.12, 0.12, 0.12}, {-0.85, 0.551, 0},
                        maker.random.chance(0.5) ? maker.light : maker.heavy);
  (void)maker.room->box({0.15, 0.15, 0.15}, {0.8, 0.581 + maker.random.between(0, 1), 0}, maker.heavy);
}

/// A body on a spring, one on a slider with a spring and two that a rod holds apart.
void make_springs(RoomMaker& maker) {
  const double stiffness = maker.light * maker.random.pick<double>({30, 100, 300});
  const std::string ball = maker.room->sphere(0.12, {-0.7, 1.5, 0}, maker.light);
  SceneHook& spring = maker.room->hook(HookKind::kDistance, "", ball, {-0.7, 2.6, 0});
  spring.desc.anchor_b = maker.room->at + DVec3{-0.7, 1.5, 0};
  spring.desc.limits = {Real(0), kRigid};
  spring.desc.spring = {.stiffness = static_cast<Real>(stiffness), .damping = static_cast<Real>(maker.light)};

  const std::string piston = maker.room->box({0.15, 0.05, 0.15}, {0.2, 0.6, 0}, maker.light);
  SceneHook& slider = maker.room->hook(HookKind::kSlider, "", piston, {0.2, 0.6, 0});
  slider.desc.axis = {0, 1, 0};
  slider.desc.spring = {.stiffness = static_cast<Real>(maker.heavy * 300),
                        .damping = static_cast<Real>(maker.heavy)};
  (void)maker.room->box({0.12, 0.12, 0.12}, {0.2, 0.771, 0}, maker.heavy);

  const std::string low = maker.room->sphere(0.1, {0.9, 0.1, 0}, maker.light);
  const std::string high = maker.room->sphere(0.1, {0.9, 0.8, 0.1}, maker.heavy);
  SceneHook& rod = maker.room->hook(HookKind::kDistance, low, high, {0.9, 0.1, 0});
  rod.desc.anchor_b = maker.room->at + DVec3{0.9, 0.8, 0.1};
}

/// Limbs in a row whose joints rub, lying on the ground, and a slab on them.
void make_ragdoll(RoomMaker& maker) {
  const int count = maker.random.integer(3, 6);
  std::string before;
  for (int i = 0; i < count; ++i) {
    const double x = 0.36 * (i - 0.5 * (count - 1));
    const std::string limb = add_limb(maker, Shape::capsule(Real(0.07), Real(0.1)), {x, 0.07, 0}, true);
    if (i > 0)
      maker.room->hook(HookKind::kBall, before, limb, {x - 0.18, 0.07, 0}).desc.motor.max_force =
          static_cast<Real>(maker.light);
    before = limb;
  }
  if (maker.random.chance(0.6))
    (void)maker.room->box({0.5, 0.08, 0.3}, {0, 0.25 + maker.random.between(0, 1), 0}, maker.heavy);
}

/// A chassis on four wheels with suspension, one axle driven.
void make_cart(RoomMaker& maker) {
  const double mass = maker.light * maker.random.pick<double>({3, 10, 30});
  const std::string chassis = maker.room->box({0.45, 0.06, 0.2}, {0, 0.25, 0}, mass);
  for (const double x : {-0.35, 0.35}) {
    for (const double z : {-0.3, 0.3}) {
      const DVec3 place = {x, 0.15, z};
      const std::string wheel = maker.room->roller(0.14, 0.04, place, maker.light);
      SceneHook& hook = maker.room->hook(HookKind::kWheel, chassis, wheel, place);
      hook.desc.axis = {0, 1, 0};
      hook.desc.second_axis = Vec3{0, 0, 1};
      hook.desc.limits = {Real(-0.05), Real(0.05)};
      hook.desc.spring = {.stiffness = static_cast<Real>(mass * 300),
                          .damping = static_cast<Real>(mass * 10)};
      if (x > 0) hook.desc.motor = {.speed = Real(-4), .max_force = static_cast<Real>(0.3 * mass)};
    }
  }
  (void)maker.room->box({0.2, 0.1, 0.15}, {0, 0.412, 0}, mass);
}

/// A net of balls, held at two edges, with a load in its middle.
void make_ball_net(RoomMaker& maker) {
  const int columns = maker.random.integer(4, 7);
  const int rows = maker.random.integer(3, 6);
  const double pitch = 0.22;
  const auto place_of = [&](int i, int j) {
    return DVec3{pitch * (i - 0.5 * (columns - 1)), 1.5, pitch * (j - 0.5 * (rows - 1))};
  };
  std::vector<std::string> balls;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const DVec3 place = place_of(i, j);
      const std::string ball = maker.room->sphere(0.05, place, maker.light);
      const DVec3 half = {0.5 * pitch, 0, 0};
      if (i > 0) maker.room->hook(HookKind::kBall, balls.back(), ball, place - half);
      if (j > 0)
        maker.room->hook(HookKind::kBall, balls[balls.size() - static_cast<std::size_t>(columns)], ball,
                         place - DVec3{0, 0, half.x});
      if (i == 0 || i + 1 == columns) maker.room->hook(HookKind::kBall, "", ball, place);
      balls.push_back(ball);
    }
  }
  (void)maker.room->sphere(0.2, {0, 1.9, 0}, maker.heavy);
}

}  // namespace hooke::fuzz
