#include "world/make.h"

#include <cmath>
#include <numbers>

namespace hooke {

using namespace test;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81;

Vec3 real(DVec3 v) {
  return vector_cast<Real>(v);
}

Quat about(Vec3 axis, double angle) {
  return quaternion_about(axis, static_cast<Real>(angle));
}

constexpr Vec3 kX = {Real(1), Real(0), Real(0)};
constexpr Vec3 kZ = {Real(0), Real(0), Real(1)};

/// A plane that goes down along x by `angle`.
void add_slope(World& world, double angle) {
  take(world.add_body(
      {.shape = Shape::half_space(), .rotation = about(kZ, -angle), .contact = {.friction = Real(1)}}));
}

/// Where the weights of a drum are, and how large.
struct Weights {
  double ring = 0.078;  ///< [m]
  double ball = 0.02;

  /// Over m r^2, with a drum of 0.1 m in radius and length and 1 kg/m^3.
  [[nodiscard]] double inertia() const {
    const double balls = 12 * 1e4 * 4 * kPi / 3 * ball * ball * ball;
    const double drum = kPi * 0.01 * 0.1;
    return (balls * (ring * ring + 0.4 * ball * ball) + drum * 0.5 * 0.01) / ((balls + drum) * 0.01);
  }
};

BodyId add_drum(World& world, const Weights& weights, DVec3 place) {
  BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::compound(), .position = place};
  desc.parts = {{.shape = Shape::cylinder(Real(0.1), Real(0.05)), .density = Real(1)}};
  for (int i = 0; i < 12; ++i) {
    const double angle = kPi / 6 * i;
    desc.parts.push_back(
        {.shape = Shape::sphere(static_cast<Real>(weights.ball)),
         .position = real({weights.ring * std::cos(angle), 0, weights.ring * std::sin(angle)}),
         .density = Real(1e4)});
  }
  for (PartDesc& part : desc.parts) part.contact.friction = Real(1);
  desc.rotation = about(kX, kPi / 2);
  desc.can_sleep = false;
  return take(world.add_body(desc));
}

/// A cone on its tip, aslant, with the spin and the rate of its regular precession.
struct Top {
  static constexpr double kRadius = 0.2, kHeight = 0.15, kTilt = kPi / 12, kSpin = 50;
  double rate = 0;  ///< [rad/s]
  DVec3 axis = {std::sin(kTilt), std::cos(kTilt), 0};

  Top() {
    // Per mass: I1 W^2 cos(tilt) - I3 spin W + g l = 0, I1 about the tip (Goldstein, section 5.7).
    const double a = 0.6 * (kHeight * kHeight + kRadius * kRadius / 4) * std::cos(kTilt);
    const double b = -0.3 * kRadius * kRadius * kSpin;
    const double c = kGravity * 0.75 * kHeight;
    rate = 2 * c / (-b + std::sqrt(b * b - 4 * a * c));
  }

  [[nodiscard]] BodyId add(World& world) const {
    const DVec3 omega = DVec3{0, rate, 0} + (kSpin - rate * std::cos(kTilt)) * axis;
    BodyDesc desc = {.kind = BodyKind::kDynamic,
                     .shape = Shape::cone(Real(kRadius), Real(kHeight / 2)),
                     .position = 0.5 * kHeight * axis,
                     .rotation = about(kZ, kPi - kTilt),
                     .velocity = real(cross(omega, 0.75 * kHeight * axis)),
                     .angular_velocity = real(omega),
                     .density = Real(2000)};
    desc.contact.friction = Real(2);
    desc.can_sleep = false;
    return take(world.add_body(desc));
  }

  /// How far the tip is from where it began [m].
  [[nodiscard]] static double way_of_tip(const World& world, BodyId top) {
    const Pose pose = world.pose(top);
    const Vec3 to_tip = rotate(pose.rotation, Vec3{Real(0), Real(kHeight / 2), Real(0)});
    return length(pose.position + vector_cast<double>(to_tip));
  }
};

/// A trough around the z axis, 1 m in radius, of flat strips; its inside.
MeshDesc trough(std::uint32_t strips) {
  MeshDesc mesh;
  for (std::uint32_t i = 0; i <= strips; ++i) {
    const double angle = kPi * i / strips - kPi / 2;
    for (const double z : {-0.3, 0.3}) mesh.positions.push_back(real({std::sin(angle), -std::cos(angle), z}));
    if (i == strips) break;
    mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
    mesh.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
  }
  return mesh;
}

}  // namespace

TEST_SUITE("world/refreshed_contacts") {
  TEST_CASE("a drum rolls over weights that lie below its rim") {
    const double angle = kPi / 9;
    World world = make_world();
    add_slope(world, angle);
    const BodyId drum = add_drum(world, {}, {0.1 * std::sin(angle), 0.1 * std::cos(angle), 0});
    test::run(world, 120);
    const double expected = 2 * kGravity * std::sin(angle) / (1 + Weights{}.inertia());
    CHECK(d(length(world.velocity(drum))) == doctest::Approx(expected).epsilon(0.005));
  }

  TEST_CASE("the tip of a spinning cone stays where it is") {
    World world = make_world();
    take(world.add_body({.shape = Shape::half_space(), .contact = {.friction = Real(2)}}));
    const BodyId id = Top().add(world);
    double farthest = 0;
    for (int step = 0; step < 180; ++step) {
      test::run(world, 1);
      farthest = std::max(farthest, Top::way_of_tip(world, id));
    }
    CHECK(farthest < 0.004);
  }

  TEST_CASE("a ball rolls in a hollow of narrow strips as in a smooth one") {
    // From 60 degrees and back; 7/10 v^2 = g (R - r)(1 - cos 60 deg) at the bottom (textbook).
    const double ball = 0.05;
    const double arm = 1 - ball;
    World world = make_world();
    take(world.add_body(
        {.shape = Shape::of_mesh(take(world.add_mesh(trough(1024)))), .contact = {.friction = Real(1)}}));
    BodyDesc desc = {.kind = BodyKind::kDynamic,
                     .shape = Shape::sphere(static_cast<Real>(ball)),
                     .position = {-arm * std::sin(kPi / 3), -arm * std::cos(kPi / 3), 0}};
    desc.contact.friction = Real(1);
    desc.can_sleep = false;
    const BodyId id = take(world.add_body(desc));
    double fastest = 0;
    double deepest = 0;
    for (int step = 0; step < 60; ++step) {
      test::run(world, 1);
      fastest = std::max(fastest, d(length(world.velocity(id))));
      deepest = std::max(deepest, length(world.pose(id).position) - arm);
    }
    CHECK(fastest == doctest::Approx(std::sqrt(10.0 / 7 * kGravity * arm * 0.5)).epsilon(0.01));
    CHECK(deepest < 0.001);
  }

  TEST_CASE("the bits of refreshed contacts do not depend on the number of workers, nor on a restore") {
    const auto hash = [](int workers, bool restored) {
      WorldDesc desc;
      desc.workers = workers;
      World world = make_world(desc);
      add_slope(world, kPi / 9);
      for (int i = 0; i < 12; ++i) add_drum(world, {}, {0.3 * i, 0.12 - 0.11 * i, 0.02 * (i % 3)});
      test::run(world, 40);
      if (restored) {
        const Snapshot snapshot = world.snapshot();
        test::run(world, 5);
        REQUIRE(world.restore(snapshot).has_value());
      }
      test::run(world, 20);
      return world.state_hash();
    };
    CHECK(hash(1, false) == hash(3, false));
    CHECK(hash(1, false) == hash(1, true));
  }
}

}  // namespace hooke
