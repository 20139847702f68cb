/// Ropes over drums: how much their friction holds, wherever the scene lies in space.

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

  explicit Drum(const Setting& setting)
      : world(make_world(desc_of(setting.lie))), up(setting.lie(DVec3{0, 1, 0})) {
    const DQuat along_z = quaternion_about<double>({1, 0, 0}, kPi / 2);
    const DQuat along_x = quaternion_about<double>({0, 0, 1}, kPi / 2);
    const DQuat turn = setting.lie.turn * (setting.lie.mirrored ? along_x : along_z);
    take(world.add_body({.shape = Shape::cylinder(Real(kRadius), Real(0.2)),
                         .rotation = {static_cast<Real>(turn.x), static_cast<Real>(turn.y),
                                      static_cast<Real>(turn.z), static_cast<Real>(turn.w)},
                         .contact = {.friction = static_cast<Real>(setting.friction)}}));
    RopeDesc desc{.total_mass = Real(0.004),
                  .pins = {},
                  .radius = Real(kStrand),
                  .contact = {.friction = static_cast<Real>(setting.friction)}};
    const int last = kOnDrum + 2 * kOnLeg;
    for (int i = 0; i <= last; ++i) {
      const double angle = std::clamp((i - kOnLeg) * kPi / kOnDrum, 0.0, kPi);
      const double below = kLeg / kOnLeg * std::max({kOnLeg - i, i - kOnLeg - kOnDrum, 0});
      const double off = i % 2 == 0 ? setting.off_plane : -setting.off_plane;
      desc.points.push_back(setting.lie({-kBend * std::cos(angle), kBend * std::sin(angle) - below, off}));
    }
    desc.loads = {{.point = 0, .mass = static_cast<Real>(setting.left)},
                  {.point = static_cast<std::uint32_t>(last), .mass = static_cast<Real>(setting.right)}};
    rope = take(world.add_rope(desc));
  }

  static WorldDesc desc_of(const Lie& lie) {
    WorldDesc desc = without_air();
    desc.gravity = vector_cast<Real>(lie({0, -kGravity, 0}));
    return desc;
  }

  /// Of the left load.
  [[nodiscard]] double height() const { return dot(world.positions(rope)[0], up); }
};

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
      CHECK(std::abs(way_of(setting)) < 1e-4);
      // It runs with a = g (m - m0) / (m + m0 + m1), from rest: in the second second 3/2 a.
      setting.right = 1.015 * most;
      CHECK(way_of(setting) > 0.05);
    }
  }
}

}  // namespace hooke
