/// Ropes over drums and edges: what their friction holds, wherever the scene lies in space, and how they run.

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace hooke {

using namespace test;

namespace {

using DQuat = Quaternion<double>;

/// How a scene lies in space: turned, and first mirrored across the plane z = x.
struct Lie {
  DQuat turn = {};
  bool mirrored = false;

  [[nodiscard]] DVec3 operator()(DVec3 v) const { return rotate(turn, mirrored ? DVec3{v.z, v.y, v.x} : v); }
};

Lie lie_of(std::uint32_t seed, bool mirrored) {
  std::mt19937 bits(seed);
  const auto number = [&] { return static_cast<double>(bits()) / 2147483648.0 - 1; };
  const double x = number();
  const double y = number();
  const double z = number();
  return {normalize(DQuat{x, y, z, number()}), mirrored};
}

/// A light rope over half of a drum whose axis is z, with legs of 30 cm; `left` hangs at its first point,
/// `right` at its last one.
struct Drum {
  static constexpr double kRadius = 0.15, kStrand = 0.005, kBend = kRadius + kStrand, kLeg = 0.3;
  static constexpr int kOnDrum = 48, kOnLeg = 30;

  struct Setting {
    double friction = 0, left = 1, right = 1;
    Lie lie = {};
    double off_plane = 0;  ///< Every other point lies so far off the plane of the rope [m].
  };

  World world;
  RopeId rope;
  DVec3 up;

  explicit Drum(const Setting& setting, const WorldDesc& desc = without_air())
      : world(make_world(turned(desc, setting.lie))), up(setting.lie(DVec3{0, 1, 0})) {
    const DQuat along_z = quaternion_about<double>({1, 0, 0}, kPi / 2);
    const DQuat along_x = quaternion_about<double>({0, 0, 1}, kPi / 2);
    const DQuat turn = setting.lie.turn * (setting.lie.mirrored ? along_x : along_z);
    take(world.add_body({.shape = Shape::cylinder(Real(kRadius), Real(0.2)),
                         .rotation = {static_cast<Real>(turn.x), static_cast<Real>(turn.y),
                                      static_cast<Real>(turn.z), static_cast<Real>(turn.w)},
                         .contact = {.friction = static_cast<Real>(setting.friction)}}));
    RopeDesc made{.total_mass = Real(0.004),
                  .pins = {},
                  .radius = Real(kStrand),
                  .contact = {.friction = static_cast<Real>(setting.friction)}};
    const int last = kOnDrum + 2 * kOnLeg;
    for (int i = 0; i <= last; ++i) {
      const double angle = std::clamp((i - kOnLeg) * kPi / kOnDrum, 0.0, kPi);
      const double below = kLeg / kOnLeg * std::max({kOnLeg - i, i - kOnLeg - kOnDrum, 0});
      const double off = i % 2 == 0 ? setting.off_plane : -setting.off_plane;
      made.points.push_back(setting.lie({-kBend * std::cos(angle), kBend * std::sin(angle) - below, off}));
    }
    made.loads = {{.point = 0, .mass = static_cast<Real>(setting.left)},
                  {.point = static_cast<std::uint32_t>(last), .mass = static_cast<Real>(setting.right)}};
    rope = take(world.add_rope(made));
  }

  static WorldDesc turned(WorldDesc desc, const Lie& lie) {
    desc.gravity = vector_cast<Real>(lie({0, -kGravity, 0}));
    return desc;
  }

  /// Of the left load.
  [[nodiscard]] double height() const { return dot(world.positions(rope)[0], up); }
};

/// What the right load gains of speed in 0.15 s over what a = g (m1 - m2 e^(mu pi)) / (m1 + m2
/// e^(mu pi)) gives it. The first tenth is left out: the rope comes under tension in it.
double speed_over_theory(World& world, RopeId rope, double friction, double heavy, int rate) {
  const std::size_t last = world.positions(rope).size() - 1;
  const Real dt = Real(1) / static_cast<Real>(rate);
  run(world, rate / 10, dt);
  const double before = -world.velocities(rope)[last].y;
  run(world, 3 * rate / 20, dt);
  const double gained = -world.velocities(rope)[last].y - before;
  const double held = std::exp(friction * kPi);
  return gained / (0.15 * kGravity * (heavy - held) / (heavy + held));
}

/// A rope of 2 cm radius over a box, with 1 kg at its first point.
RopeId add_rope_over_box(World& world, double friction, double heavy) {
  constexpr double kHalf = 0.14, kThick = 0.02, kHung = 0.5, kLength = 0.005;
  take(world.add_body({.shape = Shape::box({Real(kHalf), Real(0.1), Real(0.3)}),
                       .position = {0, -0.1, 0},
                       .contact = {.friction = static_cast<Real>(friction)}}));
  RopeDesc desc{.total_mass = Real(0.01),
                .pins = {},
                .radius = Real(kThick),
                .contact = {.friction = static_cast<Real>(friction)}};
  const double most = kHalf + kThick * kPi / 2 + kHung;
  const int segments = static_cast<int>(2 * most / kLength);
  for (int i = 0; i <= segments; ++i) {
    const double s = most * (2.0 * i / segments - 1);
    const double turn = std::clamp((std::abs(s) - kHalf) / kThick, 0.0, kPi / 2);
    const double below = std::max(0.0, std::abs(s) - kHalf - kThick * kPi / 2);
    const double x = std::min(std::abs(s), kHalf) + kThick * std::sin(turn);
    desc.points.push_back({std::copysign(x, s), kThick * std::cos(turn) - below, 0});
  }
  desc.loads = {{.point = 0, .mass = 1},
                {.point = static_cast<std::uint32_t>(segments), .mass = static_cast<Real>(heavy)}};
  return take(world.add_rope(desc));
}

/// How far the left load rises in the second second.
double way_of(const Drum::Setting& setting) {
  Drum drum(setting);
  run(drum.world, 60);
  const double before = drum.height();
  run(drum.world, 60);
  return drum.height() - before;
}

}  // namespace

TEST_SUITE("world/rope_drums") {
  TEST_CASE("over a drum friction holds e^(mu pi) times the other weight, however the scene lies in space") {
    const double friction = 0.35;
    const double most = std::exp(friction * kPi);
    std::vector<Drum::Setting> settings(2, {.friction = friction});
    settings[1].off_plane = 1e-9;
    for (std::uint32_t seed = 1; seed <= 5; ++seed)
      settings.push_back({.friction = friction, .lie = lie_of(seed, seed % 2 == 0)});
    settings.push_back({.friction = friction, .lie = {.turn = {}, .mirrored = true}});
    for (Drum::Setting setting : settings) {
      INFO(setting.lie.turn.x, " ", setting.lie.turn.w, " ", setting.lie.mirrored, " ", setting.off_plane);
      setting.right = 0.985 * most;
      CHECK(std::abs(way_of(setting)) < 0.003);
      // It runs with a = g (m - m0) / (m + m0 + m1), from rest: in the second second 3/2 a.
      setting.right = 1.015 * most;
      CHECK(way_of(setting) > 0.05);
    }
  }

  TEST_CASE("over a drum or an edge a rope with little friction runs as Atwood's machine says, at any step") {
    for (const double friction : {0.0, 0.05, 0.2}) {
      for (const int fine : {1, 4}) {
        for (const double heavy : {2.5, 4.0}) {
          INFO("friction ", friction, ", ", 60 * fine, " Hz, ", heavy, " kg");
          WorldDesc desc = without_air();
          desc.substeps = fine == 1 ? 8 : 16;
          Drum drum({.friction = friction, .left = 1, .right = heavy}, desc);
          CHECK(speed_over_theory(drum.world, drum.rope, friction, heavy, 60 * fine) ==
                doctest::Approx(1).epsilon(0.02));
          if (fine == 1 || friction > 0) continue;  // it goes round the edge in a few substeps
          World world = make_world(desc);
          const RopeId rope = add_rope_over_box(world, friction, heavy);
          CHECK(speed_over_theory(world, rope, friction, heavy, 60 * fine) ==
                doctest::Approx(1).epsilon(0.02));
        }
      }
    }
  }
}

}  // namespace hooke
