/// Bodies made of glued cells: what they weigh and carry, at what load they break, and what they then keep.

#include "constants.h"
#include "geometry/solids.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hooke {

using namespace test;

namespace {

MeshDesc block(DVec3 half) {
  const SolidMesh solid = make_box(-half, half);
  MeshDesc mesh = {.triangles = solid.triangles};
  for (const DVec3& p : solid.positions) mesh.positions.push_back(vector_cast<Real>(p));
  return mesh;
}

/// A bar along x, cut across into `count` equal pieces.
Fracture sliced_bar(int count, double length, double side) {
  FractureDesc desc;
  for (int i = 0; i < count; ++i) desc.seeds.push_back({((i + 0.5) / count - 0.5) * length, 0, 0});
  return take(fracture(block({0.5 * length, 0.5 * side, 0.5 * side}), desc));
}

BodyDesc sleepless(double density, DVec3 position = {}) {
  return {.kind = BodyKind::kDynamic,
          .position = position,
          .density = static_cast<Real>(density),
          .can_sleep = false};
}

/// Glues all cells that reach up to the top of a block to the world.
std::vector<HookId> hang(World& world, const Fracture& pieces, const FracturedBody& body, DVec3 position,
                         double half_height) {
  std::vector<HookId> held;
  for (std::size_t i = 0; i < pieces.cells.size(); ++i) {
    double top = -1e9;
    for (const Vec3& p : pieces.cells[i].mesh.positions)
      top = std::max(top, d(p.y) + pieces.cells[i].center.y);
    if (top < half_height - 1e-5) continue;
    const DVec3 center = pieces.cells[i].center;
    held.push_back(take(world.add_hook({.kind = HookKind::kFixed,
                                        .b = {.body = body.bodies[i]},
                                        .anchor = position + DVec3{center.x, half_height, center.z}})));
  }
  return held;
}

double kinetic(const World& world) {
  return world.measure().energy.kinetic;
}

/// A pane of cells that a ball flies at.
struct ShotPane {
  World world;
  FracturedBody pane;
  BodyId ball;
};

ShotPane shoot(const WorldDesc& desc, double strength) {
  ShotPane made = {make_world(desc), {}, {}};
  const Fracture pieces =
      take(fracture(block({0.5, 0.4, 0.02}), {.cells = 24, .seed = 3, .impact = DVec3{0.05, 0, 0}}));
  made.pane = take(add_fractured(made.world, pieces, sleepless(2500), static_cast<Real>(strength)));
  made.ball = take(made.world.add_body({.kind = BodyKind::kDynamic,
                                        .shape = Shape::sphere(Real(0.08)),
                                        .position = {0.05, 0, -0.3},
                                        .velocity = {0, 0, 12},
                                        .mass = 5,
                                        .bullet = true}));
  return made;
}

std::string where_of(const Result<FracturedBody>& result) {
  return result ? std::string() : result.error().where;
}

}  // namespace

TEST_SUITE("world/fractured_bodies") {
  TEST_CASE("the masses of all cells sum to that of the whole within the rounding of a cell") {
    for (const int count : {1, 9, 80}) {
      const Fracture pieces = take(fracture(block({0.5, 0.3, 0.7}), {.cells = count}));
      for (const bool given : {false, true}) {
        World world = make_world();
        BodyDesc whole = sleepless(777);
        if (given) whole.mass = Real(123.456);
        const FracturedBody body = take(add_fractured(world, pieces, whole, kRigid));
        REQUIRE(body.bodies.size() == pieces.cells.size());
        REQUIRE(body.hooks.size() == pieces.bonds.size());
        double sum = 0;
        for (const BodyId id : body.bodies) sum += d(world.mass(id));
        const double wanted = given ? d(Real(123.456)) : 777 * 0.84;
        const double ulp = wanted * d(std::numeric_limits<Real>::epsilon());
        CHECK(std::abs(sum - wanted) <= std::max(ulp, 777 * 1e-7));
      }
    }
  }

  TEST_CASE("cells stand where the whole is and move as it does") {
    World world = make_world(empty_space());
    const Fracture pieces = take(fracture(block({0.5, 0.2, 0.3}), {.cells = 12}));
    BodyDesc whole = sleepless(1000, {3, 4, 5});
    whole.rotation = quaternion_about(Vec3{0, 0, 1}, Real(0.5) * Real(kPi));
    whole.velocity = {1, 2, 3};
    whole.angular_velocity = {0, 0, 2};
    const FracturedBody body = take(add_fractured(world, pieces, whole, kRigid));
    for (std::size_t i = 0; i < body.bodies.size(); ++i) {
      const DVec3 c = pieces.cells[i].center;
      CHECK(length(world.center_of_mass(body.bodies[i]) - DVec3{3 - c.y, 4 + c.x, 5 + c.z}) < 1e-5);
      const DVec3 v = vector_cast<double>(world.velocity(body.bodies[i]));
      CHECK(length(v - DVec3{1 - 2 * c.x, 2 - 2 * c.y, 3}) < 1e-5);
    }
    CHECK(world.measure().momentum.y == doctest::Approx(2 * 1000 * 0.24).epsilon(1e-5));
  }

  TEST_CASE("a hanging block of glued cells carries its weight, at its top and in each section") {
    for (const int count : {1, 6, 40}) {
      World world = make_world(without_air());
      const DVec3 position = {0, 5, 0};
      const Fracture pieces = take(fracture(block({0.5, 0.5, 0.5}), {.cells = count, .seed = 3}));
      const FracturedBody body = take(add_fractured(world, pieces, sleepless(2000, position), kRigid));
      const std::vector<HookId> held = hang(world, pieces, body, position, 0.5);
      run(world, 120);
      double weight = 0;
      for (const HookId hook : held) weight += d(world.hook_force(hook).force.y);
      CHECK(weight == doctest::Approx(2000 * kGravity).epsilon(1e-3));
      // What hangs on a cell at the top itself is below the section.
      const auto is_up = [&](std::size_t i) {
        return std::any_of(pieces.cells[i].mesh.positions.begin(), pieces.cells[i].mesh.positions.end(),
                           [&](const Vec3& p) { return d(p.y) + pieces.cells[i].center.y > 0.5 - 1e-5; });
      };
      double below = 0;
      double section = 0;
      for (std::size_t i = 0; i < pieces.cells.size(); ++i) {
        if (!is_up(i)) below += d(world.mass(body.bodies[i])) * kGravity;
      }
      for (std::size_t k = 0; k < pieces.bonds.size(); ++k) {
        const bool a_is_up = is_up(pieces.bonds[k].a);
        const bool b_is_up = is_up(pieces.bonds[k].b);
        const double force = d(world.hook_force(body.hooks[k]).force.y);  // on b
        if (a_is_up != b_is_up) section += a_is_up ? force : -force;
      }
      if (count > 1) CHECK(section == doctest::Approx(below).epsilon(1e-3));
    }
  }

  TEST_CASE("a stretched bar breaks at strength times area") {
    const double strength = 1e6;
    const double side = 0.2;
    World world = make_world(sleepless_space(8));
    const Fracture pieces = sliced_bar(10, 2, side);
    const FracturedBody body =
        take(add_fractured(world, pieces, sleepless(1000), static_cast<Real>(strength)));
    const double limit = strength * side * side;
    double load = 0;
    while (world.events().breaks.empty() && load < 2 * limit) {
      load += 0.002 * limit;
      REQUIRE(world.apply_force(body.bodies.front(), {static_cast<Real>(-load), 0, 0}).has_value());
      REQUIRE(world.apply_force(body.bodies.back(), {static_cast<Real>(load), 0, 0}).has_value());
      run(world, 1);
    }
    // The first and the last cell take a tenth of the load for themselves only if the bar accelerates.
    CHECK(load == doctest::Approx(limit).epsilon(0.01));
  }

  TEST_CASE("a bar on two supports breaks under a load in its middle as beam theory says") {
    for (const int count : {4, 10}) {
      const double strength = 1e6;
      const double side = 0.2;
      const double span = 2;
      World world = make_world(sleepless_space(8));
      const Fracture pieces = sliced_bar(count, span, side);
      const FracturedBody body =
          take(add_fractured(world, pieces, sleepless(1000), static_cast<Real>(strength)));
      take(world.add_hook({.kind = HookKind::kHinge,
                           .b = {.body = body.bodies.front()},
                           .anchor = {-0.5 * span, 0, 0},
                           .axis = {0, 0, 1}}));
      HookDesc roller = {.kind = HookKind::kSixDegrees,
                         .b = {.body = body.bodies.back()},
                         .anchor = {0.5 * span, 0, 0},
                         .axis = {1, 0, 0},
                         .second_axis = Vec3{0, 1, 0}};
      roller.freedoms[1].locked = true;
      take(world.add_hook(roller));
      const double limit = 4 * strength * side * side * side / 6 / span;  // P L / 4 = sigma W
      const BodyId middle = body.bodies[static_cast<std::size_t>(count) / 2];
      double load = 0;
      while (world.events().breaks.empty() && load < 2 * limit) {
        load += 0.002 * limit;
        REQUIRE(world.apply_force(middle, {0, static_cast<Real>(-load), 0}, {0, 0.5 * side, 0}).has_value());
        run(world, 1);
      }
      CHECK(load == doctest::Approx(limit).epsilon(0.01));
      REQUIRE(world.events().breaks.size() == 1);
      CHECK(world.events().breaks[0].hook == body.hooks[static_cast<std::size_t>(count) / 2 - 1]);
    }
  }

  TEST_CASE("momentum is kept across all breaks of a pane that is shot through, and no energy is gained") {
    for (const int substeps : {4, 8}) {
      ShotPane shot = shoot(sleepless_space(substeps), 2e5);
      const double before = kinetic(shot.world);
      std::size_t broken = 0;
      for (int i = 0; i < 60; ++i) {
        run(shot.world, 1);
        broken += shot.world.events().breaks.size();
        CHECK(kinetic(shot.world) <= before * 1.001);
        const DVec3 momentum = shot.world.measure().momentum;
        CHECK(length(momentum - DVec3{0, 0, 60}) < 60 * 1e-6);
      }
      CHECK(broken > 5);
      CHECK(d(shot.world.velocity(shot.ball).z) > 1);
    }
  }

  TEST_CASE("a strong pane holds what breaks a weak one") {
    ShotPane shot = shoot(sleepless_space(8), 1e12);
    run(shot.world, 60);
    for (const HookId hook : shot.pane.hooks) CHECK(d(shot.world.hook_gap(hook)) < 0.01);
    CHECK(shot.world.events().breaks.empty());
    CHECK(d(shot.world.velocity(shot.ball).z) < 5);
  }

  TEST_CASE("breaks have the same bits for any workers, and after a restore in their middle") {
    std::uint64_t first = 0;
    for (const int workers : {1, 2, 4}) {
      ShotPane shot = shoot(sleepless_space(8, workers), 2e5);
      std::size_t broken = 0;
      while (broken == 0) {
        run(shot.world, 1);
        broken += shot.world.events().breaks.size();
      }
      const Snapshot middle = shot.world.snapshot();
      run(shot.world, 30);
      const std::uint64_t hash = shot.world.state_hash();
      REQUIRE(shot.world.restore(middle).has_value());
      run(shot.world, 30);
      CHECK(shot.world.state_hash() == hash);
      if (workers == 1) first = hash;
      CHECK(hash == first);
    }
  }

  TEST_CASE("connection points go to the cell in which they lie") {
    World world = make_world(empty_space());
    const Fracture pieces = sliced_bar(4, 2, 0.2);
    BodyDesc whole = sleepless(1000, {0, 1, 0});
    whole.connection_points = {{.name = "eye", .position = {0.75, 0.05, 0}}};
    const FracturedBody body = take(add_fractured(world, pieces, whole, kRigid));
    CHECK(cell_at(pieces, {0.75, 0.05, 0}) == 3);
    CHECK(cell_at(pieces, {-9, 0, 0}) == 0);
    const DVec3 place = take(world.find_place({.body = body.bodies[3], .connection_point = "eye"}));
    CHECK(length(place - DVec3{0.75, 1.05, 0}) < 1e-6);
    CHECK_FALSE(world.find_place({.body = body.bodies[2], .connection_point = "eye"}).has_value());
  }

  TEST_CASE("what cannot be added is refused, and leaves nothing behind") {
    World world = make_world();
    const Fracture pieces = sliced_bar(3, 2, 0.2);
    constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
    for (const Real strength : {Real(0), Real(-1), kNan})
      CHECK(where_of(add_fractured(world, pieces, sleepless(1000), strength)) == "strength");
    CHECK(where_of(add_fractured(world, pieces, {}, Real(1))) == "body.kind");
    CHECK(where_of(add_fractured(world, pieces, sleepless(-1, {0, 1, 0}), Real(1))) == "fracture.cells[0]");
    Fracture thin = pieces;
    for (Vec3& p : thin.cells[2].mesh.positions) p.x = 0;
    CHECK(where_of(add_fractured(world, thin, sleepless(1000, {0, 1, 0}), Real(1))) == "fracture.cells[2]");
    Fracture wrong = pieces;
    wrong.bonds[1].area = 0;
    CHECK(where_of(add_fractured(world, wrong, sleepless(1000, {0, 1, 0}), Real(1))) == "fracture.bonds[1]");
    CHECK(world.measure().energy.potential == 0);  // There is nothing that could fall.
    run(world, 1);
    CHECK(world.measure().momentum == DVec3{});
  }
}

}  // namespace hooke
