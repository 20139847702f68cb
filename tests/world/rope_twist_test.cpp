#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTorsion = 0.8;  ///< GJ of rod() [N m^2]; EI is 1.

Real real(double value) {
  return static_cast<Real>(value);
}

/// A straight rod from the origin to (1, 0, 0), with a point more beyond either end to clamp it by.
RopeDesc rod(int segments) {
  RopeDesc desc{
      .total_mass = real(0.01), .bend_stiffness = real(1), .twist_stiffness = real(kTorsion), .pins = {}};
  for (int i = -1; i <= segments + 1; ++i) desc.points.push_back({static_cast<double>(i) / segments, 0, 0});
  return desc;
}

/// The twist that rod(segments) needs to have `angle` between its clamps.
Real twist_between(double angle, int segments) {
  return real(angle * (1 + 2.0 / segments));
}

/// A cube of 0.2 m that touches nothing; its inertia is mass / 150.
BodyDesc cube(BodyKind kind, DVec3 place, double mass = 1) {
  return {.kind = kind,
          .shape = Shape::box({real(0.1), real(0.1), real(0.1)}),
          .position = place,
          .mass = real(mass),
          .collides = false,
          .can_sleep = false};
}

std::vector<HookId> clamp(World& world, BodyId body, RopeId rope, std::uint32_t first) {
  std::vector<HookId> hooks;
  for (std::uint32_t i = first; i < first + 2; ++i) {
    hooks.push_back(take(world.add_hook(
        {.a = {.body = body}, .b = {.point = point(rope, i)}, .anchor = world.positions(rope)[i]})));
  }
  return hooks;
}

double twist_of(const World& world, RopeId rope) {
  double sum = 0;
  for (const Real twist : world.twists(rope)) sum += static_cast<double>(twist);
  return sum;
}

/// A rod of 16 segments between two bodies.
struct Shaft {
  World world = make_world(empty_space());
  RopeId rope;
  BodyId left, right;

  Shaft(const RopeDesc& desc, const BodyDesc& at_left, const BodyDesc& at_right)
      : rope(take(world.add_rope(desc))),
        left(take(world.add_body(at_left))),
        right(take(world.add_body(at_right))) {
    clamp(world, left, rope, 0);
    clamp(world, right, rope, 17);
  }

  [[nodiscard]] double twist() const { return twist_of(world, rope); }
  [[nodiscard]] double torque(std::size_t segment = 8) const {
    return static_cast<double>(world.torques(rope)[segment]);
  }
  /// Turns the right end by `angle` within a second, and waits.
  void turn(double angle, int seconds_after) {
    REQUIRE(world.set_angular_velocity(right, {real(angle), real(0), real(0)}).has_value());
    run(world, 60);
    REQUIRE(world.set_angular_velocity(right, {}).has_value());
    run(world, 60 * seconds_after);
  }
};

const BodyDesc kWall = cube(BodyKind::kStatic, {0, 0, 0});
const BodyDesc kHand = cube(BodyKind::kKinematic, {1, 0, 0});

}  // namespace

TEST_SUITE("world/rope_twist") {
  TEST_CASE("a shaft that is turned resists by GJ phi / L, also beyond whole turns") {
    for (const double angle : {kPi / 2, -kPi / 2, 2.6 * kPi}) {
      Shaft shaft(rod(16), kWall, kHand);
      shaft.turn(angle, 1);
      CHECK(shaft.twist() == doctest::Approx(angle).epsilon(1e-5));
      CHECK(shaft.torque() == doctest::Approx(kTorsion * angle).epsilon(1e-5));
      CHECK(shaft.torque(0) == 0);  // inside the wall
    }
  }

  TEST_CASE("a disk on a wire swings with omega = sqrt(GJ / L I) and keeps its energy") {
    const double start = 0.5;
    RopeDesc desc = rod(16);
    desc.twist = twist_between(start, 16);
    Shaft shaft(desc, kWall, cube(BodyKind::kDynamic, {1, 0, 0}, 3));
    const double omega = std::sqrt(kTorsion / (3.0 / 150));
    std::vector<double> crossings;
    double before = start;
    const double energy = 0.5 * kTorsion * start * start;
    for (int i = 0; i < 900; ++i) {
      run(shaft.world, 1);
      const double now = shaft.twist();
      if ((now > 0) != (before > 0)) crossings.push_back(shaft.world.time() - now / (now - before) / 60);
      before = now;
      REQUIRE(shaft.world.measure().energy.total() == doctest::Approx(energy).epsilon(2e-3));
    }
    const double half_periods = static_cast<double>(crossings.size()) - 1;
    CHECK(half_periods * kPi / (crossings.back() - crossings.front()) ==
          doctest::Approx(omega).epsilon(1e-3));
  }

  TEST_CASE("a twist between free bodies turns them against each other, at any stiffness") {
    for (const double stiffness : {0.8, 8.0, 1e3, 1e6}) {
      RopeDesc desc = rod(16);
      desc.twist_stiffness = real(stiffness);
      desc.bend_stiffness = real(stiffness);
      desc.twist = twist_between(0.3, 16);
      Shaft shaft(desc, cube(BodyKind::kDynamic, {0, 0, 0}, 0.1), cube(BodyKind::kDynamic, {1, 0, 0}, 0.1));
      const double start = 0.5 * stiffness * 0.3 * 0.3;
      for (int i = 0; i < 120; ++i) {
        run(shaft.world, 1);
        const Measurement m = shaft.world.measure();
        // The mean of two angles is larger than that between them by up to h^2 k w / 8.
        REQUIRE(m.energy.total() <= 1.03 * start);
        REQUIRE(length(m.angular_momentum) < 1e-5);
      }
    }
  }

  TEST_CASE("a bent and twisted rod that flies freely keeps its angular momentum and gains no energy") {
    RopeDesc desc = rod(16);
    desc.twist = real(2);
    desc.total_mass = real(0.2);
    for (std::size_t i = 0; i < desc.points.size(); ++i) {
      const double s = (static_cast<double>(i) - 1) / 16;
      desc.points[i] = {std::sin(s), 1 - std::cos(s), 0.3 * s * s};
    }
    BodyDesc other = cube(BodyKind::kDynamic, desc.points[17], 0.3);
    other.velocity = {real(0.5), real(0), real(1)};
    other.angular_velocity = {real(1), real(2), real(3)};
    Shaft shaft(desc, cube(BodyKind::kDynamic, desc.points[1], 0.3), other);
    const Measurement start = shaft.world.measure();
    run(shaft.world, 1);
    const double energy = shaft.world.measure().energy.total();
    for (int i = 0; i < 120; ++i) {
      run(shaft.world, 1);
      const Measurement m = shaft.world.measure();
      REQUIRE(m.energy.total() <= energy);
      // Bending is implicit and loses 1 % of it by itself.
      REQUIRE(length(m.angular_momentum - start.angular_momentum) < 0.03 * length(start.angular_momentum));
    }
  }

  TEST_CASE("two shafts share a turn by their lengths, whatever turns between them") {
    // Springs in series: the torque is that of the whole length of 4/16 + 11/16.
    for (const double mass : {1.0, 1e-3}) {
      for (const double stiffness : {0.8, 8.0}) {
        RopeDesc desc = rod(16);
        desc.twist_stiffness = real(stiffness);
        desc.bend_stiffness = real(stiffness);
        Shaft shaft(desc, kWall, kHand);
        BodyDesc wheel = cube(BodyKind::kDynamic, {4.5 / 16, 0, 0}, mass);
        wheel.angular_damping = real(5);
        clamp(shaft.world, take(shaft.world.add_body(wheel)), shaft.rope, 5);
        shaft.turn(kPi / 2, 5);
        const double expected = stiffness * kPi / 2 / (15.0 / 16);
        CHECK(shaft.torque(3) == doctest::Approx(expected).epsilon(1e-3));
        CHECK(shaft.torque(9) == doctest::Approx(expected).epsilon(1e-3));
      }
    }
  }

  TEST_CASE("what hooks hold does not creep under the torque of a shaft, light or heavy") {
    for (const double mass : {1.0, 1e-2}) {
      for (const bool motor : {false, true}) {
        RopeDesc desc = rod(16);
        desc.twist_stiffness = real(8);
        desc.bend_stiffness = real(8);
        Shaft shaft(desc, cube(BodyKind::kDynamic, {0, 0, 0}, mass), kHand);
        HookDesc hook{
            .kind = HookKind::kHinge, .b = {.body = shaft.left}, .axis = {real(1), real(0), real(0)}};
        hook.motor.max_force = real(motor ? 100 : 0);
        hook.spring.stiffness = real(motor ? 0 : 8);
        hook.spring.damping = real(motor ? 0 : 0.1 * mass);
        take(shaft.world.add_hook(hook));
        shaft.turn(kPi / 2, 3);
        // The spring gives way as much as the shaft does.
        CHECK(shaft.torque() == doctest::Approx(motor ? 8 * kPi / 2 : 8 * kPi / 4).epsilon(1e-3));
      }
    }
  }

  TEST_CASE("a straight rod buckles when it is twisted beyond M L / EI = 8.987") {
    // After Greenhill 1883, for clamped ends of which one may come nearer: w'''' = i m w''' for the way w
    // across the rod as a complex number, m = M / EI, with w = w' = 0 at both ends asks for tan(m L / 2) = m
    // L / 2.
    constexpr int kSegments = 32;
    const double critical = 8.98682;
    for (const double share : {0.97, 1.05}) {
      World world = make_world(empty_space());
      RopeDesc desc = rod(kSegments);
      desc.bend_damping = real(0.05);
      desc.twist = twist_between(share * critical / kTorsion, kSegments);
      const RopeId rope = take(world.add_rope(desc));
      clamp(world, take(world.add_body(kWall)), rope, 0);
      const BodyId slide = take(world.add_body(cube(BodyKind::kDynamic, {1, 0, 0}, 0.1)));
      clamp(world, slide, rope, kSegments + 1);
      take(world.add_hook({.kind = HookKind::kSlider,
                           .b = {.body = slide},
                           .anchor = {1, 0, 0},
                           .axis = {real(1), real(0), real(0)}}));
      REQUIRE(world.apply_impulse(point(rope, kSegments / 2), {real(0), real(1e-4), real(0)}).has_value());
      const auto bow = [&] {
        double largest = 0;
        const PointView x = world.positions(rope);
        for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::hypot(x[i].y, x[i].z));
        return largest;
      };
      run(world, 60);
      const double before = bow();
      run(world, 60);
      if (share < 1) {
        CHECK(bow() < 0.8 * before);
      } else {
        CHECK(bow() > 1.25 * before);
        run(world, 600);
        CHECK(bow() > 0.1);  // a loop
      }
    }
  }

  TEST_CASE("a crank at the end of a shaft goes around with what turns the other end") {
    BodyDesc crank = cube(BodyKind::kDynamic, {0, 0, 0}, 0.5);
    crank.parts = {{.shape = Shape::box({real(0.02), real(0.1), real(0.02)}),
                    .position = {real(0), real(0.1), real(0)}}};
    crank.angular_damping = real(5);
    crank.linear_damping = real(5);
    Shaft shaft(rod(16), crank, kHand);
    const auto tip = [&] {
      const Pose pose = shaft.world.pose(shaft.left);
      return pose.position + vector_cast<double>(rotate(pose.rotation, Vec3{real(0), real(0.2), real(0)}));
    };
    CHECK(tip().y == doctest::Approx(0.2));
    shaft.turn(kPi, 6);
    CHECK(length(tip() - DVec3{0, -0.2, 0}) < 0.1 / 16);
    CHECK(std::abs(shaft.twist()) < 0.01);
  }

  TEST_CASE("a twist stays when the rope is held in one more place, and goes where it is let go") {
    World world = make_world(empty_space());
    const RopeId other = take(world.add_rope({}));
    RopeDesc desc = rod(16);
    desc.twist = twist_between(1.6, 16);
    desc.pins = {{.point = 0}, {.point = 1}, {.point = 17}, {.point = 18}};
    const RopeId rope = take(world.add_rope(desc));
    run(world, 1);
    CHECK(twist_of(world, rope) == doctest::Approx(1.6).epsilon(1e-6));
    for (const std::uint32_t i : {5U, 6U}) REQUIRE(world.pin(point(rope, i)).has_value());
    run(world, 1);
    CHECK(twist_of(world, rope) ==
          doctest::Approx(1.5).epsilon(1e-6));  // no more in the segment that is held
    CHECK(world.torques(rope)[2] == doctest::Approx(kTorsion * 1.6).epsilon(1e-6));
    REQUIRE(world.unpin(point(rope, 18)).has_value());
    REQUIRE(world.remove(other));
    run(world, 1);
    CHECK(world.torques(rope)[2] == doctest::Approx(kTorsion * 1.6).epsilon(1e-6));
    CHECK(world.torques(rope)[9] == 0);
    CHECK(twist_of(world, rope) == doctest::Approx(0.4).epsilon(1e-6));
  }

  TEST_CASE("clamps are pins, moved too, or hooks to the world") {
    for (const bool pinned : {true, false}) {
      World world = make_world(empty_space());
      RopeDesc desc = rod(16);
      desc.twist = twist_between(0.5, 16);
      desc.pins = {{.point = 0}, {.point = 1}};
      const RopeId rope = take(world.add_rope(desc));
      if (pinned) {
        // The last segment turns by a right angle and back.
        const double pitch = 1.0 / 16;
        MotionDesc turn{.kind = MotionDesc::Kind::kKeyframes};
        for (int i = 0; i <= 64; ++i) {
          const double angle = kPi / 4 * (1 - std::cos(kPi * i / 32));
          turn.keyframes.push_back(
              {1.0 * i / 32, {real(pitch * (std::cos(angle) - 1)), real(0), real(pitch * std::sin(angle))}});
        }
        REQUIRE(world.pin(point(rope, 17)).has_value());
        REQUIRE(world.pin(point(rope, 18), turn).has_value());
      } else {
        clamp(world, {}, rope, 17);
      }
      run(world, 240);
      CHECK(twist_of(world, rope) == doctest::Approx(0.5).epsilon(1e-4));
    }
  }

  TEST_CASE("a twisted rope goes on from a snapshot to the bit, with any number of workers") {
    RopeDesc desc = rod(16);
    desc.twist = twist_between(15, 16);
    desc.twist_stiffness = real(8);  // with an implicit share
    Shaft shaft(desc, cube(BodyKind::kDynamic, {0, 0, 0}, 1e-2), kHand);
    run(shaft.world, 30);
    const Snapshot snapshot = shaft.world.snapshot();
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 1, 4}) {
      REQUIRE(shaft.world.restore(snapshot).has_value());
      REQUIRE(shaft.world.set_workers(workers).has_value());
      run(shaft.world, 30);
      hashes.push_back(shaft.world.state_hash());
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);
  }

  TEST_CASE("a rod with five times its critical twist gains no energy when it is let go") {
    // Its free end comes to 2000 rad/s, more than half a turn in a substep.
    for (const double mass : {0.01, 1.0}) {
      const double angle = 60;
      RopeDesc desc = rod(16);
      desc.total_mass = real(mass);
      desc.twist = twist_between(angle, 16);
      Shaft shaft(desc, kWall, cube(BodyKind::kDynamic, {1, 0, 0}, 0.1));
      REQUIRE(shaft.world.apply_impulse(point(shaft.rope, 8), {real(0), real(1e-4), real(0)}).has_value());
      for (int i = 0; i < 120; ++i) {
        run(shaft.world, 1);
        REQUIRE(shaft.world.measure().energy.total() < 1.01 * 0.5 * kTorsion * angle * angle);
      }
    }
  }

  TEST_CASE("a round rod of steel has the stiffnesses of its material") {
    RopeDesc desc = rod(16);
    desc.radius = real(1e-3);
    desc.young_modulus = real(2e11);
    Shaft shaft(desc, kWall, kHand);
    shaft.turn(kPi / 2, 1);
    const double g = 2e11 / 2.6;
    CHECK(shaft.torque() == doctest::Approx(g * kPi * 1e-12 / 2 * kPi / 2).epsilon(1e-5));
  }

  TEST_CASE("impossible values of a rope that twists are refused") {
    World world = make_world();
    const auto complaint = [&](const RopeDesc& desc) {
      const Result<RopeId> rope = world.add_rope(desc);
      return rope ? std::string() : rope.error().where;
    };
    CHECK(complaint({.twist_stiffness = real(1)}) == "rope.twist_stiffness");
    CHECK(complaint({.bend_stiffness = real(1), .twist_stiffness = real(-1)}) == "rope.twist_stiffness");
    CHECK(complaint({.twist = kRigid}) == "rope.twist");
    CHECK(complaint({.young_modulus = real(0)}) == "rope.young_modulus");
    CHECK(complaint({.poisson_ratio = real(0.6)}) == "rope.poisson_ratio");
    CHECK(complaint({.twist_stiffness = real(1), .young_modulus = real(1e9)}).empty());
  }
}

}  // namespace hooke
