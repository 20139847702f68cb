/// Ropes where they have gone wrong in other engines: over edges, on what sleeps or goes away, in bridges
/// that break, and ten thousand segments long.

#include "hooke/geometry.h"

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

BodyId add_box(World& world, DVec3 position, double mass, Vec3 half) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::box(half),
                              .position = position,
                              .mass = static_cast<Real>(mass)}));
}

std::vector<DVec3> line(DVec3 from, DVec3 to, int segments) {
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i)
    points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  return points;
}

/// Squares of 10 cm over 3 m, whose corners lie up to 2.5 cm over or under y = 0.
void add_rough_ground(World& world, std::uint32_t seed, double friction) {
  constexpr int kPerSide = 31;
  std::vector<Real> heights;
  std::uint32_t state = 77 * seed + 1;
  for (int i = 0; i < kPerSide * kPerSide; ++i) {
    state = state * 1664525U + 1013904223U;
    heights.push_back(Real(0.05) *
                      (static_cast<Real>(state >> 8U) / static_cast<Real>(1U << 24U) - Real(0.5)));
  }
  const MeshDesc ground = take(make_height_field(kPerSide, kPerSide, Real(0.1), heights));
  take(world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(ground))),
                       .position = {-1.5, 0, -1.5},
                       .contact = {.friction = static_cast<Real>(friction)}}));
}

/// D-19: a rope of 40 segments of 2 cm and 2 cm thick over a beam with sharp edges, 10 kg at one end.
struct Beam {
  static constexpr double kRadius = 0.02, kSegment = 0.02, kHalfWidth = 0.14, kFriction = 0.3;
  World world;
  RopeId rope;
  BodyId light, heavy;

  static WorldDesc fine() {
    WorldDesc desc = without_air();
    desc.particle_substeps = 4;
    desc.sleeping = false;
    return desc;
  }

  explicit Beam(double load) : world(make_world(fine())) {
    take(world.add_body({.shape = Shape::box({Real(kHalfWidth), Real(0.05), 1}),
                         .position = {0, -0.05, 0},
                         .contact = {.friction = Real(kFriction)}}));
    RopeDesc desc{.total_mass = Real(0.08),
                  .axial_stiffness = Real(1e5),
                  .pins = {},
                  .radius = Real(kRadius),
                  .contact = {.friction = Real(kFriction)}};
    for (int i = -20; i <= 20; ++i) desc.points.push_back(around(i * kSegment));
    rope = take(world.add_rope(desc));
    light = hang(0, 10);
    heavy = hang(40, load);
  }

  /// The place at a way s along the rope from the beam's middle: flat, round the edge, down.
  static DVec3 around(double s) {
    const double way = std::abs(s) - kHalfWidth;
    const double turn = std::clamp(way / kRadius, 0.0, kPi / 2);
    const double x = std::min(std::abs(s), kHalfWidth) + kRadius * std::sin(turn);
    return {std::copysign(x, s), kRadius * std::cos(turn) - std::max(0.0, way - kRadius * kPi / 2), 0};
  }

  BodyId hang(std::uint32_t end, double mass) {
    const Real half = Real(0.02);
    const BodyId body =
        add_box(world, world.positions(rope)[end] - DVec3{0, 0.15, 0}, mass, {half, half, half});
    take(world.add_hook({.a = {.body = body}, .b = {.point = point(rope, end)}}));
    return body;
  }
};

/// D-18: ten kilograms on a shelf, hooked to what is slack until the shelf goes: a rope, or a distance, which
/// lets the load sleep. The jerk breaks the hook.
struct Shelf {
  World world = make_world(without_air());
  BodyId board = take(world.add_body({.shape = Shape::box({1, Real(0.05), 1}), .position = {0, -0.15, 0}}));
  BodyId load = add_box(world, {0, 0, 0}, 10, {Real(0.1), Real(0.1), Real(0.1)});
  HookId hook;

  explicit Shelf(bool by_rope) {
    if (!by_rope) {
      hook = take(world.add_hook({.kind = HookKind::kDistance,
                                  .b = {.body = load},
                                  .anchor = {0, 1, 0},
                                  .anchor_b = DVec3{0, 0, 0},
                                  .limits = {.upper = Real(1.5)},
                                  .break_force = 300}));
      for (int i = 0; i < 300 && !world.asleep(load); ++i) run(world, 1);
      REQUIRE(world.asleep(load));
      return;
    }
    std::vector<DVec3> slack = line({0, 1, 0}, {0.4, 0.5, 0}, 8);
    for (const DVec3 p : line({0.3, 0.43, 0}, {0, 0.1, 0}, 6)) slack.push_back(p);
    const RopeId rope = take(world.add_rope({.total_mass = Real(0.2), .points = slack}));
    hook = take(world.add_hook({.a = {.body = load}, .b = {.point = point(rope, 15)}, .break_force = 300}));
    run(world, 60);
  }
};

/// Breaks the hook, then again from the step before, from its own start and from the start of all.
void break_again(Shelf& shelf) {
  World& world = shelf.world;
  const bool slept = world.asleep(shelf.load);
  const Snapshot resting = world.snapshot();
  std::vector<Snapshot> before;  // of each step
  const auto fall = [&] {
    for (int i = 0; i < 120; ++i) {
      before.push_back(world.snapshot());
      run(world, 1);
      if (!world.broken_hooks().empty()) return i;
    }
    return -1;
  };
  CHECK(world.remove(shelf.board));
  const int at = fall();
  REQUIRE(at > 10);
  // Half a meter down to the end of the distance.
  if (slept) CHECK(at == static_cast<int>(60 * std::sqrt(2 * 0.5 / kGravity)));
  const std::vector<HookId> broken = world.broken_hooks();
  CHECK(broken == std::vector<HookId>{shelf.hook});
  const std::uint64_t hash = world.state_hash();
  run(world, 1);
  const std::uint64_t next = world.state_hash();
  for (const int back : {1, 0}) {
    REQUIRE(world.restore(before[static_cast<std::size_t>(at - back)]).has_value());
    run(world, back);
    CHECK(world.broken_hooks().empty());
    run(world, 1);
    CHECK(world.broken_hooks() == broken);
    CHECK(world.state_hash() == hash);
    run(world, 1);
    CHECK(world.broken_hooks().empty());
    CHECK(world.state_hash() == next);
  }
  REQUIRE(world.restore(resting).has_value());
  CHECK(world.asleep(shelf.load) == slept);
  CHECK(world.remove(shelf.board));
  CHECK(fall() == at);
  CHECK(world.state_hash() == hash);
  const Snapshot after = world.snapshot();
  run(world, 1);
  REQUIRE(world.restore(after).has_value());
  CHECK_FALSE(world.remove(shelf.hook));
  run(world, 1);
  CHECK(world.state_hash() == next);
}

/// Thirty planks between two ropes across a gorge of 6.2 m, each hooked to both; 1000 kg above its middle.
struct Bridge {
  World world;
  std::vector<HookId> hooks;
  std::vector<std::pair<std::uint64_t, HookId>> breaks;  ///< Step and hook.

  explicit Bridge(int workers, double break_force) : world(make_world(desc_for(workers))) {
    RopeId ropes[2];
    for (const int side : {0, 1}) {
      const double z = side == 0 ? -0.5 : 0.5;
      ropes[side] = take(world.add_rope({.total_mass = 5,
                                         .axial_stiffness = Real(1e6),
                                         .points = line({-3.1, 0, z}, {3.1, 0, z}, 62),
                                         .pins = {{0}, {62}}}));
    }
    for (int i = 0; i < 30; ++i) {
      const double x = -2.9 + 0.2 * i;
      const BodyId plank = add_box(world, {x, -0.05, 0}, 4, {Real(0.09), Real(0.02), Real(0.5)});
      for (const RopeId rope : ropes) {
        hooks.push_back(
            take(world.add_hook({.a = {.body = plank},
                                 .b = {.point = point(rope, static_cast<std::uint32_t>(2 + 2 * i))},
                                 .break_force = static_cast<Real>(break_force)})));
      }
    }
    add_box(world, {0.1, 2.5, 0.05}, 1000, {Real(0.4), Real(0.4), Real(0.4)});
  }

  static WorldDesc desc_for(int workers) {
    WorldDesc desc = without_air();
    desc.workers = workers;
    return desc;
  }

  void step() {
    REQUIRE(world.step(Real(1) / Real(60)).healthy());
    for (const HookId hook : world.broken_hooks()) breaks.emplace_back(world.step_count(), hook);
  }
};

}  // namespace

TEST_SUITE("world/rope_cases") {
  TEST_CASE("D-19: across the edge of a box tensions differ by e^(mu pi / 2) at most, and it holds so much") {
    const double most = std::exp(Beam::kFriction * kPi / 2);
    for (const double load : {10.0, 22.0, 34.0}) {  // two edges hold 10 e^(mu pi) = 25.7 kg
      Beam beam(load);
      double deepest = 0;
      for (int i = 0; i < 45; ++i) {
        run(beam.world, 1);
        deepest = std::max(deepest, beam.world.measure().largest_penetration);
      }
      CHECK(deepest < 0.01 * Beam::kRadius);
      const double fallen = -0.15 + Beam::around(0.4).y - beam.world.center_of_mass(beam.heavy).y;
      if (load > 30) {
        CHECK(fallen > 0.05);
        continue;
      }
      CHECK(fallen < 0.005);
      CHECK(length(beam.world.velocity(beam.heavy)) < Real(1e-3));
      const std::vector<Real> tension = beam.world.tensions(beam.rope);
      CHECK(d(tension.back()) == doctest::Approx(load * kGravity).epsilon(0.01));
      CHECK(d(tension.back() / tension[20]) < 1.03 * most);
      CHECK(d(tension[20] / tension.front()) < 1.03 * most);
    }
  }

  TEST_CASE("a rope that falls end on into a corner makes no energy, and throws no crate") {
    for (const BodyKind wall : {BodyKind::kStatic, BodyKind::kDynamic}) {
      for (int shape = 0; shape < 16; ++shape) {
        World world = make_world(without_air());
        take(world.add_body({.shape = Shape::half_space()}));
        take(world.add_body(
            {.kind = wall, .shape = Shape::box({Real(0.2), 1, Real(0.2)}), .position = {-0.2, 1, 0}}));
        RopeDesc desc{.total_mass = Real(0.5), .pins = {}};
        for (int i = 0; i <= 20; ++i) {
          desc.points.push_back({0.02 + 0.006 * std::sin(i * (1 + 0.1 * shape)), 2 + 0.05 * i,
                                 0.0004 * std::cos(i * i + shape)});
        }
        take(world.add_rope(desc));
        const double start = world.measure().energy.total();
        double most = start;
        for (int i = 0; i < 60; ++i) {
          run(world, 1);
          most = std::max(most, world.measure().energy.total());
        }
        INFO("rope ", shape);
        CHECK(most - start < 0.01);
      }
    }
  }

  TEST_CASE("ropes that fall on rough ground and slide over its ridges make no energy") {
    for (const double friction : {0.0, 0.3, 1.0}) {
      for (const int segments : {1, 4, 20}) {
        for (std::uint32_t seed = 1; seed <= 3; ++seed) {
          World world = make_world();
          add_rough_ground(world, seed, friction);
          const RopeId rope =
              take(world.add_rope({.total_mass = 1,
                                   .points = line({-1, 0.1, -0.03}, {1, 0.1, -0.03}, segments),
                                   .pins = {},
                                   .radius = Real(0.01),
                                   .contact = {.friction = static_cast<Real>(friction)}}));
          double least = world.measure().energy.total();
          const double first = least;
          double gained = 0;
          for (int i = 0; i < 150; ++i) {
            run(world, 1);
            const double energy = world.measure().energy.total();
            gained = std::max(gained, energy - least);
            least = std::min(least, energy);
          }
          INFO("friction ", friction, ", segments ", segments, ", seed ", seed);
          CHECK(gained < 0.01 * first);
          const PointView points = world.positions(rope);
          for (std::size_t i = 0; i < points.size(); ++i) CHECK(points[i].y > -0.05);
        }
      }
    }
  }

  TEST_CASE("a clamped rod that swings loses less than 5 % of its energy in five swings, and gains none") {
    // Alone, and with a ball of 1 g on its end, by which it is solved with hooks.
    for (const bool with_ball : {false, true}) {
      for (const int substeps : {4, 8, 32}) {
        WorldDesc desc = empty_space();
        desc.substeps = substeps;
        World world = make_world(desc);
        RopeDesc rod = {.total_mass = Real(0.2), .points = line({}, {1, 0, 0}, 20)};
        rod.bend_stiffness = Real(1);
        rod.pins = {{.point = 0}, {.point = 1}};
        const RopeId id = take(world.add_rope(rod));
        if (with_ball) {
          const BodyId ball = add_box(world, {1, 0, 0}, 1e-3, {Real(0.01), Real(0.01), Real(0.01)});
          take(world.add_hook({.a = {.body = ball}, .b = {.point = point(id, 20)}, .anchor = {1, 0, 0}}));
          REQUIRE(world.set_velocity(ball, {0, 1, 0}).has_value());
        }
        for (std::uint32_t i = 2; i <= 20; ++i) {
          const auto x = static_cast<Real>(i) / 20;
          REQUIRE(world.set_velocity(point(id, i), {Real(0), x * x, Real(0)}).has_value());
        }
        const auto energy = [&] { return world.measure().energy.kinetic + world.measure().energy.elastic; };
        const double start = energy();
        double most = 0;
        int passages = 0;
        for (double before = 1; passages < 10;) {
          run(world, 1);
          const double y = world.positions(id)[20].y;
          passages += y * before < 0 ? 1 : 0;
          before = y;
          most = std::max(most, energy());
        }
        INFO(substeps, " substeps, ball ", with_ball);
        CHECK(energy() > 0.95 * start);
        CHECK(most < 1.01 * start);
      }
    }
  }

  TEST_CASE("D-21: a rope of 10 000 segments and 100 m hangs and swings without stretch") {
    World world = make_world(without_air());
    const RopeId rope = take(world.add_rope({.direction = {Real(0.5), Real(-0.866), 0},
                                             .total_mass = 20,
                                             .masses = 10001,
                                             .length_at_rest = 100,
                                             .loads = {{.point = 10000, .mass = 10}}}));
    double most = 0;
    for (int i = 0; i < 30; ++i) {
      run(world, 1);
      most = std::max(most, world.measure().largest_stretch);
    }
    CHECK(most < 0.01);
    CHECK(length(world.positions(rope)[10000]) < 101);
    // A straight rope falls as if free, until the news of its hook arrive.
    const double way = length(world.positions(rope)[10000] - DVec3{50, -86.6, 0});
    CHECK(way == doctest::Approx(0.5 * 0.5 * kGravity * 0.25).epsilon(0.01));
  }

  TEST_CASE(
      "D-18: a hook breaks in the same step, whenever the world was restored before, and asleep or not") {
    for (const bool by_rope : {true, false}) {
      Shelf shelf(by_rope);
      break_again(shelf);
    }
  }

  TEST_CASE("D-22: a rope holds to a body asleep, static or moved, lets go of it, and outlives it") {
    struct Holder {
      BodyKind kind;
      bool asleep;
    };
    for (const Holder holder : {Holder{BodyKind::kDynamic, true}, Holder{BodyKind::kDynamic, false},
                                Holder{BodyKind::kStatic, false}, Holder{BodyKind::kKinematic, false}}) {
      for (const int ending : {0, 1, 2}) {  // the hook goes, the body, or the rope
        World world = make_world(without_air());
        take(world.add_body({.shape = Shape::half_space()}));
        const BodyId body = take(world.add_body({.kind = holder.kind,
                                                 .shape = Shape::box({Real(0.2), 1, Real(0.2)}),
                                                 .position = {0, 1, 0},
                                                 .velocity = {0, 0, Real(0.5)}}));
        if (holder.kind != BodyKind::kKinematic) REQUIRE(world.set_velocity(body, {}).has_value());
        for (int i = 0; holder.asleep && i < 300 && !world.asleep(body); ++i) run(world, 1);
        REQUIRE(world.asleep(body) == holder.asleep);
        const RopeId rope = take(world.add_rope(
            {.total_mass = Real(0.5), .points = line({0.2, 2, 0}, {1.2, 2, 0}, 20), .pins = {}}));
        const HookId hook = take(world.add_hook({.a = {.body = body}, .b = {.point = point(rope, 0)}}));
        for (int i = 0; i < 60; ++i) {
          run(world, 1);
          CHECK(d(world.hook_gap(hook)) < 1e-3);
          CHECK(world.measure().largest_stretch < 0.01);
        }
        const double moved = holder.kind == BodyKind::kKinematic ? 0.5 : 0;
        CHECK(length(world.positions(rope)[0] - DVec3{0.2, 2, moved}) < 0.02);
        CHECK(world.positions(rope)[20].y < 1.7);

        const double top = world.positions(rope)[0].y;
        CHECK((ending == 0 ? world.remove(hook) : ending == 1 ? world.remove(body) : world.remove(rope)));
        CHECK_FALSE(world.remove(hook));
        CHECK(world.hook_force(hook).force == Vec3{});
        const auto again = world.add_hook({.a = {.body = body}, .b = {.point = point(rope, 0)}});
        CHECK(again.has_value() == (ending == 0));
        if (again) CHECK(world.remove(again.value()));
        double fastest = 0;
        for (int i = 0; i < 60; ++i) {
          run(world, 1);
          for (std::size_t k = 0; k < world.velocities(rope).size(); ++k)
            fastest = std::max(fastest, length(world.velocities(rope)[k]));
        }
        if (ending == 2) {
          CHECK(world.positions(rope).empty());
        } else {
          CHECK(world.positions(rope)[0].y < top - 0.5);
          CHECK(fastest < 15);
        }
        if (ending != 1 && holder.kind == BodyKind::kDynamic)
          CHECK(length(world.center_of_mass(body) - DVec3{0, 1, 0}) < 0.01);
        if (ending == 1) CHECK(world.pose(body).position == DVec3{});
      }
    }
  }

  TEST_CASE(
      "D-16: a bridge whose hooks break one after another makes no energy, and breaks the same each time") {
    Bridge bridge(1, 10000);
    Bridge again(3, 10000);
    double least = HUGE_VAL;  // of the energy since the first hook broke
    double risen = 0;
    for (int i = 0; i < 80; ++i) {
      bridge.step();
      again.step();
      if (bridge.breaks.empty()) continue;
      const double energy = bridge.world.measure().energy.total();
      risen = std::max(risen, energy - least);
      least = std::min(least, energy);
    }
    REQUIRE(bridge.breaks.size() == again.breaks.size());
    for (std::size_t i = 0; i < bridge.breaks.size(); ++i) {
      CHECK(bridge.breaks[i].first == again.breaks[i].first);
      CHECK(bridge.breaks[i].second.slot == again.breaks[i].second.slot);
    }
    CHECK(bridge.world.state_hash() == again.world.state_hash());
    CHECK(bridge.breaks.size() >= 4);
    CHECK(bridge.breaks.size() < bridge.hooks.size());
    CHECK(bridge.breaks.front().first != bridge.breaks.back().first);
    for (std::size_t i = 0; i < bridge.breaks.size(); ++i) {
      CHECK_FALSE(bridge.world.remove(bridge.breaks[i].second));
      for (std::size_t k = 0; k < i; ++k) CHECK(bridge.breaks[k].second != bridge.breaks[i].second);
    }
    CHECK(risen < 1e-3 * 1000 * kGravity * 2.1);
  }
}

}  // namespace hooke
