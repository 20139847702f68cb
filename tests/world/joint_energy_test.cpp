#include "hooke/hooke.h"

#include "math/random.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

/// Bodies of any mass, size and speed on hooks of any kind: docs/decisions/0026-energy-of-joints.md.
namespace hooke {
using namespace test;

namespace {

/// Random numbers with the same bits everywhere.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  double between(double low, double high) { return low + (high - low) * 0.5 * (1 + signed_unit(random_)); }
  /// As likely to be between 1 and 10 as between 10 and 100.
  double of_any_size(double low, double high) { return low * std::pow(high / low, between(0, 1)); }
  bool one_of(double count) { return between(0, count) < 1; }
  int below(int count) { return std::min(count - 1, static_cast<int>(between(0, count))); }
  DVec3 direction() {
    for (;;) {
      const DVec3 v = random_vector(random_);
      if (length(v) > 0.1 && length(v) < 1) return normalize(v);
    }
  }
  Vec3 vector(double size) { return vector_cast<Real>(size * direction()); }

 private:
  std::mt19937_64 random_;
};

Shape random_shape(double size, Draw& draw) {
  const auto part = [&] { return static_cast<Real>(size * draw.of_any_size(0.1, 1)); };
  const auto whole = static_cast<Real>(size);
  switch (draw.below(5)) {
    case 0:
      return Shape::sphere(whole);
    case 1:
      return Shape::box({part(), part(), whole});
    case 2:
      return Shape::capsule(Real(0.4) * whole, part());
    case 3:
      return Shape::cylinder(part(), part());
    default:
      return Shape::cone(part(), part());
  }
}

/// Bodies that do not touch, each hooked to one before it, the first to the world or to nothing; `loops`
/// hooks more.
class Hookups {
 public:
  Hookups(unsigned seed, bool hang, int loops, const WorldDesc& desc) : world(make_world(desc)), draw_(seed) {
    const int count = 1 + draw_.below(6);
    for (int i = 0; i < count; ++i) add_body();
    if (hang) hook(0, -1);
    for (int i = 1; i < count; ++i) hook(i, draw_.below(i));
    for (int i = 0; i < loops && count > 2; ++i) hook(count - 1, draw_.below(count - 1));
  }

  World world;
  double mass = 0;

 private:
  void add_body() {
    BodyDesc desc = {.kind = BodyKind::kDynamic, .collides = false};
    const double size = draw_.of_any_size(0.02, 0.5);
    desc.shape = random_shape(size, draw_);
    desc.position = {draw_.between(-2, 2), draw_.between(-2, 2), draw_.between(-2, 2)};
    desc.rotation = quaternion_about(draw_.vector(1), static_cast<Real>(draw_.between(0, 3)));
    desc.velocity = draw_.vector(draw_.one_of(3) ? 0 : draw_.of_any_size(0.1, 30));
    desc.angular_velocity = draw_.vector(draw_.one_of(2) ? 0 : draw_.of_any_size(0.1, 50));
    desc.density = static_cast<Real>(draw_.of_any_size(30, 8000));
    bodies_.push_back(take(world.add_body(desc)));
    sizes_.push_back(size);
    mass += d(world.mass(bodies_.back()));
  }

  /// A place on the body or beside it.
  DVec3 place_on(int body) {
    const double lever = draw_.one_of(3) ? 0 : draw_.between(0, sizes_[static_cast<std::size_t>(body)]);
    return world.center_of_mass(bodies_[static_cast<std::size_t>(body)]) + lever * draw_.direction();
  }

  void hook(int body, int other) {
    HookDesc desc;
    desc.a.body = bodies_[static_cast<std::size_t>(body)];
    desc.anchor = place_on(body);
    desc.axis = draw_.vector(1);
    if (other >= 0) desc.b.body = bodies_[static_cast<std::size_t>(other)];
    if (draw_.between(0, 1) < 0.6) {
      desc.kind = HookKind::kDistance;
      desc.anchor_b = other >= 0 ? place_on(other) : desc.anchor + draw_.between(0.5, 2) * draw_.direction();
      if (draw_.one_of(3)) desc.spring.stiffness = static_cast<Real>(draw_.of_any_size(1, 1e6));
    } else {
      constexpr std::array kKinds = {HookKind::kBall, HookKind::kHinge, HookKind::kSlider, HookKind::kFixed,
                                     HookKind::kWheel};
      desc.kind = kKinds[static_cast<std::size_t>(draw_.below(5))];
    }
    (void)take(world.add_hook(desc));
  }

  Draw draw_;
  std::vector<BodyId> bodies_;
  std::vector<double> sizes_;
};

/// How much energy was ever added, as a share of the first, or of a fall by 2 m.
double largest_gain(Hookups& hookups) {
  World& world = hookups.world;
  const Energy start = world.measure().energy;
  const double scale = std::max(start.kinetic, hookups.mass * 9.81 * 2);
  double most = 0;
  for (int i = 0; i < 180; ++i) {
    REQUIRE(world.step(Real(1) / Real(60)).healthy());
    most = std::max(most, (world.measure().energy.total() - start.total()) / scale);
  }
  return most;
}

/// Of so many random worlds: how many gain more than a twentieth of their energy, and more than three times
/// it.
std::array<int, 2> count_gains(int worlds, int loops) {
  std::array<int, 2> gains = {};
  for (int seed = 0; seed < worlds; ++seed) {
    INFO("seed " << seed);
    Hookups hookups(static_cast<unsigned>(seed), seed % 3 > 0, loops, without_air());
    const double gain = largest_gain(hookups);
    gains[0] += gain > 0.05;
    gains[1] += gain > 3;
  }
  return gains;
}

}  // namespace

TEST_SUITE("world/joint_energy") {
  TEST_CASE("random trees of hooks do not blow up") {
    const auto [small, large] = count_gains(150, 0);
    CHECK(small < 30);
    CHECK(large <= 2);
  }

  TEST_CASE("random loops of hooks do not blow up") {
    const auto [small, large] = count_gains(100, 2);
    CHECK(small < 20);
    CHECK(large <= 2);
  }

  TEST_CASE(
      "a bead of grams on a rail gains no energy from a heavy body on a rod that swings past its dead "
      "point") {
    for (const int substeps : {2, 4, 8}) {
      CAPTURE(substeps);
      for (const double speed : {1.0, 5.0, 15.0}) {
        CAPTURE(speed);
        WorldDesc desc = empty_space();
        desc.substeps = substeps;
        World world = make_world(desc);
        const auto add = [&](double radius, double mass, DVec3 position, Vec3 velocity) {
          return take(world.add_body({.kind = BodyKind::kDynamic,
                                      .shape = Shape::sphere(static_cast<Real>(radius)),
                                      .position = position,
                                      .velocity = velocity,
                                      .mass = static_cast<Real>(mass),
                                      .can_sleep = false}));
        };
        const BodyId bead = add(0.02, 0.01, {}, {});
        const Vec3 v = {Real(-0.2 * speed), static_cast<Real>(speed), Real(0.1 * speed)};
        constexpr double kMass = 200;
        const BodyId heavy = add(0.3, kMass, {0.4, 0.9, 0}, v);
        take(world.add_hook({.kind = HookKind::kSlider, .a = {.body = bead}, .axis = {1, 0, 0}}));
        take(world.add_hook({.kind = HookKind::kDistance,
                             .a = {.body = bead},
                             .b = {.body = heavy},
                             .anchor = {},
                             .anchor_b = DVec3{0.4, 0.9, 0}}));
        const double start = world.measure().energy.kinetic;
        double most = 0;
        for (int i = 0; i < 1200; ++i) {
          run(world, 1);
          most = std::max(most, world.measure().energy.kinetic);
        }
        CHECK(most < 1.1 * start + 1.25 * kMass);  // an account lets all be 1 m/s fast for nothing
      }
    }
  }

  TEST_CASE("the energy that is taken out of bodies on hooks leaves their momentum as it was") {
    for (unsigned seed = 0; seed < 60; ++seed) {
      INFO("seed " << seed);
      Hookups hookups(seed, false, 0, empty_space());
      const Measurement before = hookups.world.measure();
      run(hookups.world, 60);
      const double size = std::sqrt(2 * hookups.mass * before.energy.kinetic);
      CHECK(length(hookups.world.measure().momentum - before.momentum) <= 1e-5 * size);
    }
  }
}

}  // namespace hooke
