/// Bodies that become soft where they are hit hard, dent, and become rigid again (BodyDesc::yields).

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Real kFrame = Real(1) / Real(60);
constexpr YieldsDesc kTin = {.impulse = 20,
                             .cell = Real(0.1),
                             .young_modulus = Real(3e6),
                             .damping = Real(0.02),
                             .yield_stress = Real(3e4),
                             .freeze_after = Real(0.2)};

/// A plate of 0.6 x 0.6 x 0.06 m and 12 kg, across z.
BodyDesc plate(const YieldsDesc& yields = kTin) {
  return {.kind = BodyKind::kDynamic,
          .shape = Shape::box({Real(0.3), Real(0.3), Real(0.03)}),
          .mass = Real(12),
          .yields = yields};
}

/// A ball of 6 kg that flies along z and meets the plate off its middle.
BodyDesc ball(Real speed, Real mass = 6) {
  return {.kind = BodyKind::kDynamic,
          .shape = Shape::sphere(Real(0.08)),
          .position = {0.12, 0.05, -0.5},
          .velocity = {0, 0, speed},
          .mass = mass};
}

/// What the solution of stiff solids that are hit errs by, of all momentum, whether they were bodies or not.
constexpr double kSolidsErr = 2e-4;

struct Scene {
  World world;
  BodyId plate;
  BodyId ball;
};

Scene make_scene(Real speed, const YieldsDesc& yields = kTin, int substeps = 8, int workers = 1) {
  World world = make_world(sleepless_space(substeps, workers));
  const BodyId hit = take(world.add_body(plate(yields)));
  const BodyId hits = take(world.add_body(ball(speed)));
  return {std::move(world), hit, hits};
}

/// Steps until the body is soft, or rigid again; returns whether that came within two seconds.
bool run_until(World& world, BodyId body, bool soft) {
  for (int i = 0; i < 120; ++i) {
    if ((world.soft_form(body) != SolidId{}) == soft) return true;
    REQUIRE(world.step(kFrame).healthy());
  }
  return false;
}

double relative(DVec3 change, DVec3 whole) {
  return length(change) / length(whole);
}

/// How far the vertices of a surface are out of the plane z = 0 of a body's frame, at most [m].
double bulge(const World& world, BodyId body) {
  const Pose pose = world.pose(body);
  const Quaternion<double> back = conjugate(
      Quaternion<double>{d(pose.rotation.x), d(pose.rotation.y), d(pose.rotation.z), d(pose.rotation.w)});
  double most = 0;
  for (const DVec3& p : world.surface(body))
    most = std::max(most, std::abs(rotate(back, p - pose.position).z));
  return most;
}

}  // namespace

TEST_SUITE("world/yielding") {
  TEST_CASE("a plate that is hit dents for good, and mass, momentum and spin stay") {
    for (const int substeps : {4, 8, 32}) {
      CAPTURE(substeps);
      Scene s = make_scene(10, kTin, substeps);
      const Measurement before = s.world.measure();
      const double bulge_before = bulge(s.world, s.plate);
      double most_energy = before.energy.total();
      double worst = 0;
      std::vector<YieldEvent> yields;
      std::vector<FreezeEvent> freezes;
      for (int i = 0; i < 150; ++i) {
        REQUIRE(s.world.step(kFrame).healthy());
        const Events& events = s.world.events();
        yields.insert(yields.end(), events.yields.begin(), events.yields.end());
        freezes.insert(freezes.end(), events.freezes.begin(), events.freezes.end());
        const Measurement now = s.world.measure();
        most_energy = std::max(most_energy, now.energy.total());
        worst = std::max({worst, relative(now.momentum - before.momentum, before.momentum),
                          relative(now.angular_momentum - before.angular_momentum, before.angular_momentum)});
        CHECK(s.world.mass(s.plate) == Real(12));
      }
      CHECK(worst < kSolidsErr);
      REQUIRE(yields.size() == 1);
      REQUIRE(freezes.size() == 1);
      CHECK(yields[0].body == s.plate);
      CHECK(yields[0].impulse > 20);
      CHECK(std::abs(yields[0].place.x - 0.12) < 0.1);
      CHECK(std::abs(yields[0].place.z + 0.03) < 0.05);
      CHECK(freezes[0].body == s.plate);
      CHECK(freezes[0].solid == yields[0].solid);
      CHECK(freezes[0].time - yields[0].time < 2);
      CHECK(most_energy < before.energy.total() * (1 + 1e-5));
      CHECK(s.world.soft_form(s.plate) == SolidId{});
      CHECK(s.world.is_reshaped(s.plate));
      CHECK(bulge_before == doctest::Approx(0.03));
      CHECK(bulge(s.world, s.plate) > 0.045);
    }
  }

  TEST_CASE("a solid has the mass, the momentum and the spin of the body to rounding") {
    for (const Shape& shape : {Shape::box({Real(0.3), Real(0.2), Real(0.05)}), Shape::sphere(Real(0.2)),
                               Shape::cylinder(Real(0.2), Real(0.3)), Shape::cone(Real(0.2), Real(0.3)),
                               Shape::capsule(Real(0.1), Real(0.2))}) {
      CAPTURE(static_cast<int>(shape.kind));
      World world = make_world(sleepless_space(8));
      BodyDesc desc = plate({.impulse = Real(1e-3), .cell = Real(0.08), .young_modulus = Real(1e4)});
      desc.shape = shape;
      desc.mass = Real(7.3);
      desc.position = {3.4, 20.7, -8.1};
      desc.velocity = {3, -1, 2};
      desc.angular_velocity = {2, 1, -3};
      const BodyId body = take(world.add_body(desc));
      const Measurement before = world.measure();
      const DVec3 center = world.center_of_mass(body);
      // The solid is so soft that it is not solved as a whole, which would err more.
      BodyDesc mote = ball(0, Real(1e-2));
      mote.shape = Shape::sphere(Real(0.01));
      mote.position = center + DVec3{1.2, 0, 0};
      mote.velocity = {-50, -1, 2};
      const BodyId hits = take(world.add_body(mote));
      const Measurement with_mote = world.measure();
      for (int i = 0; i < 1000 && world.soft_form(body) == SolidId{}; ++i)
        REQUIRE(world.step(Real(1e-4)).healthy());  // In so short a step the blow itself moves little.
      REQUIRE(world.soft_form(body) != SolidId{});
      CHECK(world.mass(body) == Real(7.3));
      CHECK(world.mass(world.soft_form(body)) == doctest::Approx(7.3).epsilon(1.3e-7));
      const Measurement after = world.measure();
      CHECK(relative(after.momentum - with_mote.momentum, with_mote.momentum) < 1e-6);
      CHECK(relative(after.angular_momentum - with_mote.angular_momentum, with_mote.angular_momentum) < 1e-6);
      CHECK(after.energy.total() < with_mote.energy.total() * (1 + 1e-6));
      CHECK(world.remove(hits));
      CHECK(before.energy.kinetic > 0);
    }
  }

  TEST_CASE("freezing moves no vertex by more than 1e-5 m, and takes no momentum") {
    YieldsDesc later = kTin;
    later.freeze_after = 100;
    Scene one = make_scene(10);
    Scene other = make_scene(10, later);
    bool frozen = false;
    for (int i = 0; i < 150 && !frozen; ++i) {
      REQUIRE(one.world.step(kFrame).healthy());
      REQUIRE(other.world.step(kFrame).healthy());
      frozen = !one.world.events().freezes.empty();
    }
    REQUIRE(frozen);
    const std::vector<DVec3> rigid = one.world.surface(one.plate);
    const std::vector<DVec3> soft = other.world.surface(other.plate);
    REQUIRE(rigid.size() == soft.size());
    double most = 0;
    for (std::size_t i = 0; i < rigid.size(); ++i) most = std::max(most, length(rigid[i] - soft[i]));
    CHECK(most < 1e-6);
    const Measurement a = one.world.measure();
    const Measurement b = other.world.measure();
    CHECK(relative(a.momentum - b.momentum, b.momentum) < 1e-7);
    CHECK(relative(a.angular_momentum - b.angular_momentum, b.angular_momentum) < 1e-6);
    CHECK(a.energy.total() <= b.energy.total());
    CHECK(length(one.world.velocity(one.plate) - other.world.velocity(other.plate)) < 1e-6);
    CHECK(one.world.triangles(one.plate) == other.world.triangles(other.plate));
  }

  TEST_CASE("a dent has the same bits for any workers, and after a restore while soft") {
    std::uint64_t with_one = 0;
    for (const int workers : {1, 2, 8}) {
      Scene s = make_scene(10, kTin, 8, workers);
      REQUIRE(run_until(s.world, s.plate, true));
      run(s.world, 3);
      REQUIRE(s.world.soft_form(s.plate) != SolidId{});
      const Snapshot snapshot = s.world.snapshot();
      REQUIRE(run_until(s.world, s.plate, false));
      run(s.world, 5);
      const std::uint64_t hash = s.world.state_hash();
      REQUIRE(s.world.restore(snapshot).has_value());
      REQUIRE(s.world.soft_form(s.plate) != SolidId{});
      REQUIRE(run_until(s.world, s.plate, false));
      run(s.world, 5);
      CHECK(s.world.state_hash() == hash);
      if (workers == 1) with_one = hash;
      CHECK(hash == with_one);
    }
  }

  TEST_CASE("each step after a restore while soft has the hash that it had before") {
    Scene s = make_scene(10);
    REQUIRE(run_until(s.world, s.plate, true));
    run(s.world, 3);
    const Snapshot snapshot = s.world.snapshot();
    std::vector<std::uint64_t> hashes;
    while (s.world.soft_form(s.plate) != SolidId{}) {
      REQUIRE(s.world.step(kFrame).healthy());
      hashes.push_back(s.world.state_hash());
    }
    CHECK(hashes.size() > 5);
    REQUIRE(s.world.restore(snapshot).has_value());
    for (const std::uint64_t hash : hashes) {
      REQUIRE(s.world.step(kFrame).healthy());
      CHECK(s.world.state_hash() == hash);
    }
  }

  TEST_CASE("a restore before the blow makes the body whole") {
    Scene s = make_scene(10);
    const Snapshot snapshot = s.world.snapshot();
    REQUIRE(run_until(s.world, s.plate, true));
    REQUIRE(run_until(s.world, s.plate, false));
    const std::uint64_t hash = s.world.state_hash();
    REQUIRE(s.world.restore(snapshot).has_value());
    CHECK_FALSE(s.world.is_reshaped(s.plate));
    CHECK(bulge(s.world, s.plate) == doctest::Approx(0.03));
    REQUIRE(run_until(s.world, s.plate, true));
    REQUIRE(run_until(s.world, s.plate, false));
    CHECK(s.world.state_hash() == hash);
  }

  TEST_CASE("a blow below the impulse moves a body as one that does not yield") {
    World rigid = make_world(sleepless_space(8));
    BodyDesc desc = plate();
    desc.yields.reset();
    const BodyId stays = take(rigid.add_body(desc));
    (void)take(rigid.add_body(ball(10)));
    YieldsDesc strong = kTin;
    strong.impulse = 80;  // The ball has 60 N s and does not bounce.
    Scene s = make_scene(10, strong);
    for (int i = 0; i < 30; ++i) {
      (void)rigid.step(kFrame);
      (void)s.world.step(kFrame);
      CHECK(s.world.events().yields.empty());
    }
    CHECK(s.world.pose(s.plate).position == rigid.pose(stays).position);
    CHECK(s.world.pose(s.plate).rotation == rigid.pose(stays).rotation);
    CHECK(s.world.angular_velocity(s.plate) == rigid.angular_velocity(stays));
  }

  TEST_CASE("a dented plate is hit again, and dents more") {
    Scene s = make_scene(10);
    REQUIRE(run_until(s.world, s.plate, true));
    REQUIRE(run_until(s.world, s.plate, false));
    const double first = bulge(s.world, s.plate);
    REQUIRE(s.world.set_pose(s.plate, {.position = {0, 0, 0}}).has_value());
    REQUIRE(s.world.set_velocity(s.plate, {}).has_value());
    REQUIRE(s.world.set_angular_velocity(s.plate, {}).has_value());
    CHECK(s.world.remove(s.ball));
    (void)take(s.world.add_body(ball(12)));
    REQUIRE(run_until(s.world, s.plate, true));
    REQUIRE(run_until(s.world, s.plate, false));
    CHECK(bulge(s.world, s.plate) > first + 0.005);
    CHECK(s.world.mass(s.plate) == Real(12));
  }

  TEST_CASE("a dented plate collides by its new shape") {
    Scene s = make_scene(14);
    REQUIRE(run_until(s.world, s.plate, true));
    REQUIRE(run_until(s.world, s.plate, false));
    CHECK(s.world.remove(s.ball));
    REQUIRE(s.world.set_pose(s.plate, {}).has_value());
    REQUIRE(s.world.set_velocity(s.plate, {}).has_value());
    REQUIRE(s.world.set_angular_velocity(s.plate, {}).has_value());
    run(s.world, 1);
    // A ray from in front through the middle of each triangle that looks that way meets the plate there.
    const std::vector<DVec3> x = s.world.surface(s.plate);
    int tried = 0;
    double worst = 0;
    for (const auto& [a, b, c] : s.world.triangles(s.plate)) {
      const DVec3 normal = normalize(cross(x[b] - x[a], x[c] - x[a]));
      if (normal.z > -0.8) continue;
      const DVec3 middle = 1.0 / 3 * (x[a] + x[b] + x[c]);
      const auto hit = take(s.world.cast_ray(middle - DVec3{0, 0, 1}, {0, 0, 2}));
      REQUIRE(hit.has_value());
      CHECK(hit->body == s.plate);
      worst = std::max(worst, std::abs(hit->point.z - middle.z));
      ++tried;
    }
    CHECK(tried > 30);
    CHECK(worst < 0.012);
  }

  TEST_CASE("two bodies that hit each other both yield") {
    World world = make_world(sleepless_space(8));
    BodyDesc left = plate();
    left.position = {0, 0, -0.3};
    left.velocity = {0, 0, 5};
    BodyDesc right = plate();
    right.position = {0.04, 0.02, 0.3};
    right.velocity = {0, 0, -5};
    const BodyId a = take(world.add_body(left));
    const BodyId b = take(world.add_body(right));
    const Measurement before = world.measure();
    bool both = false;
    for (int i = 0; i < 120; ++i) {
      REQUIRE(world.step(kFrame).healthy());
      both = both || (world.soft_form(a) != SolidId{} && world.soft_form(b) != SolidId{});
      CHECK(world.measure().energy.total() < before.energy.total() * (1 + 1e-5));
      if (i < 30) CHECK(world.center_of_mass(a).z < world.center_of_mass(b).z);  // Later they have turned.
    }
    CHECK(length(world.measure().momentum - before.momentum) < kSolidsErr * 60);
    CHECK(both);
    CHECK(world.is_reshaped(a));
    CHECK(world.is_reshaped(b));
  }

  TEST_CASE("a plate on the ground under a cloth gains no energy by a ball of 8 kg at 8 m/s") {
    for (const DVec3 place :
         {DVec3{-0.23, 0.6, 0.096}, DVec3{0.193, 0.6, -0.188}, DVec3{-0.114, 0.6, -0.229}}) {
      CAPTURE(place.x);
      World world = make_world(without_air());
      (void)take(world.add_body({.shape = {.kind = ShapeKind::kHalfSpace}}));
      YieldsDesc tin = kTin;
      tin.young_modulus = Real(7e6);
      tin.damping = Real(0.005);
      BodyDesc desc = plate(tin);
      desc.shape = Shape::box({Real(0.4), Real(0.03), Real(0.4)});
      desc.position = {0, 0.031, 0};
      const BodyId hit = take(world.add_body(desc));
      ClothDesc cloth;
      cloth.columns = cloth.rows = 21;
      cloth.corner = {-0.5, 0.066, -0.5};
      cloth.row_direction = {Real(0), Real(0), Real(1)};
      (void)take(world.add_cloth(cloth));
      BodyDesc falls = ball(0, Real(8));
      falls.position = place;
      falls.velocity = {0, Real(-8), 0};
      (void)take(world.add_body(falls));
      REQUIRE(run_until(world, hit, true));
      const double before = 8 * (8.0 * 8 / 2 + 9.81 * 0.6);
      for (int i = 0; i < 6; ++i) {
        CHECK(world.measure().energy.total() < before);
        REQUIRE(world.step(kFrame).healthy());
      }
    }
  }

  TEST_CASE("a door stays on its hinges, soft and rigid again") {
    World world = make_world(without_air());
    BodyDesc desc = plate();
    desc.angular_damping = Real(0.5);
    const BodyId door = take(world.add_body(desc));
    std::vector<HookId> hinges;
    for (const double y : {-0.25, 0.25}) {
      hinges.push_back(
          take(world.add_hook({.kind = HookKind::kHinge, .b = {.body = door}, .anchor = {-0.3, y, 0}})));
    }
    (void)take(world.add_body(ball(8)));
    REQUIRE(run_until(world, door, true));
    for (int i = 0; i < 20; ++i) {
      REQUIRE(world.step(kFrame).healthy());
      for (const HookId hinge : hinges) CHECK(world.hook_gap(hinge) < 1e-3);
    }
    REQUIRE(run_until(world, door, false));
    run(world, 1);
    const Real value = world.hook_value(hinges[0]);
    const Vec3 spin = world.angular_velocity(door);
    CHECK(std::abs(spin.x) + std::abs(spin.z) < Real(0.02) + Real(0.05) * std::abs(spin.y));
    run(world, 10);
    CHECK(std::abs(world.hook_value(hinges[0]) - value - Real(10) * kFrame * spin.y) < Real(0.05));
    for (const HookId hinge : hinges) CHECK(world.hook_gap(hinge) < 1e-3);
    CHECK(world.find_place({.body = door, .connection_point = "left"}).has_value());
  }

  TEST_CASE("a soft door does not touch the post that it is hooked to") {
    World world = make_world(sleepless_space(8));
    const BodyId post = take(world.add_body({.shape = Shape::box({Real(0.1), Real(0.5), Real(0.1)}),
                                             .position = {-0.33, 0, 0}}));  // They overlap.
    const BodyId door = take(world.add_body(plate()));
    (void)take(world.add_hook(
        {.kind = HookKind::kHinge, .a = {.body = post}, .b = {.body = door}, .anchor = {-0.3, 0, 0}}));
    (void)take(world.add_body(ball(6)));
    const double before = world.measure().energy.total();
    REQUIRE(run_until(world, door, true));
    for (int i = 0; i < 60; ++i) {
      REQUIRE(world.step(kFrame).healthy());
      CHECK(world.measure().energy.total() < before * (1 + 1e-5));
    }
    CHECK(std::abs(world.angular_velocity(door).y) > 1);
  }

  TEST_CASE("one hinge alone keeps the axis of a soft door") {
    World world = make_world(sleepless_space(8));
    const BodyId door = take(world.add_body(plate()));
    const HookId hinge =
        take(world.add_hook({.kind = HookKind::kHinge, .b = {.body = door}, .anchor = {-0.3, 0, 0}}));
    (void)take(world.add_body(ball(8)));
    REQUIRE(run_until(world, door, true));
    run(world, 10);
    REQUIRE(world.soft_form(door) != SolidId{});
    const Vec3 spin = world.angular_velocity(door);
    CHECK(std::abs(spin.y) > 1);
    CHECK(std::abs(spin.x) + std::abs(spin.z) < Real(0.35) * std::abs(spin.y));
    REQUIRE(run_until(world, door, false));
    CHECK(world.hook_gap(hinge) < 1e-4);
  }

  TEST_CASE("what is hooked to a body while it is soft stays hooked when it is rigid again") {
    Scene s = make_scene(10);
    REQUIRE(run_until(s.world, s.plate, true));
    const DVec3 at = take(s.world.find_place({.point = {.kind = PointRef::Kind::kSolid,
                                                        .slot = s.world.soft_form(s.plate).slot,
                                                        .generation = s.world.soft_form(s.plate).generation,
                                                        .index = 0,
                                                        .world = s.world.soft_form(s.plate).world}}));
    const RopeId rope = take(s.world.add_rope({.hook_point = at,
                                               .direction = {0, 1, 0},
                                               .total_mass = Real(0.2),
                                               .masses = 8,
                                               .length_at_rest = Real(0.5),
                                               .pins = {}}));
    const HookId hook = take(s.world.add_hook({.a = {.body = s.plate},
                                               .b = {.point = {.kind = PointRef::Kind::kRope,
                                                               .slot = rope.slot,
                                                               .generation = rope.generation,
                                                               .index = 0,
                                                               .world = rope.world}},
                                               .anchor = at}));
    const Measurement before = s.world.measure();
    REQUIRE(run_until(s.world, s.plate, false));
    run(s.world, 20);
    CHECK(s.world.hook_gap(hook) < 1e-3);
    CHECK(length(s.world.measure().momentum - before.momentum) < kSolidsErr * 60);
    CHECK(s.world.mass(rope) == doctest::Approx(0.2));
    CHECK(s.world.remove(hook));
  }

  TEST_CASE("a body that is removed while soft takes its solid with it, and the solid the body") {
    for (const bool by_solid : {false, true}) {
      Scene s = make_scene(10);
      const HookId hook = take(s.world.add_hook({.kind = HookKind::kHinge, .b = {.body = s.plate}}));
      REQUIRE(run_until(s.world, s.plate, true));
      const SolidId solid = s.world.soft_form(s.plate);
      CHECK(s.world.body_of(solid) == s.plate);
      CHECK((by_solid ? s.world.remove(solid) : s.world.remove(s.plate)));
      CHECK(s.world.positions(solid).empty());
      CHECK(s.world.mass(s.plate) == 0);
      CHECK(s.world.surface(s.plate).empty());
      CHECK_FALSE(s.world.remove(hook));
      run(s.world, 5);
      CHECK(s.world.memory().particles == 0);
      (void)take(s.world.add_body(plate()));
      run(s.world, 5);
    }
  }

  TEST_CASE("pushes on a soft body move its points as a whole") {
    Scene s = make_scene(10);
    REQUIRE(run_until(s.world, s.plate, true));
    run(s.world, 2);
    const DVec3 before = s.world.measure().momentum;
    REQUIRE(s.world.apply_impulse(s.plate, {Real(6), 0, 0}).has_value());
    CHECK(length(s.world.measure().momentum - before - DVec3{6, 0, 0}) < 1e-5);
    REQUIRE(s.world.apply_force(s.plate, {0, Real(60), 0}).has_value());
    run(s.world, 1);
    CHECK(length(s.world.measure().momentum - before - DVec3{6, 1, 0}) < 1e-4);
    REQUIRE(s.world.set_velocity(s.plate, {1, 2, 3}).has_value());
    CHECK(length(s.world.velocity(s.plate) - Vec3{1, 2, 3}) < 1e-5);
    REQUIRE(s.world.set_angular_velocity(s.plate, {0, 2, 0}).has_value());
    CHECK(length(s.world.angular_velocity(s.plate) - Vec3{0, 2, 0}) < 1e-4);
    REQUIRE(s.world.set_pose(s.plate, {.position = {50, 0, 0}}).has_value());
    CHECK(length(s.world.pose(s.plate).position - DVec3{50, 0, 0}) < 1e-5);
    run(s.world, 1);
    CHECK(length(s.world.center_of_mass(s.plate) - DVec3{50, 0, 0}) < 0.1);
  }

  TEST_CASE("a soft body with a pinned point stays soft until the point is let go") {
    Scene s = make_scene(10);
    REQUIRE(run_until(s.world, s.plate, true));
    const SolidId solid = s.world.soft_form(s.plate);
    const PointRef point = {.kind = PointRef::Kind::kSolid,
                            .slot = solid.slot,
                            .generation = solid.generation,
                            .index = 3,
                            .world = solid.world};
    REQUIRE(s.world.pin(point).has_value());
    run(s.world, 120);
    CHECK(s.world.soft_form(s.plate) == solid);
    REQUIRE(s.world.unpin(point).has_value());
    CHECK(run_until(s.world, s.plate, false));
  }

  TEST_CASE("what presses slowly makes a body soft, too") {
    World world = make_world(without_air());
    (void)take(world.add_body({.shape = Shape::half_space()}));
    BodyDesc desc = plate({.impulse = 50, .cell = Real(0.1), .young_modulus = Real(1e6)});
    desc.shape = Shape::box({Real(0.3), Real(0.1), Real(0.3)});
    desc.position = {0, 0.1, 0};
    const BodyId cushion = take(world.add_body(desc));
    const BodyId weight = take(world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = Shape::box({Real(0.2), Real(0.2), Real(0.2)}),
                                               .position = {0, 0.4, 0},
                                               .mass = Real(200)}));
    bool yielded = false;
    for (int i = 0; i < 30; ++i) {
      REQUIRE(world.step(kFrame).healthy());
      yielded = yielded || !world.events().yields.empty();
    }
    CHECK_FALSE(yielded);  // It gives 32.7 N s a step.
    for (int i = 0; i < 60 && !yielded; ++i) {
      REQUIRE(world.apply_force(weight, {0, Real(-3000), 0}).has_value());
      REQUIRE(world.step(kFrame).healthy());
      yielded = yielded || !world.events().yields.empty();
    }
    CHECK(yielded);  // 82.7 N s.
    CHECK(world.center_of_mass(weight).y > 0.2);
    CHECK(world.is_reshaped(cushion));
  }

  TEST_CASE("masses, speeds and sizes at their ends leave all finite") {
    struct Case {
      Real mass, speed;
    };
    for (const Case& one : {Case{Real(12000), 10}, Case{Real(0.012), 100}, Case{6, 100}}) {
      CAPTURE(one.mass);
      World world = make_world(sleepless_space(8));
      const BodyId body = take(world.add_body(plate()));
      const BodyId hits = take(world.add_body(ball(one.speed, one.mass)));
      const Measurement before = world.measure();
      for (int i = 0; i < 60; ++i) {
        REQUIRE(world.step(kFrame).healthy());
        CHECK(world.measure().energy.total() < before.energy.total() * (1 + 1e-4));
      }
      CHECK(relative(world.measure().momentum - before.momentum, before.momentum) < kSolidsErr);
      CHECK(is_finite(world.velocity(body)));
      CHECK(is_finite(world.velocity(hits)));
    }
  }

  TEST_CASE("what cannot yield is refused with a cure") {
    World world = make_world(empty_space());
    const auto refused = [&](BodyDesc desc, const char* where, const char* cure) {
      const Result<BodyId> added = world.add_body(desc);
      REQUIRE_FALSE(added.has_value());
      CHECK(added.error().where == where);
      CHECK(added.error().message.find(cure) != std::string::npos);
    };
    BodyDesc desc = plate();
    desc.kind = BodyKind::kStatic;
    refused(desc, "body.yields", "hooks to the world");
    desc = plate();
    desc.kind = BodyKind::kKinematic;
    refused(desc, "body.yields", "dynamic");
    desc = plate();
    desc.shape = Shape::compound();
    desc.parts = {{.shape = Shape::sphere(1)}, {.shape = Shape::sphere(2)}};
    refused(desc, "body.yields", "join the parts");
    desc = plate();
    desc.sensor = true;
    refused(desc, "body.yields", "sensor");
    desc = plate();
    desc.gravity_scale = 0;
    refused(desc, "body.yields", "gravity_scale");
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    for (const Real impulse : {Real(0), Real(-1), nan, kRigid}) {
      desc = plate();
      desc.yields->impulse = impulse;
      refused(desc, "body.yields.impulse", "positive");
    }
    desc = plate();
    desc.yields->poisson_ratio = Real(0.5);
    refused(desc, "body.yields.poisson_ratio", "0.499");
    desc = plate();
    desc.yields->freeze_below = 0;
    refused(desc, "body.yields.freeze_below", "positive");
    desc = plate();
    desc.yields->cell = -1;
    refused(desc, "body.yields.cell", "out of range");
    const BodyId good = take(world.add_body(plate()));
    for (const HookKind kind : {HookKind::kSlider, HookKind::kWheel, HookKind::kSixDegrees}) {
      const Result<HookId> hook = world.add_hook({.kind = kind, .b = {.body = good}});
      REQUIRE_FALSE(hook.has_value());
      CHECK(hook.error().where == "hook.kind");
      CHECK(hook.error().message.find("ball, hinge, fixed or distance") != std::string::npos);
    }
    CHECK(world.surface(BodyId{}).empty());
    CHECK(world.soft_form(BodyId{}) == SolidId{});
    CHECK(world.body_of(SolidId{}) == BodyId{});
  }
}

}  // namespace hooke
