#include "scenes/scene_audit.h"
#include "scenes/scene_builder.h"
#include "scenes/scene_changes.h"

#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <string>
#include <vector>

/// Scenes in which what is solved in one way meets what is solved in another: contacts, hooks, ropes, cloths
/// and jellies with masses up to a thousand times apart. Each must hold however it is turned, in a mirror,
/// and whatever is added first. The goal is always the same: gaps, overlaps and sinking of less than 0.1 % of
/// the size, and no energy from nothing (kGoal). Where it is missed, the bound is a fifth above the worst of
/// today's four runs, and the goal stands beside it.

namespace hooke {

using namespace test;

namespace {

constexpr double kGoal = 1e-3;  ///< Of the size; of the energy at the start.

/// What a figure may come to.
struct Bound {
  Figure figure = Figure::kCount;
  double value = kGoal;
};

/// A body that is to stay at its height [m].
struct Watched {
  std::string name = {};
  double sink = kGoal;
};

/// The goals, or what is known to be missed. How deep bodies are in each other while they fall has none.
std::vector<Bound> with_goals(const std::vector<Bound>& known) {
  std::vector<Bound> bounds = {
      {Figure::kEnergy},       {Figure::kRestGap},
      {Figure::kRestOverlap},  {Figure::kPointOverlap},
      {Figure::kRopeStretch},  {Figure::kClothStretch, 0.01},
      {Figure::kUnhealthy, 0}, {Figure::kOverlap, std::numeric_limits<double>::infinity()}};
  for (Bound& bound : bounds) {
    for (const Bound& own : known) bound = bound.figure == own.figure ? own : bound;
  }
  return bounds;
}

void check_audit(const Audit& audit, const std::vector<Bound>& known) {
  for (const Bound& bound : with_goals(known)) {
    const std::string name = name_of(bound.figure);
    CAPTURE(name);
    CHECK(audit.of(bound.figure).value <= bound.value);
  }
}

double height_of(const Scene& scene, const std::string& name) {
  for (const SceneBody& body : scene.objects.bodies) {
    if (body.tag.name == name) return body.desc.position.y;
  }
  FAIL("no body of this name");
  return 0;
}

/// Checks four runs: upright, turned as a whole, in a mirror, and with its objects in another order.
void check_each_way(const Scene& scene, const Watched& watched = {}, const std::vector<Bound>& known = {}) {
  const Placement turned = {.rotation = normalize(Quaternion<double>{0.31, -0.52, 0.71, 0.43}),
                            .position = {3.1, -2.3, 5.7}};
  const std::array audits = {run_audit(scene), run_audit(scene, turned), run_audit(mirrored(scene)),
                             run_audit(reordered(scene))};
  const std::array<std::string, 4> ways = {"upright", "turned", "mirrored", "reordered"};
  for (std::size_t i = 0; i < audits.size(); ++i) {
    CAPTURE(ways[i]);
    check_audit(audits[i], known);
    if (watched.name.empty()) continue;
    CHECK(std::abs(audits[i].ends.at(watched.name).y - height_of(scene, watched.name)) <= watched.sink);
  }
}

SceneBuilder with_floor(double seconds = 3) {
  SceneBuilder builder;
  builder.scene.seconds = seconds;
  builder.scene.world.sleeping = false;
  (void)builder.box({20, 0.5, 20}, {0, -0.5, 0}, 0);
  return builder;
}

/// Cubes of 1 m and a ton on each other under one of a hundred tons, which is the last body.
std::vector<std::string> add_tower(SceneBuilder& builder) {
  std::vector<std::string> cubes;
  for (int i = 0; i <= 10; ++i)
    cubes.push_back(builder.box({0.5, 0.5, 0.5}, {0, 0.5 + i, 0}, i == 10 ? 1e5 : 1e3));
  return cubes;
}

/// A top on four legs of 1 kg and 1 m that are glued to it, their feet at the height `floor`.
std::string add_table(SceneBuilder& builder, double floor, double mass) {
  const std::string top = builder.box({0.5, 0.05, 0.5}, {0, floor + 1.05, 0}, mass);
  constexpr std::array kPlaces = {DVec3{-0.41, 0, -0.43}, DVec3{-0.37, 0, 0.42}, DVec3{0.43, 0, -0.36},
                                  DVec3{0.38, 0, 0.41}};
  for (const DVec3& place : kPlaces) {
    const std::string leg = builder.box({0.05, 0.5, 0.05}, place + DVec3{0, floor + 0.5, 0}, 1);
    builder.hook(HookKind::kFixed, top, leg, place + DVec3{0, floor + 1, 0});
  }
  return top;
}

Scene make_pyramid(int rows, double mass, double top) {
  SceneBuilder builder = with_floor();
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i)
      (void)builder.box({0.5, 0.5, 0.5}, {i - 0.5 * (rows - row - 1), 0.5 + row, 0}, mass);
  }
  (void)builder.box({0.5, 0.5, 0.5}, {0, 0.5 + rows, 0}, top);
  return builder.scene;
}

/// A rope over a wheel on an axle, with a load on each side.
Scene make_pulley(double wheel, double load) {
  SceneBuilder builder = with_floor();
  const DVec3 axle = {0, 3, 0};
  const double way = 0.311;  // Of the rope's middle from the axle [m].
  builder.hook(HookKind::kHinge, "", builder.roller(0.3, 0.05, axle, wheel), axle).desc.axis = {0, 0, 1};
  std::vector<DVec3> points = line({-way, 1.5, 0}, {-way, 2.95, 0}, 30);
  for (int i = 0; i <= 48; ++i) {
    const double t = i / 24.0 - 1;  // Tangent of half the angle from the top.
    points.push_back(axle + (way / (1 + t * t)) * DVec3{2 * t, 1 - t * t, 0});
  }
  for (const DVec3& place : line({way, 2.95, 0}, {way, 1.5, 0}, 30)) points.push_back(place);
  const std::string rope = builder.rope(points, 0.5);
  for (const double side : {-1.0, 1.0})
    builder.tie(builder.box({0.15, 0.15, 0.15}, {side * way, 1.35, 0}, load), rope,
                side < 0 ? 0 : points.size() - 1);
  return builder.scene;
}

/// A table on four thin legs, a cloth on it, and a crate on that.
Scene make_covered_table(double crate) {
  SceneBuilder builder = with_floor(2);
  (void)add_table(builder, 0, 10);
  builder.cloth({0, 1.106, 0}, 1, 13);
  (void)builder.box({0.2, 0.2, 0.2}, {0, 1.312, 0}, crate);
  return builder.scene;
}

/// Limbs of 5 kg in a row on the ground, joined by balls that rub, and a slab on them.
Scene make_loaded_ragdoll(double slab) {
  SceneBuilder builder = with_floor();
  std::string before;
  for (int i = 0; i < 6; ++i) {
    const DVec3 place = {0.4 * (i - 2.5), 0.1, 0};
    SceneBody& limb = builder.body(Shape::capsule(Real(0.1), Real(0.1)), place, 5);
    limb.desc.rotation = quarter_turn({0, 0, 1});
    const std::string name = limb.tag.name;
    if (i > 0)
      builder.hook(HookKind::kBall, before, name, place - DVec3{0.2, 0, 0}).desc.motor.max_force = Real(2);
    before = name;
  }
  (void)builder.box({1, 0.1, 0.4}, {0, 0.3, 0}, slab);
  return builder.scene;
}

/// A net of balls of 0.1 kg, held at two edges, and a load hooked to its middle.
Scene make_ball_net(int columns, int rows, double load) {
  SceneBuilder builder;
  builder.scene.seconds = 3;
  builder.scene.world.sleeping = false;
  std::vector<std::string> balls;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const DVec3 place = {0.2 * i, 3, 0.2 * j};
      const std::string ball = builder.sphere(0.04, place, 0.1);
      if (i > 0) builder.hook(HookKind::kBall, balls.back(), ball, place - DVec3{0.1, 0, 0});
      if (j > 0)
        builder.hook(HookKind::kBall, balls[balls.size() - static_cast<std::size_t>(columns)], ball,
                     place - DVec3{0, 0, 0.1});
      if (i == 0 || i + 1 == columns) builder.hook(HookKind::kBall, "", ball, place);
      balls.push_back(ball);
    }
  }
  const DVec3 middle = {0.2 * (columns / 2), 3, 0.2 * (rows / 2)};
  const std::string ball = balls[static_cast<std::size_t>(rows / 2 * columns + columns / 2)];
  const std::string weight = builder.sphere(0.2, middle - DVec3{0, 0.5, 0}, load);
  builder.hook(HookKind::kBall, ball, weight, middle);
  return builder.scene;
}

/// Ropes along and across that sag like a dish, tied at their crossings and pinned at their ends, and a ball
/// that rests in the middle.
Scene make_rope_net(int count, double load) {
  SceneBuilder builder;
  builder.scene.seconds = 1.5;
  const double end = 0.2 * (count + 1);
  const auto place_of = [&](int i, int j) {
    const double x = 0.2 * i / end;
    const double z = 0.2 * j / end;
    return DVec3{0.2 * i, 2 - 16 * 0.1 * end * x * (1 - x) * z * (1 - z), 0.2 * j};
  };
  std::vector<std::string> along;
  for (int k = 1; k <= 2 * count; ++k) {
    std::vector<DVec3> points;
    for (int i = 0; i <= count + 1; ++i)
      points.push_back(k <= count ? place_of(i, k) : place_of(k - count, i));
    const std::string rope = builder.rope(points, 0.1 * count);
    builder.pin_both_ends();
    if (k <= count) along.push_back(rope);
    for (std::size_t j = 0; k > count && j < along.size(); ++j)
      builder.tie(along[j], rope, j + 1).a_point = ScenePoint{.index = static_cast<std::uint32_t>(k - count)};
  }
  (void)builder.sphere(0.3, {0.5 * end, 2.312 - 0.1 * end, 0.5 * end}, load);
  return builder.scene;
}

/// A cube of jelly of 0.4 m with a plate on it. Its plate is the last body.
Scene make_jelly(double young_modulus, double load) {
  SceneBuilder builder = with_floor(4);
  builder.jelly({0, 0.202, 0}, 0.4, 4).desc.young_modulus = static_cast<Real>(young_modulus);
  (void)builder.box({0.3, 0.05, 0.3}, {0, 0.454, 0}, load);
  return builder.scene;
}

/// Two jaws on sliders that hold a box between them in the air.
Scene make_gripper(double jaw, double box) {
  SceneBuilder builder = with_floor(2);
  (void)builder.box({0.1, 0.1, 0.1}, {0, 1, 0}, box);
  for (const double side : {-1.0, 1.0}) {
    const DVec3 place = {0.12 * side, 1, 0};
    SceneHook& hook = builder.hook(HookKind::kSlider, "", builder.box({0.02, 0.1, 0.05}, place, jaw), place);
    hook.desc.axis = {static_cast<Real>(-side), 0, 0};
    hook.desc.motor = {.speed = Real(0.5), .max_force = static_cast<Real>(40 * box)};
  }
  return builder.scene;
}

/// Four boxes of 1 kg under one of 100 kg, and a rope over them with a weight of 10 kg at each end.
Scene make_draped_tower() {
  SceneBuilder builder = with_floor();
  for (int i = 0; i < 5; ++i) (void)builder.box({0.25, 0.25, 0.25}, {0, 0.25 + 0.5 * i, 0}, i == 4 ? 100 : 1);
  std::vector<DVec3> points = line({-0.262, 1.8, 0}, {-0.262, 2.512, 0}, 15);
  for (const DVec3& place : line({-0.21, 2.512, 0}, {0.21, 2.512, 0}, 9)) points.push_back(place);
  for (const DVec3& place : line({0.262, 2.512, 0}, {0.262, 1.8, 0}, 15)) points.push_back(place);
  const std::string rope = builder.rope(points, 0.2);
  for (const double side : {-1.0, 1.0}) {
    const std::string weight = builder.box({0.05, 0.05, 0.05}, {0.315 * side, 1.75, 0}, 10);
    builder.tie(weight, rope, side < 0 ? 0 : points.size() - 1);
  }
  return builder.scene;
}

/// Driven hinges in a row that hold a load out level. The first turns up, the others hold.
Scene make_arm(int links, double link, double load) {
  SceneBuilder builder;
  builder.scene.seconds = 2;
  builder.scene.world.sleeping = false;
  std::string before;
  for (int i = 0; i < links; ++i) {
    const DVec3 anchor = {0.5 * i, 5, 0};
    const std::string name = builder.box({0.24, 0.04, 0.04}, anchor + DVec3{0.25, 0, 0}, link);
    SceneHook& hook = builder.hook(HookKind::kHinge, before, name, anchor);
    hook.desc.axis = {0, 0, 1};
    hook.desc.motor = {.speed = i == 0 ? Real(0.2) : Real(0), .max_force = Real(1e6)};
    before = name;
  }
  const DVec3 end = {0.5 * links, 5, 0};
  builder.hook(HookKind::kFixed, before, builder.box({0.1, 0.1, 0.1}, end + DVec3{0.1, 0, 0}, load), end);
  return builder.scene;
}

/// Two ropes of 4 m with planks of 1 kg between them, and a load that lies on these.
Scene make_bridge(double load, double restitution) {
  SceneBuilder builder = with_floor(2);
  std::vector<std::string> ropes;
  for (const double z : {-0.5, 0.5}) {
    std::vector<DVec3> points;
    for (int i = 0; i <= 40; ++i) {
      const double x = i / 20.0 - 1;
      points.push_back({2 * x, 1 + 0.4 * x * x, z});
    }
    ropes.push_back(builder.rope(points, 2));
    builder.pin_both_ends();
  }
  for (int i = 1; i < 10; ++i) {
    const double x = i / 5.0 - 1;
    const std::string plank = builder.box({0.15, 0.02, 0.45}, {2 * x, 1 + 0.4 * x * x, 0}, 1);
    for (const std::string& rope : ropes) builder.tie(plank, rope, 4 * static_cast<std::size_t>(i));
  }
  builder.scene.materials.push_back({.name = "lively", .restitution = static_cast<Real>(restitution)});
  (void)builder.box({0.25, 0.25, 0.25}, {0, 1.29, 0}, load);
  builder.scene.objects.bodies.back().tag.material = "lively";
  return builder.scene;
}

}  // namespace

TEST_SUITE("world/mixed scenes") {
  TEST_CASE("a knob glued to a tower leaves it standing") {
    SceneBuilder builder = with_floor();
    const std::vector<std::string> tower = add_tower(builder);
    builder.hook(HookKind::kFixed, tower[5], builder.sphere(0.1, {0.6, 5.5, 0}, 1), {0.5, 5.5, 0});
    check_each_way(builder.scene, {tower.back()});
  }

  TEST_CASE("a slack rope tied to a tower leaves it standing") {
    SceneBuilder builder = with_floor();
    const std::vector<std::string> tower = add_tower(builder);
    builder.tie(tower[5], builder.rope(line({0.51, 5.8, 0}, {0.81, 5.8, 0}, 8), 0.2, 0.005), 0);
    check_each_way(builder.scene, {tower.back()});
  }

  TEST_CASE("a lamp that hangs beside a tower leaves it standing") {
    for (const double gap : {0.005, 0.015}) {
      CAPTURE(gap);
      SceneBuilder builder = with_floor();
      const std::vector<std::string> tower = add_tower(builder);
      const DVec3 place = {0.55 + gap, 5.5, 0};
      builder.hook(HookKind::kBall, "", builder.box({0.05, 0.05, 0.05}, place, 1), place + DVec3{0, 1, 0});
      check_each_way(builder.scene, {tower.back()});
    }
  }

  TEST_CASE("a slack rope tied to a crate does not let a heavy block sink into it") {
    SceneBuilder builder = with_floor();
    const std::string crate = builder.box({0.5, 0.5, 0.5}, {0, 0.5, 0}, 100);
    const std::string block = builder.box({0.5, 0.5, 0.5}, {0, 1.5, 0}, 1e4);
    builder.tie(crate, builder.rope(line({0.51, 0.8, 0}, {0.81, 0.8, 0}, 8), 0.2, 0.005), 0);
    check_each_way(builder.scene, {block});
  }

  TEST_CASE("a pyramid of ten rows stands under a thousand times the mass of a cube") {
    const Scene scene = make_pyramid(10, 1e3, 1e6);
    check_each_way(scene, {scene.objects.bodies.back().tag.name});
  }

  TEST_CASE("the axle of a light pulley holds a ton on each side") {
    for (const double wheel : {4.0, 0.5}) {
      CAPTURE(wheel);
      check_each_way(make_pulley(wheel, 1e3), {},  // goal: kGoal, in both
                     {{Figure::kEnergy, 0.0085}, {Figure::kRopeStretch, 0.047}});
    }
  }

  TEST_CASE("a cloth between a table with thin legs and a crate is neither stretched nor pressed through") {
    check_each_way(make_covered_table(500));
  }

  TEST_CASE("a table on thin legs stands on bumps, and a foot that slips makes no energy") {
    SceneBuilder builder;
    builder.scene.seconds = 3;
    builder.scene.world.sleeping = false;
    builder.ground({1.2, 0, 1.2}, 13, [](std::uint32_t i, std::uint32_t j) { return 0.02 * ((i + j) % 2); });
    const std::string top = add_table(builder, 0.02, 1e4);
    check_each_way(builder.scene, {top, 0.021});
  }

  TEST_CASE("a table of ten tons on thin legs stands on a loose board") {
    SceneBuilder builder = with_floor();
    (void)builder.box({0.8, 0.05, 0.8}, {0, 0.05, 0}, 50);
    const std::string top = add_table(builder, 0.1, 1e4);
    check_each_way(builder.scene, {top});
  }

  TEST_CASE("limbs whose joints rub carry a slab") {
    for (const double slab : {600.0, 6000.0}) {
      CAPTURE(slab);
      const Scene scene = make_loaded_ragdoll(slab);
      check_each_way(scene, {scene.objects.bodies.back().tag.name});
    }
  }

  TEST_CASE("a small net of balls carries a thousand times the mass of one") {
    check_each_way(make_ball_net(9, 8, 100), {}, {{Figure::kEnergy, 0.0047}});  // goal: kGoal
  }

  TEST_CASE("a large net of balls carries a thousand times the mass of one") {
    check_each_way(make_ball_net(25, 25, 100), {},  // goal: kGoal
                   {{Figure::kEnergy, 0.01}});
  }

  TEST_CASE("a net of ropes carries a ball") {
    check_each_way(make_rope_net(5, 100));
  }

  // With 64 substeps of 4 each it sags by 20.9 mm, and so it does within 3 % with 8 of 4.
  TEST_CASE("a jelly sags under a ton as far as one that is solved to the end") {
    const Scene scene = make_jelly(1e6, 1000);
    check_each_way(scene, {scene.objects.bodies.back().tag.name, 0.023});
    Scene finer = scene;
    finer.world.particle_substeps = 4;
    const Audit audit = run_audit(finer);
    CHECK(audit.of(Figure::kEnergy).value < 0.1);
    CHECK(0.454 - audit.ends.at("body_1").y == doctest::Approx(0.0209).epsilon(0.1));
  }

  TEST_CASE("a jelly under a ton gains no energy where there is no friction") {
    Scene scene = make_jelly(1e6, 1000);
    scene.seconds = 1.5;
    for (SceneBody& body : scene.objects.bodies) body.tag.friction = Real(0);
    check_each_way(scene);
  }

  // A load of 10 kg is lighter than the lowest layer of points.
  TEST_CASE("jelly as stiff as rubber, wood or steel carries loads and gains no energy") {
    for (const double young_modulus : {1e7, 1e9, 1e11}) {
      for (const double load : {10.0, 1e3, 1e4}) {
        for (const double friction : {0.0, 0.5, 10.0}) {
          CAPTURE(young_modulus);
          CAPTURE(load);
          CAPTURE(friction);
          Scene scene = make_jelly(young_modulus, load);
          scene.seconds = 1;
          scene.objects.bodies.back().desc.position.y += 0.1;
          for (SceneBody& body : scene.objects.bodies) body.tag.friction = static_cast<Real>(friction);
          check_audit(run_audit(scene), {{Figure::kEnergy, kGoal}});
        }
      }
    }
  }

  TEST_CASE("jelly as stiff as rubber, wood or steel falls and lies still") {
    for (const double young_modulus : {1e7, 1e9, 2e11}) {
      CAPTURE(young_modulus);
      SceneBuilder builder = with_floor(1.5);
      builder.jelly({0, 0.7, 0}, 0.4, 4).desc.young_modulus = static_cast<Real>(young_modulus);
      check_each_way(builder.scene);
    }
  }

  // Contacts that stop light points after the stress is found had let 100 MPa gain ten times all energy.
  TEST_CASE("stiff jellies that fall on each other and tip over gain no energy") {
    for (const double young_modulus : {1e6, 1e8, 1e10}) {
      CAPTURE(young_modulus);
      const auto check_pile = [&](int count, double drop, double turn, double offset) {
        CAPTURE(count);
        SceneBuilder builder = with_floor(1);
        for (int i = 0; i < count; ++i) {
          SceneSolid& jelly = builder.jelly({offset * i, 0.202 + drop + (0.4 + drop) * i, 0}, 0.4, 4);
          jelly.desc.young_modulus = static_cast<Real>(young_modulus);
          jelly.desc.rotation =
              quaternion_about(Vec3{Real(0), Real(1), Real(0)}, static_cast<Real>(turn * i));
        }
        check_audit(run_audit(builder.scene), {{Figure::kEnergy, kGoal}});
      };
      check_pile(2, 0.02, 0, 0);
      check_pile(4, 0.05, 0.35, 0);
      check_pile(2, 0.3, 0.5, 0.15);
    }
  }

  // Points that stress moved as if no hook held them had been drawn back as light ones: 50 kg gained 17 times
  // the energy of the scene at 100 MPa, and 5 t fifty thousand times at 10 GPa.
  TEST_CASE("stiff jelly that hangs on hooks and carries a load gains no energy") {
    for (const double young_modulus : {1e6, 1e8, 1e10}) {
      for (const double load : {50.0, 5e3}) {
        for (const bool one : {true, false}) {
          CAPTURE(young_modulus);
          CAPTURE(load);
          CAPTURE(one);
          SceneBuilder builder;
          builder.scene.seconds = 1;
          builder.jelly({0, 1, 0}, 0.4, 4).desc.young_modulus = static_cast<Real>(young_modulus);
          const std::string box = builder.box({0.1, 0.1, 0.1}, {0, 0.68, 0}, load);
          const auto hang = [&](const std::string& from, DVec3 place) {
            if (one && (place.x != 0 || place.z != 0)) return;
            builder.hook(HookKind::kBall, from, "jelly_0", place);
          };
          for (const double x : {-0.2, 0.0, 0.2}) {
            for (const double z : {-0.2, 0.0, 0.2}) hang("", {x, 1.2, z});
          }
          for (const double x : {-0.1, 0.0, 0.1}) hang(box, {x, 0.8, 0});
          const Audit audit = run_audit(builder.scene);
          check_audit(audit, {{Figure::kEnergy, kGoal}, {Figure::kGap, 0.001}});
        }
      }
    }
  }

  TEST_CASE("jaws hold a heavy box in the air") {
    const Scene scene = make_gripper(0.1, 50);
    check_each_way(scene, {scene.objects.bodies[1].tag.name, 2e-4});
  }

  TEST_CASE("a rope with two weights over a tower leaves it standing") {
    check_each_way(make_draped_tower(), {"body_5"});
  }

  TEST_CASE("an arm of eight motors holds a ton") {
    check_each_way(make_arm(8, 0.5, 1000), {},  // goal: kGoal, in both
                   {{Figure::kEnergy, 0.78}, {Figure::kRestGap, 150}});
  }

  TEST_CASE("an arm of four motors holds a ton") {
    check_each_way(make_arm(4, 2, 1000));
  }

  TEST_CASE("a bridge of ropes and planks carries a load of thirty times the mass of a plank") {
    check_each_way(make_bridge(30, 0));
  }

  // The planks hang at one point of each rope and may tip. The load slides and rolls on them.
  TEST_CASE("a bridge of ropes and planks gains no energy from a load, with or without restitution") {
    check_each_way(make_bridge(30, 0.01));
    check_each_way(make_bridge(100, 0));
  }

  TEST_CASE("long: a bridge of ropes and planks gains no energy from a heavy load" * doctest::skip()) {
    check_each_way(make_bridge(300, 0.01));
    check_each_way(make_bridge(1000, 0));
  }

  // Soft contacts would let a body sink as on a spring of the lighter mass: by 82 % of a cube in the last of
  // these. At rest, ten times the mass of a cube sinks in by 0.2 %: below 0.5 % contacts stay soft.
  TEST_CASE("a heavy body that falls on lighter ones does not sink into them") {
    for (const double mass : {10.0, 1000.0}) {
      for (const int cubes : {1, 3}) {
        SceneBuilder builder = with_floor(2);
        for (int i = 0; i < cubes; ++i) (void)builder.box({0.2, 0.2, 0.2}, {0, 0.2 + 0.4 * i, 0}, 1);
        (void)builder.box({0.25, 0.25, 0.25}, {0.01, 0.4 * cubes + 1, 0.02}, mass);
        check_each_way(builder.scene, {}, {{Figure::kOverlap, 0.005}, {Figure::kRestOverlap, 0.005}});
      }
    }
  }

  TEST_CASE("a heavy ball that falls on a light rope gets no energy from it") {
    SceneBuilder builder;
    builder.scene.seconds = 2;
    (void)builder.rope(line({-1, 1, 0}, {1, 1, 0}, 9), 0.03, 0.01);
    builder.pin_both_ends();
    (void)builder.sphere(0.35, {0, 2.38, 0}, 100);
    check_each_way(builder.scene, {},  // goal: kGoal, in both
                   {{Figure::kEnergy, 0.002}, {Figure::kRopeStretch, 0.01}});
  }

  TEST_CASE("a crate that falls on a rope on the ground gets no energy from it") {
    SceneBuilder builder = with_floor();
    (void)builder.rope(line({-1, 0.01, 0}, {1, 0.01, 0.1}, 21), 0.5);
    (void)builder.box({0.3, 0.3, 0.3}, {0, 0.4, 0}, 100);
    check_each_way(builder.scene, {}, {{Figure::kEnergy, 0.0018}});  // goal: kGoal
  }
}

}  // namespace hooke
