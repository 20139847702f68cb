/// Chapter 5 of the manual: a curtain that does not stretch, a sheet that falls in air, a balloon, and a
/// sheet that tears.

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

/// A curtain of 2 m by 1 m, held at every fourth point of its upper edge.
bool curtain(hooke::World& world) {
  constexpr std::uint32_t kColumns = 21;
  constexpr std::uint32_t kRows = 11;
  hooke::ClothDesc desc = {
      .columns = kColumns,
      .rows = kRows,
      .corner = {0, 3, 0},
      .width = 2,
      .height = 1,
      .areal_density = 0.3f,
      .tethers = true,
  };
  for (std::uint32_t column = 0; column < kColumns; column += 4) desc.pins.push_back({.point = column});
  const auto cloth = world.add_cloth(desc);
  if (!cloth) return false;
  advance(world, 180);
  const hooke::PointView points = world.positions(cloth.value());
  return agrees("the curtain hangs down by [m]", 3 - points[(kRows - 1) * kColumns].y, 1, 0.01);
}

/// A sheet that falls flat: its weight is its drag, sigma g = rho C v^2 / 2 for each square meter.
bool falling_sheet(hooke::World& world) {
  const auto cloth = world.add_cloth({
      .columns = 9,
      .rows = 9,
      .corner = {10, 0, 0},
      .row_direction = {0, 0, 1},
      .areal_density = 0.2f,
      .drag_coefficient = 1.2f,
  });
  if (!cloth) return false;
  advance(world, 120);
  const double speed = -world.velocities(cloth.value())[40].y;
  return agrees("speed of the sheet [m/s]", speed, std::sqrt(2 * 0.2 * kGravity / (1.225 * 1.2)), 0.01);
}

/// A sphere of rings, closed by two poles, triangles facing outward.
hooke::MeshDesc make_sphere(std::uint32_t rings, std::uint32_t sides) {
  hooke::MeshDesc mesh = {.positions = {{0, 1, 0}, {0, -1, 0}}};
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double polar = kPi * (ring + 1) / (rings + 1);
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double turn = 2 * kPi * side / sides;
      mesh.positions.push_back(hooke::vector_cast<hooke::Real>(
          hooke::DVec3{std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)}));
    }
  }
  const auto at = [sides](std::uint32_t ring, std::uint32_t side) { return 2 + ring * sides + side % sides; };
  for (std::uint32_t side = 0; side < sides; ++side) {
    mesh.triangles.push_back({0, at(0, side + 1), at(0, side)});
    mesh.triangles.push_back({1, at(rings - 1, side), at(rings - 1, side + 1)});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side)});
      mesh.triangles.push_back({at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)});
    }
  }
  return mesh;
}

/// Six times the volume is the sum of the triangles' triple products.
double volume(const hooke::World& world, hooke::ClothId cloth) {
  const hooke::PointView points = world.positions(cloth);
  double sum = 0;
  for (const auto& [a, b, c] : world.triangles(cloth)) {
    sum += hooke::dot(points[a], hooke::cross(points[b], points[c]));
  }
  return sum / 6;
}

/// Gas: (pressure + 101325 Pa) times volume stays, while the skin gives way to it.
bool balloon() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto mesh = world.add_mesh(make_sphere(9, 16));
  if (!mesh) return false;
  const auto skin = world.add_cloth({
      .mesh = mesh.value(),
      .stretch_stiffness = 2e3f,
      .damping = 2,
      .pressure = 2000.0f,
  });
  if (!skin) {
    std::printf("%s: %s\n", skin.error().where.c_str(), skin.error().message.c_str());
    return false;
  }
  const double before = (2000 + 101325) * volume(world, skin.value());
  advance(world, 120);
  const double after = volume(world, skin.value());
  std::printf("the balloon holds %.3f m^3 at %.0f Pa\n", after, world.pressure(skin.value()));
  return world.pressure(skin.value()) < 1900 &&
         agrees("pressure times volume [J]", (world.pressure(skin.value()) + 101325) * after, before, 0.01);
}

/// A sheet that is drawn apart at two corners.
bool tears(hooke::World& world) {
  const auto rag = world.add_cloth({
      .columns = 11,
      .rows = 11,
      .stretch_stiffness = 100,
      .tear_strain = 0.2f,
      .pins = {{.point = 0},
               {.point = 120,
                .motion = {.kind = hooke::MotionDesc::Kind::kConstantVelocity, .velocity = {1, -1, 0}}}},
  });
  if (!rag) return false;
  std::size_t split = 0;
  for (int frame = 0; frame < 120; ++frame) {
    world.step(1.0f / 60);
    split += world.events().tears.size();
  }
  if (world.positions(rag.value()).size() != 121 + split) return false;
  std::printf("the sheet tore at %zu points\n", split);
  return split > 0;
}

}  // namespace

int main() {
  hooke::World world = hooke::World::create().value();
  return curtain(world) && falling_sheet(world) && balloon() && tears(world) ? 0 : 1;
}
