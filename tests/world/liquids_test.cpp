/// What floats in a liquid, and how deep (Archimedes), with gravity in any direction.

#include "geometry/meshes.h"
#include "math/root.h"
#include "world/make.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr double kGravity = 9.81;
constexpr double kWater = 1000;
constexpr double kPi = std::numbers::pi;

/// Still water whose surface lies 2 m above the origin, against gravity.
struct Pool {
  explicit Pool(Quat turn, Real drag = Real(3)) {
    up = vector_cast<double>(rotate(turn, Vec3{0, Real(1), 0}));
    WorldDesc desc = without_air();
    desc.gravity = vector_cast<Real>(-kGravity * up);
    desc.sleeping = false;
    world = make_world(desc);
    take(world.add_field({.kind = FieldDesc::Kind::kLiquid, .height = 2.0, .density = kWater, .drag = drag}));
  }

  /// How deep a point lies.
  [[nodiscard]] double depth(DVec3 x) const { return 2 - dot(up, x); }

  World world = make_world();
  DVec3 up = {};
};

DVec3 middle_of(const PointView& points) {
  DVec3 sum;
  for (std::size_t i = 0; i < points.size(); ++i) sum += points[i];
  return (1.0 / static_cast<double>(points.size())) * sum;
}

std::vector<Quat> turns() {
  return {Quat{}, quaternion_about(Vec3{Real(1), Real(2), Real(-0.5)}, Real(2.1)),
          quaternion_about(Vec3{0, 0, Real(1)}, Real(3.1415927))};
}

}  // namespace

TEST_SUITE("world/liquids") {
  TEST_CASE("the cube root is exact to 1e-15, and 0 for a number that is not positive") {
    for (double x = 1e-30; x < 1e30; x *= 7.3) {
      const double root = math::cube_root(x);
      CHECK(root * root * root == doctest::Approx(x).epsilon(1e-15));
    }
    CHECK(math::cube_root(0) == 0);
    CHECK(math::cube_root(-8) == 0);
  }

  TEST_CASE("a block of jelly floats as deep as its density says, whatever its cells") {
    for (const Quat turn : turns()) {
      for (const std::int32_t cells : {1, 3}) {
        Pool pool(turn);
        SolidDesc desc = {.cells = {cells, cells, cells},
                          .size = {Real(0.6), Real(0.3), Real(0.5)},
                          .position = 2.1 * pool.up,
                          .rotation = turn,
                          .density = Real(600),
                          .young_modulus = Real(1e6)};
        const SolidId block = take(pool.world.add_solid(desc));
        run(pool.world, 600);
        // 0.6 of its height lies below the surface: the middle a tenth of the height.
        CHECK(pool.depth(middle_of(pool.world.positions(block))) == doctest::Approx(0.03).epsilon(0.02));
      }
    }
  }

  TEST_CASE("a body floats across gravity, wherever that points") {
    for (const Quat turn : turns()) {
      Pool pool(turn);
      const BodyId box = take(pool.world.add_body({.kind = BodyKind::kDynamic,
                                                   .shape = Shape::box({Real(0.5), Real(0.25), Real(0.4)}),
                                                   .position = 2.1 * pool.up,
                                                   .rotation = turn,
                                                   .density = Real(600)}));
      run(pool.world, 900);
      CHECK(pool.depth(pool.world.center_of_mass(box)) == doctest::Approx(0.05).epsilon(0.01));
    }
  }

  TEST_CASE("a rope lifts by the volume it has, and lies at the surface by half of it") {
    const double radius = 0.02;
    const double length = 2;
    const double volume = kPi * radius * radius * length;
    for (const double density : {250.0, 2000.0}) {
      // Deep below: as a whole at g (1 - rho_w / rho), without drag.
      Pool pool(turns()[1], Real(0));
      RopeDesc desc = {.total_mass = static_cast<Real>(density * volume), .pins = {}, .radius = Real(radius)};
      for (int i = 0; i <= 20; ++i) desc.points.push_back({length * i / 20, -30, 0});
      const RopeId rope = take(pool.world.add_rope(desc));
      run(pool.world, 30);
      const DVec3 v = middle_of(pool.world.positions(rope)) - DVec3{length / 2, -30, 0};
      const double way = -0.5 * kGravity * (1 - kWater / density) * 0.25;
      CHECK(dot(v, pool.up) == doctest::Approx(way).epsilon(0.01));
    }
    Pool pool(Quat{});
    RopeDesc desc = {.total_mass = Real(0.5 * kWater * volume), .pins = {}, .radius = Real(radius)};
    for (int i = 0; i <= 20; ++i) desc.points.push_back({length * i / 20, 2.3, 0});
    const RopeId rope = take(pool.world.add_rope(desc));
    run(pool.world, 900);
    CHECK(std::abs(pool.depth(middle_of(pool.world.positions(rope)))) < 0.003);
  }

  TEST_CASE("a balloon floats to its middle where it has half the mass of the water it displaces") {
    for (const Quat turn : turns()) {
      Pool pool(turn);
      MeshDesc mesh = test::make_sphere(3);
      for (Vec3& p : mesh.positions) p = Real(0.1) * p;
      ClothDesc desc;
      desc.mesh = take(pool.world.add_mesh(mesh));
      desc.position = 2.1 * pool.up;
      desc.stretch_stiffness = Real(1e5);
      desc.pressure = Real(5000);
      const double area = 4 * kPi * 0.01;
      const double displaced = 4 * kPi / 3 * 1e-3;
      desc.areal_density = static_cast<Real>(0.5 * kWater * displaced / area);
      const ClothId balloon = take(pool.world.add_cloth(desc));
      run(pool.world, 900);
      CHECK(std::abs(pool.depth(middle_of(pool.world.positions(balloon)))) < 0.004);
    }
  }

  TEST_CASE("a sheet floats by its thickness, and a light one does not run away") {
    for (const double share : {0.5, 0.01}) {
      Pool pool(turns()[1]);
      ClothDesc desc;
      desc.columns = desc.rows = 7;
      desc.width = desc.height = Real(0.6);
      desc.corner = 2.0 * pool.up;
      desc.column_direction = rotate(turns()[1], Vec3{Real(1), 0, 0});
      desc.row_direction = rotate(turns()[1], Vec3{0, 0, Real(1)});
      desc.thickness = Real(0.02);
      desc.areal_density = static_cast<Real>(share * kWater * 0.02);
      const ClothId sheet = take(pool.world.add_cloth(desc));
      run(pool.world, 900);
      CHECK(std::abs(pool.depth(middle_of(pool.world.positions(sheet)))) < 0.02);
      CHECK(pool.world.measure().energy.kinetic < 1e-3);
    }
  }
}

}  // namespace hooke
