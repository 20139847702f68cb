#include "elements/dipoles.h"

#include "world/make.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <numbers>
#include <string>

using namespace hooke;
using namespace hooke::test;

namespace {

constexpr double kMu0 = 4e-7 * std::numbers::pi;  ///< [T m/A]

BodyDesc magnet(DVec3 position, Vec3 moment) {
  BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.02)), .position = position};
  desc.mass = Real(1);
  desc.dipole_moment = moment;
  return desc;
}

FieldDesc uniform(Vec3 flux_density) {
  return {.kind = FieldDesc::Kind::kMagnetic, .vector = flux_density};
}

/// Time of the first passage of the moment through the field's direction, times four.
double period_of_needle(World& world, BodyId needle, Real dt) {
  double before = 1;
  for (int i = 0;; ++i) {
    const double now = static_cast<double>(rotate(world.pose(needle).rotation, Vec3{1, 0, 0}).z);
    if (i > 0 && now * before <= 0) return 4 * static_cast<double>(dt) * (i - now / (now - before));
    if (i > 100000) return 0;
    before = now;
    world.step(dt);
  }
}

}  // namespace

TEST_SUITE("world/dipoles") {
  TEST_CASE("two magnets on one axis attract with 3 mu0 m1 m2 / (2 pi r^4), whichever comes first") {
    for (const bool turned : {false, true}) {
      World world = make_world(empty_space());
      const DVec3 far = {0, 0.3, 0};
      const BodyId a = take(world.add_body(magnet(turned ? far : DVec3{}, {0, Real(40), 0})));
      const BodyId b = take(world.add_body(magnet(turned ? DVec3{} : far, {0, Real(25), 0})));
      run(world, 1, Real(1e-3));
      const double force = 3 * kMu0 * 40 * 25 / (2 * std::numbers::pi * std::pow(0.3, 4));
      CHECK(world.velocity(a).y == doctest::Approx((turned ? -1 : 1) * 1e-3 * force).epsilon(1e-5).scale(0));
      CHECK(world.velocity(b) == -world.velocity(a));
      CHECK(world.angular_velocity(a) == Vec3{});
    }
  }

  TEST_CASE("magnets side by side repel by half as much when they point the same way, and the field turns") {
    World world = make_world(empty_space());
    const BodyId a = take(world.add_body(magnet({}, {0, Real(40), 0})));
    const BodyId b = take(world.add_body(magnet({0.3, 0, 0}, {0, Real(25), 0})));
    run(world, 1, Real(1e-3));
    const double force = 3 * kMu0 * 40 * 25 / (4 * std::numbers::pi * std::pow(0.3, 4));
    CHECK(world.velocity(b).x == doctest::Approx(1e-3 * force).epsilon(1e-5).scale(0));
    CHECK(world.velocity(a) == -world.velocity(b));

    // Above a magnet that points up the field points up, beside it down.
    CHECK(elements::dipole_field({0, 1, 0}, {0, 2, 0}).y == doctest::Approx(2e-7 / 8).scale(0));
    CHECK(elements::dipole_field({0, 1, 0}, {2, 0, 0}).y == doctest::Approx(-1e-7 / 8).scale(0));
    CHECK(elements::dipole_field({0, 1, 0}, {}) == DVec3{});
    CHECK(elements::dipole_field({0, 1, 0}, {0, 1e-9, 0}) == DVec3{});
  }

  TEST_CASE("the force is the gradient of the energy, and the opposite of the other's to the last bit") {
    const DVec3 a = {0.3, -1.2, 0.7};
    const DVec3 b = {-0.9, 0.1, 1.7};
    const DVec3 d = {0.31, 0.43, -0.27};
    const double inverse = 1 / length(d);
    const DVec3 n = inverse * d;
    const DVec3 force = elements::dipole_force(a, b, n, inverse);
    const auto energy = [&](DVec3 at) { return -dot(b, elements::dipole_field(a, at)); };
    const double step = 1e-5;
    for (const DVec3 axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}}) {
      const double slope = (energy(d + step * axis) - energy(d - step * axis)) / (2 * step);
      CHECK(dot(force, axis) == doctest::Approx(-slope).epsilon(1e-6).scale(0));
    }
    CHECK(elements::dipole_force(b, a, -n, inverse) == -force);
    // Both torques and the pair of forces turn nothing as a whole.
    const DVec3 whole =
        cross(b, elements::dipole_field(a, d)) + cross(a, elements::dipole_field(b, -d)) + cross(d, force);
    CHECK(length(whole) < 1e-12 * length(cross(d, force)));
  }

  TEST_CASE("two magnets in space keep momentum, angular momentum and energy") {
    World world = make_world(empty_space());
    BodyDesc first = magnet({}, {Real(100), 0, 0});
    first.velocity = {0, Real(0.1), 0};
    first.angular_velocity = {0, Real(2), Real(1)};
    take(world.add_body(first));
    BodyDesc second = magnet({0.5, 0.1, -0.1}, {Real(30), Real(60), Real(-100)});
    second.shape = Shape::box({Real(0.06), Real(0.03), Real(0.04)});
    take(world.add_body(second));
    const Measurement start = world.measure();
    CHECK(start.energy.potential != 0.0);
    double swing = 0;
    for (int i = 0; i < 120; ++i) {
      run(world, 1, Real(1.0 / 240));
      swing = std::max(swing, std::abs(world.measure().energy.kinetic - start.energy.kinetic));
    }
    const Measurement end = world.measure();
    CHECK(length(end.momentum - start.momentum) < 1e-6);
    // The field of one turns the other by some 5e-3 N m, half a second long.
    CHECK(length(end.angular_momentum - start.angular_momentum) < 1e-6);
    CHECK(swing > 0.002);
    CHECK(std::abs(end.energy.total() - start.energy.total()) < 0.01 * swing);
  }

  TEST_CASE("a needle swings in a uniform field with 2 pi sqrt(I / m B)") {
    World world = make_world(empty_space());
    take(world.add_field(uniform({Real(0.02), 0, 0})));
    BodyDesc desc = magnet({5, 0, 0}, {Real(0.5), 0, 0});
    desc.rotation = quaternion_about(Vec3{0, Real(1), 0}, Real(-0.02));
    const BodyId needle = take(world.add_body(desc));
    const double inertia = 0.4 * 0.02 * 0.02;
    const double period = 2 * std::numbers::pi * std::sqrt(inertia / (0.5 * 0.02));
    // Started at rest it is half a substep late, four times: 1.3e-3 of the period.
    CHECK(period_of_needle(world, needle, Real(1.0 / 240)) == doctest::Approx(period).epsilon(2e-3).scale(0));
    CHECK(world.velocity(needle) == Vec3{});
  }

  TEST_CASE("in a gradient a magnet along the field is pulled with m g, and across it with half of that") {
    const auto speed_after_a_second = [](Vec3 moment) {
      World world = make_world(empty_space());
      take(world.add_field({.kind = FieldDesc::Kind::kMagnetic,
                            .vector = {0, Real(1e-9), 0},
                            .center = {1, 2, 3},
                            .strength = 0.2}));
      const BodyId body = take(world.add_body(magnet({1, 2, 3}, moment)));
      run(world, 1, Real(1e-3));
      return 1e3 * vector_cast<double>(world.velocity(body));
    };
    CHECK(speed_after_a_second({0, Real(3), 0}).y == doctest::Approx(0.6).epsilon(1e-5));
    CHECK(speed_after_a_second({Real(3), 0, 0}).x == doctest::Approx(-0.3).epsilon(1e-5));
  }

  TEST_CASE("a dipole field does what a still body with its moment does, and turns a charge") {
    const auto pushed = [](bool as_field) {
      World world = make_world(empty_space());
      if (as_field) {
        take(world.add_field(
            {.kind = FieldDesc::Kind::kDipole, .vector = {Real(40), Real(5), 0}, .center = {1, 0, 0}}));
      } else {
        BodyDesc still = magnet({1, 0, 0}, {Real(40), Real(5), 0});
        still.kind = BodyKind::kStatic;
        take(world.add_body(still));
      }
      const BodyId body = take(world.add_body(magnet({1.2, 0.1, 0.1}, {0, 0, Real(30)})));
      run(world, 10);
      return vector_cast<double>(world.velocity(body));
    };
    CHECK(length(pushed(true)) > 1e-3);
    CHECK(pushed(true) == pushed(false));

    World world = make_world(empty_space());
    take(world.add_field({.kind = FieldDesc::Kind::kDipole, .vector = {0, Real(1e6), 0}}));
    ParticleDesc charged = {.position = {1, 0, 0}, .velocity = {Real(1), 0, 0}};
    charged.charge = Real(1);
    const ParticlesId particle = take(world.add_particles({.particles = {charged}}));
    run(world, 1, Real(1e-3));
    // q v x B, with B = -mu0 m / (4 pi r^3) beside the magnet.
    CHECK(world.velocities(particle)[0].z == doctest::Approx(-1e-3 * 0.1).epsilon(3e-3).scale(0));
  }

  TEST_CASE("a body without a moment is untouched, and so is one that forces do not move") {
    World world = make_world(empty_space());
    take(world.add_field(uniform({0, Real(1), 0})));
    take(world.add_field(
        {.kind = FieldDesc::Kind::kDipole, .vector = {Real(1e6), 0, 0}, .center = {0, 1, 0}}));
    const BodyId plain = take(world.add_body(magnet({}, {})));
    BodyDesc held = magnet({3, 0, 0}, {Real(9), 0, 0});
    held.kind = BodyKind::kKinematic;
    const BodyId moved = take(world.add_body(held));
    run(world, 10);
    CHECK(world.center_of_mass(plain) == DVec3{});
    CHECK(world.center_of_mass(moved) == DVec3{3, 0, 0});
  }

  TEST_CASE("magnets far too strong for the step, or in one place, stay finite and hold together") {
    WorldDesc desc = empty_space();
    World world = make_world(desc);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 6; ++i) {
      BodyDesc one = magnet({0.05 * (i / 2), 0, 0}, {Real(1e9), Real(i), 0});
      one.collides = i % 3 != 0;
      bodies.push_back(take(world.add_body(one)));
    }
    take(world.add_field(uniform({0, Real(1e30), 0})));
    take(world.add_field(
        {.kind = FieldDesc::Kind::kDipole, .vector = {Real(1e9), 0, 0}, .center = {0.05, 0, 0}}));
    run(world, 120);
    for (const BodyId body : bodies) {
      CHECK(is_finite(world.center_of_mass(body)));
      CHECK(length(world.velocity(body)) < Real(100));
    }
  }

  TEST_CASE("a ball that clings to a ceiling of iron stays awake and falls when its magnet goes") {
    World world = make_world(without_air());
    take(world.add_body({.shape = Shape::box({Real(1), Real(0.1), Real(1)}), .position = {0, 1.12, 0}}));
    BodyDesc kept = magnet({0, 1.3, 0}, {0, Real(500), 0});
    kept.kind = BodyKind::kStatic;
    kept.collides = false;
    const BodyId holder = take(world.add_body(kept));
    const BodyId ball = take(world.add_body(magnet({0, 1, 0}, {0, Real(500), 0})));
    run(world, 180);
    CHECK_FALSE(world.asleep(ball));
    CHECK(world.center_of_mass(ball).y == doctest::Approx(1.0).epsilon(2e-3));
    REQUIRE(world.remove(holder));
    run(world, 12);
    CHECK(world.velocity(ball).y == doctest::Approx(-9.81 * 0.2).epsilon(1e-3));
  }

  TEST_CASE("many magnets end in the same bits for any number of workers") {
    std::uint64_t hash = 0;
    for (const int workers : {1, 3}) {
      WorldDesc desc = empty_space();
      desc.workers = workers;
      World world = make_world(desc);
      take(world.add_field(uniform({0, Real(0.01), 0})));
      for (int i = 0; i < 60; ++i) {
        const Real turn = Real(0.7) * static_cast<Real>(i);
        take(world.add_body(
            magnet({0.08 * (i % 8), 0.08 * (i / 8), 0.01 * (i % 3)}, {Real(5), turn, Real(20) - turn})));
      }
      run(world, 60);
      if (workers == 1) hash = world.state_hash();
      CHECK(world.state_hash() == hash);
    }
  }

  TEST_CASE("a moment or a magnetic field that is not finite or too large is an error that names the key") {
    World world = make_world();
    const Real nan = static_cast<Real>(std::nan(""));
    const auto body = [&](Vec3 moment) {
      const Result<BodyId> made = world.add_body(magnet({}, moment));
      return made ? std::string("made") : made.error().where;
    };
    CHECK(body({nan, 0, 0}) == "body.dipole_moment");
    CHECK(body({0, static_cast<Real>(2e9), 0}) == "body.dipole_moment");
    CHECK(body({0, 0, kRigid}) == "body.dipole_moment");
    const auto field = [&](const FieldDesc& desc) {
      const Result<FieldId> made = world.add_field(desc);
      return made ? std::string("made") : made.error().where;
    };
    using Kind = FieldDesc::Kind;
    CHECK(field({.kind = Kind::kDipole, .vector = {0, nan, 0}}) == "field.vector");
    CHECK(field({.kind = Kind::kDipole, .vector = {0, Real(2e9), 0}}) == "field.vector");
    CHECK(field({.kind = Kind::kDipole, .center = {std::nan(""), 0, 0}}) == "field.center");
    CHECK(field({.kind = Kind::kMagnetic, .vector = {Real(1), 0, 0}, .strength = 2e9}) == "field.strength");
    CHECK(field({.kind = Kind::kMagnetic, .strength = 1}) == "field.vector");
    CHECK(field({.kind = Kind::kMagnetic}) == "made");
  }
}
