/// Cuts by a blade: what parts, along which way, and what is kept.

#include "constants.h"
#include "world/make.h"
#include "world/pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// A sheet of 21 x 21 points in the plane z = 0, from x = 0 to 1 and from y = 0 down to -1.
ClothDesc sheet() {
  return {.columns = 21,
          .rows = 21,
          .stretch_stiffness = 200,
          .shear_stiffness = 40,
          .damping = Real(0.05),
          .tethers = false};
}

/// A blade across the plane z = 0 that goes from x = `from` to `to` at a height, which it leaves by `slope`.
CutDesc along_x(double from, double to, double y, double slope = 0) {
  return {.from = {DVec3{from, y + slope * from, -0.1}, DVec3{from, y + slope * from, 0.1}},
          .to = {DVec3{to, y + slope * to, -0.1}, DVec3{to, y + slope * to, 0.1}}};
}

double exact_mass(const World& world, ClothId cloth) {
  return d(world.mass(cloth));
}

/// Lengths of the edges of triangles that no other triangle shares [m].
double rim_of(const World& world, ClothId cloth) {
  const auto triangles = world.triangles(cloth);
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  }
  std::sort(edges.begin(), edges.end());
  double sum = 0;
  for (const auto& edge : edges) {
    if (std::count(edges.begin(), edges.end(), edge) == 1)
      sum += length(world.positions(cloth)[edge[0]] - world.positions(cloth)[edge[1]]);
  }
  return sum;
}

/// A block of 4 x 3 x 4 cells of 0.1 m about the origin.
SolidDesc block(Real modulus) {
  return {.cells = {4, 3, 4},
          .size = {Real(0.4), Real(0.3), Real(0.4)},
          .density = 1000,
          .young_modulus = modulus,
          .poisson_ratio = Real(0.3),
          .velocity = {1, 0, Real(0.5)}};
}

/// A level blade through all that is at a height.
CutDesc across(double y) {
  return {.from = {DVec3{-2, y, -2}, DVec3{-2, y, 2}}, .to = {DVec3{2, y, -2}, DVec3{2, y, 2}}};
}

MeshDesc ball(Real radius, int around) {
  MeshDesc mesh;
  for (int i = 0; i <= around / 2; ++i) {
    for (int k = 0; k < around; ++k) {
      const double a = 3.14159265358979 * i / (around / 2);
      const double b = 2 * 3.14159265358979 * k / around;
      mesh.positions.push_back(vector_cast<Real>(
          d(radius) * DVec3{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)}));
      const auto at = [&](int row, int column) {
        return static_cast<std::uint32_t>(row * around + column % around);
      };
      if (i == around / 2) continue;
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      mesh.triangles.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return mesh;
}

/// Whether each edge of the surface belongs to two triangles that run along it in opposite directions.
bool is_closed(const World& world, SolidId solid) {
  std::vector<std::array<std::uint32_t, 2>> there;
  std::vector<std::array<std::uint32_t, 2>> back;
  for (const auto& t : world.triangles(solid)) {
    for (std::size_t k = 0; k < 3; ++k) {
      there.push_back({t[k], t[(k + 1) % 3]});
      back.push_back({t[(k + 1) % 3], t[k]});
    }
  }
  std::sort(there.begin(), there.end());
  std::sort(back.begin(), back.end());
  return there == back;
}

double longest_edge(const World& world, SolidId solid) {
  const std::vector<DVec3> x = world.surface(solid);
  double longest = 0;
  for (const auto& t : world.triangles(solid)) {
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, length(x[t[k]] - x[t[(k + 1) % 3]]));
  }
  return longest;
}

}  // namespace

TEST_SUITE("world/cut") {
  TEST_CASE("a blade through a sheet makes two of it, along its way to within a cell") {
    for (const double slope : {0.0, 0.1, 0.37}) {
      World world = make_world(sleepless_space(8));
      const ClothId cloth = take(world.add_cloth(sheet()));
      const double mass = exact_mass(world, cloth);
      const CutResult cut = take(world.cut(along_x(-0.1, 1.1, -0.5123, slope)));
      REQUIRE(cut.cloths.size() == 1);
      CHECK(cut.cloths[0].cloth == cloth);
      CHECK(cut.cloths[0].scored == 0);
      CHECK(cut.cloths[0].first_added == 441);
      CHECK(cut.cloths[0].added == world.splits(cloth).size());
      CHECK(world.positions(cloth).size() == 441 + cut.cloths[0].added);
      CHECK(count_pieces(world, cloth) == 2);
      CHECK(world.triangles(cloth).size() == 800);
      CHECK(exact_mass(world, cloth) == mass);
      for (std::size_t i = 0; i < cut.cloths[0].added; ++i) {
        const DVec3 place = world.positions(cloth)[441 + i];
        CHECK(place == world.positions(cloth)[world.splits(cloth)[i]]);
        CHECK(std::abs(place.y - (-0.5123 + slope * place.x)) < 0.05);
      }
      run(world, 10);
    }
  }

  TEST_CASE("a cut keeps momentum and spin, and adds no energy, of a sheet that flies and is stretched") {
    World world = make_world(sleepless_space(8));
    ClothDesc desc = sheet();
    desc.damping = 0;
    desc.stretch_stiffness = desc.shear_stiffness = 100;
    const ClothId cloth = take(world.add_cloth(desc));
    for (std::uint32_t i = 0; i < 441; ++i) {
      const DVec3 x = world.positions(cloth)[i];
      REQUIRE(world.set_velocity(point(cloth, i), vector_cast<Real>(DVec3{2 * x.x, 1 + 2 * x.y, 0.5 - x.x}))
                  .has_value());
    }
    run(world, 12);
    for (const double y : {-0.61, -0.52, -0.38}) {
      const Measurement before = world.measure();
      REQUIRE(before.energy.elastic > 1e-4);
      const CutResult cut = take(
          world.cut({.from = {DVec3{-3, y, -3}, DVec3{-3, y, 3}}, .to = {DVec3{4, y, -3}, DVec3{4, y, 3}}}));
      REQUIRE(cut.cloths.size() == 1);
      const Measurement after = world.measure();
      CHECK(length(after.momentum - before.momentum) <= 1e-9 * length(before.momentum));
      CHECK(length(after.angular_momentum - before.angular_momentum) <=
            1e-9 * length(before.angular_momentum));
      CHECK(after.energy.kinetic == doctest::Approx(before.energy.kinetic).epsilon(1e-9));
      CHECK(after.energy.elastic <= before.energy.elastic * (1 + 1e-7));
      const double energy = after.energy.total();
      run(world, 5);
      CHECK(world.measure().energy.total() < energy * 1.001);
      CHECK(length(world.measure().momentum - before.momentum) < 1e-6 * length(before.momentum));
    }
  }

  TEST_CASE("many short sweeps cut as one long one does") {
    std::array<std::vector<std::array<std::uint32_t, 3>>, 2> triangles;
    std::array<double, 2> rims = {};
    for (const std::size_t sweeps : {1U, 240U}) {
      World world = make_world(sleepless_space(8));
      const ClothId cloth = take(world.add_cloth(sheet()));
      for (std::size_t i = 0; i < sweeps; ++i) {
        const double from = 1.2 * static_cast<double>(i) / static_cast<double>(sweeps) - 0.1;
        const double to = 1.2 * static_cast<double>(i + 1) / static_cast<double>(sweeps) - 0.1;
        take(world.cut(along_x(from, to, -0.5123, 0.21)));
      }
      CHECK(count_pieces(world, cloth) == 2);
      CHECK(exact_mass(world, cloth) == doctest::Approx(0.2));
      rims[sweeps == 1 ? 0 : 1] = rim_of(world, cloth);
    }
    CHECK(rims[0] > 4 + 2 * std::sqrt(1 + 0.21 * 0.21));
    CHECK(rims[0] == doctest::Approx(rims[1]).epsilon(1e-12));
  }

  TEST_CASE("a cut that ends inside leaves one piece with a slit; a stab is scored until a cut reaches it") {
    World world = make_world(sleepless_space(8));
    const ClothId cloth = take(world.add_cloth(sheet()));
    take(world.cut(along_x(-0.1, 0.5, -0.5123)));
    CHECK(count_pieces(world, cloth) == 1);
    const double slit = rim_of(world, cloth);
    CHECK(slit > 4.9);
    CHECK(slit < 5.5);
    const CutResult stab = take(world.cut(along_x(0.71, 0.74, -0.5123)));
    REQUIRE(stab.cloths.size() == 1);
    CHECK(stab.cloths[0].edges == 1);
    CHECK(stab.cloths[0].scored == 1);
    CHECK(stab.cloths[0].added == 0);
    CHECK(rim_of(world, cloth) == slit);
    // What the stab has scored is not looked at again: the cuts beside it join through it.
    take(world.cut(along_x(0.5, 0.71, -0.5123)));
    take(world.cut(along_x(0.74, 1.1, -0.5123)));
    CHECK(count_pieces(world, cloth) == 2);
    run(world, 5);
  }

  TEST_CASE("a slit of two edges opens at the point between them") {
    World world = make_world(sleepless_space(8));
    const ClothId cloth = take(world.add_cloth(sheet()));
    const CutResult cut = take(world.cut(along_x(0.41, 0.54, -0.5123)));
    REQUIRE(cut.cloths.size() == 1);
    CHECK(cut.cloths[0].edges >= 2);
    CHECK(cut.cloths[0].scored == 0);
    CHECK(cut.cloths[0].added == cut.cloths[0].edges - 1);
    CHECK(count_pieces(world, cloth) == 1);
  }

  TEST_CASE("what is cut off falls, whatever tethers and spring bends have held it") {
    for (const ClothDesc::Bend bend : {ClothDesc::Bend::kSpring, ClothDesc::Bend::kAngle}) {
      WorldDesc setting = sleepless_space(8);
      setting.gravity = {0, -10, 0};
      World world = make_world(setting);
      ClothDesc desc = sheet();
      desc.bend = bend;
      desc.bend_stiffness = bend == ClothDesc::Bend::kSpring ? Real(5) : Real(1e-3);
      desc.tethers = true;
      for (std::uint32_t i = 0; i < 21; ++i) desc.pins.push_back({.point = i});
      const ClothId cloth = take(world.add_cloth(desc));
      const std::size_t springs = world.memory().springs;
      take(world.cut(along_x(-0.1, 1.1, -0.5123, 0.03)));
      CHECK(world.memory().springs < springs);
      const double above = world.positions(cloth)[21 * 9].y;
      const double below = world.positions(cloth)[440].y;
      run(world, 30);
      CHECK(below - world.positions(cloth)[440].y == doctest::Approx(0.5 * 10 * 0.25).epsilon(0.03));
      CHECK(above - world.positions(cloth)[21 * 9].y < 0.01);
    }
  }

  TEST_CASE("a slit lets a tethered sheet gape, while points beside it keep their tethers") {
    World world = make_world(sleepless_space(8));
    ClothDesc desc = sheet();
    desc.tethers = true;
    desc.pins = {{.point = 0}, {.point = 20}};
    const ClothId cloth = take(world.add_cloth(desc));
    // Down the middle from below: the lower corners may part, and are still held by their sides.
    take(world.cut({.from = {DVec3{0.5123, -1.1, -0.1}, DVec3{0.5123, -1.1, 0.1}},
                    .to = {DVec3{0.5123, -0.4, -0.1}, DVec3{0.5123, -0.4, 0.1}}}));
    CHECK(count_pieces(world, cloth) == 1);
    for (int i = 0; i < 60; ++i) {
      REQUIRE(world.apply_force(point(cloth, 420), {Real(-0.5), 0, 0}).has_value());
      REQUIRE(world.apply_force(point(cloth, 440), {Real(0.5), 0, 0}).has_value());
      run(world, 1);
    }
    const PointView x = world.positions(cloth);
    CHECK(length(x[420] - x[0]) < 1.01);
    CHECK(length(x[440] - x[20]) < 1.01);
    double gap = 0;
    for (std::size_t i = 0; i < world.splits(cloth).size(); ++i)
      gap = std::max(gap, length(x[441 + i] - x[world.splits(cloth)[i]]));
    CHECK(gap > 0.08);
  }

  TEST_CASE("a pin and a hook in the way of the blade stay with the larger side, and it says so") {
    World world = make_world(sleepless_space(8));
    ClothDesc desc = sheet();
    desc.pins = {{.point = 21 * 10}};
    const ClothId cloth = take(world.add_cloth(desc));
    const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::sphere(Real(0.02)),
                                            .position = {0.5, -0.5, 0},
                                            .mass = Real(0.01)}));
    const HookId at_point = take(
        world.add_hook({.a = {.point = point(cloth, 220)}, .b = {.body = box}, .anchor = {0.5, -0.5, 0}}));
    const HookId within = take(world.add_hook(
        {.a = {.point = point(cloth, PointRef::kNearest)}, .b = {.body = box}, .anchor = {0.53, -0.48, 0}}));
    const RopeId rope = take(world.add_rope({.hook_point = {5, 0, 0}}));
    const CutResult cut = take(world.cut(along_x(-0.1, 1.1, -0.5)));
    REQUIRE(cut.cloths.size() == 1);
    CHECK(cut.cloths[0].held >= 2);
    CHECK(count_pieces(world, cloth) == 2);
    CHECK(world.is_pinned(point(cloth, 21 * 10)));
    run(world, 20);
    CHECK(world.hook_gap(at_point) < Real(1e-3));
    CHECK(world.hook_gap(within) < Real(1e-3));
    CHECK(d(world.positions(rope)[0].x) == doctest::Approx(5));
  }

  TEST_CASE("a rope falls from where it was cut") {
    WorldDesc setting = sleepless_space(8);
    setting.gravity = {0, -10, 0};
    World world = make_world(setting);
    const RopeId rope = take(world.add_rope({.hook_point = {3, 0, 0}, .direction = {0, -1, 0}}));
    const BodyId bob = take(world.add_body(
        {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.05)), .position = {3, -1, 0}, .mass = 1}));
    const HookId hook =
        take(world.add_hook({.a = {.point = point(rope, 15)}, .b = {.body = bob}, .anchor = {3, -1, 0}}));
    run(world, 10);
    const double y = world.pose(bob).position.y;
    const auto v = d(world.velocity(bob).y);
    const CutResult cut = take(world.cut({.from = {DVec3{-2, -0.4999, -2}, DVec3{-2, -0.4999, 2}},
                                          .to = {DVec3{4, -0.4999, -2}, DVec3{4, -0.4999, 2}}}));
    REQUIRE(cut.ropes.size() == 1);
    CHECK(cut.ropes[0].segments == std::vector<std::uint32_t>{7});
    CHECK(world.broken_segments(rope) == cut.ropes[0].segments);
    run(world, 30);
    CHECK(y + 0.5 * v - world.pose(bob).position.y == doctest::Approx(1.25).epsilon(0.03));
    CHECK(world.hook_gap(hook) < Real(1e-3));
    CHECK(take(world.cut({.from = {DVec3{-2, -0.4999, -2}, DVec3{-2, -0.4999, 2}},
                          .to = {DVec3{4, -0.4999, -2}, DVec3{4, -0.4999, 2}}}))
              .ropes.empty());
  }

  TEST_CASE("a closed cloth that is cut bursts") {
    World world = make_world(sleepless_space(8));
    MeshDesc mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const ClothId ball =
        take(world.add_cloth({.mesh = take(world.add_mesh(mesh)), .damping = 2, .pressure = Real(1000)}));
    run(world, 10);
    const double energy = world.measure().energy.total();
    const CutResult cut = take(world.cut(
        {.from = {DVec3{-2, 0.01, -2}, DVec3{-2, 0.01, 2}}, .to = {DVec3{2, 0.01, -2}, DVec3{2, 0.01, 2}}}));
    REQUIRE(cut.cloths.size() == 1);
    CHECK(cut.cloths[0].burst);
    CHECK(cut.cloths[0].edges == 4);
    CHECK(count_pieces(world, ball) == 2);
    CHECK(world.pressure(ball) == Real(0));
    CHECK(world.measure().energy.total() < energy);
    run(world, 10);
  }

  TEST_CASE("a blade through a solid makes two of it, soft or stiff, with closed surfaces") {
    for (const Real modulus : {Real(1e4), Real(1e8)}) {
      World world = make_world(sleepless_space(8));
      const SolidId solid = take(world.add_solid(block(modulus)));
      const auto mass = d(world.mass(solid));
      const double volume = world.volume(solid);
      const std::size_t points = world.positions(solid).size();
      const Measurement before = world.measure();
      const CutResult cut = take(world.cut(across(0.03)));
      REQUIRE(cut.solids.size() == 1);
      CHECK(cut.solids[0].solid == solid);
      CHECK(cut.solids[0].first_added == points);
      CHECK(cut.solids[0].scored == 0);
      CHECK(world.positions(solid).size() == points + cut.solids[0].added);
      CHECK(world.splits(solid).size() == cut.solids[0].added);
      CHECK(count_pieces(world, solid) == 2);
      CHECK(is_closed(world, solid));
      CHECK(d(world.mass(solid)) == mass);
      CHECK(world.volume(solid) == doctest::Approx(volume).epsilon(1e-6));
      const Measurement after = world.measure();
      CHECK(length(after.momentum - before.momentum) <= 1e-9 * length(before.momentum));
      CHECK(after.energy.total() == doctest::Approx(before.energy.total()).epsilon(1e-9));
      // Both parts fly on, and apart where they are pushed apart.
      const DVec3 momentum = after.momentum;
      run(world, 30);
      CHECK(length(world.measure().momentum - momentum) < 1e-5 * length(momentum));
      CHECK(world.measure().energy.total() <= after.energy.total() * 1.001);
      CHECK(take(world.cut(across(0.03 + 0.5))).solids.empty());
    }
  }

  TEST_CASE("what is cut off a held solid falls as a free body") {
    for (const Real modulus : {Real(2e4), Real(1e6)}) {
      WorldDesc setting = sleepless_space(8);
      setting.gravity = {0, -10, 0};
      World world = make_world(setting);
      SolidDesc desc = block(modulus);
      desc.velocity = {};
      for (std::uint32_t i = 0; i < 5 * 4 * 5; ++i) {
        if (i / 5 % 4 == 3) desc.pins.push_back({.point = i});
      }
      const SolidId solid = take(world.add_solid(desc));
      run(world, 2);
      REQUIRE(take(world.cut(across(-0.07))).solids.size() == 1);
      const double y = world.positions(solid)[0].y;
      const auto v = d(world.velocities(solid)[0].y);
      const int frames = modulus > Real(1e5) ? 6 : 24;
      run(world, frames);
      const double t = frames / 60.0;
      CHECK(y + t * v - world.positions(solid)[0].y == doctest::Approx(5 * t * t).epsilon(0.05));
    }
  }

  TEST_CASE("a solid opens where a blade went, and a mesh that it carries stays on both sides") {
    // The triangles of the second ball are longer than cells.
    for (const int around : {24, 10}) {
      World world = make_world(sleepless_space(8));
      SolidDesc desc = block(Real(1e4));
      desc.velocity = {};
      desc.visual = take(world.add_mesh(ball(Real(0.2), around)));
      const SolidId solid = take(world.add_solid(desc));
      const double longest = longest_edge(world, solid);
      const std::size_t triangles = world.triangles(solid).size();
      for (int i = 0; i < 40; ++i) {
        CutDesc part = across(0.03);
        part.from[0].x = part.from[1].x = -0.3 + 0.015 * i;
        part.to[0].x = part.to[1].x = -0.3 + 0.015 * (i + 1);
        take(world.cut(part));
      }
      CHECK(world.triangles(solid).size() > triangles);
      const PointView x = world.positions(solid);
      for (std::uint32_t i = 0; i < x.size(); ++i)
        REQUIRE(world.set_velocity(point(solid, i), {0, x[i].y > 0.1 ? Real(2) : Real(0), 0}).has_value());
      run(world, 40);
      CHECK(longest_edge(world, solid) < 1.6 * longest);
      const std::vector<DVec3> surface = world.surface(solid);
      const auto [low, high] = std::minmax_element(surface.begin(), surface.end(),
                                                   [](const DVec3& a, const DVec3& b) { return a.y < b.y; });
      CHECK(high->y - low->y > 1);
    }
  }

  TEST_CASE("a solid that is matched as a whole is refused, with a way out") {
    World world = make_world(sleepless_space(8));
    SolidDesc desc = block(Real(1e4));
    desc.elasticity = SolidDesc::Elasticity::kShapeMatching;
    const SolidId solid = take(world.add_solid(desc));
    const CutResult cut = take(world.cut(across(0.03)));
    CHECK(cut.empty());
    REQUIRE(cut.refused.size() == 1);
    CHECK(cut.refused[0].object == point(solid, 0));
    CHECK(cut.refused[0].why.find("kTetrahedra") != std::string::npos);
  }

  TEST_CASE("only what is named is cut") {
    World world = make_world(sleepless_space(8));
    const ClothId first = take(world.add_cloth(sheet()));
    ClothDesc behind = sheet();
    behind.corner.z = 0.01;
    const ClothId second = take(world.add_cloth(behind));
    CutDesc blade = along_x(-0.1, 1.1, -0.51);
    blade.cloths = {second};
    CHECK(take(world.cut(blade)).cloths.size() == 1);
    CHECK(world.splits(first).empty());
    CHECK(!world.splits(second).empty());
    CHECK(world.splits(SolidId{}).empty());
  }

  TEST_CASE("the same bits for any workers, and after a restoration between two cuts") {
    std::array<std::uint64_t, 3> hashes = {};
    for (std::size_t k = 0; k < 3; ++k) {
      World world = make_world(sleepless_space(8, k == 1 ? 4 : 1));
      ClothDesc desc = sheet();
      desc.pins = {{.point = 0}, {.point = 20}};
      desc.tethers = true;
      desc.thickness = Real(0.01);
      desc.self_contact = true;
      desc.velocity = {0, 0, 1};
      take(world.add_cloth(desc));
      take(world.add_cloth({.columns = 5, .rows = 5, .corner = {5, 0, 0}}));
      const auto cut_on = [&](double from, double to) {
        run(world, 3);
        const CutDesc blade = {.from = {DVec3{from, -0.52, -1}, DVec3{from, -0.52, 1}},
                               .to = {DVec3{to, -0.52, -1}, DVec3{to, -0.52, 1}}};
        CHECK(take(world.cut(blade)).cloths.size() == 1);
      };
      cut_on(0.21, 0.23);
      cut_on(-0.1, 0.4);
      if (k == 2) {
        const Snapshot middle = world.snapshot();
        cut_on(0.4, 1.1);
        run(world, 10);
        REQUIRE(world.restore(middle).has_value());
      }
      cut_on(0.4, 1.1);
      run(world, 30);
      hashes[k] = world.state_hash();
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);
  }

  TEST_CASE("blades that are none") {
    World world = make_world(sleepless_space(8));
    const ClothId cloth = take(world.add_cloth(sheet()));
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 2e9}) {
      CutDesc blade = along_x(-0.1, 1.1, -0.51);
      blade.to[1].y = bad;
      const Result<CutResult> cut = world.cut(blade);
      REQUIRE(!cut.has_value());
      CHECK(cut.error().where == "cut.to[1]");
    }
    CutDesc still = along_x(0.5, 0.5, -0.51);
    CHECK(take(world.cut(still)).empty());
    still.from[1] = still.from[0];
    still.to[1] = still.to[0] = {0.9, -0.5, 0};
    CHECK(take(world.cut(still)).empty());
    CutDesc stale = along_x(-0.1, 1.1, -0.51);
    stale.cloths = {cloth, ClothId{}};
    const Result<CutResult> cut = world.cut(stale);
    REQUIRE(!cut.has_value());
    CHECK(cut.error().where == "cut.cloths[1]");
    CHECK(world.splits(cloth).empty());
  }
}

}  // namespace hooke
