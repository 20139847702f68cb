#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr DebugDrawDesc kNothing = {.contacts = false};

/// Keeps all shapes of a picture.
class Record : public DebugDraw {
 public:
  struct Line {
    DebugSubject subject;
    DVec3 from, to;
    DebugColor color;
    [[nodiscard]] DVec3 way() const { return to - from; }
  };
  struct Triangle {
    std::array<DVec3, 3> corners;
    DebugColor color;
  };
  void line(DebugSubject subject, DVec3 from, DVec3 to, DebugColor color) override {
    lines.push_back({subject, from, to, color});
  }
  void point(DebugSubject /*subject*/, DVec3 place, DebugColor color) override {
    points.emplace_back(place, color);
  }
  void triangle(DebugSubject /*subject*/, const std::array<DVec3, 3>& corners, DebugColor color) override {
    triangles.push_back({corners, color});
  }
  void text(DebugSubject /*subject*/, DVec3 place, std::string_view text, DebugColor /*color*/) override {
    texts.emplace_back(place, text);
  }

  std::vector<Line> lines;
  std::vector<std::pair<DVec3, DebugColor>> points;
  std::vector<Triangle> triangles;
  std::vector<std::pair<DVec3, std::string>> texts;
};

struct Drawn {
  Record record;
  DebugDrawLegend legend;
};

Drawn draw(const World& world, const DebugDrawDesc& desc) {
  Drawn drawn;
  drawn.legend = take(world.debug_draw(drawn.record, desc));
  return drawn;
}

BodyId add_box(World& world, DVec3 position, Real half, Real mass) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::box({half, half, half}),
                              .position = position,
                              .mass = mass}));
}

void add_ground(World& world) {
  take(world.add_body({.shape = Shape::half_space()}));
}

/// Stretches all points of an object along x about the plane x = 0.
template <class Id>
void stretch(World& world, Id id, double factor) {
  const std::size_t count = world.positions(id).size();
  for (std::uint32_t i = 0; i < count; ++i) {
    DVec3 place = world.positions(id)[i];
    place.x *= factor;
    REQUIRE(world.set_position(point(id, i), place).has_value());
  }
}

}  // namespace

TEST_SUITE("world/debug_draw") {
  TEST_CASE("forces of contacts carry the weight of a box, in arrows of the length that was asked for") {
    World world = make_world();
    add_ground(world);
    add_box(world, {0, 0.5, 0}, Real(0.5), Real(20));
    run(world, 60);
    const Drawn drawn = draw(world, {.texts = true, .meters_per_newton = 0.01, .axis_length = 0.25});
    CHECK(drawn.legend.contacts == 4);
    CHECK(drawn.record.points.size() == 4);
    CHECK(drawn.record.texts.size() == 4);
    CHECK(drawn.record.texts[0].second.ends_with(" N"));
    double force = 0;
    int normals = 0;
    for (const Record::Line& line : drawn.record.lines) {
      CHECK(line.subject == DebugSubject::kContacts);
      CHECK(std::abs(line.from.x) == doctest::Approx(0.5).epsilon(1e-3));
      if (std::abs(length(line.way()) - 0.25) < 1e-6) {
        ++normals;
      } else if (line.way().y > 1e-3) {
        force += line.way().y / 0.01;
      }
    }
    CHECK(normals == 4);
    CHECK(force == doctest::Approx(20 * kGravity).epsilon(1e-3));
    CHECK(drawn.legend.force == doctest::Approx(5 * kGravity).epsilon(0.02));
  }

  TEST_CASE("a particle on the ground is pushed up by its weight, at its lowest point") {
    World world = make_world();
    add_ground(world);
    take(world.add_particles(
        {.particles = {{.position = {1, 0.1, 2}, .mass = Real(3), .radius = Real(0.1)}}}));
    run(world, 120);
    const Drawn drawn = draw(world, {.meters_per_newton = 1});
    REQUIRE(drawn.legend.contacts == 1);
    CHECK(drawn.record.points[0].first.y == doctest::Approx(0).epsilon(1e-3));
    CHECK(drawn.legend.force == doctest::Approx(3 * kGravity).epsilon(1e-3));
  }

  TEST_CASE("a rope is red where it pulls most, and each color tells its tension") {
    World world = make_world(without_air());
    const RopeId rope = take(world.add_rope({.hook_point = {0, 5, 0},
                                             .direction = {0, -1, 0},
                                             .total_mass = Real(1.1),
                                             .masses = 11,
                                             .length_at_rest = 2,
                                             .loads = {{.point = 10, .mass = Real(4)}}}));
    run(world, 600);
    DebugDrawDesc desc = kNothing;
    desc.loads = true;
    desc.texts = true;
    const Drawn drawn = draw(world, desc);
    REQUIRE(drawn.record.lines.size() == 10);
    const std::vector<Real> tensions = world.tensions(rope);
    CHECK(drawn.legend.tension == d(tensions[0]));
    CHECK(drawn.legend.full_tension == d(tensions[0]));
    CHECK(drawn.legend.tension == doctest::Approx((4 + 1) * kGravity).epsilon(0.03));
    for (std::size_t i = 0; i < 10; ++i)
      CHECK(drawn.record.lines[i].color == load_color(d(tensions[i]) / d(tensions[0])));
    CHECK(drawn.record.lines[0].color == load_color(1));
    REQUIRE(drawn.record.texts.size() == 1);
    CHECK(std::stod(drawn.record.texts[0].second) == doctest::Approx(drawn.legend.tension).epsilon(0.01));
    desc.full_tension = 1000;
    CHECK(draw(world, desc).record.lines[0].color == load_color(d(tensions[0]) / 1000));
    CHECK(draw(world, desc).legend.full_tension == 1000);
    CHECK(draw(world, desc).legend.tension == d(tensions[0]));
  }

  TEST_CASE("cloths and solids have the strain by which they were stretched or pressed together") {
    DebugDrawDesc desc = kNothing;
    desc.loads = true;
    for (const double strain : {0.1, -0.2}) {
      CAPTURE(strain);
      World cloths = make_world(empty_space());
      stretch(cloths, take(cloths.add_cloth({.columns = 5, .rows = 5, .width = 1, .height = 1})), 1 + strain);
      World solids = make_world(empty_space());
      stretch(solids, take(solids.add_solid({.cells = {2, 2, 2}, .size = {1, 1, 1}})), 1 + strain);
      World matched = make_world(empty_space());
      stretch(
          matched,
          take(matched.add_solid(
              {.elasticity = SolidDesc::Elasticity::kShapeMatching, .cells = {2, 2, 2}, .size = {1, 1, 1}})),
          1 + strain);
      for (const World* world : {&cloths, &solids}) {
        const Drawn drawn = draw(*world, desc);
        CHECK(drawn.legend.strain == doctest::Approx(std::abs(strain)).epsilon(1e-4));
        CHECK(drawn.record.triangles.size() == (world == &cloths ? 32 : 48));
        for (const Record::Triangle& triangle : drawn.record.triangles)
          CHECK(triangle.color == load_color(strain > 0 ? 1 : -1));
      }
      // Faces across the direction of the stretch keep their form.
      const Drawn drawn = draw(matched, desc);
      CHECK(drawn.legend.strain == doctest::Approx(std::abs(strain)).epsilon(1e-4));
      const auto is_full = [&](const Record::Triangle& one) {
        return one.color == load_color(strain > 0 ? 1 : -1);
      };
      CHECK(std::ranges::count_if(drawn.record.triangles, is_full) == 32);
    }
  }

  TEST_CASE("an arrow of velocity is the way in a time") {
    World world = make_world(empty_space());
    take(world.add_body({.kind = BodyKind::kDynamic,
                         .shape = Shape::sphere(1),
                         .position = {1, 2, 3},
                         .velocity = {3, 0, 4}}));
    DebugDrawDesc desc = kNothing;
    desc.velocities = true;
    desc.seconds = 0.5;
    const Drawn drawn = draw(world, desc);
    REQUIRE(drawn.record.lines.size() == 1);
    CHECK(drawn.record.lines[0].from == DVec3{1, 2, 3});
    CHECK(drawn.record.lines[0].to == DVec3{2.5, 2, 5});
    CHECK(drawn.legend.speed == 5);
  }

  TEST_CASE("boxes hold what they are around, and a half-space has none") {
    World world = make_world(empty_space());
    add_ground(world);
    take(world.add_body({.shape = Shape::sphere(Real(0.5)), .position = {1, 2, 3}}));
    take(world.add_rope({.hook_point = {5, 4, 0},
                         .direction = {0, -1, 0},
                         .masses = 3,
                         .length_at_rest = 2,
                         .radius = Real(0.125)}));
    DebugDrawDesc desc = kNothing;
    desc.bounds = true;
    const Drawn drawn = draw(world, desc);
    REQUIRE(drawn.record.lines.size() == 24);
    const auto expect = [&](std::size_t first, DVec3 lower, DVec3 upper) {
      DVec3 low = drawn.record.lines[first].from;
      DVec3 high = low;
      for (std::size_t i = first; i < first + 12; ++i) {
        const auto& [subject, from, to, color] = drawn.record.lines[i];
        for (const DVec3& end : {from, to}) {
          low = {std::min(low.x, end.x), std::min(low.y, end.y), std::min(low.z, end.z)};
          high = {std::max(high.x, end.x), std::max(high.y, end.y), std::max(high.z, end.z)};
        }
      }
      CHECK(length(low - lower) < 1e-5);
      CHECK(length(high - upper) < 1e-5);
    };
    expect(0, {0.5, 1.5, 2.5}, {1.5, 2.5, 3.5});
    expect(12, {4.875, 1.875, -0.125}, {5.125, 4.125, 0.125});
  }

  TEST_CASE("a hook shows its places, its gap, its axes and its force") {
    World world = make_world(without_air());
    const BodyId box = add_box(world, {0, 1, 0}, Real(0.25), Real(2));
    const HookId hook = take(world.add_hook({.b = {box}, .anchor = {0, 2, 0}}));
    run(world, 60);
    DebugDrawDesc desc = kNothing;
    desc.hooks = true;
    desc.texts = true;
    desc.axis_length = 0.5;
    const Drawn drawn = draw(world, desc);
    REQUIRE(drawn.record.points.size() == 2);
    CHECK(drawn.record.points[0].first == world.hook_anchors(hook)[0]);
    int axes = 0;
    for (const Record::Line& line : drawn.record.lines)
      axes += length(line.way()) == doctest::Approx(0.5) && line.from == world.hook_anchors(hook)[0] ? 1 : 0;
    CHECK(axes == 3);
    REQUIRE(drawn.record.texts.size() == 1);
    CHECK(std::stod(drawn.record.texts[0].second) == doctest::Approx(2 * kGravity).epsilon(1e-3));
  }

  TEST_CASE("who sleeps is told") {
    World world = make_world();
    add_ground(world);
    add_box(world, {0, 0.5, 0}, Real(0.5), Real(1));
    add_box(world, {3, 90, 0}, Real(0.5), Real(1));
    run(world, 120);
    DebugDrawDesc desc = kNothing;
    desc.sleep = true;
    const Drawn drawn = draw(world, desc);
    CHECK(drawn.legend.asleep == 1);
    CHECK(drawn.record.points.size() == 2);
    CHECK(drawn.record.lines.size() == 12);
  }

  TEST_CASE("lines tell which way contacts and hooks are solved") {
    World world = make_world({.sleeping = false});
    add_ground(world);
    add_box(world, {9, 0.5, 0}, Real(0.5), Real(1));
    const BodyId first = add_box(world, {0, 5, 0}, Real(0.25), Real(1));
    const BodyId second = add_box(world, {1, 5, 0}, Real(0.25), Real(1));
    take(world.add_hook({.b = {first}, .anchor = {0, 6, 0}}));
    take(world.add_hook({.a = {first}, .b = {second}, .anchor = {0.5, 5, 0}}));
    run(world, 10);
    DebugDrawDesc desc = kNothing;
    desc.routes = true;
    const Drawn drawn = draw(world, desc);
    REQUIRE(drawn.record.lines.size() == 4);
    CHECK(drawn.record.lines[0].color == debug_routes_of_contacts()[0].color);
    for (std::size_t i = 1; i < 4; ++i)
      CHECK(drawn.record.lines[i].color == debug_routes_of_hooks()[0].color);
    CHECK(debug_routes_of_hooks()[0].name == "tree");
  }

  TEST_CASE("a picture changes nothing, is the same for the same state, and refuses lengths that are none") {
    World world = make_world();
    add_ground(world);
    add_box(world, {0, 0.4, 0}, Real(0.5), Real(1));
    take(world.add_cloth({.columns = 4, .rows = 4, .corner = {2, 1, 0}}));
    run(world, 20);
    const std::uint64_t before = world.state_hash();
    const DebugDrawDesc all = {.velocities = true,
                               .bounds = true,
                               .loads = true,
                               .hooks = true,
                               .sleep = true,
                               .routes = true,
                               .texts = true};
    const Drawn once = draw(world, all);
    World other = make_world();
    REQUIRE(other.restore(world.snapshot()).has_value());
    const Drawn again = draw(other, all);
    CHECK(world.state_hash() == before);
    REQUIRE(once.record.lines.size() == again.record.lines.size());
    for (std::size_t i = 0; i < once.record.lines.size(); ++i)
      CHECK(once.record.lines[i].to == again.record.lines[i].to);
    CHECK(once.record.texts == again.record.texts);
    Record record;
    for (const DebugDrawDesc& bad : {DebugDrawDesc{.meters_per_newton = -1}, DebugDrawDesc{.seconds = 1e7},
                                     DebugDrawDesc{.full_strain = NAN}}) {
      const auto refused = world.debug_draw(record, bad);
      REQUIRE_FALSE(refused.has_value());
      CHECK(refused.error().code == ErrorCode::kOutOfRange);
    }
    CHECK(record.lines.empty());
    const World moved = std::move(world);
    CHECK(draw(world, all).record.lines.empty());
  }

  TEST_CASE("colors of loads go from blue over white to red, in 129 steps") {
    CHECK(load_color(1) == load_color(7));
    CHECK(load_color(-1) == load_color(-INFINITY));
    CHECK(load_color(NAN) == DebugColor{0, 0, 0});
    CHECK(load_color(1).r > 2 * load_color(1).b);
    CHECK(load_color(-1).b > 2 * load_color(-1).r);
    CHECK(load_color(0).r == doctest::Approx(load_color(0).b).epsilon(0.05));
    std::vector<DebugColor> colors;
    for (int i = -1000; i <= 1000; ++i) {
      const DebugColor color = load_color(i / 1000.0);
      if (colors.empty() || colors.back() != color) colors.push_back(color);
    }
    CHECK(colors.size() == 129);
  }
}

}  // namespace hooke
