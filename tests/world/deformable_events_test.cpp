#include "world/surface_room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <utility>
#include <vector>

/// What deformables tell of their contacts: when they begin and end, how hard things meet, and which forces
/// they give each other.

namespace hooke {
namespace {

constexpr double kGravity = 9.81;  // As WorldDesc has it [m/s^2].

BodyId add_floor(Room& room, bool reports = false) {
  BodyDesc desc;
  desc.kind = BodyKind::kStatic;
  desc.shape = Shape::half_space();
  desc.reports_contacts = reports;
  return room.world.add_body(desc).value();
}

SolidDesc jelly(DVec3 at) {
  SolidDesc desc = soft_cube(at, Real(0.2), 3);
  desc.young_modulus = Real(5e4);
  desc.thickness = Real(0.004);
  return desc;
}

/// Whether a figure is that expected, but for this share of it.
bool is_near(double figure, double expected, double share) {
  return std::abs(figure - expected) <= share * std::abs(expected);
}

/// All events of deformables in some steps, each with its step.
struct Log {
  std::vector<std::pair<int, DeformableContactEvent>> begins, ends;
  std::vector<std::pair<int, DeformableHitEvent>> hits;

  void watch(World& world, int steps) {
    for (int i = 0; i < steps; ++i) {
      REQUIRE(world.step(kFrame).healthy());
      const auto step = static_cast<int>(world.step_count());
      for (const auto& e : world.events().deformable_begins) begins.emplace_back(step, e);
      for (const auto& e : world.events().deformable_ends) ends.emplace_back(step, e);
      for (const auto& e : world.events().deformable_hits) hits.emplace_back(step, e);
    }
  }

  [[nodiscard]] std::vector<double> figures() const {
    std::vector<double> all;
    for (const auto* list : {&begins, &ends}) {
      for (const auto& [step, e] : *list) {
        for (const double x : {double(step), double(e.a.slot), double(e.b.slot), double(e.body.slot)})
          all.push_back(x);
      }
    }
    for (const auto& [step, e] : hits) {
      for (const double x : {double(step), double(e.a.slot), double(e.b.slot), double(e.body.slot), e.point.x,
                             e.point.y, double(e.normal.y), double(e.speed), double(e.impulse)})
        all.push_back(x);
    }
    return all;
  }
};

/// A sheet without air, that falls from `height` [m] above the ground.
ClothDesc falling(double height) {
  ClothDesc desc = sheet(11, {0, height, 0});
  desc.self_contact = false;
  return desc;
}

/// Sheets, a jelly, a rope and a ball that fall on each other.
Room make_heap(int workers) {
  Room room;
  REQUIRE(room.world.set_workers(workers));
  add_floor(room, true);
  for (int i = 0; i < 3; ++i) {
    ClothDesc cloth = sheet(15, {0.01 * i, 0.25 + 0.02 * i, 0});
    cloth.hit_speed = Real(0.2);
    cloth.reports_contacts = i != 1;
    room.add(cloth);
  }
  SolidDesc solid = jelly({0, 0.11, 0});
  solid.hit_speed = Real(0.1);
  room.add(solid);
  RopeDesc rope;
  rope.hook_point = {-0.15, 0.35, 0.01};
  rope.direction = {Real(1), Real(0), Real(0)};
  rope.length_at_rest = Real(0.3);
  rope.total_mass = Real(0.05);
  rope.pins = {};
  rope.touches_surfaces = true;
  rope.reports_contacts = true;
  room.add(rope);
  BodyDesc ball;
  ball.shape = Shape::sphere(Real(0.04));
  ball.mass = Real(0.1);
  ball.position = {0.02, 0.42, 0};
  ball.hit_speed = Real(0.5);
  REQUIRE(room.world.add_body(ball));
  return room;
}

}  // namespace

TEST_SUITE("world/deformable_events") {
  TEST_CASE("a sheet that falls begins to touch the ground once, at the time of free fall") {
    Room room;
    const BodyId floor = add_floor(room);
    ClothDesc desc = falling(1.0);
    desc.reports_contacts = true;
    const ClothId cloth = room.add(desc);
    room.add(sheet(5, {3, 0.3, 0}));  // It falls, too, and does not ask.
    Log log;
    log.watch(room.world, 120);
    REQUIRE(log.begins.size() == 1);
    CHECK(log.begins[0].second == DeformableContactEvent{point(cloth, 0), {}, floor});
    // It falls 1 m less half of its thickness in sqrt(2 s / g), 27 steps.
    const double steps = std::sqrt(2 * 0.9975 / kGravity) * 60;
    CHECK(std::abs(log.begins[0].first - steps) < 1.5);
    CHECK(log.ends.empty());
    CHECK(log.hits.empty());
  }

  TEST_CASE("a contact ends when the sheet is thrown off, and a sheet that is removed ends its contacts") {
    Room room;
    const BodyId floor = add_floor(room, true);
    const ClothId cloth = room.add(falling(0.01));
    Log log;
    log.watch(room.world, 30);
    CHECK(log.begins.size() == 1);
    for (std::uint32_t i = 0; i < 121; ++i)
      REQUIRE(room.world.set_velocity(point(cloth, i), {Real(0), Real(2), Real(0)}));
    log.watch(room.world, 3);
    REQUIRE(log.ends.size() == 1);
    CHECK(log.ends[0].second == DeformableContactEvent{point(cloth, 0), {}, floor});
    log.watch(room.world, 60);
    CHECK(log.begins.size() == 2);
    CHECK(room.world.remove(cloth));
    log.watch(room.world, 1);
    REQUIRE(log.ends.size() == 2);
    CHECK(log.ends[1].second.a == point(cloth, 0));
  }

  TEST_CASE(
      "a sheet hits the ground at sqrt(2 g s), with half of its mass times that at least as the impulse") {
    Room room;
    const BodyId floor = add_floor(room);
    ClothDesc desc = falling(0.5);
    desc.hit_speed = Real(0.5);
    const ClothId cloth = room.add(desc);
    Log log;
    log.watch(room.world, 60);
    REQUIRE(!log.hits.empty());
    const DeformableHitEvent& hit = log.hits[0].second;
    const double speed = std::sqrt(2 * kGravity * 0.4975);
    CHECK(hit.a == point(cloth, 0));
    CHECK(hit.body == floor);
    CHECK(is_near(static_cast<double>(hit.speed), speed, 0.01));
    CHECK(static_cast<double>(hit.normal.y) == doctest::Approx(-1));
    const double mass = static_cast<double>(room.world.mass(cloth));
    // A sheet is stopped within two particle substeps: the first one takes it to the ground, the second one
    // the rest of its speed. The harder one has half of the impulse or more.
    CHECK(static_cast<double>(hit.impulse) > 0.49 * mass * speed);
    CHECK(static_cast<double>(hit.impulse) < 1.01 * mass * speed);
    CHECK(std::abs(hit.point.y - 0.0025) < 0.01);
    CHECK(log.begins.empty());  // It asked for hits alone.
  }

  TEST_CASE("two sheets that fly at each other at 3 m/s hit once, and a slower pair is not told") {
    Room room;
    room.world = World::create({.gravity = {}, .substeps = 8, .workers = 1}).value();
    ClothDesc low = falling(0);
    low.velocity = {Real(0), Real(1), Real(0)};
    low.hit_speed = Real(2);
    const ClothId first = room.add(low);
    ClothDesc high = falling(0.1);
    high.velocity = {Real(0), Real(-2), Real(0)};
    high.reports_contacts = true;
    const ClothId second = room.add(high);
    ClothDesc slow = falling(0.1);
    slow.corner.x += 1;
    slow.hit_speed = Real(2);
    slow.velocity = {Real(0), Real(-1), Real(0)};
    room.add(slow);
    ClothDesc still = falling(0);
    still.corner.x += 1;
    room.add(still);
    Log log;
    log.watch(room.world, 30);
    REQUIRE(log.hits.size() >= 1);
    const DeformableHitEvent& hit = log.hits[0].second;
    CHECK(hit.a == point(first, 0));
    CHECK(hit.b == point(second, 0));
    CHECK(is_near(static_cast<double>(hit.speed), 3, 0.02));
    CHECK(is_near(static_cast<double>(hit.normal.y), 1, 0.02));
    for (const auto& [step, one] : log.hits) CHECK(one.a == point(first, 0));
    REQUIRE(log.begins.size() >= 1);
    CHECK(log.begins[0].second == DeformableContactEvent{point(first, 0), point(second, 0), {}});
  }

  TEST_CASE("a strip that folds on itself begins to touch itself") {
    Room room;
    add_floor(room);
    ClothDesc strip = sheet(3, {});
    strip.columns = 41;
    strip.width = Real(40) * kEdge;
    strip.corner = {0, 0.05, 0};
    strip.column_direction = {Real(0.2), Real(1), Real(0)};
    strip.reports_contacts = true;
    const ClothId cloth = room.add(strip);
    Log log;
    log.watch(room.world, 90);
    const auto touches_itself = [&](const auto& e) {
      return e.second.a == point(cloth, 0) && e.second.b == point(cloth, 0) && !e.second.body;
    };
    CHECK(std::any_of(log.begins.begin(), log.begins.end(), touches_itself));
  }

  TEST_CASE("a sheet on the ground, a jelly and a rope press with their weights to 0.5 %") {
    Room room;
    const BodyId floor = add_floor(room, true);
    const ClothId cloth = room.add(falling(0.005));
    SolidDesc solid = jelly({1, 0.105, 0});
    solid.damping = Real(0.05);
    const SolidId block = room.add(solid);
    RopeDesc desc;
    desc.hook_point = {-1, 0.01, 0};
    desc.length_at_rest = Real(0.5);
    desc.total_mass = Real(0.2);
    desc.pins = {};
    const RopeId rope = room.add(desc);
    for (int i = 0; i < 240; ++i) room.world.step(kFrame);
    const std::vector<DeformableContact> all = room.world.deformable_contacts(floor);
    REQUIRE(all.size() == 3);
    double sum = 0;
    for (const auto& [of, mass] : {std::pair(point(cloth, 0), room.world.mass(cloth)),
                                   std::pair(point(block, 0), room.world.mass(block)),
                                   std::pair(point(rope, 0), room.world.mass(rope))}) {
      const std::vector<DeformableContact> own = room.world.deformable_contacts(of);
      REQUIRE(own.size() == 1);
      const double weight = static_cast<double>(mass) * kGravity;
      CHECK(is_near(static_cast<double>(own[0].force.y), weight, 0.005));
      CHECK(is_near(static_cast<double>(own[0].normal_force), weight, 0.005));
      sum += static_cast<double>(own[0].force.y);
    }
    CHECK(sum > 0);
    // The points of the sheet carry it together.
    double of_points = 0;
    for (std::uint32_t i = 0; i < 121; ++i)
      of_points += static_cast<double>(room.world.contact_force(point(cloth, i)).y);
    CHECK(is_near(of_points, static_cast<double>(room.world.mass(cloth)) * kGravity, 0.005));
  }

  TEST_CASE("a sheet that lies on a pinned one presses with its weight, and friction holds it on a slope") {
    Room room;
    ClothDesc upper = sheet(11, {0, 0.006, 0});
    upper.self_contact = false;
    upper.reports_contacts = true;
    ClothDesc lower = sheet(21, {});
    lower.self_contact = false;
    for (std::uint32_t i = 0; i < 441; ++i) lower.pins.push_back({.point = i});
    const ClothId held = room.add(lower);
    const ClothId lies = room.add(upper);
    for (int i = 0; i < 240; ++i) room.world.step(kFrame);
    const std::vector<DeformableContact> all = room.world.deformable_contacts();
    REQUIRE(all.size() == 1);
    CHECK(all[0].a == point(held, 0));
    CHECK(all[0].b == point(lies, 0));
    const double weight = static_cast<double>(room.world.mass(lies)) * kGravity;
    CHECK(is_near(static_cast<double>(all[0].force.y), -weight, 0.005));
    CHECK(std::abs(all[0].point.y) < 0.005);
  }

  TEST_CASE(
      "measure tells by how much sheets are nearer than their thickness, and none once they are apart") {
    Room room;
    room.world = World::create({.gravity = {}, .substeps = 8, .workers = 1}).value();
    CHECK(room.world.measure().largest_surface_overlap == 0);
    ClothDesc low = falling(0);
    for (std::uint32_t i = 0; i < 121; ++i) low.pins.push_back({.point = i});
    room.add(low);
    ClothDesc high = low;                                    // 3 mm above it; they keep 5 mm.
    high.corner = high.corner + DVec3{0.006, 0.003, 0.004};  // Its points are over faces, not over points.
    const ClothId upper = room.add(high);
    CHECK(room.world.step(kFrame).held_back_share == 0);
    CHECK(is_near(room.world.measure().largest_surface_overlap, 0.002, 0.01));
    const Snapshot then = room.world.snapshot();
    REQUIRE(room.world.restore(then));
    CHECK(room.world.measure().largest_surface_overlap == 0);  // Contacts are found in steps.
    for (std::uint32_t i = 0; i < 121; ++i) REQUIRE(room.world.unpin(point(upper, i)));
    for (int i = 0; i < 60; ++i) room.world.step(kFrame);
    CHECK(room.world.measure().largest_surface_overlap < 1e-5);
  }

  TEST_CASE("the share of points that are held back is their number over points and substeps") {
    Room room;
    // Pinned sheets that are driven through each other by their pins: nothing can give way.
    std::uint32_t vertices = 0;
    for (const int way : {-1, 1}) {
      ClothDesc desc = falling(way * -0.01);
      for (std::uint32_t i = 0; i < 121; ++i) {
        desc.pins.push_back({.point = i,
                             .motion = {.kind = MotionDesc::Kind::kConstantVelocity,
                                        .velocity = {Real(0), Real(way), Real(0)}}});
      }
      room.add(desc);
      vertices += 121;
    }
    double largest = 0;
    for (int i = 0; i < 10; ++i) {
      const StepReport report = room.world.step(kFrame);
      CHECK(report.held_back_share == doctest::Approx(report.points_held_back / (8.0 * vertices)));
      CHECK(report.held_back_share <= 1);
      largest = std::max(largest, report.held_back_share);
    }
    CHECK(largest > 0);
  }

  TEST_CASE("events have the same bits for any workers, and after restore begins are not told twice") {
    Log one, three;
    Room first = make_heap(1);
    Room second = make_heap(3);
    one.watch(first.world, 60);
    three.watch(second.world, 60);
    CHECK(one.begins.size() > 3);
    CHECK(one.hits.size() > 1);
    CHECK(one.figures() == three.figures());
    const Snapshot then = first.world.snapshot();
    Log before, after;
    before.watch(first.world, 30);
    REQUIRE(first.world.restore(then));
    CHECK(first.world.events().deformable_begins.empty());
    CHECK(first.world.deformable_contacts().empty());
    after.watch(first.world, 30);
    CHECK(before.figures() == after.figures());
    CHECK(first.world.state_hash() != 0);
  }

  TEST_CASE("asking changes no bit, and who does not ask is told nothing") {
    std::vector<DVec3> places;
    for (const bool asks : {false, true}) {
      Room room;
      add_floor(room);
      ClothDesc low = sheet(15, {0, 0.05, 0});
      low.reports_contacts = asks;
      const ClothId cloth = room.add(low);
      room.add(sheet(15, {0.01, 0.08, 0}));
      Log log;
      log.watch(room.world, 60);
      CHECK(log.begins.empty() == !asks);
      CHECK(room.world.deformable_contacts().empty() == !asks);
      const PointView points = room.world.positions(cloth);
      for (std::size_t i = 0; i < points.size(); ++i) places.push_back(points[i]);
    }
    const std::size_t half = places.size() / 2;
    CHECK(std::equal(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half),
                     places.begin() + static_cast<std::ptrdiff_t>(half)));
  }
}

}  // namespace hooke
