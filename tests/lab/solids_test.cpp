#include "constants.h"
#include "geometry/meshes.h"
#include "lab/scenes.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace hooke {

using lab::CollisionOptions;
using test::advance;
using test::empty_space;
using test::kGravity;
using test::make_run;
using test::make_world;
using test::take;
using MeshSearch = CollisionOptions::MeshSearch;
using Search = CollisionOptions::Search;
using Sweep = CollisionOptions::Sweep;

namespace {

BodyDesc solid(World& world, const MeshDesc& mesh, DVec3 position, double restitution = 0) {
  BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::of_mesh(take(world.add_mesh(mesh)))};
  desc.position = position;
  desc.contact = {.friction = Real(0), .restitution = static_cast<Real>(restitution)};
  return desc;
}

MeshDesc ell() {
  return test::make_ell(Real(0.5));
}

Quat about_z(double angle) {
  return quaternion_about(Vec3{0, 0, 1}, static_cast<Real>(angle));
}

/// A disc of radius 1 m about z, of density 1000, with an axle through its middle.
struct Wheel {
  BodyId id = {};
  double inertia = 0;

  Wheel(World& world, DVec3 position, double half_thickness = 0.125) {
    BodyDesc disc = {.kind = BodyKind::kDynamic,
                     .shape = Shape::box({Real(1), Real(0.25), static_cast<Real>(half_thickness)})};
    disc.position = position;
    disc.contact = {.friction = Real(0), .restitution = Real(0)};
    id = take(world.add_body(disc));
    take(world.add_hook({.kind = HookKind::kHinge, .b = {id}, .anchor = position, .axis = {0, 0, 1}}));
    const double mass = 1000 * 2 * 0.5 * 2 * half_thickness;
    inertia = mass * (1 + 0.0625) / 3;
  }
};

}  // namespace

TEST_SUITE("lab/solids") {
  TEST_CASE("a concave solid falls over an arm that stands in its notch, and touches when its notch does") {
    // The notch of an ell on its back: its inner face, at y = 0 below the ell's frame, comes down on a post
    // that the hull of the ell would have met 0.5 m before.
    for (const Search search : {Search::kHalving, Search::kEvent, Search::kAdvancement}) {
      for (const MeshSearch mesh_search : {MeshSearch::kTree, MeshSearch::kAll}) {
        CAPTURE(static_cast<int>(search));
        World world = make_world();
        // Upside down: the arms are above x in [-2, 0] and beside; the notch is open below and to the left.
        BodyDesc corner = solid(world, ell(), {0, 3, 0}, 1);
        corner.rotation = about_z(std::numbers::pi);
        const BodyId id = take(world.add_body(corner));
        const MeshDesc post = test::make_box({Real(0.25), Real(0.5), Real(0.25)});
        BodyDesc stands = solid(world, post, {-1.5, 0.5, 0});
        stands.kind = BodyKind::kStatic;
        take(world.add_body(stands));
        lab::Run run = make_run(world, {.stepper = "rk4",
                                        .collisions = {.mesh_search = mesh_search,
                                                       .search = search,
                                                       .sweep = Sweep::kNone,
                                                       .epsilon = 1e-9,
                                                       .iteration_limit = 200}});
        while (run.collisions().hits == 0 && run.time() < 1) advance(run, 1);
        // From 3 - 1 to 1.
        CHECK(std::abs(run.collisions().last_hit - std::sqrt(2 * 1 / kGravity)) < 1e-6);
        CHECK(run.collisions().deepest < 1.0001e-9);
        CHECK(length(take(run.body(id)).angular_velocity) > 0.1);  // it is hit aside of its center
      }
    }
  }

  TEST_CASE("a hit of two solids follows from their masses and inertias, and keeps momentum and energy") {
    World world = make_world(empty_space());
    const double half = 0.5;
    const MeshDesc cube = test::make_box({Real(half), Real(half), Real(half)});
    BodyDesc first = solid(world, cube, {0, 0, 0}, 1);
    first.velocity = {Real(1), Real(0), Real(0)};
    BodyDesc second = solid(world, cube, {1.25, 0, 0}, 1);
    second.density = 3000;
    const BodyId a = take(world.add_body(first));
    const BodyId b = take(world.add_body(second));
    lab::Run run = make_run(world, {.stepper = "rk4"});
    const double energy = run.energy().total();
    advance(run, 30);
    CHECK(run.collisions().hits == 1);
    CHECK(run.collisions().last_hit == doctest::Approx(0.25).epsilon(1e-5));
    // v1' = (m1 - m2) / (m1 + m2), v2' = 2 m1 / (m1 + m2)
    CHECK(take(run.body(a)).velocity.x == doctest::Approx(-0.5));
    CHECK(take(run.body(b)).velocity.x == doctest::Approx(0.5));
    CHECK(length(take(run.body(b)).angular_velocity) < 1e-9);
    CHECK(run.energy().total() == doctest::Approx(energy).epsilon(1e-12));
  }

  TEST_CASE("a solid rests on another and slides down a slope of solids as Coulomb says") {
    for (const double friction : {0.2, 0.6}) {
      CAPTURE(friction);
      World world = make_world();
      const double slope = std::atan(0.5);
      BodyDesc plate = solid(world, test::make_box({Real(8), Real(0.5), Real(1)}), {0, 0, 0});
      plate.kind = BodyKind::kStatic;
      plate.rotation = about_z(-slope);
      plate.contact.friction = static_cast<Real>(friction);
      take(world.add_body(plate));
      const DVec3 up = {std::sin(slope), std::cos(slope), 0};
      const DVec3 down = {std::cos(slope), -std::sin(slope), 0};
      // The ell lies on one of its flat sides.
      BodyDesc block = solid(world, ell(), 1.0 * up - 4.0 * down);
      block.rotation = about_z(-slope) * quaternion_about(Vec3{1, 0, 0}, Real(std::numbers::pi / 2));
      block.contact.friction = static_cast<Real>(friction);
      const BodyId id = take(world.add_body(block));
      lab::Run run = make_run(world, {.stepper = "rk4", .collisions = {.sweep = Sweep::kNone}});
      const DVec3 before = take(run.body(id)).center;
      advance(run, 60);
      const double a = kGravity * std::max(0.0, std::sin(slope) - friction * std::cos(slope));
      CHECK(std::abs(dot(take(run.body(id)).center - before, down) - 0.5 * a) < 1e-4);
      CHECK(std::abs(dot(take(run.body(id)).center - before, up)) < 1e-5);
    }
  }

  TEST_CASE("a ball in the notch of a solid, and a solid on a plane, come to rest there") {
    World world = make_world();
    take(world.add_body({.shape = Shape::half_space()}));
    BodyDesc corner = solid(world, ell(), {0, 0.25, 0});
    corner.contact.friction = Real(0.5);
    const BodyId id = take(world.add_body(corner));
    const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::sphere(Real(0.25)),
                                             .position = {1.4, 2, 0},
                                             .velocity = {Real(-0.2), Real(0), Real(0)}}));
    lab::Run run = make_run(world, {.stepper = "rk4", .collisions = {.sweep = Sweep::kNone}});
    advance(run, 240);
    CHECK(take(run.body(id)).center.y == doctest::Approx(5.0 / 6).epsilon(1e-5));
    CHECK(take(run.body(ball)).center.y == doctest::Approx(1.25).epsilon(1e-5));
    CHECK(take(run.body(ball)).center.x > 1.25 - 1e-5);
    CHECK(length(take(run.body(id)).velocity) < 1e-6);
  }

  TEST_CASE("a wheel on its axle only turns, and hits with its inertia") {
    World world = make_world();
    const Wheel wheel(world, {0, 2, 0});
    BodyDesc ball = {
        .kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.125)), .position = {0.75, 3, 0}};
    ball.mass = Real(10);
    ball.contact = {.friction = Real(0), .restitution = Real(1)};
    const BodyId id = take(world.add_body(ball));
    lab::Run run = make_run(world, {.stepper = "rk4", .collisions = {.epsilon = 1e-9}});
    CHECK(run.report()[0].left_out.empty());
    const double energy = run.energy().total();
    while (run.collisions().hits == 0 && run.time() < 1) advance(run, 1);
    const double h = 3 - 0.125 - 2.25;
    const double v = std::sqrt(2 * kGravity * h);
    CHECK(std::abs(run.collisions().last_hit - std::sqrt(2 * h / kGravity)) < 1e-7);
    // An impulse p at the lever r: I omega = r p, m (v' + v) = p, and energy is kept.
    const double r = 0.75;
    const double p = 2 * v / (1.0 / 10 + r * r / wheel.inertia);
    const lab::BodyState now = take(run.body(wheel.id));
    CHECK(now.angular_velocity.z == doctest::Approx(-r * p / wheel.inertia).epsilon(1e-6));
    CHECK(length(now.center - DVec3{0, 2, 0}) == 0);
    CHECK(length(now.velocity) == 0);
    CHECK(run.energy().total() == doctest::Approx(energy).epsilon(1e-9));
    advance(run, 600);
    CHECK(length(take(run.body(wheel.id)).center - DVec3{0, 2, 0}) == 0);
    CHECK(std::abs(take(run.body(wheel.id)).angular_velocity.x) < 1e-12);
    CHECK(take(run.body(id)).center.y < -100);
    // The same where the hinge does not hold: it falls.
    World loose = make_world();
    const Wheel same(loose, {0, 2, 0});
    take(loose.add_hook({.kind = HookKind::kBall, .b = {same.id}, .anchor = {0, 2, 0}}));
    lab::Run other = make_run(loose, {});
    CHECK(other.report()[0].left_out.size() == 1);
    advance(other, 60);
    CHECK(take(other.body(same.id)).center.y == doctest::Approx(2 - kGravity / 2));
  }

  TEST_CASE("meshes that are no solids are told, by the laboratory as by the world") {
    World world = make_world();
    MeshDesc open = test::make_box({Real(1), Real(1), Real(1)});
    open.triangles.pop_back();
    take(world.add_body({.shape = Shape::of_mesh(take(world.add_mesh(open)))}));
    take(world.add_body(
        {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.5)), .position = {0, 2, 0}}));
    CHECK(lab::Run::create(world));  // balls come down on any triangles
    take(world.add_body(solid(world, ell(), {0, 5, 0})));
    const auto refused = lab::Run::create(world);
    REQUIRE(!refused);
    CHECK(refused.error().where == "body 1");
    CHECK(refused.error().message.find("no solid") != std::string::npos);
  }
}

}  // namespace hooke
