/// Chapter 3 of the manual: a pendulum, a door with a stop, a lift, a spring scale and a thread that breaks.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kGravity = 9.81;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

void advance(hooke::World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60);
}

hooke::BodyId add_ball(hooke::World& world, hooke::DVec3 position, float mass) {
  return world
      .add_body({.kind = hooke::BodyKind::kDynamic,
                 .shape = hooke::Shape::sphere(0.1f),
                 .position = position,
                 .mass = mass})
      .value();
}

/// A ball, 1 m below a hinge of the world, 0.1 rad from hanging straight.
bool pendulum(hooke::World& world) {
  const hooke::BodyId ball = add_ball(world, {std::sin(0.1), -std::cos(0.1), 0}, 1);
  const auto hinge =
      world.add_hook({.kind = hooke::HookKind::kHinge, .b = {.body = ball}, .axis = {0, 0, 1}});
  if (!hinge) return false;
  double first = 0;  // times at which it swings through its lowest place [s]
  double last = 0;
  int crossings = 0;
  double before = world.pose(ball).position.x;
  for (int frame = 0; frame < 600; ++frame) {
    world.step(1.0f / 60);
    const double x = world.pose(ball).position.x;
    if ((before > 0) != (x > 0)) {
      last = world.time() - x / (x - before) / 60;
      if (crossings++ == 0) first = last;
    }
    before = x;
  }
  // Of a ball, not of a point: I = m (L^2 + 2/5 r^2); a swing of 0.1 rad adds a sixteenth of its square.
  const double period = 2 * kPi * std::sqrt((1 + 0.4 * 0.01) / kGravity) * (1 + 0.01 / 16);
  return crossings > 2 &&
         agrees("period of the pendulum [s]", 2 * (last - first) / (crossings - 1), period, 0.005);
}

/// A motor of 5 N m turns a door against its stop at 90 degrees.
bool door(hooke::World& world) {
  const hooke::BodyId ball = add_ball(world, {10.5, 0, 0}, 2);
  const auto hinge = world.add_hook({.kind = hooke::HookKind::kHinge,
                                     .b = {.body = ball},
                                     .anchor = {10, 0, 0},
                                     .axis = {0, 1, 0},
                                     .limits = {.lower = 0, .upper = 1.5708f},
                                     .motor = {.speed = 1, .max_force = 5}});
  if (!hinge) return false;
  advance(world, 180);
  return agrees("the door at its stop [rad]", world.hook_value(hinge.value()), kPi / 2, 0.01);
}

/// A motor lifts 50 kg at 0.5 m/s; then it is told to stop, and holds.
bool lift(hooke::World& world) {
  const hooke::BodyId cabin = add_ball(world, {20, 0, 0}, 50);
  const auto rail = world.add_hook({.kind = hooke::HookKind::kSlider,
                                    .b = {.body = cabin},
                                    .anchor = {20, 0, 0},
                                    .axis = {0, 1, 0},
                                    .motor = {.speed = 0.5f, .max_force = 2000}});
  if (!rail) return false;
  advance(world, 120);
  if (!world.set_motor(rail.value(), {.speed = 0, .max_force = 2000})) return false;
  advance(world, 60);
  return agrees("the lift after 2 s of 0.5 m/s [m]", world.hook_value(rail.value()), 1, 0.01);
}

/// 2 kg on a spring of 200 N/m.
bool scale(hooke::World& world) {
  const hooke::BodyId weight = add_ball(world, {30, 0, 0}, 2);
  const auto spring = world.add_hook({.kind = hooke::HookKind::kSlider,
                                      .b = {.body = weight},
                                      .anchor = {30, 0, 0},
                                      .axis = {0, 1, 0},
                                      .spring = {.stiffness = 200, .damping = 20}});
  if (!spring) return false;
  advance(world, 300);
  return agrees("the scale [m]", world.hook_value(spring.value()), -2 * kGravity / 200, 0.01) &&
         agrees("its force [N]", world.hook_force(spring.value()).force.y, 2 * kGravity, 0.01);
}

/// A thread that carries 15 N, and a ball that weighs 19.6 N.
bool thread(hooke::World& world) {
  const hooke::BodyId ball = add_ball(world, {40, 0, 0}, 2);
  const auto hook = world.add_hook({.b = {.body = ball}, .anchor = {40, 0.5, 0}, .break_force = 15});
  if (!hook) return false;
  world.step(1.0f / 60);
  double needed = 0;
  for (const hooke::BreakEvent& event : world.events().breaks) {
    if (event.hook == hook.value()) needed = event.force;
  }
  return agrees("force that broke the thread [N]", needed, 2 * kGravity, 0.01);
}

/// A bar of four glued slices, clamped at one end.
bool shelf(hooke::World& world) {
  hooke::MeshDesc bar = {.triangles = {{0, 4, 6},
                                       {0, 6, 2},
                                       {1, 3, 7},
                                       {1, 7, 5},
                                       {0, 1, 5},
                                       {0, 5, 4},
                                       {2, 6, 7},
                                       {2, 7, 3},
                                       {0, 2, 3},
                                       {0, 3, 1},
                                       {4, 5, 7},
                                       {4, 7, 6}}};
  for (const float z : {-0.05f, 0.05f}) {
    for (const float y : {-0.05f, 0.05f}) {
      for (const float x : {0.0f, 2.0f}) bar.positions.push_back({x, y, z});
    }
  }
  const auto pieces =
      hooke::fracture(bar, {.seeds = {{0.25, 0, 0}, {0.75, 0, 0}, {1.25, 0, 0}, {1.75, 0, 0}}});
  if (!pieces) return false;
  const auto body = hooke::add_fractured(world, pieces.value(),
                                         {.kind = hooke::BodyKind::kDynamic, .position = {50, 0, 0}}, 8e5f);
  if (!body) return false;
  const auto clamp = world.add_hook(
      {.kind = hooke::HookKind::kFixed, .b = {.body = body.value().bodies[0]}, .anchor = {50, 0, 0}});
  if (!clamp) return false;
  advance(world, 60);
  const hooke::Vec3 torque = world.hook_force(body.value().hooks[0]).torque;
  return agrees("moment of 1.5 m of the bar [N m]", torque.z, 10 * kGravity * 1.5 * 1.5 / 2, 0.01);
}

}  // namespace

int main() {
  hooke::World world = hooke::World::create().value();
  return pendulum(world) && door(world) && lift(world) && scale(world) && thread(world) && shelf(world) ? 0
                                                                                                        : 1;
}
