#include "hooke/hooke.h"

#include "world/make.h"
#include "world/shots.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <vector>

/// Seeded shots of 1 g to 10 kg at 1 to 1000 m/s at a cloth that is held all around, at a jelly that stands
/// on the ground, and at a net of ropes finer than the shot: balls, boxes, needles of 3 mm, cones, hulls and
/// concave meshes. Where a shot has got to is counted by exact predicates (validation/crossings.h).

namespace hooke {
namespace {

using test::Form;
using test::held_sheet;
using test::hits_above;
using test::kForms;
using test::kHalfWidth;
using test::make_world;
using test::Random;
using test::shot;
using test::take;
using test::Triangles;

constexpr Real kFrame = Real(1) / Real(60);  // [s]
constexpr int kFrames = 20;

/// Triangles of a grid of n x n points.
Triangles grid_triangles(std::uint32_t n) {
  Triangles triangles;
  for (std::uint32_t row = 0; row + 1 < n; ++row) {
    for (std::uint32_t column = 0; column + 1 < n; ++column) {
      const std::uint32_t at = row * n + column;
      triangles.push_back({at, at + 1, at + n});
      triangles.push_back({at + 1, at + n + 1, at + n});
    }
  }
  return triangles;
}

/// Whether a place is below a sheet that is held at its rim, and not in the bag that it makes.
template <class Points>
bool is_through(DVec3 at, const Points& points, const Triangles& triangles) {
  if (at.y > -0.01 || std::abs(at.x) > kHalfWidth || std::abs(at.z) > kHalfWidth) return false;
  const bool meets_plane = std::abs(at.x + 0.0137e-3 * -at.y) < kHalfWidth;
  return (hits_above(at, points, triangles) + (meets_plane ? 1 : 0)) % 2 == 0;
}

/// Steps until the shot has gone through, has come up again, or time is over. What has come up may fly over
/// the rim, and comes down outside.
template <class IsThrough>
bool passes_sheet(std::uint32_t seed, BodyId body, World& world, IsThrough is_through) {
  bool has_hit = false;
  for (int i = 0; i < kFrames; ++i) {
    CHECK_MESSAGE(world.step(kFrame).healthy(), "seed " << seed << " frame " << i);
    const DVec3 at = world.pose(body).position;
    if (is_through(at)) return true;
    if (has_hit && at.y > 0) return false;
    has_hit = has_hit || at.y < 0 || world.velocity(body).y > Real(0);
  }
  return false;
}

/// Whether a shot goes through a cloth.
bool passes_cloth(std::uint32_t seed) {
  Random random = {.state = 77U * seed};
  World world = make_world({.gravity = {}, .particle_substeps = seed % 2 == 0 ? 1 : 4});
  const ClothId cloth = take(world.add_cloth(held_sheet(seed % 3 == 0 ? 13 : 25)));
  const BodyId body = take(world.add_body(shot(static_cast<Form>(seed % kForms), 0.01, random, world)));
  return passes_sheet(seed, body, world, [&](DVec3 at) {
    return is_through(at, world.positions(cloth), world.triangles(cloth));
  });
}

/// Whether a shot gets into a jelly.
bool enters_jelly(std::uint32_t seed) {
  Random random = {.state = 991U * seed};
  World world = make_world({.gravity = {}});
  SolidDesc desc;
  desc.cells = {4, 2, 4};
  desc.size = {Real(1.2), Real(0.5), Real(1.2)};
  desc.position = {0, -0.25, 0};
  desc.young_modulus = static_cast<Real>(random.log_between(1e4, 1e6));
  const SolidId solid = take(world.add_solid(desc));
  const BodyId body = take(world.add_body(shot(static_cast<Form>(seed % kForms), 0.01, random, world)));
  bool through = false;
  for (int i = 0; i < kFrames && !through; ++i) {
    CHECK_MESSAGE(world.step(kFrame).healthy(), "seed " << seed << " frame " << i);
    through = hits_above(world.pose(body).position, world.surface(solid), world.triangles(solid)) % 2 != 0;
  }
  return through;
}

/// A net of ropes along both sides, hooked where they cross: the ropes of one side, and how many there are.
struct Net {
  std::vector<RopeId> ropes = {};
  std::uint32_t count = 0;

  [[nodiscard]] std::vector<DVec3> crossings(const World& world) const {
    std::vector<DVec3> all;
    for (const RopeId rope : ropes) {
      const auto points = world.positions(rope);
      for (std::size_t i = 0; i < points.size(); ++i) all.push_back(points[i]);
    }
    return all;
  }
};

/// Ropes `gap` apart, whose points are the crossings; both directions are held at their ends.
Net add_net(double gap, World& world) {
  Net net;
  net.count = static_cast<std::uint32_t>(std::lround(2 * kHalfWidth / gap)) + 1;
  const auto place = [&](std::uint32_t i) { return -kHalfWidth + 2 * kHalfWidth * i / (net.count - 1); };
  const auto add = [&](std::uint32_t line, bool across) {
    RopeDesc desc;
    desc.total_mass = Real(0.05);
    desc.radius = Real(0.002);
    for (std::uint32_t i = 0; i < net.count; ++i)
      desc.points.push_back(across ? DVec3{place(line), 0, place(i)} : DVec3{place(i), 0, place(line)});
    desc.pins = {{0}, {net.count - 1}};
    return take(world.add_rope(desc));
  };
  std::vector<RopeId> across;
  for (std::uint32_t line = 0; line < net.count; ++line) net.ropes.push_back(add(line, false));
  for (std::uint32_t line = 1; line + 1 < net.count; ++line) across.push_back(add(line, true));
  for (std::uint32_t row = 1; row + 1 < net.count; ++row) {
    for (std::uint32_t column = 1; column + 1 < net.count; ++column) {
      HookDesc hook;
      hook.a.point = point(net.ropes[row], column);
      hook.b.point = point(across[column - 1], row);
      hook.anchor = {place(column), 0, place(row)};
      (void)take(world.add_hook(hook));
    }
  }
  return net;
}

/// Whether a shot that is wider than the meshes of a net gets through it.
bool passes_net(std::uint32_t seed) {
  Random random = {.state = 1237U * seed};
  World world = make_world({.gravity = {}});
  const Net net = add_net(0.1, world);
  constexpr std::array<Form, 4> kWide = {Form::kBall, Form::kHull, Form::kMesh, Form::kBall};
  const BodyId body = take(world.add_body(shot(kWide[seed % kWide.size()], 0.085, random, world)));
  const Triangles triangles = grid_triangles(net.count);
  return passes_sheet(seed, body, world,
                      [&](DVec3 at) { return is_through(at, net.crossings(world), triangles); });
}

/// How many of the shots with seeds from 1 to `count` pass; each is named.
int passed_of(std::uint32_t count, bool (*passes)(std::uint32_t seed)) {
  int passed = 0;
  for (std::uint32_t seed = 1; seed <= count; ++seed) {
    if (!passes(seed)) continue;
    MESSAGE("passed: seed " << seed);
    ++passed;
  }
  return passed;
}

TEST_SUITE_BEGIN("world/deformable_shots");

TEST_CASE("no shot of 1 g to 10 kg at 1 to 1000 m/s goes through a held cloth") {
  CHECK(passed_of(240, passes_cloth) == 0);
}

TEST_CASE("no shot enters a jelly") {
  CHECK(passed_of(160, enters_jelly) == 0);
}

TEST_CASE("no shot goes through a net with meshes finer than it") {
  CHECK(passed_of(40, passes_net) == 0);
}

TEST_CASE("long: none of 10 000 shots goes through cloth, jelly or nets" * doctest::skip()) {
  CHECK(passed_of(4500, passes_cloth) == 0);
  CHECK(passed_of(4500, enters_jelly) == 0);
  CHECK(passed_of(1000, passes_net) == 0);
}

TEST_SUITE_END();

}  // namespace
}  // namespace hooke
