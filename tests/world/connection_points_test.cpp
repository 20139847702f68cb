#include "constants.h"
#include "world/make.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Vec3 kHalf = {Real(0.3), Real(0.2), Real(0.1)};

BodyId add_box(World& world, DVec3 position, const std::vector<ConnectionPointDesc>& points = {},
               Quat rotation = {}) {
  BodyDesc desc = {.kind = BodyKind::kDynamic,
                   .shape = Shape::box(kHalf),
                   .position = position,
                   .rotation = rotation,
                   .mass = Real(2)};
  desc.connection_points = points;
  return take(world.add_body(desc));
}

RopeId add_rope(World& world, const std::vector<ConnectionPointDesc>& points = {}) {
  return take(world.add_rope({.hook_point = {0, 3, 0},
                              .direction = {0, Real(-1), 0},
                              .total_mass = Real(0.5),
                              .masses = 9,
                              .length_at_rest = 2,
                              .connection_points = points}));
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

DVec3 place(const World& world, const HookEnd& end) {
  return take(world.find_place(end));
}

double apart(DVec3 a, DVec3 b) {
  return length(a - b);
}

std::string complaint(const Result<HookId>& added) {
  return added ? "" : added.error().where + ": " + added.error().message;
}

}  // namespace

TEST_SUITE("world/connection_points") {
  TEST_CASE("every kind of object has connection points of its own") {
    World world = make_world();
    const MeshId mesh = take(world.add_mesh({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                             .triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}}));
    const auto body_names = [&](const BodyDesc& desc) {
      return joined(world.connection_points({.body = take(world.add_body(desc))}));
    };
    const std::string sides = " left right bottom top back front";
    CHECK(body_names({.shape = Shape::half_space()}) == "center origin");
    CHECK(body_names({.shape = Shape::of_mesh(mesh)}) == "center origin");
    CHECK(body_names({.shape = Shape::sphere(1)}) == "center origin" + sides);
    CHECK(body_names({.shape = Shape::cone(1, 1)}) == "center origin bottom top");
    CHECK(body_names({.shape = Shape::box({1, 1, 1})}) ==
          "center origin" + sides +
              " bottom_left_back bottom_right_back top_left_back top_right_back bottom_left_front "
              "bottom_right_front top_left_front top_right_front");
    BodyDesc ball = {.shape = Shape::sphere(1)};
    ball.connection_points = {{"eye", {0, 0, 1}}, {"top", {}}};
    CHECK(body_names(ball) == "eye top center origin left right bottom back front");
    CHECK(joined(world.connection_points({.point = point(add_rope(world), 0)})) == "start middle end");
    CHECK(joined(world.connection_points({.point = point(take(world.add_cloth({})), 0)})) ==
          "top_left top_right bottom_left bottom_right left right top bottom center");
    CHECK(joined(world.connection_points({.point = point(take(world.add_cloth({.mesh = mesh})), 0)})) == "");
    CHECK(joined(world.connection_points({.point = point(take(world.add_solid({})), 0)})) ==
          "left right bottom top back front bottom_left_back bottom_right_back top_left_back "
          "top_right_back bottom_left_front bottom_right_front top_left_front top_right_front center");
    const ParticlesId spring =
        take(world.add_particles({.particles = {{{0, 0, 0}}, {{1, 0, 0}}}, .springs = {{1, 0}}}));
    CHECK(joined(world.connection_points({.point = point(spring, 0)})) == "start end");
    CHECK(place(world, {.point = point(spring, 0), .connection_point = "start"}) == DVec3{1, 0, 0});
    const ParticlesId single = take(world.add_particles({.particles = {{{4, 5, 6}}}}));
    CHECK(place(world, {.point = point(single, 0), .connection_point = "center"}) == DVec3{4, 5, 6});
    CHECK(world.connection_points({}).empty());
  }

  TEST_CASE("connection points are where their names say") {
    World world = make_world();
    const Quat turn = {0, 0, std::sqrt(Real(0.5)), std::sqrt(Real(0.5))};  // x to y
    const BodyId box = add_box(world, {1, 2, 3}, {{"eye", {0.3, 0.1, 0}}}, turn);
    const auto of_box = [&](const char* name) {
      return place(world, {.body = box, .connection_point = name}) - DVec3{1, 2, 3};
    };
    CHECK(apart(of_box("center"), {}) < 1e-6);
    CHECK(apart(of_box("right"), {0, 0.3, 0}) < 1e-6);
    CHECK(apart(of_box("top_left_front"), {-0.2, -0.3, 0.1}) < 1e-6);
    CHECK(apart(of_box("eye"), {-0.1, 0.3, 0}) < 1e-6);
    const BodyId cone = take(world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::cone(1, 1)}));
    CHECK(apart(place(world, {.body = cone, .connection_point = "center"}), {0, -0.5, 0}) < 1e-6);
    CHECK(apart(place(world, {.body = cone, .connection_point = "origin"}), {}) < 1e-6);
    CHECK(apart(place(world, {.body = cone, .connection_point = "top"}), {0, 1, 0}) < 1e-6);

    const ClothId cloth = take(world.add_cloth({.columns = 4, .rows = 3, .width = 3, .height = 2}));
    const auto of_cloth = [&](const char* name) {
      return place(world, {.point = point(cloth, 0), .connection_point = name});
    };
    CHECK(apart(of_cloth("top_left"), {0, 0, 0}) < 1e-6);
    CHECK(apart(of_cloth("bottom_right"), {3, -2, 0}) < 1e-6);
    CHECK(apart(of_cloth("top"), {1.5, 0, 0}) < 1e-6);
    CHECK(apart(of_cloth("right"), {3, -1, 0}) < 1e-6);
    CHECK(apart(of_cloth("center"), {1.5, -1, 0}) < 1e-6);

    for (const std::array<std::int32_t, 3>& cells :
         {std::array{1, 1, 1}, std::array{2, 3, 4}, std::array{3, 3, 5}}) {
      const SolidId solid = take(world.add_solid({.cells = cells, .size = {2, 4, 6}, .position = {1, 1, 1}}));
      const auto of_solid = [&](const char* name) {
        return place(world, {.point = point(solid, 0), .connection_point = name});
      };
      CHECK(apart(of_solid("center"), {1, 1, 1}) < 1e-5);
      CHECK(apart(of_solid("top"), {1, 3, 1}) < 1e-5);
      CHECK(apart(of_solid("front"), {1, 1, 4}) < 1e-5);
      CHECK(apart(of_solid("bottom_right_back"), {2, -1, -2}) < 1e-5);
    }
  }

  TEST_CASE("a rope's end on a box's top carries its weight, and hooks by names need no anchor") {
    World world = make_world(without_air());
    const RopeId rope = add_rope(world);
    const BodyId box = add_box(world, {0, 0.8, 0});
    const HookId hook = take(world.add_hook({.a = {.body = box, .connection_point = "top"},
                                             .b = {.point = point(rope, 0), .connection_point = "end"}}));
    run(world, 300);
    CHECK(std::abs(d(world.hook_force(hook).force.y) + 2 * kGravity) < 1e-3 * 2 * kGravity);
    CHECK(apart(world.center_of_mass(box), {0, 0.8, 0}) < 2e-3);
    CHECK(std::abs(d(world.tensions(rope).front()) - (2.5 - 0.5 / 16) * kGravity) < 0.02);
  }

  TEST_CASE(
      "a hook pulls two connection points together, and an end without a name is held where the other is") {
    World world = make_world(empty_space());
    const BodyId a = add_box(world, {0, 0, 0});
    const BodyId b = add_box(world, {0.7, 0, 0});
    const HookId ball = take(world.add_hook(
        {.a = {.body = a, .connection_point = "right"}, .b = {.body = b, .connection_point = "left"}}));
    CHECK(std::abs(world.hook_anchors(ball)[0].x - 0.3) < 1e-6);
    CHECK(std::abs(world.hook_anchors(ball)[1].x - 0.4) < 1e-6);
    const BodyId c = add_box(world, {0, 5, 0});
    const HookId hinge = take(
        world.add_hook({.kind = HookKind::kHinge, .b = {.body = c, .connection_point = "bottom_left_back"}}));
    for (const DVec3& anchor : world.hook_anchors(hinge)) CHECK(apart(anchor, {-0.3, 4.8, -0.1}) < 1e-6);
    const HookId rod = take(world.add_hook({.kind = HookKind::kDistance,
                                            .a = {.body = b, .connection_point = "top"},
                                            .b = {.body = c, .connection_point = "bottom"}}));
    CHECK(std::abs(d(world.hook_value(rod)) - std::hypot(0.7, 4.6)) < 1e-6);
    run(world, 120);
    CHECK(d(world.hook_gap(ball)) < 1e-4);
    CHECK(d(world.hook_gap(hinge)) < 1e-4);
  }

  TEST_CASE("the other end of a hook at a connection point is the place nearest to it") {
    World world = make_world();
    const RopeId rope = add_rope(world);
    const BodyId box = add_box(world, {0.3, 2.1, 0});
    for (const bool swapped : {false, true}) {
      HookDesc desc;
      desc.a = {.body = box, .connection_point = "left"};
      desc.b = {.point = point(rope, PointRef::kNearest)};
      if (swapped) std::swap(desc.a, desc.b);
      const HookId hook = take(world.add_hook(desc));
      for (const DVec3& anchor : world.hook_anchors(hook)) CHECK(apart(anchor, {0, 2.1, 0}) < 1e-6);
    }
  }

  TEST_CASE("a connection point moves with its object, also when others are removed and after a restore") {
    World world = make_world(without_air());
    const RopeId first = add_rope(world);
    const RopeId rope = add_rope(world, {{"knot", {0.1, 2.2, 0}}, {"third", {}, 3}});
    const SolidId jelly = take(world.add_solid({.cells = {3, 2, 2}, .position = {2, 3, 0}}));
    const ClothId cloth = take(world.add_cloth(
        {.columns = 5, .rows = 5, .corner = {-3, 3, 0}, .connection_points = {{"eye", {-2.6, 2.45, 0}}}}));
    const HookEnd knot = {.point = point(rope, 0), .connection_point = "knot"};
    const HookEnd top = {.point = point(jelly, 0), .connection_point = "top"};
    const HookEnd eye = {.point = point(cloth, 0), .connection_point = "eye"};
    CHECK(apart(place(world, knot), {0, 2.2, 0}) < 1e-6);
    CHECK(apart(place(world, eye), {-2.6, 2.45, 0}) < 1e-6);
    CHECK(place(world, {.point = point(rope, 0), .connection_point = "third"}) == world.positions(rope)[3]);
    REQUIRE(world.apply_impulse(point(rope, 8), {Real(0.4), 0, Real(0.2)}).has_value());
    run(world, 40);
    // 0.8 m of 0.25 m segments: a fifth of the way from point 3 to point 4.
    const DVec3 between = 0.8 * world.positions(rope)[3] + 0.2 * world.positions(rope)[4];
    CHECK(apart(place(world, knot), between) < 1e-5);
    CHECK(apart(between, {0, 2.2, 0}) > 0.05);
    const DVec3 jelly_top = place(world, top);
    const DVec3 cloth_eye = place(world, eye);
    const Snapshot snapshot = world.snapshot();
    CHECK(world.remove(first));
    CHECK(apart(place(world, knot), between) < 1e-5);
    CHECK(place(world, top) == jelly_top);
    CHECK(place(world, eye) == cloth_eye);
    REQUIRE(world.restore(snapshot).has_value());
    const auto hang_and_run = [&] {
      const BodyId box = add_box(world, {0, 0, 0});
      HookDesc desc;
      desc.b = knot;
      desc.a = {.body = box, .connection_point = "top"};
      const HookId hook = take(world.add_hook(desc));
      run(world, 30);
      CHECK(d(world.hook_gap(hook)) < 1e-3);
      return world.state_hash();
    };
    const std::uint64_t hash = hang_and_run();
    REQUIRE(world.restore(snapshot).has_value());
    CHECK(hang_and_run() == hash);
  }

  TEST_CASE("an unknown name is an error that lists the names that exist") {
    World world = make_world();
    const RopeId rope = add_rope(world, {{"knot", {0, 2.2, 0}}});
    const BodyId box = add_box(world, {0, 0, 0});
    const ClothId cloth =
        take(world.add_cloth({.mesh = take(world.add_mesh({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                                           .triangles = {{0, 1, 2}}}))}));
    const auto hook = [&](HookEnd a, HookEnd b) { return complaint(world.add_hook({.a = a, .b = b})); };
    CHECK(hook({.body = box}, {.point = point(rope, 0), .connection_point = "and"}) ==
          "hook.b: has no connection point 'and', there are knot, start, middle, end");
    CHECK(hook({.body = take(world.add_body({})), .connection_point = "top"}, {.body = box}) ==
          "hook.a: has no connection point 'top', there are center, origin");
    CHECK(hook({.body = box}, {.point = point(cloth, 0), .connection_point = "corner"}) ==
          "hook.b: has no connection point 'corner', there are none");
    CHECK(hook({.connection_point = "end"}, {.body = box}) ==
          "hook.a: is the world, which has no connection points");
    CHECK(complaint(world.add_hook(
              {.a = {.body = BodyId{77, 1}, .connection_point = "top"}, .b = {.body = box}})) ==
          "hook.a: refers to nothing that is in the world");
    CHECK_FALSE(world.find_place({}).has_value());
    CHECK_FALSE(world.find_place({.point = point(rope, PointRef::kNearest)}).has_value());
    CHECK_FALSE(world.find_place({.body = BodyId{77, 1}}).has_value());
    CHECK(place(world, {.body = box}) == DVec3{});

    const auto body = [&](std::vector<ConnectionPointDesc> points) {
      const Result<BodyId> added = world.add_body({.connection_points = std::move(points)});
      return added ? "" : added.error().where + ": " + added.error().message;
    };
    CHECK(body({{"a", {}}, {"b", {}}}) == "");
    CHECK(body({{"a", {}}, {"a", {}}}) == "body.connection_points.a: is the name of another one too");
    CHECK(body({{"", {}}}) == "body.connection_points[0]: needs a name of 1 to 64 bytes");
    CHECK(body({{"a", {}, 0}}) ==
          "body.connection_points.a: must be a place [x, y, z]: a body has no points");
    CHECK(body({{"a", {std::nan(""), 0, 0}}}) ==
          "body.connection_points.a: [nan, 0, 0] is out of range, must be finite and within 1e+09 m of the "
          "origin");
    const auto added = world.add_rope({.masses = 4, .connection_points = {{"a", {}, 4}}});
    REQUIRE_FALSE(added.has_value());
    CHECK(added.error().where + ": " + added.error().message ==
          "rope.connection_points.a: 4 is out of range, must be 0 to 3");
  }
}

}  // namespace hooke
