#include "lab/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke {

using lab::CollisionOptions;
using test::advance;
using test::empty_space;
using test::make_run;
using test::make_world;
using test::take;
using Search = CollisionOptions::Search;
using Sweep = CollisionOptions::Sweep;

namespace {

const double kGravity = static_cast<double>(Real(9.81));

BodyDesc ball(double radius, DVec3 position, double restitution) {
  BodyDesc desc = {
      .kind = BodyKind::kDynamic, .shape = Shape::sphere(static_cast<Real>(radius)), .position = position};
  desc.contact = {.friction = Real(0), .restitution = static_cast<Real>(restitution)};
  return desc;
}

BodyDesc ground(double friction = 0) {
  BodyDesc desc = {.shape = Shape::half_space()};
  desc.contact.friction = static_cast<Real>(friction);
  return desc;
}

lab::Options exact(Search search, double dt = 1.0 / 60) {
  return {
      .stepper = "rk4", .dt = dt, .collisions = {.search = search, .epsilon = 1e-11, .iteration_limit = 200}};
}

Shape box_of(double x, double y, double z) {
  return Shape::box({static_cast<Real>(x), static_cast<Real>(y), static_cast<Real>(z)});
}

constexpr Search kSearches[] = {Search::kHalving, Search::kBackward, Search::kEvent, Search::kAdvancement};

}  // namespace

TEST_SUITE("lab/collisions") {
  TEST_CASE("every search finds the times at which spheres hit, to 1e-9 s") {
    for (const Search search : kSearches) {
      CAPTURE(static_cast<int>(search));
      World falling = make_world();
      take(falling.add_body(ground()));
      take(falling.add_body(ball(0.25, {0, 1, 0}, 0.5)));
      lab::Run run = make_run(falling, exact(search));
      advance(run, 30);
      CHECK(run.collisions().last_hit == doctest::Approx(std::sqrt(2 * 0.75 / kGravity)).epsilon(2e-9));
      CHECK(run.collisions().hits == 1);

      // |(2, 0.3, 0) - t (4, 0, 0)| = 0.5
      World flying = make_world(empty_space());
      BodyDesc first = ball(0.25, {0, 0, 0}, 1);
      first.velocity = {Real(3), Real(0), Real(0)};
      BodyDesc second = ball(0.25, {2, 0.3125, 0}, 1);
      second.velocity = {Real(-1), Real(0), Real(0)};
      take(flying.add_body(first));
      take(flying.add_body(second));
      lab::Run other = make_run(flying, exact(search));
      advance(other, 40);
      const double way = 2 - std::sqrt(0.25 - 0.3125 * 0.3125);
      CHECK(std::abs(other.collisions().last_hit - way / 4) < 1e-9);
    }
  }

  TEST_CASE("a rod that turns hits a ball, and an edge an edge, when their equations say") {
    for (const Search search : {Search::kEvent, Search::kAdvancement, Search::kHalving}) {
      CAPTURE(static_cast<int>(search));
      World world = make_world(empty_space());
      BodyDesc rod = {.kind = BodyKind::kDynamic, .shape = Shape::capsule(Real(0.125), Real(2))};
      rod.angular_velocity = {Real(0), Real(0), Real(-1)};
      take(world.add_body(rod));
      take(world.add_body(ball(0.125, {1, 0, 0}, 1)));
      // From upright, the side of the rod comes down on the ball: sin(angle left) = (0.125 + 0.125) / 1.
      lab::Run run = make_run(world, exact(search));
      advance(run, 90);
      CHECK(run.collisions().hits == 1);
      const double expected = std::numbers::pi / 2 - std::asin(0.25);
      CHECK(std::abs(run.collisions().last_hit - expected) < 1e-9);

      // Two cubes on edge, their edges crossed, 1 m apart, one falling.
      World edges = make_world();
      const double half = 0.125 * std::numbers::pi;
      const auto s = static_cast<Real>(std::sin(half)), c = static_cast<Real>(std::cos(half));
      BodyDesc lower = {.shape = box_of(0.5, 0.5, 0.5)};
      lower.rotation = {s, Real(0), Real(0), c};
      BodyDesc upper = {.kind = BodyKind::kDynamic, .shape = box_of(0.5, 0.5, 0.5)};
      upper.rotation = {Real(0), Real(0), s, c};
      upper.position = {0, std::sqrt(2.0) + 1, 0};
      upper.contact.restitution = Real(1);
      take(edges.add_body(lower));
      take(edges.add_body(upper));
      lab::Options options = exact(search);
      lab::Run fall = make_run(edges, options);
      while (fall.collisions().hits == 0 && fall.time() < 1) advance(fall, 1);
      CHECK(std::abs(fall.collisions().last_hit - std::sqrt(2 / kGravity)) < 1e-7);  // rotations are float
    }
  }

  TEST_CASE("a ball with restitution 1 keeps its height over 1000 bounces") {
    World world = make_world();
    take(world.add_body(ground()));
    const BodyId id = take(world.add_body(ball(0.25, {0, 1.25, 0}, 1)));
    lab::Run run = make_run(world, exact(Search::kEvent));
    const double energy = run.energy().total();
    double top = 0;
    while (run.collisions().hits < 1000) {
      advance(run, 1);
      const lab::BodyState now = take(run.body(id));
      top = std::max(top, now.center.y + length_squared(now.velocity) / (2 * kGravity));
    }
    CHECK(run.energy().total() == doctest::Approx(energy).epsilon(1e-6));
    CHECK(top - 1.25 < 1e-6);
    CHECK(run.collisions().last_hit == doctest::Approx(1999 * std::sqrt(2 / kGravity)).epsilon(1e-6));
  }

  TEST_CASE("a ball with restitution e comes to rest when the series of its bounces ends") {
    World world = make_world();
    take(world.add_body(ground()));
    const BodyId id = take(world.add_body(ball(0.25, {0, 1.25, 0}, 0.5)));
    lab::Run run = make_run(world, {.stepper = "rk4", .collisions = {.epsilon = 1e-9}});
    advance(run, 180);
    const double end = std::sqrt(2 / kGravity) * (1 + 0.5) / (1 - 0.5);
    CHECK(run.collisions().last_hit == doctest::Approx(end).epsilon(1e-3));
    CHECK(take(run.body(id)).center.y == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(length(take(run.body(id)).velocity) < 1e-9);
    CHECK(run.collisions().zeno == 0);
    const std::uint64_t rollbacks = run.collisions().rollbacks;
    advance(run, 100);  // rest costs nothing
    CHECK(run.collisions().rollbacks == rollbacks);
  }

  TEST_CASE("a ball never passes a wall, at any speed, unless the way is not looked at") {
    for (const double speed : {1.0, 30.0, 1e3, 1e5, 1e8}) {
      for (const Search search : kSearches) {
        for (const Sweep sweep : {Sweep::kCast, Sweep::kExtruded}) {
          CAPTURE(speed);
          CAPTURE(static_cast<int>(search));
          World world = make_world(empty_space());
          take(world.add_body({.shape = box_of(0.001, 1, 1), .position = {1, 0, 0}}));
          BodyDesc desc = ball(0.01, {0, 0, 0}, 1);
          desc.velocity = {static_cast<Real>(speed), Real(0), Real(0)};
          const BodyId id = take(world.add_body(desc));
          lab::Run run = make_run(world, {.collisions = {.search = search, .sweep = sweep}});
          advance(run, speed > 1 ? 4 : 90);
          CHECK(take(run.body(id)).center.x < 0.99);
          CHECK(take(run.body(id)).velocity.x == doctest::Approx(-speed).epsilon(1e-6));
        }
      }
    }
    World world = make_world(empty_space());
    take(world.add_body({.shape = box_of(0.001, 1, 1), .position = {1, 0, 0}}));
    BodyDesc desc = ball(0.01, {0, 0, 0}, 1);
    desc.velocity = {Real(1000), Real(0), Real(0)};
    const BodyId id = take(world.add_body(desc));
    lab::Run run = make_run(world, {.collisions = {.sweep = Sweep::kNone}});
    advance(run, 1);
    CHECK(take(run.body(id)).center.x > 1);
  }

  TEST_CASE("a rod at 1000 rad/s does not cut through a thin wall") {
    World world = make_world(empty_space());
    take(world.add_body({.shape = box_of(0.0005, 1, 1), .position = {0.6, 0, 0}}));
    BodyDesc rod = {.kind = BodyKind::kDynamic, .shape = Shape::capsule(Real(0.01), Real(1))};
    rod.angular_velocity = {Real(0), Real(0), Real(1000)};
    const BodyId id = take(world.add_body(rod));
    lab::Run run = make_run(world, {.dt = 1e-3});
    bool through = false;
    for (int i = 0; i < 20; ++i) {
      advance(run, 1);
      const lab::BodyState now = take(run.body(id));
      const DVec3 tip = rotate(now.rotation, DVec3{0, 1, 0});
      // The tip beyond the wall while the rod's line crosses it within the wall's height.
      through = through || std::max((now.center + tip).x, (now.center - tip).x) > 0.6 + 0.011;
    }
    CHECK_FALSE(through);
    CHECK(run.collisions().hits > 0);
  }

  TEST_CASE("the paper's collider lets a ball pass the edge of a box, the exact one does not") {
    const auto lowest = [](CollisionOptions::Collider collider) {
      World world = make_world();
      take(world.add_body({.shape = box_of(1, 1, 1)}));
      const BodyId id = take(world.add_body(ball(0.5, {1.25, 2.5, 0}, 0)));
      lab::Run run = make_run(world, {.collisions = {.collider = collider}});
      advance(run, 45);
      return std::pair(take(run.body(id)).center, run.collisions().hits);
    };
    const auto [passed, no_hits] = lowest(CollisionOptions::Collider::kFaces);
    CHECK(no_hits == 0);
    CHECK(passed.y == doctest::Approx(2.5 - kGravity * 0.75 * 0.75 / 2).epsilon(1e-6));
    const auto [missed, hits] = lowest(CollisionOptions::Collider::kExact);
    CHECK(hits > 0);
    CHECK(missed.x > 1.3);
  }

  TEST_CASE("a box slides to a stop after v^2 / (2 mu g), and then stands") {
    World world = make_world();
    take(world.add_body(ground(0.25)));
    BodyDesc box = {.kind = BodyKind::kDynamic, .shape = box_of(0.5, 0.25, 0.5), .position = {0, 0.25, 0}};
    box.velocity = {Real(2), Real(0), Real(0)};
    box.contact.friction = Real(0.25);
    const BodyId id = take(world.add_body(box));
    lab::Run run = make_run(world, {.stepper = "rk4"});
    advance(run, 120);
    CHECK(take(run.body(id)).center.x == doctest::Approx(4 / (2 * 0.25 * kGravity)).epsilon(1e-4));
    CHECK(take(run.body(id)).center.y == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(length(take(run.body(id)).velocity) < 1e-9);
    CHECK(run.collisions().rollbacks == 0);
  }

  TEST_CASE("a sliding ball rolls after 2 v / (7 mu g), with 5 / 7 of its speed") {
    World world = make_world();
    take(world.add_body(ground(0.25)));
    BodyDesc desc = ball(0.25, {0, 0.25, 0}, 0);
    desc.velocity = {Real(3), Real(0), Real(0)};
    desc.contact.friction = Real(0.25);
    const BodyId id = take(world.add_body(desc));
    lab::Run run = make_run(world, {.stepper = "rk4"});
    advance(run, 60);
    const lab::BodyState now = take(run.body(id));
    CHECK(now.velocity.x == doctest::Approx(15.0 / 7).epsilon(1e-5));
    CHECK(now.angular_velocity.z == doctest::Approx(-15.0 / 7 / 0.25).epsilon(1e-5));
  }

  TEST_CASE("a hit aside of the center turns a box: momentum and energy stay") {
    World world = make_world(empty_space());
    BodyDesc box = {.kind = BodyKind::kDynamic, .shape = box_of(0.5, 0.5, 0.5), .mass = Real(2)};
    box.contact = {.friction = Real(0), .restitution = Real(1)};
    const BodyId struck = take(world.add_body(box));
    BodyDesc desc = ball(0.25, {-2, 0.25, 0.125}, 1);
    desc.mass = Real(1);
    desc.velocity = {Real(3), Real(0), Real(0)};
    const BodyId id = take(world.add_body(desc));
    lab::Run run = make_run(world, {.stepper = "rk4"});
    const double energy = run.energy().total();
    advance(run, 60);
    // j = (1 + e) v / (1/m + 1/M + (r x n)^2 / I), I = M / 6.
    const double lever = 0.25 * 0.25 + 0.125 * 0.125;
    const double impulse = 2 * 3 / (1 + 0.5 + lever * 3);
    CHECK(take(run.body(id)).velocity.x == doctest::Approx(3 - impulse).epsilon(1e-6));
    CHECK(take(run.body(struck)).velocity.x == doctest::Approx(impulse / 2).epsilon(1e-6));
    CHECK(take(run.body(struck)).angular_velocity.z == doctest::Approx(-0.25 * impulse * 3).epsilon(1e-2));
    CHECK(run.energy().total() == doctest::Approx(energy).epsilon(1e-7));
  }

  TEST_CASE("materials are looked up as a World does") {
    WorldDesc desc;
    desc.materials = {{.a = 1, .b = 2, .friction = Real(0), .restitution = Real(0.5)}};
    World world = take(World::create(desc));
    BodyDesc floor = ground();
    floor.contact.material = 1;
    take(world.add_body(floor));
    BodyDesc fall = ball(0.25, {0, 1.25, 0}, 0);
    fall.contact.material = 2;
    const BodyId id = take(world.add_body(fall));
    lab::Run run = make_run(world, {.stepper = "rk4", .dt = 1e-3});
    double top = 0;
    for (int i = 0; i < 800; ++i) {
      advance(run, 1);
      if (run.collisions().hits == 1) top = std::max(top, take(run.body(id)).center.y - 0.25);
    }
    CHECK(top == doctest::Approx(0.25).epsilon(1e-4));
  }

  TEST_CASE("a ball and a box come down on a mesh as on a plane") {
    World world = make_world();
    MeshDesc floor;
    for (const double x : {-4.0, 4.0}) {
      for (const double z : {-4.0, 4.0}) floor.positions.push_back(vector_cast<Real>(DVec3{x, 0, z}));
    }
    floor.triangles = {{0, 1, 2}, {1, 3, 2}};
    take(world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(floor)))}));
    const BodyId id = take(world.add_body(ball(0.25, {-2, 1.25, 1}, 0.5)));
    BodyDesc box = {.kind = BodyKind::kDynamic, .shape = box_of(0.5, 0.25, 0.5), .position = {1, 0.5, 1}};
    const BodyId crate = take(world.add_body(box));
    lab::Run run = make_run(world, exact(Search::kEvent));
    while (run.collisions().hits < 2 && run.time() < 1) advance(run, 1);
    CHECK(run.collisions().last_hit == doctest::Approx(std::sqrt(2 / kGravity)).epsilon(1e-9));
    CHECK(take(run.body(id)).velocity.y > 1);
    CHECK(take(run.body(crate)).center.y == doctest::Approx(0.25).epsilon(1e-9));
    CHECK(length(take(run.body(crate)).velocity) < 1e-9);
  }

  TEST_CASE("one of five touching balls leaves, as one came") {
    World world = make_world(empty_space());
    std::vector<BodyId> row;
    for (int i = 0; i < 5; ++i) {
      BodyDesc desc = ball(0.125, {i == 0 ? -1.0 : 0.25 * i, 0, 0}, 1);
      if (i == 0) desc.velocity = {Real(2), Real(0), Real(0)};
      row.push_back(take(world.add_body(desc)));
    }
    lab::Run run = make_run(world, {.stepper = "rk4"});
    advance(run, 60);
    for (std::size_t i = 0; i < 5; ++i)
      CHECK(take(run.body(row[i])).velocity.x == doctest::Approx(i == 4 ? 2 : 0).epsilon(1e-9));
    CHECK(run.collisions().hits == 4);
  }

  TEST_CASE("a stack of boxes stands, and is not tried again") {
    World world = make_world();
    take(world.add_body(ground(0.5)));
    std::vector<BodyId> stack;
    for (int i = 0; i < 4; ++i) {
      BodyDesc box = {.kind = BodyKind::kDynamic,
                      .shape = box_of(0.25, 0.25, 0.25),
                      .position = {0.03125 * i, 0.25 + 0.5 * i, 0}};
      stack.push_back(take(world.add_body(box)));
    }
    lab::Run run = make_run(world, {.stepper = "rk4"});
    advance(run, 60);
    for (std::size_t i = 0; i < stack.size(); ++i) {
      CHECK(take(run.body(stack[i])).center.y == doctest::Approx(0.25 + 0.5 * static_cast<double>(i)));
      CHECK(length(take(run.body(stack[i])).velocity) < 1e-9);
    }
    CHECK(run.collisions().rollbacks == 0);
  }

  TEST_CASE("only the region of a hit is taken again, with the same result") {
    const auto run_with = [](bool regional) {
      World world = make_world();
      take(world.add_body(ground()));
      for (int i = 0; i < 6; ++i) take(world.add_body(ball(0.25, {2.0 * i, 0.5 + 0.3 * i, 0}, 0.5)));
      lab::Run run = make_run(world, {.collisions = {.regional = regional}});
      advance(run, 30);
      return run;
    };
    const lab::Run alone = run_with(true);
    const lab::Run all = run_with(false);
    CHECK(alone.collisions().hits == all.collisions().hits);
    CHECK(alone.collisions().resimulated_seconds < 0.5 * all.collisions().resimulated_seconds);
    CHECK(alone.energy().total() == doctest::Approx(all.energy().total()).epsilon(1e-6));
  }

  TEST_CASE("the iteration limit ends a search, and the ball hits all the same") {
    World world = make_world();
    take(world.add_body(ground()));
    const BodyId id = take(world.add_body(ball(0.25, {0, 1.25, 0}, 1)));
    lab::Run run =
        make_run(world, {.collisions = {.search = Search::kHalving, .epsilon = 1e-9, .iteration_limit = 5}});
    advance(run, 60);
    CHECK(run.collisions().limit_reached > 0);
    CHECK(run.collisions().hits == 1);
    CHECK(run.collisions().deepest < 1e-9);
    CHECK(take(run.body(id)).center.y > 0.25);
  }

  TEST_CASE("a backward step leaves an error where the method is not symmetric in time") {
    const auto error_of = [](const std::string& stepper) {
      World world = make_world();
      take(world.add_body(ground()));
      take(world.add_body(ball(0.25, {0, 1.25, 0}, 0)));
      lab::Run run = make_run(world, {.stepper = stepper, .collisions = {.search = Search::kBackward}});
      advance(run, 40);
      return run.collisions().backward_error;
    };
    CHECK(error_of("verlet") < 1e-12);
    CHECK(error_of("euler") > 1e-5);
  }

  TEST_CASE("the preselections leave fewer pairs than all, and the same motion") {
    const auto run_with = [](Preselection preselection) {
      World world = make_world();
      take(world.add_body(ground()));
      for (int i = 0; i < 8; ++i) {
        BodyDesc rod = {.kind = BodyKind::kDynamic, .shape = box_of(0.5, 0.0625, 0.0625)};
        rod.position = {0, 0.3 + 0.4 * i, 0};
        take(world.add_body(rod));
      }
      lab::Run run = make_run(world, {.collisions = {.preselection = preselection, .regional = false}});
      advance(run, 20);
      return std::pair(run.collisions().candidates, run.energy().total());
    };
    const auto all = run_with(Preselection::kAllPairs);
    for (const Preselection kind : kPreselections) {
      if (kind == Preselection::kAllPairs) continue;
      CAPTURE(name_of(kind));
      const auto some = run_with(kind);
      CHECK(some.first < all.first);
      CHECK(some.second == doctest::Approx(all.second).epsilon(1e-9));
    }
    CHECK(run_with(Preselection::kOrientedBox).first < run_with(Preselection::kSphere).first);
    CHECK(run_with(Preselection::kBox).first < run_with(Preselection::kSphere).first);
  }

  TEST_CASE("what cannot be collided, and limits that make no sense, are refused in words") {
    World world = make_world();
    BodyDesc can = {.kind = BodyKind::kDynamic, .shape = Shape::cylinder(Real(0.5), Real(0.5))};
    take(world.add_body(can));
    CHECK(lab::Run::create(world));  // alone it needs none
    take(world.add_body(ground()));
    CHECK(
        lab::Run::create(world).error().message ==
        "a cylinder has no corners; the laboratory collides spheres, capsules, boxes, hulls, half-spaces and "
        "meshes");
    for (const double epsilon : {0.0, -1.0, 2.0, std::nan("")}) {
      CHECK(lab::Run::create(world, {.collisions = {.epsilon = epsilon}}).error().where ==
            "collisions.epsilon");
    }
    CHECK(lab::Run::create(world, {.collisions = {.iteration_limit = 0}}).error().where ==
          "collisions.iteration_limit");
    CHECK(lab::Run::create(world, {.collisions = {.collider = CollisionOptions::Collider::kNone}}));
  }
}

}  // namespace hooke
