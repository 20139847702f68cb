#include "geometry/meshes.h"
#include "world/make.h"

#include <cmath>
#include <string>

namespace hooke {

using namespace test;

namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kAir = 101325;

/// A sphere of radius 0.1 m whose springs have the stiffness k.
ClothDesc ball(World& world, double stiffness) {
  MeshDesc mesh = test::make_sphere(3);
  for (Vec3& p : mesh.positions) p = Real(0.1) * p;
  ClothDesc desc;
  desc.mesh = take(world.add_mesh(mesh));
  desc.stretch_stiffness = static_cast<Real>(stiffness);
  desc.shear_stiffness = Real(0);
  desc.bend_stiffness = Real(0);
  desc.damping = static_cast<Real>(stiffness * 1e-3);
  desc.drag_coefficient = desc.lift_coefficient = Real(0);
  return desc;
}

struct Sphere {
  double volume = 0;
  double area = 0;
  std::vector<DVec3> points;
};

Sphere measure(const World& world, ClothId id) {
  Sphere s;
  const PointView x = world.positions(id);
  for (std::size_t i = 0; i < x.size(); ++i) s.points.push_back(x[i]);
  for (const auto& t : world.triangles(id)) {
    s.volume += dot(x[t[0]], cross(x[t[1]], x[t[2]])) / 6;
    s.area += 0.5 * length(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
  }
  return s;
}

}  // namespace

TEST_SUITE("world/gas") {
  TEST_CASE("a balloon stands where twice its tension over its radius is the pressure in it (V74)") {
    WorldDesc still = test::empty_space();
    still.substeps =
        64;  // one pass leaves a part (w h)^2 of the skin's stiffness unused, w of its fastest mode
    still.particle_substeps = 4;
    World world = make_world(still);
    const double k = 5000;
    ClothDesc desc = ball(world, k);
    desc.pressure = Real(5000);
    desc.areal_density = Real(20);
    desc.damping = Real(0);
    desc.air_friction = Real(2500);
    const ClothId id = take(world.add_cloth(desc));
    const Sphere before = measure(world, id);
    CHECK(world.pressure(id) == doctest::Approx(5000).epsilon(1e-3));
    run(world, 30);
    const Sphere after = measure(world, id);
    const double pressure = static_cast<double>(world.pressure(id));
    // p V stays: Boyle.
    CHECK((pressure + kAir) * after.volume == doctest::Approx((5000 + kAir) * before.volume).epsilon(1e-4));
    // Tension in the mean over the skin: each spring pulls with k (l - L), and T = sum k (l - L) l / 2 A.
    double work = 0;
    for (const auto& t : world.triangles(id)) {
      for (int i = 0; i < 3; ++i) {
        const double now = length(world.positions(id)[t[i]] - world.positions(id)[t[(i + 1) % 3]]);
        const double rest = length(before.points[t[i]] - before.points[t[(i + 1) % 3]]);
        work += 0.5 * k * (now - rest) * now;  // each edge has two triangles
      }
    }
    const double tension = work / (2 * after.area);
    const double radius = 3 * after.volume / after.area;
    CHECK(2 * tension / radius == doctest::Approx(pressure).epsilon(0.02));
    const double strain = std::cbrt(after.volume / before.volume) - 1;
    CHECK(strain > 0.009);
    CHECK(world.measure().energy.kinetic < 1e-6);
  }

  TEST_CASE("the volume of a ball swings at the frequency of its gas and its skin, whatever the substep") {
    // Skin without stiffness: m r'' = 4 pi r^2 p, so that w^2 = 12 pi r P / m at P everywhere.
    WorldDesc still = test::empty_space();
    still.substeps = 64;
    World world = make_world(still);
    ClothDesc desc = ball(world, 1e-3);
    desc.total_mass = Real(100);
    desc.pressure = Real(0);
    const ClothId id = take(world.add_cloth(desc));
    const double rest = measure(world, id).volume;
    const double frequency = std::sqrt(12 * kPi * 0.1 * kAir / 100) / (2 * kPi);
    for (std::uint32_t i = 0; i < world.positions(id).size(); ++i)
      REQUIRE(world.set_velocity(point(id, i), vector_cast<Real>(world.positions(id)[i])));
    double last = 0;
    double first_crossing = 0;
    double last_crossing = 0;
    int crossings = 0;
    while (crossings < 7 && world.time() < 4) {
      run(world, 1, Real(1) / Real(600));
      const double now = measure(world, id).volume / rest - 1;
      if (now * last < 0) {
        const double at = world.time() - now / (now - last) / 600;
        if (crossings == 0) first_crossing = at;
        last_crossing = at;
        ++crossings;
      }
      last = now;
    }
    REQUIRE(crossings == 7);
    CHECK(3 / (last_crossing - first_crossing) == doctest::Approx(frequency).epsilon(0.02));
  }

  TEST_CASE("gas pushes no closed cloth anywhere, and turns none") {
    World world = make_world(test::empty_space());
    ClothDesc desc = ball(world, 2000);
    desc.pressure = Real(2e4);
    const ClothId id = take(world.add_cloth(desc));
    REQUIRE(world.apply_impulse(point(id, 0), {Real(0.01), Real(0.02), 0}));
    const Measurement before = world.measure();
    run(world, 120);
    const Measurement after = world.measure();
    CHECK(length(after.momentum - before.momentum) < 2e-6 * length(before.momentum) + 1e-7);
    CHECK(length(after.angular_momentum - before.angular_momentum) < 1e-6);
  }

  TEST_CASE("a crushed ball stays finite and comes back") {
    World world = make_world(test::empty_space());
    ClothDesc desc = ball(world, 2000);
    desc.pressure = Real(1e4);
    const ClothId id = take(world.add_cloth(desc));
    const double rest = measure(world, id).volume;
    for (std::uint32_t i = 0; i < world.positions(id).size(); ++i) {
      DVec3 x = world.positions(id)[i];
      x.y *= 0.01;
      REQUIRE(world.set_position(point(id, i), x));
    }
    run(world, 240);
    CHECK(measure(world, id).volume > 0.9 * rest);
  }

  TEST_CASE("only a closed mesh that faces outward holds gas") {
    World world = make_world();
    ClothDesc grid;
    grid.pressure = Real(100);
    CHECK(world.add_cloth(grid).error().where == "cloth.pressure");
    MeshDesc inward = test::make_sphere(1);
    for (auto& t : inward.triangles) std::swap(t[0], t[1]);
    ClothDesc desc;
    desc.mesh = take(world.add_mesh(inward));
    desc.pressure = Real(100);
    CHECK(world.add_cloth(desc).error().where == "cloth.pressure");
    desc.pressure = static_cast<Real>(std::nan(""));
    CHECK(world.add_cloth(desc).error().where == "cloth.pressure");
    CHECK(world.memory().particles == 0);
    CHECK(world.pressure(ClothId{}) == 0);
  }
}

}  // namespace hooke
