/// Chapter 6 of the manual: a bar that hangs, a bar of clay that is drawn and let go, and a cheap jelly.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>
#include <vector>

namespace {

constexpr double kGravity = 9.81;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

void advance(hooke::World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60);
}

/// All points of a solid that lie at a height [m].
std::vector<hooke::PointRef> layer(const hooke::World& world, hooke::SolidId solid, double height) {
  std::vector<hooke::PointRef> found;
  const hooke::PointView points = world.positions(solid);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (std::abs(points[i].y - height) < 1e-4) found.push_back(hooke::point(solid, i));
  }
  return found;
}

void pin(hooke::World& world, const std::vector<hooke::PointRef>& points,
         const hooke::MotionDesc& motion = {}) {
  for (const hooke::PointRef& point : points) world.pin(point, motion).value();
}

/// Mean height of some points [m].
double mean_height(const hooke::World& world, hooke::SolidId solid, const std::vector<hooke::PointRef>& of) {
  double sum = 0;
  for (const hooke::PointRef& point : of) sum += world.positions(solid)[point.index].y;
  return sum / static_cast<double>(of.size());
}

/// A bar that hangs by its upper end is longer by rho g L^2 / 2 E. Without Poisson's effect it stays
/// straight.
bool hanging_bar(hooke::World& world) {
  const auto bar = world.add_solid({
      .cells = {1, 10, 1},
      .size = {0.2f, 1, 0.2f},
      .position = {0, 2, 0},
      .density = 1000,
      .young_modulus = 1e5f,
      .poisson_ratio = 0,
      .damping = 0.02f,
  });
  if (!bar) return false;
  const std::vector<hooke::PointRef> lower = layer(world, bar.value(), 1.5);
  pin(world, layer(world, bar.value(), 2.5));
  advance(world, 180);
  return agrees("the bar is longer by [m]", 1.5 - mean_height(world, bar.value(), lower),
                1000 * kGravity * 1 / (2 * 1e5), 0.03);
}

/// A bar of clay is drawn by 10 %. It yields at sigma / E = 4 %, and keeps the rest when it is let go.
bool clay() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto bar = world.add_solid({
      .cells = {1, 10, 1},
      .size = {0.2f, 1, 0.2f},
      .young_modulus = 1e5f,
      .poisson_ratio = 0.3f,
      .damping = 0.01f,
      .yield_stress = 4e3f,
  });
  if (!bar) return false;
  const std::vector<hooke::PointRef> upper = layer(world, bar.value(), 0.5);
  pin(world, layer(world, bar.value(), -0.5));
  pin(world, upper,
      {.kind = hooke::MotionDesc::Kind::kKeyframes,
       .keyframes = {{.time = 0}, {.time = 1.5, .offset = {0, 0.1f, 0}}}});
  advance(world, 120);
  for (const hooke::PointRef& point : upper) world.unpin(point).value();
  advance(world, 90);
  const double length = mean_height(world, bar.value(), upper) + 0.5;
  return agrees("the clay keeps a length of [m]", length, 1.1 / 1.04, 0.005);
}

/// A form that is matched at 2 Hz swings at 2 Hz, whatever its mass and size.
bool jelly() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto cube = world.add_solid({
      .elasticity = hooke::SolidDesc::Elasticity::kShapeMatching,
      .match_hz = 2,
      .match_damping_ratio = 0,
      .cells = {2, 2, 2},
  });
  if (!cube) return false;
  const hooke::PointView points = world.positions(cube.value());
  std::vector<hooke::Vec3> speeds;
  for (std::size_t i = 0; i < points.size(); ++i) speeds.push_back({static_cast<float>(points[i].x), 0, 0});
  for (std::uint32_t i = 0; i < speeds.size(); ++i) {
    if (!world.set_velocity(hooke::point(cube.value(), i), speeds[i])) return false;
  }
  double quarter = 0;  // when the stretching cube turns back [s]
  double widest = 0;
  for (int frame = 0; frame < 30; ++frame) {
    world.step(1.0f / 240);
    const double x = std::abs(world.positions(cube.value())[0].x);
    if (x > widest) quarter = world.time();
    widest = std::fmax(widest, x);
  }
  return agrees("period of the jelly [s]", 4 * quarter, 1 / 2.0, 0.05);
}

}  // namespace

int main() {
  hooke::World world = hooke::World::create().value();
  return hanging_bar(world) && clay() && jelly() ? 0 : 1;
}
