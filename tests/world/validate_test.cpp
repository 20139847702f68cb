/// The functions that HOOKE_VALIDATE calls in checked builds find nothing in what a step leaves, and find
/// what is damaged by hand.

#include "base/assert.h"
#include "solver/check_routes.h"
#include "state/check_contacts.h"
#include "state/check_tables.h"
#include "world/access.h"
#include "world/make.h"

#include <algorithm>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

std::string said;  // NOLINT: what the handler below was told

void remember(const char* condition, const char*, int) {
  said = condition;
}

std::string text(const char* what) {
  return what == nullptr ? "" : what;
}

BodyId add_cube(World& world, DVec3 position) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::box({Real(0.25), Real(0.25), Real(0.25)}),
                              .position = position}));
}

/// A stack of two cubes, which is solved directly, and a cube alone, which is soft.
World make_cubes() {
  World world = make_world();
  take(world.add_body({.kind = BodyKind::kStatic, .shape = Shape::half_space()}));
  add_cube(world, {0, 0.25, 0});
  add_cube(world, {0, 0.75, 0});
  add_cube(world, {5, 0.25, 0});
  return world;
}

void add_ball_hook(World& world, BodyId a, BodyId b, DVec3 anchor) {
  take(world.add_hook({.kind = HookKind::kBall, .a = {.body = a}, .b = {.body = b}, .anchor = anchor}));
}

/// Two pairs of hooked cubes, in the air.
World make_hooked_cubes() {
  World world = make_world();
  for (const double x : {0.0, 5.0}) {
    const BodyId a = add_cube(world, {x, 5, 0});
    add_ball_hook(world, a, add_cube(world, {x + 1, 5, 0}), {x + 0.5, 5, 0});
  }
  return world;
}

/// A cube that hangs on a rope.
World make_hanging_cube() {
  World world = make_world();
  const BodyId cube = add_cube(world, {0, 5, 0});
  const RopeId rope = take(world.add_rope({.hook_point = {0, 6, 0}, .masses = 5}));
  take(world.add_hook({.kind = HookKind::kBall, .a = {.body = cube}, .b = {.point = point(rope, 4)}}));
  return world;
}

state::Tables tables_after(World& world, int steps) {
  run(world, steps);
  return WorldAccess::tables(world);
}

/// What a check says of tables that `damage` has changed.
template <class Check, class Damage>
std::string after(const state::Tables& tables, Check&& check, Damage&& damage) {
  state::Tables copy = tables;
  damage(copy);
  return text(check(copy));
}

/// The first manifold that goes this way.
std::uint32_t row_with(const state::Tables& t, state::ContactRoute route) {
  const auto at = std::find_if(t.pairs.manifold.begin(), t.pairs.manifold.end(),
                               [route](const state::Manifold& m) { return m.route == route; });
  REQUIRE(at != t.pairs.manifold.end());
  return static_cast<std::uint32_t>(at - t.pairs.manifold.begin());
}

}  // namespace

TEST_SUITE("world/validate") {
  TEST_CASE("what is wrong with a table is reported as a broken invariant") {
    const base::AssertHandler before = base::set_assert_handler(remember);
    base::validate(nullptr, __FILE__, __LINE__);
    CHECK(said.empty());
    base::validate("order of pairs", __FILE__, __LINE__);
    CHECK(said == "order of pairs");
    base::set_assert_handler(before);
  }

  TEST_CASE("masses below zero are found, and what is not a number passes") {
    World world = make_hanging_cube();
    const state::Tables t = tables_after(world, 1);
    const auto check = state::find_disagreement;
    using T = state::Tables;
    const std::uint32_t cube = t.moving_bodies.front();
    CHECK(text(check(t)).empty());
    CHECK(after(t, check, [](T& d) { d.particles.mass[1] = Real(-1); }) == "mass of a particle");
    CHECK(after(t, check, [](T& d) { d.particles.velocity[1].inverse_mass = Real(-1); }) ==
          "inverse mass of a particle");
    CHECK(after(t, check, [&](T& d) { d.bodies.mass[cube].mass = Real(-1); }) == "mass of a body");
    CHECK(after(t, check, [&](T& d) { d.bodies.motion[cube].inverse_mass = Real(-1); }) ==
          "inverse mass of a body");
    CHECK(
        after(t, check, [](T& d) { d.particles.mass[1] = std::numeric_limits<Real>::quiet_NaN(); }).empty());
  }

  TEST_CASE("contacts of bodies that are damaged are found") {
    World world = make_cubes();
    const state::Tables t = tables_after(world, 1);
    REQUIRE(t.pairs.manifold.size() == 3);
    const auto check = state::find_in_body_contacts;
    using T = state::Tables;
    CHECK(text(check(t)).empty());
    CHECK(after(t, check, [](T& d) {
            d.pairs.manifold[0].normal = {Real(2), 0, 0};
          }) == "normal of a manifold");
    CHECK(after(t, check, [](T& d) { d.pairs.manifold[0].normal = {}; }) == "normal of a manifold");
    CHECK(after(t, check, [](T& d) { d.pairs.manifold.pop_back(); }) == "manifolds of a pair");
    CHECK(after(t, check, [](T& d) { d.pairs.manifold.emplace_back(); }) == "manifolds of no pair");
    CHECK(after(t, check, [](T& d) { ++d.pairs.pair.back().first_manifold; }) == "gap between manifolds");
    CHECK(after(t, check, [](T& d) { d.bodies.traits[d.pairs.manifold[0].body_b].sensor = true; }) ==
          "a manifold of a sensor");
    CHECK(after(t, check, [](T& d) { d.pairs.seen.pop_back(); }) == "poses that were seen");
  }

  TEST_CASE("damaged pairs and bodies that sleep are found") {
    World world = make_cubes();
    const state::Tables t = tables_after(world, 120);
    REQUIRE(!t.pairs.sleeping.pair.empty());
    const auto check = state::find_in_body_contacts;
    using T = state::Tables;
    CHECK(text(check(t)).empty());
    const std::uint32_t sleeper = t.moving_bodies.front();
    REQUIRE(t.bodies.asleep[sleeper] != 0);
    CHECK(after(t, check, [&](T& d) { d.bodies.asleep[sleeper] = 0; }) == "a sleeping pair that moves");
    CHECK(after(t, check, [&](T& d) { ++d.pairs.sleeping.of_body[sleeper]; }) == "number of sleeping pairs");
    CHECK(after(t, check, [](T& d) { ++d.pairs.sleeping.contacts; }) == "number of sleeping contacts");
    CHECK(after(t, check, [](T& d) {
            d.pairs.manifold.clear();
            d.pairs.pair = {d.pairs.sleeping.pair.front()};
            d.pairs.pair[0].first_manifold = d.pairs.pair[0].manifold_count = 0;
          }) == "a pair that sleeps and does not");

    CHECK(text(state::find_in_sleepers(t)).empty());
    const auto still = state::find_in_sleepers;
    CHECK(after(t, still, [&](T& d) { d.bodies.motion[sleeper].v.y = Real(1); }) == "a sleeper that moves");
    CHECK(after(t, still, [&](T& d) { d.bodies.motion[sleeper].dx.y = Real(1); }) ==
          "a sleeper that is on its way");
    CHECK(after(t, still, [&](T& d) { d.bodies.traits[sleeper].kind = BodyKind::kKinematic; }) ==
          "a sleeper that never rests");
  }

  TEST_CASE("contacts of points that are damaged are found") {
    World world = make_cubes();
    state::Tables t = tables_after(world, 1);
    const auto body = [&t](std::uint32_t collider) { return t.colliders.body[collider]; };
    for (std::uint32_t i = 0; i < 2; ++i) {
      state::Contacts::for_each_column(t.contacts, [](auto& column) { column.emplace_back(); });
      t.contacts.collider[i] = i;
      t.contacts.body[i] = body(i);
    }
    t.element_contacts = {{.collider = 0, .body = body(0), .count = 2, .particle = {3, 4}},
                          {.collider = 1, .body = body(1), .count = 3, .particle = {3, 4, 7}}};
    t.rope_contacts = {{.segment_a = 0, .segment_b = 2, .particle = {0, 1, 2, 3}},
                       {.segment_a = 0, .segment_b = 3, .particle = {0, 1, 3, 4}}};
    const auto check = state::find_in_point_contacts;
    using T = state::Tables;
    CHECK(text(check(t)).empty());
    CHECK(after(t, check, [](T& d) { d.contacts.particle[0] = 1; }) == "order of contacts");
    CHECK(after(t, check, [](T& d) { ++d.contacts.body[0]; }) == "body of a contact");
    CHECK(after(t, check, [](T& d) { d.element_contacts[1] = d.element_contacts[0]; }) ==
          "order of element contacts");
    CHECK(after(t, check, [](T& d) { d.element_contacts[1].particle[2] = 4; }) == "points of an element");
    CHECK(after(t, check, [](T& d) { d.element_contacts[1].count = 4; }) == "number of an element's points");
    CHECK(after(t, check, [](T& d) { d.element_contacts[0].normal.y = Real(0.5); }) ==
          "normal of an element contact");
    CHECK(after(t, check, [](T& d) { ++d.element_contacts[0].body; }) == "body of an element contact");
    CHECK(after(t, check, [](T& d) { d.rope_contacts[0].particle[2] = 1; }) ==
          "points of a contact of ropes");
    CHECK(after(t, check, [](T& d) { std::swap(d.rope_contacts[0], d.rope_contacts[1]); }) ==
          "order of contacts of ropes");
    CHECK(after(t, check, [](T& d) { d.rope_contacts[0].normal.y = Real(2); }) ==
          "normal of a contact of ropes");
  }

  TEST_CASE("blocks, ways and direct islands that are damaged are found") {
    World world = make_cubes();
    const state::Tables t = tables_after(world, 1);
    const WorldData& w = WorldAccess::data(world);
    const solver::BodyContacts& contacts = w.frame.body_contacts;
    const solver::DirectIslands& direct = w.frame.direct_islands;
    REQUIRE(direct.count == 1);
    const std::uint32_t soft = row_with(t, state::ContactRoute::kSoft);
    std::vector<std::uint32_t> marks;
    CHECK(text(solver::find_in_contact_routes(t, contacts, direct, marks)).empty());

    const auto of_tables = [&](auto&& damage) {
      return after(
          t, [&](const auto& d) { return solver::find_in_contact_routes(d, contacts, direct, marks); },
          damage);
    };
    using T = state::Tables;
    CHECK(of_tables([&](T& d) { d.pairs.manifold[soft].route = state::ContactRoute::kNone; }) ==
          "way of a lane");
    CHECK(of_tables([&](T& d) { d.pairs.manifold[soft].body_b = d.pairs.manifold[soft].body_a; }) ==
          "bodies of a lane");
    CHECK(of_tables([&](T& d) { d.pairs.manifold.push_back(d.pairs.manifold[soft]); }) ==
          "lanes of a manifold");
    CHECK(of_tables([](T& d) { d.pairs.coupled.push_back({.manifold = 1000}); }) ==
          "number of coupled manifolds");

    const auto of_blocks = [&](auto&& damage) {
      solver::BodyContacts copy = contacts;
      damage(copy);
      return text(solver::find_in_contact_routes(t, copy, direct, marks));
    };
    using C = solver::BodyContacts;
    CHECK(of_blocks([](C& c) {
            c.color_begin = {0, static_cast<int>(c.blocks.size())};
          }) == "a body that is twice in a color");
    CHECK(of_blocks([](C& c) { c.color_begin.pop_back(); }) == "blocks of no color");
    CHECK(of_blocks([](C& c) { c.manifold_of[0] = 1000; }) == "manifold of a lane");
    CHECK(of_blocks([](C& c) { c.manifold_of.pop_back(); }) == "lanes of blocks");
    CHECK(of_blocks([](C& c) { c.blocks[0].anchored = !c.blocks[0].anchored; }) == "who moves in a lane");
    CHECK(of_blocks([](C& c) { c.blocks[0].count = 17; }) == "lanes of a block");

    const auto of_islands = [&](auto&& damage) {
      solver::DirectIslands copy = direct;
      damage(copy);
      return text(solver::find_in_contact_routes(t, contacts, copy, marks));
    };
    using D = solver::DirectIslands;
    CHECK(of_islands([](D& d) { d.islands[0].contacts.pop_back(); }) == "a direct contact of no island");
    CHECK(of_islands([](D& d) { d.count = 0; }) == "a direct contact of no island");
    CHECK(of_islands([](D& d) { std::swap(d.islands[0].graph.bodies[0], d.islands[0].graph.bodies[1]); }) ==
          "order of a direct island");
    CHECK(of_islands([](D& d) { d.island_of[d.islands[0].graph.bodies[0]] = 5; }) ==
          "a body of two direct islands");
    CHECK(of_islands([](D& d) { d.islands[0].contacts[1] = d.islands[0].contacts[0]; }) ==
          "order of direct contacts");
    CHECK(of_islands([](D& d) { d.islands[0].rows.clear(); }) == "rows of a direct contact");
  }

  TEST_CASE("articulations that are damaged are found") {
    World world = make_hooked_cubes();
    const state::Tables t = tables_after(world, 1);
    solver::Joints& joints = WorldAccess::data(world).derived.joints;
    REQUIRE(joints.order.size() == 2);
    std::vector<std::uint32_t> marks;
    const auto check = [&](const state::Tables& d) { return solver::find_in_joint_routes(d, joints, marks); };
    using T = state::Tables;
    CHECK(text(check(t)).empty());
    CHECK(after(t, check, [](T& d) { d.hooks[1].route = state::JointRoute::kNone; }) == "way of a hook");
    CHECK(after(t, check, [](T& d) { d.hooks.pop_back(); }) == "hook of an articulation");
    CHECK(after(t, check, [](T& d) { d.hooks.push_back(d.hooks[0]); }) == "a hook that nothing solves");

    joints.order.push_back(joints.order.front());
    CHECK(text(check(t)) == "a hook that is solved twice");
    joints.order.pop_back();
    std::vector<std::uint32_t>& bodies = joints.articulations[joints.order[1]].bodies;
    const std::uint32_t kept = bodies[0];
    bodies[0] = joints.articulations[joints.order[0]].bodies[0];
    CHECK(text(check(t)) == "a body of two articulations");
    bodies[0] = kept;
    joints.iterative.hooks.push_back(0);
    CHECK(text(check(t)) == "way of an iterative joint");
    joints.iterative.hooks.pop_back();
    CHECK(text(check(t)).empty());
  }

  TEST_CASE("coupled groups that are damaged are found") {
    World world = make_hanging_cube();
    const state::Tables t = tables_after(world, 1);
    const WorldData& w = WorldAccess::data(world);
    const std::vector<solver::RopeSystem>& ropes = w.derived.rope_systems;
    REQUIRE(w.derived.coupled_groups.count == 1);
    REQUIRE(ropes.size() == 1);
    std::vector<std::uint32_t> marks;
    const auto said_of = [&](auto&& damage) {
      solver::CoupledGroups copy = w.derived.coupled_groups;
      damage(copy);
      return text(solver::find_in_coupled_groups(t, ropes, copy, marks));
    };
    using G = solver::CoupledGroups;
    CHECK(said_of([](G&) {}).empty());
    CHECK(said_of([](G& g) { g.groups[0].hooks.clear(); }) == "a hook that is coupled to nothing");
    CHECK(said_of([](G& g) { g.groups[0].hooks.push_back(7); }) == "hooks of coupled groups");
    CHECK(said_of([](G& g) { g.groups[0].bodies.push_back(g.groups[0].bodies[0]); }) ==
          "bodies of coupled groups");
    CHECK(said_of([](G& g) { g.groups[0].rope_systems.clear(); }) ==
          "a rope that is solved twice, or not at all");
    CHECK(said_of([](G& g) { g.groups[0].ends.clear(); }) == "rows of a coupled group");
    CHECK(said_of([](G& g) {
            const solver::CoupledGroup first = g.groups[0];
            g.groups.resize(1);
            g.groups.push_back(first);
            g.count = 2;
          }) == "hooks of coupled groups");
    CHECK(after(
              t,
              [&](const state::Tables& d) {
                return solver::find_in_coupled_groups(d, ropes, w.derived.coupled_groups, marks);
              },
              [](state::Tables& d) { d.bodies.asleep[d.moving_bodies[0]] = 1; }) ==
          "body of a coupled group");
  }
}

}  // namespace hooke
