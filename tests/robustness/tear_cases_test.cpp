/// Cloth that tears under many hits at once, and between pins that contradict each other.

#include "robustness/judged_room.h"

#include <set>
#include <string>
#include <utility>

namespace hooke {

using namespace test;

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// What is wrong with the topology of a cloth that was `whole` with `points` points; empty if nothing is.
std::string fault_of(const World& world, ClothId cloth, const Triangles& whole, std::size_t points) {
  const auto torn = world.triangles(cloth);
  const auto splits = world.splits(cloth);
  const std::size_t count = world.positions(cloth).size();
  if (count != points + splits.size()) return "points and splits do not add up";
  std::vector<std::uint32_t> origin(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    origin[i] = i < points ? i : splits[i - points];
    if (origin[i] > i) return "a point split off a later one";
    origin[i] = origin[origin[i]];
  }
  if (torn.size() != whole.size()) return "triangles are gone";
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<std::vector<std::size_t>> fans(count);
  for (std::size_t i = 0; i < torn.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (torn[i][k] >= count) return "a triangle has a point that is not there";
      if (origin[torn[i][k]] != whole[i][k]) return "a triangle has a point from elsewhere";
      if (!edges.insert({torn[i][k], torn[i][(k + 1) % 3]}).second) return "an edge has three triangles";
      fans[torn[i][k]].push_back(i);
    }
  }
  for (std::uint32_t p = 0; p < count; ++p) {
    if (fans[p].empty()) return "a point has no triangle";
    // Triangles about a point hang together by edges at it.
    std::vector<std::size_t> open = {fans[p].front()};
    std::set<std::size_t> seen = {open.front()};
    while (!open.empty()) {
      const auto t = torn[open.back()];
      open.pop_back();
      for (const std::size_t other : fans[p]) {
        int common = 0;
        for (const std::uint32_t q : t)
          common += q == torn[other][0] || q == torn[other][1] || q == torn[other][2] ? 1 : 0;
        if (common >= 2 && seen.insert(other).second) open.push_back(other);
      }
    }
    if (seen.size() != fans[p].size()) return "a point joins two fans";
  }
  return "";
}

MotionDesc moved_by(Real x) {
  MotionDesc motion;
  motion.kind = MotionDesc::Kind::kKeyframes;
  motion.keyframes = {{0, {}}, {0.5, {x, Real(0), Real(0)}}};
  return motion;
}

/// A cloth of 21 x 21 points that is held at its rim, below four balls of 50 m/s.
ClothId add_storm(World& world) {
  ClothDesc desc = sheet(21, {});
  desc.tear_strain = Real(0.1);
  desc.stretch_stiffness = 500;
  desc.shear_stiffness = 100;
  desc.damping = Real(0.02);
  for (std::uint32_t i = 0; i < 441; ++i) {
    if (i % 21 == 0 || i % 21 == 20 || i / 21 == 0 || i / 21 == 20) desc.pins.push_back({i});
  }
  const auto cloth = world.add_cloth(desc);
  REQUIRE(cloth.has_value());
  for (int i = 0; i < 4; ++i) {
    REQUIRE(world.add_body({.kind = BodyKind::kDynamic,
                            .shape = Shape::sphere(Real(0.03)),
                            .position = {0.17 * (i % 2 - 0.5), 0.2 + 0.15 * i, 0.17 * (i / 2 - 0.5)},
                            .velocity = {Real(0), Real(-50), Real(0)},
                            .mass = Real(0.2)}));
  }
  return cloth.value();
}

}  // namespace

TEST_SUITE("robustness/tears") {
  TEST_CASE("E-23: balls at 50 m/s tear a cloth: it stays a surface, energy falls, and bits repeat") {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 4}) {
      World world = World::create({.substeps = 4, .workers = workers}).value();
      const ClothId cloth = add_storm(world);
      const Triangles whole = world.triangles(cloth);
      const double start = world.measure().energy.total();
      for (int i = 0; i < 56; ++i) {
        CHECK(world.step(Real(1) / 480).healthy());
        CHECK(fault_of(world, cloth, whole, 441) == "");
        CHECK(world.measure().energy.total() < 1.02 * start);
      }
      CHECK(world.splits(cloth).size() > 100);
      CHECK(world.positions(cloth).size() <= 3 * whole.size());
      hashes.push_back(world.state_hash());
    }
    CHECK(hashes[0] == hashes[1]);
  }

  TEST_CASE("E-13: a cloth that can tear comes apart between two pins that part to ten times their edge") {
    World world = World::create({}).value();
    ClothDesc desc = sheet(21, {});
    desc.damping = Real(0.05);
    desc.tear_strain = Real(0.3);
    desc.tethers = false;
    desc.pins = {{220, moved_by(Real(-0.09))}, {221, moved_by(Real(0.09))}};
    const ClothId cloth = world.add_cloth(desc).value();
    const Triangles whole = world.triangles(cloth);
    for (int i = 0; i < 90; ++i) {
      CHECK(world.step(kFrame).healthy());
      CHECK(fault_of(world, cloth, whole, 441) == "");
      CHECK(fastest_of(world, cloth) < 10);
    }
    CHECK(!world.splits(cloth).empty());
    CHECK(world.measure().largest_stretch < 1);
  }
}

}  // namespace hooke
