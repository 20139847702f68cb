/// Chapter 1 of the manual: a ball falls on the ground, and a wrong description comes back as an error.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

namespace {

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

}  // namespace

int main() {
  hooke::Result<hooke::World> made = hooke::World::create();
  if (!made) return 1;
  hooke::World& world = made.value();

  const auto ground = world.add_body({.shape = hooke::Shape::half_space()});
  const auto ball = world.add_body({
      .kind = hooke::BodyKind::kDynamic,
      .shape = hooke::Shape::sphere(0.25f),
      .position = {0, 10, 0},
      .density = 500,
  });
  if (!ground || !ball) return 1;

  for (int frame = 0; frame < 60; ++frame) world.step(1.0f / 60);
  const hooke::Pose pose = world.pose(ball.value());
  const double fallen = 10 - pose.position.y;
  const double speed = -world.velocity(ball.value()).y;
  bool good = agrees("fallen in 1 s [m]", fallen, 9.81 / 2, 0.01);
  good = agrees("speed after 1 s [m/s]", speed, 9.81, 0.01) && good;
  good =
      agrees("mass [kg]", world.mass(ball.value()), 500 * 4.0 / 3 * 3.14159265 * 0.25 * 0.25 * 0.25, 0.001) &&
      good;

  for (int frame = 0; frame < 180; ++frame) world.step(1.0f / 60);
  good = agrees("height at rest [m]", world.pose(ball.value()).position.y, 0.25, 0.01) && good;

  const auto wrong = world.add_body({.kind = hooke::BodyKind::kDynamic, .shape = hooke::Shape::sphere(-1)});
  if (wrong) return 1;
  std::printf("refused: %s: %s\n", wrong.error().where.c_str(), wrong.error().message.c_str());

  world.remove(ball.value());
  const auto push = world.apply_impulse(ball.value(), {1, 0, 0});
  good = good && !push && push.error().code == hooke::ErrorCode::kStaleId;
  return good ? 0 : 1;
}
