/// Bodies that touch ropes and cloths between their points.

#include "hooke/world.h"

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// So thick is a rope in the middle of a segment, over its radius (collision/deformable/element_contacts.h).
constexpr double kThickness = 0.8;

/// How high the second segment of a rope runs at x.
double height_of_line(PointView points, double x) {
  const DVec3 a = points[1];
  const DVec3 b = points[2];
  return a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y);
}

/// A cloth of n x n points over the square of side `size` about the y axis, at the height `y`.
ClothDesc sheet(int n, double size, double y) {
  return {.columns = n,
          .rows = n,
          .corner = {-0.5 * size, y, -0.5 * size},
          .row_direction = {0, 0, 1},
          .width = static_cast<Real>(size),
          .height = static_cast<Real>(size)};
}

std::vector<PinDesc> corners(int n) {
  const auto last = static_cast<std::uint32_t>(n - 1);
  const auto row = static_cast<std::uint32_t>(n);
  return {{.point = 0}, {.point = last}, {.point = row * last}, {.point = row * last + last}};
}

/// A box of triangles, as a body that does not move.
BodyId add_mesh_box(World& world, Vec3 half_extents, DVec3 position) {
  const auto [x, y, z] = std::array{half_extents.x, half_extents.y, half_extents.z};
  const MeshDesc box = {.positions = {{-x, -y, -z},
                                      {x, -y, -z},
                                      {x, y, -z},
                                      {-x, y, -z},
                                      {-x, -y, z},
                                      {x, -y, z},
                                      {x, y, z},
                                      {-x, y, z}},
                        .triangles = {{0, 2, 1},
                                      {0, 3, 2},
                                      {4, 5, 6},
                                      {4, 6, 7},
                                      {0, 1, 5},
                                      {0, 5, 4},
                                      {3, 6, 2},
                                      {3, 7, 6},
                                      {0, 4, 7},
                                      {0, 7, 3},
                                      {1, 2, 6},
                                      {1, 6, 5}}};
  return take(world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(box))),
                              .position = position,
                              .contact = {.friction = 1}}));
}

struct Under {
  double height = std::numeric_limits<double>::quiet_NaN();
  std::array<std::uint32_t, 3> corner = {};
  std::array<double, 3> weight = {};
};

/// The triangle of a sheet that is over or under (x, z), and its height there.
Under triangle_at(PointView p, int n, double x, double z) {
  for (int row = 0; row + 1 < n; ++row) {
    for (int column = 0; column + 1 < n; ++column) {
      const auto a = static_cast<std::uint32_t>(row * n + column);
      const auto b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(n);
      const auto e = c + 1;
      const bool even = (row + column) % 2 == 0;
      const std::array<std::array<std::uint32_t, 3>, 2> triangles =
          even ? std::array<std::array<std::uint32_t, 3>, 2>{{{a, c, e}, {a, e, b}}}
               : std::array<std::array<std::uint32_t, 3>, 2>{{{a, c, b}, {b, c, e}}};
      for (const auto& t : triangles) {
        const DVec3 u = p[t[1]] - p[t[0]];
        const DVec3 v = p[t[2]] - p[t[0]];
        const double rx = x - p[t[0]].x;
        const double rz = z - p[t[0]].z;
        const double det = u.x * v.z - u.z * v.x;
        const double s = (rx * v.z - rz * v.x) / det;
        const double r = (u.x * rz - u.z * rx) / det;
        if (s < 0 || r < 0 || s + r > 1) continue;
        return {p[t[0]].y + s * u.y + r * v.y, t, {1 - s - r, s, r}};
      }
    }
  }
  return {};
}

}  // namespace

TEST_SUITE("world/element_contacts") {
  TEST_CASE("a rope of three segments over a narrow block rests on it, and does not sink in between nodes") {
    for (const ShapeKind kind :
         {ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kCone, ShapeKind::kSphere}) {
      World world = make_world(without_air());
      BodyDesc block;
      if (kind == ShapeKind::kBox)
        block = {.shape = Shape::box({Real(0.05), Real(0.3), Real(0.3)}), .position = {0, -0.3, 0}};
      if (kind == ShapeKind::kCylinder)
        block = {.shape = Shape::cylinder(Real(0.05), Real(0.3)), .position = {0, -0.3, 0}};
      if (kind == ShapeKind::kCapsule)
        block = {.shape = Shape::capsule(Real(0.05), Real(0.3)), .position = {0, -0.35, 0}};
      if (kind == ShapeKind::kCone)
        block = {.shape = Shape::cone(Real(0.1), Real(0.3)), .position = {0, -0.3, 0}};
      if (kind == ShapeKind::kSphere) block = {.shape = Shape::sphere(Real(0.05)), .position = {0, -0.05, 0}};
      block.contact.friction = 1;
      take(world.add_body(block));
      const double radius = 0.01;
      const RopeId rope =
          take(world.add_rope({.total_mass = Real(0.3),
                               .points = {{-0.6, 0.05, 0}, {-0.2, 0.05, 0}, {0.2, 0.05, 0}, {0.6, 0.05, 0}},
                               .pins = {},
                               .radius = static_cast<Real>(radius),
                               .contact = {.friction = 1}}));
      double lowest = 1;
      for (int i = 0; i < 90; ++i) {
        run(world, 1);
        lowest = std::min(lowest, height_of_line(world.positions(rope), 0));
      }
      INFO("shape ", static_cast<int>(kind));
      CHECK(lowest > 0.95 * kThickness * radius);
    }
  }

  TEST_CASE("a small ball on a coarse cloth rests as deep as its weight on the corners would be") {
    const int n = 4;
    const double radius = 0.03;
    WorldDesc desc = without_air();
    desc.particle_substeps = 4;
    for (const double mass : {0.01, 0.02}) {
      ClothDesc cloth = sheet(n, 0.9, 0);
      cloth.pins = corners(n);
      cloth.stretch_stiffness = 1000;
      cloth.damping = Real(1);
      cloth.contact.friction = 1;
      World world = make_world(desc);
      const ClothId held = take(world.add_cloth(cloth));
      const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = Shape::sphere(static_cast<Real>(radius)),
                                               .position = {0.01, 0.1, 0.03},
                                               .mass = static_cast<Real>(mass),
                                               .linear_damping = 2,
                                               .angular_damping = 5,
                                               .contact = {.friction = 1}}));
      run(world, 300);  // It rolls on to the lowest corner.
      const DVec3 center = world.center_of_mass(ball);
      const Under under = triangle_at(world.positions(held), n, center.x, center.z);
      CHECK(std::max({under.weight[0], under.weight[1], under.weight[2]}) < 0.8);
      CHECK(center.y - under.height > radius);
      CHECK(center.y - under.height < radius + 0.003);

      World other = make_world(desc);
      for (std::size_t k = 0; k < 3; ++k)
        cloth.loads.push_back({.point = under.corner[k], .mass = static_cast<Real>(under.weight[k] * mass)});
      const ClothId loaded = take(other.add_cloth(cloth));
      run(other, 900);
      CHECK(
          under.height ==
          doctest::Approx(triangle_at(other.positions(loaded), n, center.x, center.z).height).epsilon(0.01));
    }
  }

  TEST_CASE("a thin pole does not poke through a coarse cloth that falls on it") {
    for (const double speed : {0.0, 10.0}) {  // it slides off some time
      World world = make_world(without_air());
      const double top = 1;
      take(world.add_body({.shape = Shape::capsule(Real(0.01), Real(0.5)),
                           .position = {0.06, 0.49, 0.03},
                           .contact = {.friction = 1}}));
      const int n = 7;
      ClothDesc cloth = sheet(n, 1.2, 1.1);
      cloth.velocity = {0, static_cast<Real>(-speed), 0};
      cloth.contact.friction = 1;
      const ClothId falls = take(world.add_cloth(cloth));
      double lowest = 10;
      for (int i = 0; i < 30; ++i) {
        run(world, 1);
        lowest = std::min(lowest, triangle_at(world.positions(falls), n, 0.06, 0.03).height);
      }
      CHECK(lowest > top);
    }
  }

  TEST_CASE("a rope of three segments over ridges of a mesh rests on them") {
    World world = make_world(without_air());
    SUBCASE("of a block") {
      add_mesh_box(world, {Real(0.05), Real(0.3), Real(0.3)}, {0, -0.3, 0});
    }
    SUBCASE("of a sheet that ends there") {
      const MeshDesc sheet = {.positions = {{Real(-0.05), 0, -1}, {Real(0.05), 0, -1}, {0, 0, 1}},
                              .triangles = {{0, 2, 1}}};
      take(
          world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(sheet))), .contact = {.friction = 1}}));
    }
    const double radius = 0.01;
    const RopeId rope =
        take(world.add_rope({.total_mass = Real(0.3),
                             .points = {{-0.6, 0.05, 0}, {-0.2, 0.05, 0}, {0.2, 0.05, 0}, {0.6, 0.05, 0}},
                             .pins = {},
                             .radius = static_cast<Real>(radius),
                             .contact = {.friction = 1}}));
    double lowest = 1;
    for (int i = 0; i < 90; ++i) {
      run(world, 1);
      lowest = std::min(lowest, height_of_line(world.positions(rope), 0));
    }
    CHECK(lowest > 0.95 * kThickness * radius);
  }

  TEST_CASE("a spike of a mesh does not poke through a coarse cloth that falls on it") {
    for (const double speed : {0.0, 10.0}) {
      World world = make_world(without_air());
      const Real foot = Real(0.05);
      const MeshDesc spike = {
          .positions = {{-foot, 0, -foot}, {foot, 0, -foot}, {foot, 0, foot}, {-foot, 0, foot}, {0, 1, 0}},
          .triangles = {{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}, {0, 1, 2}, {0, 2, 3}}};
      take(world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(spike))),
                           .position = {0.06, 0, 0.03},
                           .contact = {.friction = 1}}));
      const int n = 7;
      ClothDesc cloth = sheet(n, 1.2, 1.1);
      cloth.velocity = {0, static_cast<Real>(-speed), 0};
      cloth.contact.friction = 1;
      cloth.shear_stiffness = 2000;  // So that no fold hangs beside the tip within these frames.
      const ClothId falls = take(world.add_cloth(cloth));
      double lowest = 10;
      for (int i = 0; i < 30; ++i) {
        run(world, 1);
        lowest = std::min(lowest, triangle_at(world.positions(falls), n, 0.06, 0.03).height);
      }
      CHECK(lowest > 1);
    }
  }

  TEST_CASE("a ball that hits a cloth or a rope between its points keeps the momentum, and neither passes") {
    for (const bool on_rope : {false, true}) {
      World world = make_world(empty_space());
      ClothId cloth;
      RopeId rope;
      if (on_rope) {
        rope = take(world.add_rope({.total_mass = Real(0.2),
                                    .points = {{-0.6, 0, 0}, {-0.2, 0, 0}, {0.2, 0, 0}, {0.6, 0, 0}},
                                    .pins = {}}));
      } else {
        ClothDesc desc = sheet(5, 1, 0);
        desc.contact.friction = Real(0.5);
        desc.stretch_stiffness = 200;
        desc.shear_stiffness = 100;
        cloth = take(world.add_cloth(desc));
      }
      const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = Shape::sphere(Real(0.03)),
                                               .position = {0.1, 0.2, on_rope ? 0.004 : 0.05},
                                               .velocity = {Real(0.3), -3, 0},
                                               .mass = Real(0.1)}));
      const Measurement before = world.measure();
      double energy = 0;
      for (int i = 0; i < 60; ++i) {
        run(world, 1);
        energy = std::max(energy, world.measure().energy.total());
        if (i == 10) {
          const DVec3 center = world.center_of_mass(ball);
          const double height = on_rope ? height_of_line(world.positions(rope), center.x)
                                        : triangle_at(world.positions(cloth), 5, center.x, center.z).height;
          CHECK(center.y > height);
        }
      }
      const Measurement after = world.measure();
      CHECK(length(after.momentum - before.momentum) < 1e-6 * length(before.momentum));
      CHECK(energy < 1.001 * before.energy.total());
    }
  }

  TEST_CASE("bodies as narrow as the meshes come to rest on a cloth, asleep or not") {
    // Of such heaps half threw a body up as it fell asleep, and one in ten let one through.
    for (const double lift : {0.0, 1e-4, 2e-4, 5e-4}) {
      CAPTURE(lift);
      const int n = 13;
      World world = make_world();
      ClothDesc cloth = sheet(n, 1.2, 1);
      cloth.total_mass = Real(0.4);
      cloth.stretch_stiffness = 2000;
      cloth.shear_stiffness = 500;
      cloth.tethers = true;
      for (std::uint32_t k = 0; k < n; ++k) {
        for (const std::uint32_t point : {k, n * k, n * (n - 1) + k, n * k + n - 1})
          cloth.pins.push_back({.point = point});
      }
      take(world.add_cloth(cloth));
      std::vector<BodyId> bodies;
      const Real size = Real(0.06);
      const std::array<Shape, 3> shapes = {Shape::sphere(size), Shape::box({size, size, size}),
                                           Shape::capsule(Real(0.8) * size, size)};
      for (int k = 0; k < 9; ++k) {
        bodies.push_back(
            take(world.add_body({.kind = BodyKind::kDynamic,
                                 .shape = shapes[static_cast<std::size_t>(k % 3)],
                                 .position = {0.19 * (k % 3 - 1), 1.15 + lift, 0.21 * (k / 3 - 1)},
                                 .mass = Real(0.3)})));
      }
      run(world, 200);
      for (int i = 0; i < 250; ++i) {
        run(world, 1);
        for (const BodyId body : bodies) {
          CHECK(world.center_of_mass(body).y > 0.9);
          CHECK(length(world.velocity(body)) < 1);  // They roll on it, and push each other.
        }
      }
    }
  }

  TEST_CASE("element contacts have the same bits for any number of workers, and again after a restore") {
    check_same_bits(without_air(), [](World& world) {
      take(world.add_body({.shape = Shape::box({Real(0.05), Real(0.3), Real(3)}), .position = {0, -0.3, 0}}));
      for (int k = 0; k < 5; ++k) {
        take(world.add_rope({.points = {{-0.5, 0.05, 0.2 * k},
                                        {-0.2, 0.05, 0.2 * k},
                                        {0.2, 0.05, 0.2 * k},
                                        {0.6, 0.05, 0.2 * k}},
                             .pins = {}}));
      }
      ClothDesc cloth = sheet(5, 1, 0.5);
      cloth.pins = corners(5);
      take(world.add_cloth(cloth));
      take(world.add_cloth(sheet(5, 1, 0.1)));
      take(world.add_body({.kind = BodyKind::kDynamic,
                           .shape = Shape::box({Real(0.03), Real(0.03), Real(0.03)}),
                           .position = {0.1, 0.6, 0}}));
    });
  }
}

}  // namespace hooke
