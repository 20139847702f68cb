/// What a scene becomes does not depend on how the host's processor is set to round, nor on the instructions
/// that steps use; and the hash sees all that later bits depend upon.

#include "hooke/machine.h"

#include "world/make.h"

#include <cfenv>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace hooke {

using namespace test;

namespace {

constexpr Real kDt = Real(1) / Real(60);

struct Fair {
  World world;
  BodyId box = {}, wheel = {};
  RopeId rope = {};
  ClothId flag = {};
  SolidId jelly = {};
  HookId hinge = {};
};

/// What the test itself computes would be rounded as the host does: these are given.
const std::pair<DVec3, Quat> kBoxes[] = {
    {{0, 0.3, 0}, {}},
    {{0.1, 0.71, 0.07}, {Real(0.02), Real(0.04), Real(0.01), Real(0.99)}},
    {{0.2, 1.12, 0.14}, {Real(0.04), Real(0.09), Real(0.01), Real(0.97)}},
};

/// Boxes, a wheel on a hinge, a rope with a load, a flag in gusts, jelly; with numbers that are not exact.
Fair make_fair() {
  WorldDesc desc;
  desc.wind = {.velocity = {Real(4.3), 0, Real(0.7)}, .gust = Real(0.4), .side_gust = Real(0.3)};
  Fair f{.world = make_world(desc)};
  World& w = f.world;
  take(w.add_body({.shape = Shape::half_space()}));
  for (const auto& [place, turn] : kBoxes) {
    f.box = take(w.add_body({.kind = BodyKind::kDynamic,
                             .shape = Shape::box({Real(0.31), Real(0.17), Real(0.23)}),
                             .position = place,
                             .rotation = turn}));
  }
  f.wheel = take(w.add_body({.kind = BodyKind::kDynamic,
                             .shape = Shape::cylinder(Real(0.4), Real(0.1)),
                             .position = {2.1, 1.3, 0},
                             .angular_velocity = {0, Real(2.7), 0}}));
  f.hinge = take(w.add_hook({.kind = HookKind::kHinge, .a = {.body = f.wheel}, .anchor = {2.1, 1.3, 0}}));
  f.rope = take(w.add_rope({.hook_point = {-2, 3.1, 0},
                            .total_mass = Real(0.37),
                            .masses = 11,
                            .length_at_rest = Real(1.3),
                            .stiffness = Real(3e3),
                            .bend_stiffness = Real(0.003)}));
  f.flag = take(w.add_cloth({.columns = 7, .rows = 6, .corner = {-1, 3, 1}, .pins = {{0}, {35}}}));
  f.jelly = take(w.add_solid({.cells = {2, 2, 2},
                              .size = {Real(0.4), Real(0.5), Real(0.3)},
                              .position = {1, 1.7, 1},
                              .young_modulus = Real(2.3e4)}));
  take(w.add_hook({.kind = HookKind::kBall,
                   .a = {.point = point(f.rope, 10)},
                   .b = {.point = point(f.jelly, PointRef::kNearest)}}));
  return f;
}

/// Everything between: built, changed, stepped and asked; the hash at several times.
std::vector<std::uint64_t> life() {
  std::vector<std::uint64_t> hashes;
  Fair f = make_fair();
  World& w = f.world;
  hashes.push_back(w.state_hash());
  for (int i = 0; i < 20; ++i) {
    CHECK(w.apply_impulse(f.box, {Real(0.13), Real(0.11), 0}, {0.3, 0.9, 0.1}).has_value());
    CHECK(w.apply_force(f.wheel, {Real(0.7), 0, 0}, {2.3, 1.37, 0.1}).has_value());
    CHECK(w.step(kDt).healthy());
    const Result<std::optional<CastHit>> hit = w.cast_ray({0.03, 5, 0.01}, {0.1, -9, 0.2});
    REQUIRE(hit.has_value());
    REQUIRE(hit.value().has_value());
    CHECK(w.set_pose(f.box, {{0.1, 2.9, (*hit)->point.y}, {Real(0.1), Real(0.2), 0, 1}}).has_value());
    CHECK(w.set_angular_velocity(f.box, {Real(0.3), Real(0.7), Real(1.1)}).has_value());
    hashes.push_back(w.state_hash());
  }
  return hashes;
}

}  // namespace

TEST_SUITE("world/same_bits") {
  TEST_CASE("steps give the same bits however the host rounds") {
    const std::vector<std::uint64_t> expected = life();
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      REQUIRE(std::fesetround(mode) == 0);
      const std::vector<std::uint64_t> got = life();
      const int after = std::fegetround();
      std::fesetround(FE_TONEAREST);
      CHECK(got == expected);
      CHECK(after == mode);  // the host has its own again
    }
  }

#ifdef __SSE2__
  TEST_CASE("steps give the same bits where the host flushes denormals") {
    const std::vector<std::uint64_t> expected = life();
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040);  // FTZ and DAZ
    const std::vector<std::uint64_t> got = life();
    const unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    CHECK(got == expected);
    CHECK((after & 0x8040) == 0x8040);
  }
#endif

  TEST_CASE("steps give the same bits with each instruction set of the machine") {
    const std::vector<std::uint64_t> expected = life();
    const std::vector<std::string> sets = instruction_sets();
    REQUIRE_FALSE(sets.empty());
    CHECK(sets.front() == "scalar");
    CHECK(std::set<std::string>(sets.begin(), sets.end()).size() == sets.size());
    for (const std::string& set : sets) {
      REQUIRE(use_instruction_set(set).has_value());
      CHECK_MESSAGE(life() == expected, set);
    }
    const Result<void> wrong = use_instruction_set("abacus");
    REQUIRE_FALSE(wrong.has_value());
    CHECK(wrong.error().message.find("'abacus'") != std::string::npos);
    CHECK(wrong.error().message.find(sets.back()) != std::string::npos);
    CHECK(use_instruction_set("").has_value());
  }

  TEST_CASE("the hash covers everything that acts") {
    const std::vector<std::pair<const char*, std::function<void(Fair&)>>> changes = {
        {"gravity",
         [](Fair& f) {
           CHECK(f.world.set_gravity({0, Real(-9.82), 0}).has_value());
         }},
        {"wind",
         [](Fair& f) {
           CHECK(f.world.set_wind({.velocity = {Real(4.3), 0, Real(0.71)}}).has_value());
         }},
        {"force",
         [](Fair& f) {
           CHECK(f.world.apply_force(f.box, {Real(1e-3), 0, 0}).has_value());
         }},
        {"torque",
         [](Fair& f) {
           CHECK(f.world.apply_torque(f.box, {Real(1e-3), 0, 0}).has_value());
         }},
        {"force on a point",
         [](Fair& f) {
           CHECK(f.world.apply_force(point(f.rope, 3), {Real(1e-3), 0, 0}).has_value());
         }},
        {"motor",
         [](Fair& f) {
           CHECK(f.world.set_motor(f.hinge, {1, 1}).has_value());
         }},
        {"spring",
         [](Fair& f) {
           CHECK(f.world.set_spring(f.hinge, {1, 1}).has_value());
         }},
        {"pin", [](Fair& f) { CHECK(f.world.pin(point(f.rope, 3)).has_value()); }},
        {"unpin", [](Fair& f) { CHECK(f.world.unpin(point(f.flag, 35)).has_value()); }},
        {"field",
         [](Fair& f) {
           take(f.world.add_field({.vector = {Real(1e-3), 0, 0}}));
         }},
        {"law", [](Fair& f) { take(f.world.add_force_law(BodyForceLaw([](BodyForceView&) {}))); }},
        {"body",
         [](Fair& f) {
           take(f.world.add_body({.shape = Shape::sphere(1), .position = {99, 0, 0}}));
         }},
        {"hook",
         [](Fair& f) {
           take(f.world.add_hook({.a = {.body = f.box}, .anchor = {0, 9, 0}}));
         }},
    };
    for (const auto& [name, change] : changes) {
      Fair changed = make_fair();
      const std::uint64_t before = changed.world.state_hash();
      change(changed);
      CHECK_MESSAGE(changed.world.state_hash() != before, name);
    }
  }

  TEST_CASE("the hash covers the properties of bodies and of the world") {
    const BodyDesc plain = {
        .kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.5)), .position = {0, 9, 0}};
    const auto hash_with = [](const WorldDesc& desc, const BodyDesc& body) {
      World world = make_world(desc);
      take(world.add_body(body));
      return world.state_hash();
    };
    const std::uint64_t expected = hash_with({}, plain);
    CHECK(hash_with({}, plain) == expected);
    CHECK(hash_with({.workers = 3}, plain) == expected);
    const std::vector<std::function<void(BodyDesc&)>> changes = {
        [](BodyDesc& b) { b.mass = Real(7); },
        [](BodyDesc& b) { b.density = Real(999); },
        [](BodyDesc& b) { b.shape.radius = Real(0.51); },
        [](BodyDesc& b) { b.linear_damping = Real(0.1); },
        [](BodyDesc& b) { b.gravity_scale = Real(0.9); },
        [](BodyDesc& b) { b.contact.friction = Real(0.4); },
        [](BodyDesc& b) { b.contact.restitution = Real(0.1); },
        [](BodyDesc& b) { b.contact.static_friction = Real(0.9); },
        [](BodyDesc& b) { b.filter.mask = 3; },
        [](BodyDesc& b) { b.bullet = true; },
        [](BodyDesc& b) { b.can_sleep = false; },
        [](BodyDesc& b) { b.drag_coefficient = 1; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
      BodyDesc body = plain;
      changes[i](body);
      CHECK_MESSAGE(hash_with({}, body) != expected, i);
    }
    CHECK(hash_with({.substeps = 9}, plain) != expected);
    CHECK(hash_with({.materials = {{.a = 1, .b = 2}}}, plain) != expected);
    CHECK(hash_with({.sleeping = false}, plain) != expected);
  }
}

}  // namespace hooke
