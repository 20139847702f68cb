#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

/// \file
/// Loads that are much heavier than a cloth, at single points of it: the cloth is solved as a whole.

namespace hooke {

using namespace test;

namespace {

constexpr std::uint32_t kColumns = 31;
constexpr std::uint32_t kRows = 21;
constexpr std::uint32_t kLoaded = 10 * kColumns + 30;  ///< In the middle of the free edge.

/// A flag of 0.2 kg and 1.5 m x 1 m, held along one edge, with a limit of 5 %.
ClothDesc flag() {
  ClothDesc cloth;
  cloth.columns = kColumns;
  cloth.rows = kRows;
  cloth.width = Real(1.5);
  cloth.height = Real(1);
  cloth.corner = {0, 2, 0};
  cloth.total_mass = Real(0.2);
  cloth.extension_max = Real(0.05);
  for (std::uint32_t row = 0; row < kRows; ++row) cloth.pins.push_back({row * kColumns});
  return cloth;
}

/// Largest extension of the links along rows and columns of that flag.
double largest_extension(const World& world, ClothId cloth) {
  const PointView at = world.positions(cloth);
  double largest = 0;
  for (std::uint32_t i = 0; i < kColumns * kRows; ++i) {
    const auto look = [&](std::uint32_t next) {
      largest = std::max(largest, length(at[next] - at[i]) / 0.05 - 1);
    };
    if (i % kColumns + 1 < kColumns) look(i + 1);
    if (i + kColumns < kColumns * kRows) look(i + kColumns);
  }
  return largest;
}

struct Extremes {
  double extension = 0;
  double energy_gain = -1;  ///< Over the first energy.
  std::uint32_t unconverged = 0;
};

Extremes watch(World& world, ClothId cloth, int steps) {
  Extremes extremes;
  const double first = world.measure().energy.total();
  for (int i = 0; i < steps; ++i) {
    extremes.unconverged += world.step(Real(1) / Real(60)).cloths_unconverged;
    extremes.extension = std::max(extremes.extension, largest_extension(world, cloth));
    extremes.energy_gain = std::max(extremes.energy_gain, world.measure().energy.total() / first - 1);
  }
  return extremes;
}

/// Hooks a box to the loaded point of the flag.
void hang_box(World& world, ClothId cloth, Real mass) {
  const BodyId box = take(world.add_body(
      {.kind = BodyKind::kDynamic,
       .shape = {.kind = ShapeKind::kBox, .half_extents = {Real(0.05), Real(0.05), Real(0.05)}},
       .position = {1.5, 1.45, 0},
       .mass = mass}));
  HookDesc hook;
  hook.a.point = point(cloth, kLoaded);
  hook.b.body = box;
  hook.anchor = {1.5, 1.5, 0};
  take(world.add_hook(hook));
}

/// A cloth of 0.3 kg and 1.6 m x 1.6 m, held along all edges at a height of 1.5 m, with a limit of 5 %.
ClothDesc net() {
  constexpr std::uint32_t kSide = 41;
  ClothDesc cloth;
  cloth.columns = cloth.rows = kSide;
  cloth.width = cloth.height = Real(1.6);
  cloth.corner = {-0.8, 1.5, -0.8};
  cloth.row_direction = {0, 0, 1};
  cloth.total_mass = Real(0.3);
  cloth.extension_max = Real(0.05);
  for (std::uint32_t i = 0; i < kSide; ++i) {
    for (const std::uint32_t edge : {i, kSide * (kSide - 1) + i, i * kSide, i * kSide + kSide - 1})
      cloth.pins.push_back({edge});
  }
  return cloth;
}

/// Drops bodies in a circle on the net.
std::vector<BodyId> drop_on_net(World& world, int count, ShapeKind kind, Real mass) {
  std::vector<BodyId> bodies;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const double radius = count > 1 ? 0.3 : 0;
    bodies.push_back(
        take(world.add_body({.kind = BodyKind::kDynamic,
                             .shape = kind == ShapeKind::kBox ? Shape::box({Real(0.1), Real(0.1), Real(0.1)})
                                                              : Shape::sphere(Real(0.1)),
                             .position = {radius * std::cos(angle), 1.65, radius * std::sin(angle)},
                             .mass = mass})));
  }
  return bodies;
}

/// Largest extension of the links of the net.
double net_extension(const World& world, ClothId cloth) {
  constexpr std::uint32_t kSide = 41;
  const PointView at = world.positions(cloth);
  double largest = 0;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const auto look = [&](std::uint32_t next) {
      largest = std::max(largest, length(at[next] - at[i]) / 0.04 - 1);
    };
    if (i % kSide + 1 < kSide) look(i + 1);
    if (i + kSide < kSide * kSide) look(i + kSide);
  }
  return largest;
}

}  // namespace

TEST_SUITE("world/loaded_cloths") {
  TEST_CASE("bodies that fall on points of a cloth are borne within its limit, without a gain of energy") {
    struct Case {
      int count;
      ShapeKind kind;
      Real mass;
      bool corners_only;  ///< Nothing else holds the cloth.
      double most;
    };
    for (const Case& c :
         {Case{1, ShapeKind::kSphere, 4, false, 0.05}, Case{1, ShapeKind::kSphere, 20, false, 0.05},
          Case{6, ShapeKind::kSphere, 1, false, 0.05}, Case{6, ShapeKind::kBox, 1, false, 0.05},
          Case{6, ShapeKind::kSphere, 1, true, 0.05}, Case{6, ShapeKind::kBox, 1, true, 0.08}}) {
      CAPTURE(c.count);
      CAPTURE(c.mass);
      CAPTURE(c.corners_only);
      World world = make_world({});
      ClothDesc desc = net();
      if (c.corners_only) desc.pins = {{0}, {40}, {40 * 41}, {41 * 41 - 1}};
      const ClothId cloth = take(world.add_cloth(desc));
      const std::vector<BodyId> bodies = drop_on_net(world, c.count, c.kind, c.mass);
      const double first = world.measure().energy.total();
      double extension = 0;
      double energy = first;
      for (int i = 0; i < 90; ++i) {
        CHECK(world.step(Real(1) / Real(60)).healthy());
        extension = std::max(extension, net_extension(world, cloth));
        energy = std::max(energy, world.measure().energy.total());
      }
      CHECK(extension < c.most);
      CHECK(energy < (c.corners_only ? 1.01 : 1.001) * first);
      for (const BodyId body : bodies) CHECK(world.pose(body).position.y > 1.2);
    }
  }

  TEST_CASE("a ball that a free cloth catches keeps the momentum of both, with and without friction") {
    for (const Real friction : {Real(0), Real(0.5)}) {
      CAPTURE(friction);
      World world = make_world(empty_space());
      ClothDesc cloth = net();
      cloth.pins.clear();
      cloth.contact.friction = friction;
      take(world.add_cloth(cloth));
      take(world.add_body({.kind = BodyKind::kDynamic,
                           .shape = {.kind = ShapeKind::kSphere, .radius = Real(0.1)},
                           .position = {0.2, 1.65, 0.1},
                           .velocity = {Real(1), Real(-3), Real(0.5)},
                           .mass = 2}));
      const Measurement before = world.measure();
      run(world, 30);
      const Measurement after = world.measure();
      CHECK(length(after.momentum - before.momentum) < 2e-4 * length(before.momentum));
      CHECK(after.energy.total() < 1.001 * before.energy.total());
    }
  }

  TEST_CASE("a flag of 0.2 kg keeps its limit of 5 % under masses at one point, and gains no energy") {
    // Easy to shear, it comes to fewer threads that bear the load.
    for (const Real shear : {ClothDesc{}.shear_stiffness, Real(2e3)}) {
      for (const Real mass : {Real(0.1), Real(1), Real(5), Real(50)}) {
        CAPTURE(shear);
        CAPTURE(mass);
        World world = make_world({});
        ClothDesc desc = flag();
        desc.shear_stiffness = shear;
        desc.loads = {{kLoaded, mass}};
        const ClothId cloth = take(world.add_cloth(desc));
        const Extremes extremes = watch(world, cloth, 180);
        CHECK(extremes.extension < (mass < 10 ? 0.055 : 0.065));
        CHECK(extremes.energy_gain < 0.012);
        if (mass < 10) CHECK(extremes.unconverged <= (mass < 5 || shear > 1e3 ? 0 : 10));
      }
    }
  }

  TEST_CASE("it does so under a body that is hooked to the point") {
    for (const Real shear : {ClothDesc{}.shear_stiffness, Real(2e3)}) {
      CAPTURE(shear);
      World world = make_world({});
      ClothDesc desc = flag();
      desc.shear_stiffness = shear;
      const ClothId cloth = take(world.add_cloth(desc));
      hang_box(world, cloth, 5);
      const Extremes extremes = watch(world, cloth, 160);
      CHECK(extremes.extension < (shear > 1e3 ? 0.06 : 0.13));
      CHECK(extremes.energy_gain < 0.005);
    }
  }

  TEST_CASE("a load on a strip of three columns hangs as far below as springs in series say") {
    // Each column has 10 links of 2000 N/m and bears 2 kg.
    World world = make_world(without_air());
    ClothDesc strip;
    strip.columns = 3;
    strip.rows = 11;
    strip.width = Real(0.1);
    strip.height = Real(0.5);
    strip.corner = {0, 2, 0};
    strip.total_mass = Real(0.001);
    strip.stretch_stiffness = 2000;
    strip.shear_stiffness = 0;
    strip.bend_stiffness = 0;
    strip.damping = 400;
    strip.tethers = false;
    strip.pins = {{0}, {1}, {2}};
    strip.loads = {{30, 2}, {31, 2}, {32, 2}};
    const ClothId cloth = take(world.add_cloth(strip));
    run(world, 300);
    for (const std::uint32_t i : {30U, 31U, 32U})
      CHECK(1.5 - world.positions(cloth)[i].y == doctest::Approx(10 * 2 * kGravity / 2000).epsilon(0.002));
  }

  TEST_CASE("all ways to bend, meshes and gas are solved with a load, too") {
    for (const ClothDesc::Bend bend :
         {ClothDesc::Bend::kNone, ClothDesc::Bend::kSpring, ClothDesc::Bend::kAngle,
          ClothDesc::Bend::kIsometric, ClothDesc::Bend::kYarn}) {
      CAPTURE(static_cast<int>(bend));
      World world = make_world({});
      ClothDesc desc = flag();
      desc.bend = bend;
      desc.loads = {{kLoaded, 5}};
      const ClothId cloth = take(world.add_cloth(desc));
      const Extremes extremes = watch(world, cloth, 60);
      CHECK(extremes.extension < 0.055);
      CHECK(extremes.energy_gain < 0.01);
    }
  }

  TEST_CASE("a free flag with a heavy point that is thrown keeps its momentum and spin") {
    World world = make_world(empty_space());
    ClothDesc cloth = flag();
    cloth.pins.clear();
    cloth.loads = {{kLoaded, 5}};
    cloth.velocity = {1, 2, 3};
    const ClothId id = take(world.add_cloth(cloth));
    take(world.apply_impulse(point(id, kLoaded), Vec3{-3, 8, 5}));
    const Measurement before = world.measure();
    run(world, 120);
    const Measurement after = world.measure();
    CHECK(length(after.momentum - before.momentum) < 2e-5 * length(before.momentum));
    CHECK(length(after.angular_momentum - before.angular_momentum) < 1e-4 * length(before.angular_momentum));
    CHECK(after.energy.total() < 1.001 * before.energy.total());
  }

  TEST_CASE("two loaded flags have the same bits for any workers, and after a restore") {
    check_same_bits({}, [](World& world) {
      ClothDesc desc = flag();
      desc.loads = {{kLoaded, 5}};
      take(world.add_cloth(desc));
      desc.corner.x = 3;
      desc.loads = {{kLoaded - 4, 2}};
      take(world.add_cloth(desc));
    });
  }

  TEST_CASE("a cloth under bodies has the same bits for any workers, and after a restore") {
    check_same_bits({}, [](World& world) {
      take(world.add_cloth(net()));
      drop_on_net(world, 6, ShapeKind::kBox, 1);
      ClothDesc other = net();
      other.corner.x = 2;
      take(world.add_cloth(other));
      take(world.add_body({.kind = BodyKind::kDynamic,
                           .shape = {.kind = ShapeKind::kSphere, .radius = Real(0.1)},
                           .position = {2.8, 1.65, 0},
                           .mass = 4}));
    });
  }

  TEST_CASE("a cloth with too many points to be solved to the end is counted") {
    World world = make_world({});
    ClothDesc desc;
    desc.columns = desc.rows = 90;
    desc.corner = {0, 2, 0};
    desc.total_mass = 1;
    desc.pins = {{0}, {89}};
    desc.loads = {{45 * 90 + 45, 500}};
    take(world.add_cloth(desc));
    std::uint32_t unconverged = 0;
    for (int i = 0; i < 5; ++i) {
      const StepReport report = world.step(Real(1) / Real(60));
      CHECK(report.healthy());
      unconverged += report.cloths_unconverged;
    }
    CHECK(unconverged > 0);
  }

  TEST_CASE("a heavy body that comes too fast to be solved with its cloth is counted, and no slow one is") {
    for (const Real speed : {Real(0), Real(30)}) {
      World world = make_world({});
      take(world.add_cloth(net()));
      take(world.add_body({.kind = BodyKind::kDynamic,
                           .shape = Shape::sphere(Real(0.1)),
                           .position = {0, 1.65, 0},
                           .velocity = {0, -speed, 0},
                           .mass = 4}));
      std::uint32_t left = 0;
      for (int i = 0; i < 30; ++i) left += world.step(Real(1) / Real(60)).cloths_left_to_contacts;
      CAPTURE(speed);
      CHECK((left > 0) == (speed > 0));
    }
  }
}

}  // namespace hooke
