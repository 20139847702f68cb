#include "hooke/hooke.h"

#include "world/surface_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <numbers>
#include <string>
#include <vector>

/// Contacts of ropes with cloths, solids and other ropes, as surfaces touch each other. Ropes that are solved
/// together with what they touch stand in world/rope_contacts_test.cpp.

namespace hooke {
namespace {

constexpr double kGravity = 9.81;

RopeDesc rope(std::vector<DVec3> points, Real radius = Real(0.004)) {
  RopeDesc desc;
  desc.touches_surfaces = true;
  desc.points = std::move(points);
  desc.total_mass = Real(0.05);
  desc.radius = radius;
  desc.drag_coefficient = Real(0);
  desc.pins = {};
  return desc;
}

/// A straight rope of `segments` segments.
RopeDesc straight(DVec3 from, DVec3 to, int segments, Real radius = Real(0.004)) {
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i)
    points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  return rope(std::move(points), radius);
}

ClothDesc pinned_sheet(int n, DVec3 at) {
  ClothDesc desc = sheet(n, at);
  desc.self_contact = false;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n * n); ++i) desc.pins.push_back({.point = i});
  return desc;
}

}  // namespace

TEST_SUITE("world/rope_surfaces") {
  TEST_CASE(
      "a rope that falls on a pinned cloth comes to rest on it, its radius and half a thickness above") {
    for (const int segments : {1, 5, 40}) {
      CAPTURE(segments);
      Room room;
      room.add(pinned_sheet(16, {0, 0, 0}));
      const RopeId id = room.add(straight({-0.1, 0.05, 0.013}, {0.11, 0.06, -0.07}, segments));
      const Run result = run(room, 240);
      CHECK(result.crossing == 0);
      CHECK(result.held_back == 0);
      const PointView x = room.world.positions(id);
      double least = 1, most = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        least = std::min(least, x[i].y);
        most = std::max(most, x[i].y);
      }
      CHECK(least == doctest::Approx(0.0065).epsilon(0.02));
      CHECK(most == doctest::Approx(0.0065).epsilon(0.02));
      CHECK(rms_of(room.world.velocities(id)) < 1e-3);
    }
  }

  namespace {

  /// Acceleration of a rope that slides down a pinned sheet of the given slope [rad], along it or across.
  double acceleration_of_slide(double slope, Real friction, bool across) {
    Room room;
    const DVec3 down = {std::cos(slope), -std::sin(slope), 0};
    const DVec3 normal = {std::sin(slope), std::cos(slope), 0};
    room.add(ramp(down, friction));
    const DVec3 start = 0.031 * down + 0.0066 * normal;
    RopeDesc moving = across ? straight(start + DVec3{0, 0, -0.067}, start + DVec3{0, 0, 0.071}, 7)
                             : straight(start, start + 0.2 * down + DVec3{0, 0, 0.05}, 11);
    moving.contact.friction = friction;
    const RopeId id = room.add(moving);
    constexpr int kFrames = 36;
    CHECK(run(room, kFrames).crossing == 0);
    return dot(down, mean_of(room.world.velocities(id))) / (kFrames / 60.0);
  }

  }  // namespace

  TEST_CASE(
      "a rope slides on a cloth as Coulomb's law says: g (sin a - mu cos a), without friction g sin a") {
    const double slope = 20.0 / 180 * std::numbers::pi;
    for (const bool across : {false, true}) {
      CAPTURE(across);
      CHECK(acceleration_of_slide(slope, Real(0), across) ==
            doctest::Approx(kGravity * std::sin(slope)).epsilon(0.01));
      const double held = kGravity * (std::sin(slope) - 0.3 * std::cos(slope));
      CHECK(acceleration_of_slide(slope, Real(0.3), across) == doctest::Approx(held).epsilon(0.03));
      CHECK(std::abs(acceleration_of_slide(slope, Real(0.375), across)) < 0.02);
    }
  }

  namespace {

  /// A world that takes one substep of 1/480 s a step, between which points move straight.
  Room room_of_substeps() {
    Room room;
    room.world = World::create({.substeps = 1, .workers = 1}).value();
    return room;
  }

  /// Steps one substep after the other. Returns how many lines passed each other.
  std::size_t passes_in(Room& room, int substeps) {
    std::size_t passes = 0;
    Surfaces before = surfaces_of(room);
    for (int i = 0; i < substeps; ++i) {
      CHECK(room.world.step(kFrame / Real(8)).healthy());
      const Surfaces after = surfaces_of(room);
      passes += count_passes(before, after);
      before = after;
    }
    return passes;
  }

  }  // namespace

  TEST_CASE("a rope without a radius is refused") {
    Room room;
    for (const Real radius : {Real(0), Real(-1)}) {
      const auto refused = room.world.add_rope(straight({0, 0, 0}, {1, 0, 0}, 4, radius));
      REQUIRE(!refused);
      CHECK(refused.error().where == "rope.radius");
    }
  }

  TEST_CASE("intersect: a rope that falls across a taut one hangs over it and does not pass") {
    Room room = room_of_substeps();
    RopeDesc lower = straight({-0.3, 0, 0}, {0.3, 0, 0}, 20);
    lower.pins = {{.point = 0}, {.point = 20}};
    RopeDesc upper = straight({0.002, 0.05, -0.2}, {-0.003, 0.05, 0.2}, 16);
    lower.air_friction = upper.air_friction = Real(0.1);  // Else its halves would swing for long.
    const RopeId below = room.add(lower);
    const RopeId above = room.add(upper);
    const double start = room.world.measure().energy.total();
    CHECK(passes_in(room, 8 * 300) == 0);
    // It hangs over the lower one, and trembles: what each of them bears is not known to the other's
    // solution.
    CHECK(mean_of(room.world.positions(above)).y > -0.15);
    CHECK(rms_of(room.world.velocities(above)) < 0.1);
    CHECK(std::abs(room.world.positions(below)[10].y) < 0.01);
    CHECK(room.world.measure().energy.total() < start);
  }

  TEST_CASE("intersect: ropes that meet in flight do not pass, keep their momentum and gain no energy") {
    for (const double speed : {1.0, 20.0}) {
      CAPTURE(speed);
      Room room = room_of_substeps();
      REQUIRE(room.world.set_gravity({}).has_value());
      for (const double side : {-1.0, 1.0}) {
        RopeDesc desc = straight({-0.2 * side, 0.03 * side, -0.1}, {0.2 * side, 0.03 * side, 0.1}, 15);
        desc.velocity = {Real(0), Real(-speed * side), Real(0.2)};
        room.add(desc);
      }
      const Measurement before = room.world.measure();
      CHECK(passes_in(room, 480) == 0);
      const Measurement after = room.world.measure();
      CHECK(length(after.momentum - before.momentum) < 1e-4 * 0.05 * speed);
      CHECK(after.energy.total() < before.energy.total());
    }
  }

  TEST_CASE("intersect: a heap of ropes on a cloth: none passes another or the cloth in 300 frames") {
    Room room = room_of_substeps();
    room.add(pinned_sheet(16, {0, 0, 0}));
    for (int i = 0; i < 10; ++i) {
      const double turn = 2.4 * i;
      const DVec3 along = {0.1 * std::cos(turn), 0, 0.1 * std::sin(turn)};
      const DVec3 middle = {0.01 * std::cos(3.0 * i), 0.02 + 0.015 * i, 0.01 * std::sin(3.0 * i)};
      RopeDesc desc = straight(middle - along, middle + along, 8);
      desc.air_friction = Real(0.02);
      room.add(desc);
    }
    std::size_t passes = 0;
    std::size_t crossing = 0;
    for (int i = 0; i < 300; ++i) {
      passes += passes_in(room, 8);
      crossing += count_crossings(surfaces_of(room)).crossing;
    }
    CHECK(passes == 0);
    CHECK(crossing == 0);
    for (std::size_t i = 1; i < room.surfaces.size(); ++i) {
      const RopeId id = std::get<RopeId>(room.surfaces[i]);
      CHECK(mean_of(room.world.positions(id)).y > 0.006);
      CHECK(rms_of(room.world.velocities(id)) < 0.05);
    }
  }

  TEST_CASE("intersect: a rope that falls on a jelly lies on it, and does not go in within 300 frames") {
    Room room;
    room.add_ground();
    SolidDesc jelly;
    jelly.cells = {4, 2, 4};
    jelly.size = {Real(0.2), Real(0.1), Real(0.2)};
    jelly.young_modulus = Real(2e4);
    jelly.thickness = Real(0.004);
    jelly.position = {0, 0.055, 0};
    room.add(jelly);
    RopeDesc desc = straight({-0.06, 0.14, 0.013}, {0.05, 0.16, -0.02}, 8);
    desc.air_friction = Real(0.05);
    const RopeId id = room.add(desc);
    const Run result = run(room, 300);
    CHECK(result.crossing == 0);
    CHECK(result.held_back == 0);
    const PointView x = room.world.positions(id);
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(x[i].y > 0.095);
      CHECK(x[i].y < 0.115);
    }
    CHECK(rms_of(room.world.velocities(id)) < 0.01);
  }

  TEST_CASE("ropes that both repel, or both touch ropes, are left to what they have for it") {
    const auto lowest_after = [](bool repels, bool filtered) {
      Room room;
      RopeDesc lower = straight({-0.1, 0, 0}, {0.1, 0, 0}, 10);
      lower.pins = {{.point = 0}, {.point = 10}};
      RopeDesc upper = straight({0.01, 0.012, -0.05}, {0.01, 0.012, 0.05}, 5);
      if (repels) lower.repulsion_strength = upper.repulsion_strength = Real(1e-12);
      if (filtered) lower.filter.mask = 2;
      room.add(lower);
      const RopeId id = room.add(upper);
      for (int i = 0; i < 30; ++i) room.world.step(kFrame);
      return mean_of(room.world.positions(id)).y;
    };
    CHECK(lowest_after(false, false) > -0.1);
    CHECK(lowest_after(true, false) < -0.5);
    CHECK(lowest_after(false, true) < -0.5);
  }

  TEST_CASE("a rope that is thrown at a cloth in flight keeps their momentum and gains no energy") {
    Room room;
    REQUIRE(room.world.set_gravity({}).has_value());
    room.add(sheet(12, {0, 0, 0}));
    RopeDesc thrown = straight({-0.2, 0.05, 0.01}, {0.2, 0.06, -0.03}, 16);
    thrown.velocity = {Real(0), Real(-5), Real(1)};
    room.add(thrown);
    const Measurement before = room.world.measure();
    const Run result = run(room, 60);
    CHECK(result.crossing == 0);
    const Measurement after = room.world.measure();
    CHECK(length(after.momentum - before.momentum) < 2e-3 * length(before.momentum));
    // The blow stretches the cloth, as one of a body does. Both fly on with a common velocity.
    CHECK(after.energy.kinetic < before.energy.kinetic);
    CHECK(after.energy.kinetic > 0.5 * dot(after.momentum, after.momentum) / (0.05 + 0.2 * 0.22 * 0.22));
  }

  namespace {

  /// Least distance of the points of a cloth and the segments of a rope.
  double gap_between(const World& world, ClothId cloth, RopeId id) {
    const PointView x = world.positions(cloth);
    const PointView line = world.positions(id);
    double least = 1;
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const DVec3 along = line[k + 1] - line[k];
        const double share = std::clamp(dot(x[i] - line[k], along) / dot(along, along), 0.0, 1.0);
        least = std::min(least, length(x[i] - line[k] - share * along));
      }
    }
    return least;
  }

  /// Steps for 5 s. Nothing crosses, and what moves and stands high never has more energy than at first.
  void check_calm(Room& room, ClothId cloth, RopeId id) {
    const auto energy = [&] {
      const Energy now = room.world.measure().energy;
      return now.kinetic + now.potential;
    };
    const double before = energy();
    for (int i = 0; i < 300; ++i) {
      const Run result = run(room, 1);
      REQUIRE(result.crossing == 0);
      REQUIRE(result.held_back == 0);
      REQUIRE(energy() < before + 1e-6);
    }
    // At bends edges touch, which keep 0.8 of the thickness.
    CHECK(gap_between(room.world, cloth, id) > 0.75 * 0.0065);
  }

  }  // namespace

  TEST_CASE("intersect: a cloth of ten times its mass hangs over a taut rope") {
    for (const Real stiffness : {kRigid, Real(1e4)}) {
      CAPTURE(stiffness);
      Room room;
      RopeDesc line = straight({-0.4, 0.5, 0.003}, {0.4, 0.5, 0.003}, 20);
      line.pins = {{.point = 0}, {.point = 20}};
      line.stiffness = stiffness;
      const ClothDesc cloth = sheet(20, {0, 0.52, 0});
      line.total_mass = Real(0.1) * cloth.areal_density * cloth.width * cloth.height;
      const RopeId id = room.add(line);
      const ClothId hung = room.add(cloth);
      check_calm(room, hung, id);
      CHECK(rms_of(room.world.velocities(hung)) < 0.1);
      CHECK(mean_of(room.world.positions(hung)).y > 0.35);
    }
  }

  TEST_CASE("intersect: a rope of ten times its mass lies in a cloth that hangs at its corners") {
    Room room;
    ClothDesc cloth = sheet(20, {0, 0.5, 0});
    for (const std::uint32_t i : {0U, 19U, 380U, 399U}) cloth.pins.push_back({.point = i});
    const ClothId id = room.add(cloth);
    RopeDesc heavy = straight({-0.15, 0.55, 0.01}, {0.15, 0.55, -0.02}, 12);
    heavy.total_mass = Real(10) * cloth.areal_density * cloth.width * cloth.height;
    const RopeId lying = room.add(heavy);
    check_calm(room, id, lying);
    CHECK(mean_of(room.world.positions(lying)).y > 0.35);
    CHECK(rms_of(room.world.velocities(lying)) < 0.3);
  }

  TEST_CASE("a rope that is cut into single points lies on the few cells of a cloth") {
    Room room;
    ClothDesc floor;
    floor.columns = floor.rows = 3;
    floor.width = floor.height = Real(0.4);
    floor.corner = {-0.2, 0, -0.2};
    floor.row_direction = {Real(0), Real(0), Real(1)};
    for (std::uint32_t i = 0; i < 9; ++i) floor.pins.push_back({i});
    room.add(floor);
    RopeDesc coil;
    coil.touches_surfaces = true;
    coil.total_mass = Real(0.05);
    coil.radius = Real(0.002);
    coil.pins.clear();
    constexpr int kPoints = 400;
    for (int i = 0; i < kPoints; ++i) {
      const double from_axis = 0.02 + 0.002 * std::sqrt(i);
      coil.points.push_back({from_axis * std::cos(2.4 * i), 0.02 + 5e-5 * i, from_axis * std::sin(2.4 * i)});
    }
    const RopeId rope = room.add(coil);
    std::size_t cut = 0;
    for (int i = 0; i + 1 < kPoints; ++i) {
      const PointView x = room.world.positions(rope);
      const DVec3 middle = 0.5 * (x[i] + x[i + 1]);
      const DVec3 side = 1e-4 * normalize(cross(x[i + 1] - x[i], DVec3{0, 1, 0}));
      const DVec3 down = {0, 1e-4, 0};
      const auto made = room.world.cut({.from = {middle - side + down, middle + side + down},
                                        .to = {middle - side - down, middle + side - down},
                                        .ropes = {rope}});
      REQUIRE(made);
      for (const RopeCut& one : made.value().ropes) cut += one.segments.size();
    }
    REQUIRE(cut == kPoints - 1);
    for (int i = 0; i < 120; ++i) CHECK(room.world.step(kFrame).healthy());
    const PointView x = room.world.positions(rope);
    double lowest = 1;
    for (std::size_t i = 0; i < x.size(); ++i) lowest = std::min(lowest, x[i].y);
    CHECK(lowest > 0);
  }

  namespace {

  /// Largest relative change of length of a segment of a rope whose segments are equally long.
  double largest_stretch(const World& world, RopeId id, double rest) {
    const PointView x = world.positions(id);
    double most = 0;
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
      most = std::max(most, std::abs(length(x[i + 1] - x[i]) / rest - 1));
    return most;
  }

  /// Adds a box that is hooked to a point of a rope, its center at the hook.
  BodyId hang(Room& room, RopeId rope, std::uint32_t at, double mass) {
    const DVec3 place = room.world.positions(rope)[at];
    BodyDesc box = {.kind = BodyKind::kDynamic};
    box.shape = Shape::box({Real(0.05), Real(0.05), Real(0.05)});
    box.mass = static_cast<Real>(mass);
    box.position = place;
    const auto body = room.world.add_body(box);
    REQUIRE(body);
    HookDesc hook;
    hook.a.body = body.value();
    hook.b.point = point(rope, at);
    hook.anchor = place;
    REQUIRE(room.world.add_hook(hook));
    return body.value();
  }

  }  // namespace

  TEST_CASE("intersect: a rope that bears a body is not stretched by a rope that is thrown at it") {
    for (const double speed : {1.0, 5.0}) {
      CAPTURE(speed);
      Room room;
      RopeDesc line = straight({0, 1, 0}, {0, 0.2, 0}, 20);
      line.pins = {{.point = 0}};
      const RopeId taut = room.add(line);
      hang(room, taut, 20, 5);
      RopeDesc light = straight({0.03, 0.61, -0.1}, {0.03, 0.63, 0.1}, 10);
      light.velocity = {static_cast<Real>(-speed), 0, 0};
      room.add(light);
      const double before = room.world.measure().energy.total();
      double most = 0;
      for (int i = 0; i < 60; ++i) {
        CHECK(run(room, 1).held_back == 0);
        most = std::max(most, largest_stretch(room.world, taut, 0.04));
        CHECK(room.world.measure().energy.total() < before + 1e-3);
      }
      CHECK(most < 0.005);
    }
  }

  TEST_CASE("filters keep a rope from a cloth") {
    const auto height_after = [](FilterDesc filter) {
      Room room;
      ClothDesc base = pinned_sheet(8, {0, 0, 0});
      base.filter.group = filter.group;
      room.add(base);
      RopeDesc falling = straight({-0.06, 0.01, 0.01}, {0.06, 0.01, 0.01}, 6);
      falling.filter = filter;
      const RopeId id = room.add(falling);
      for (int i = 0; i < 30; ++i) room.world.step(kFrame);
      return mean_of(room.world.positions(id)).y;
    };
    CHECK(height_after({}) > 0.006);
    CHECK(height_after({.mask = 2}) < -0.5);
    CHECK(height_after({.group = -3}) < -0.5);
    CHECK(height_after({.mask = 2, .group = 3}) > 0.006);
  }

  TEST_CASE("a closed rope, which is solved in a coupled group, lies on a cloth as others do") {
    Room room;
    room.add(pinned_sheet(16, {0, 0, 0}));
    std::vector<DVec3> points;
    for (int i = 0; i <= 20; ++i) {
      const double turn = 2 * std::numbers::pi * i / 20.5;
      points.push_back({0.08 * std::cos(turn), 0.03, 0.08 * std::sin(turn)});
    }
    points.back() = points.front() + DVec3{1e-5, 0, 0};
    RopeDesc desc = rope(points);
    desc.air_friction = Real(0.05);
    const RopeId id = room.add(desc);
    HookDesc hook;
    hook.a.point = point(id, 0);
    hook.b.point = point(id, 20);
    hook.anchor = points.front();
    const auto added = room.world.add_hook(hook);
    REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
    const Run result = run(room, 240);
    CHECK(result.crossing == 0);
    CHECK(result.held_back == 0);
    const PointView x = room.world.positions(id);
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i].y == doctest::Approx(0.0065).epsilon(0.05));
    CHECK(rms_of(room.world.velocities(id)) < 0.01);
  }

  TEST_CASE("intersect: a rope that is turned with the world and its gravity falls on a cloth the same way") {
    const auto heights = [](bool turned) {
      // Around z by a quarter: x becomes y, and y becomes -x.
      const auto turn = [&](DVec3 p) { return turned ? DVec3{-p.y, p.x, p.z} : p; };
      Room room;
      REQUIRE(room.world.set_gravity(vector_cast<Real>(turn({0, -kGravity, 0}))).has_value());
      ClothDesc base = pinned_sheet(16, {0, 0, 0});
      base.corner = turn(base.corner);
      base.column_direction = vector_cast<Real>(turn({1, 0, 0}));
      room.add(base);
      std::vector<DVec3> points;
      for (int i = 0; i <= 12; ++i)
        points.push_back(turn({-0.1 + 0.017 * i, 0.03 + 0.001 * i, 0.013 - 0.004 * i}));
      const RopeId id = room.add(rope(points));
      CHECK(run(room, 60).crossing == 0);
      std::vector<double> found;
      const PointView x = room.world.positions(id);
      for (std::size_t i = 0; i < x.size(); ++i) found.push_back(turned ? -x[i].x : x[i].y);
      return found;
    };
    const std::vector<double> upright = heights(false);
    const std::vector<double> turned = heights(true);
    for (std::size_t i = 0; i < upright.size(); ++i)
      CHECK(turned[i] == doctest::Approx(upright[i]).epsilon(1e-3));
  }

  TEST_CASE("a rope that is sewn to a cloth, or tied to a point of it, is not pushed off") {
    for (const std::uint32_t hooks : {1U, 8U}) {
      Room room;
      REQUIRE(room.world.set_gravity({}).has_value());
      const ClothId cloth = room.add(sheet(8, {0, 0, 0}));
      std::vector<DVec3> border;
      for (std::size_t i = 0; i < 8; ++i) border.push_back(room.world.positions(cloth)[i]);
      // Along the border and finer than it, or from its first point away.
      const RopeId id = room.add(hooks > 1 ? straight(border[0], border[7], 28)
                                           : straight(border[0], border[0] + DVec3{0, 0.1, 0}, 10));
      for (std::uint32_t i = 0; i < hooks; ++i) {
        HookDesc hook;
        hook.a.point = point(id, 4 * i);
        hook.b.point = point(cloth, i);
        hook.anchor = border[i];
        const auto added = room.world.add_hook(hook);
        REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
      }
      CHECK(run(room, 30).held_back == 0);
      CHECK(rms_of(room.world.velocities(id)) < 1e-4);
      CHECK(rms_of(room.world.velocities(cloth)) < 1e-4);
    }
  }

  namespace {

  /// Two ropes fall on a sheet that hangs over a taut one, and slide off.
  Room ropes_and_sheet(int workers, bool ropes_first) {
    Room room;
    room.world = World::create({.substeps = 8, .workers = workers}).value();
    RopeDesc line = straight({-0.4, 0.5, 0.003}, {0.4, 0.5, 0.003}, 20);
    line.pins = {{.point = 0}, {.point = 20}};
    const std::array ropes = {line, straight({-0.1, 0.56, -0.1}, {0.1, 0.57, 0.05}, 9),
                              straight({-0.1, 0.54, 0.1}, {0.1, 0.59, 0.02}, 14)};
    if (!ropes_first) room.add(sheet(14, {0, 0.52, 0}));
    for (const RopeDesc& desc : ropes) room.add(desc);
    if (ropes_first) room.add(sheet(14, {0, 0.52, 0}));
    return room;
  }

  }  // namespace

  TEST_CASE(
      "intersect: ropes on a sheet over a rope cross it in none of 300 frames, whoever was added first") {
    for (const bool ropes_first : {false, true}) {
      Room room = ropes_and_sheet(1, ropes_first);
      const Run result = run(room, 300);
      CHECK(result.crossing == 0);
      CHECK(result.held_back < 100);  // Of 243 points in 2400 substeps.
    }
  }

  TEST_CASE(
      "ropes in contact go on from a snapshot, with every instruction set and workers, with the same bits") {
    std::uint64_t expected = 0;
    for (const std::string& set : instruction_sets()) {
      REQUIRE(use_instruction_set(set));
      Room room = ropes_and_sheet(1, true);
      run(room, 25);
      const Snapshot snapshot = room.world.snapshot();
      run(room, 25);
      const std::uint64_t hash = room.world.state_hash();
      if (expected == 0) expected = hash;
      CHECK_MESSAGE(hash == expected, set);
      REQUIRE(room.world.restore(snapshot));
      run(room, 25);
      CHECK(room.world.state_hash() == expected);
    }
    REQUIRE(use_instruction_set("").has_value());
    Room room = ropes_and_sheet(3, true);
    run(room, 50);
    CHECK(room.world.state_hash() == expected);
  }
}

}  // namespace hooke
