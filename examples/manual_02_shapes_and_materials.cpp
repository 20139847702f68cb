/// Chapter 2 of the manual: a hammer of two materials, a hull, a valley, a bounce and a slope with friction.

#include "hooke/geometry.h"
#include "hooke/hooke.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr double kGravity = 9.81;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

/// A handle of wood along y, a head of steel at its top.
bool compound(hooke::World& world) {
  const auto hammer = world.add_body({
      .kind = hooke::BodyKind::kDynamic,
      .shape = hooke::Shape::compound(),
      .parts = {{.shape = hooke::Shape::box({0.02f, 0.15f, 0.02f}), .density = 700},
                {.shape = hooke::Shape::box({0.06f, 0.02f, 0.02f}),
                 .position = {0, 0.17f, 0},
                 .density = 7800}},
      .position = {0, 50, 0},
  });
  if (!hammer) return false;
  const double handle = 0.04 * 0.30 * 0.04 * 700;
  const double head = 0.12 * 0.04 * 0.04 * 7800;
  return agrees("mass of the hammer [kg]", world.mass(hammer.value()), handle + head, 0.001) &&
         agrees("its center over its frame [m]", world.center_of_mass(hammer.value()).y - 50,
                0.17 * head / (handle + head), 0.001);
}

/// The hull of six points is an octahedron: its volume is 4/3 of the cube of its radius.
bool hull(hooke::World& world) {
  const auto points = world.add_mesh({
      .positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      .triangles = {{0, 2, 4}},  // a mesh has one at least; its hull does not look at it
  });
  if (!points) return false;
  const auto gem = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                   .shape = hooke::Shape::hull_of(points.value()),
                                   .position = {5, 50, 0},
                                   .density = 3});
  return gem && agrees("mass of the gem [kg]", world.mass(gem.value()), 4, 0.001);
}

/// A valley of 9 x 9 heights, 1 m apart, with a flat bottom. A ball rolls down and comes to rest there.
bool valley(hooke::World& world) {
  std::vector<hooke::Real> heights;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      heights.push_back(0.2f * static_cast<float>(std::max(std::abs(column - 4) - 1, 0)));
    }
  }
  const auto mesh = world.add_mesh(hooke::make_height_field(9, 9, 1, heights).value());
  if (!mesh) return false;
  const auto ground = world.add_body({.shape = hooke::Shape::of_mesh(mesh.value())});
  const auto ball = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::sphere(0.2f),
                                    .position = {1.5, 0.6, 4.1},
                                    .contact = {.rolling_friction = 0.02f}});
  if (!ground || !ball) return false;
  for (int frame = 0; frame < 600; ++frame) world.step(1.0f / 60);
  return agrees("height of the ball in the valley [m]", world.pose(ball.value()).position.y, 0.2, 0.01);
}

/// A ball bounces to the square of its restitution times the height of its fall.
bool bounce(hooke::World& world) {
  const auto floor = world.add_body({.shape = hooke::Shape::box({1, 0.5f, 1}), .position = {20, -0.5, 0}});
  const auto ball = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::sphere(0.1f),
                                    .position = {20, 2.1, 0},
                                    .contact = {.restitution = 0.8f}});
  if (!floor || !ball) return false;
  double top = 0;
  bool rising = false;
  for (int frame = 0; frame < 72; ++frame) {
    world.step(1.0f / 60);
    rising = rising || world.velocity(ball.value()).y > 0;
    if (rising) top = std::fmax(top, world.pose(ball.value()).position.y - 0.1);
  }
  return agrees("height of the bounce [m]", top, 0.8 * 0.8 * 2, 0.02);
}

/// How far a crate slides in 1 s on a plane of 30 degrees [m].
double slide(float friction) {
  hooke::World world = hooke::World::create().value();
  const hooke::Quat tilt = hooke::quaternion_about(hooke::Vec3{0, 0, 1}, -3.14159265f / 6);
  const hooke::ContactDesc wood = {.friction = friction};
  const auto slope = world.add_body({.rotation = tilt, .contact = wood});
  const hooke::DVec3 start = hooke::vector_cast<double>(hooke::rotate(tilt, hooke::Vec3{0, 0.1f, 0}));
  const auto crate = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                     .shape = hooke::Shape::box({0.3f, 0.1f, 0.3f}),
                                     .position = start,
                                     .rotation = tilt,
                                     .contact = wood});
  if (!slope || !crate) return -1;
  for (int frame = 0; frame < 60; ++frame) world.step(1.0f / 60);
  return hooke::length(world.pose(crate.value()).position - start);
}

/// The crate holds where friction is above tan(30 deg) = 0.577, and slides by a t^2 / 2 where it is not.
bool friction() {
  const double way = kGravity * (0.5 - 0.3 * std::sqrt(0.75)) / 2;
  const double held = slide(0.6f);
  std::printf("slid with friction 0.6 [m]: %.5f\n", held);
  return held >= 0 && held < 0.001 && agrees("slid with friction 0.3 [m]", slide(0.3f), way, 0.02);
}

}  // namespace

int main() {
  hooke::World world = hooke::World::create().value();
  return compound(world) && hull(world) && valley(world) && bounce(world) && friction() ? 0 : 1;
}
