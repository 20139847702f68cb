#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

SolidDesc matched(std::array<std::int32_t, 3> cells, Vec3 size, Real hz = Real(10),
                  Real damping = Real(0.1)) {
  SolidDesc desc;
  desc.elasticity = SolidDesc::Elasticity::kShapeMatching;
  desc.cells = cells;
  desc.size = size;
  desc.match_hz = hz;
  desc.match_damping_ratio = damping;
  return desc;
}

std::vector<DVec3> places(const World& world, SolidId solid) {
  std::vector<DVec3> result;
  const PointView view = world.positions(solid);
  for (std::size_t i = 0; i < view.size(); ++i) result.push_back(view[i]);
  return result;
}

/// Largest change of the distance of two points [m].
double deformation(const std::vector<DVec3>& a, const std::vector<DVec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      largest = std::max(largest, std::abs(length(a[i] - a[j]) - length(b[i] - b[j])));
  }
  return largest;
}

/// An octahedron with corners at the distance r from its center.
MeshDesc octahedron(Real r) {
  return {
      .positions = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
      .triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

std::string complaint(World& world, const SolidDesc& desc) {
  const auto added = world.add_solid(desc);
  return added ? "" : added.error().where + ": " + added.error().message;
}

}  // namespace

TEST_SUITE("world/shape_matching") {
  TEST_CASE("a kicked solid keeps momentum and angular momentum, and its shape comes back") {
    for (const Real hz : {Real(4), Real(30), kRigid}) {
      World world = make_world(empty_space());
      const SolidId solid =
          take(world.add_solid(matched({3, 2, 4}, {Real(0.3), Real(0.2), Real(0.5)}, hz, Real(0.3))));
      const std::vector<DVec3> before = places(world, solid);
      REQUIRE(world.apply_impulse(point(solid, 0), {Real(3), Real(2), Real(-4)}).has_value());
      REQUIRE(world.apply_impulse(point(solid, 17), {Real(-5), Real(9), Real(1)}).has_value());
      REQUIRE(world.apply_impulse(point(solid, 40), {Real(1), Real(-7), Real(6)}).has_value());
      run(world, 1);
      const Measurement start = world.measure();
      double worst_momentum = 0, worst_angular = 0;
      for (int i = 0; i < 300; ++i) {
        run(world, 1);
        const Measurement now = world.measure();
        worst_momentum = std::max(worst_momentum, length(now.momentum - start.momentum));
        worst_angular = std::max(worst_angular, length(now.angular_momentum - start.angular_momentum));
      }
      INFO(d(hz) << " Hz: momentum off by " << worst_momentum / length(start.momentum)
                 << ", angular momentum by " << worst_angular / length(start.angular_momentum) << ", form by "
                 << deformation(places(world, solid), before) << " m");
      CHECK(worst_momentum < 1e-5 * length(start.momentum));
      CHECK(worst_angular < 1e-5 * length(start.angular_momentum));
      CHECK(deformation(places(world, solid), before) < (hz > Real(4) ? 1e-3 : 0.02));  // it spins
    }
  }

  TEST_CASE("a spinning solid goes on spinning") {
    World world = make_world(empty_space());
    const SolidId solid =
        take(world.add_solid(matched({3, 3, 3}, {Real(0.4), Real(0.4), Real(0.4)}, Real(20))));
    const PointView points = world.positions(solid);
    const double omega = 2 * std::numbers::pi;  // a turn per second
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const DVec3 v = cross(DVec3{0, omega, 0}, points[i]);
      REQUIRE(world.set_velocity(point(solid, i), vector_cast<Real>(v)).has_value());
    }
    const double energy = world.measure().energy.kinetic;
    const DVec3 first = points[0];
    run(world, 600);
    const DVec3 now = world.positions(solid)[0];
    const double turned = std::atan2(first.z * now.x - first.x * now.z, first.x * now.x + first.z * now.z);
    INFO("after 10 turns off by " << turned << " rad, energy by "
                                  << world.measure().energy.kinetic / energy - 1);
    // w^2 / k = 1/400 farther out: the inertia is larger by 1/200, the turns are fewer by as much.
    CHECK(std::abs(turned) < 0.4);
    CHECK(std::abs(world.measure().energy.kinetic / energy - 1) < 0.01);
  }

  TEST_CASE("any deformation swings at the frequency of the solid, whatever the substeps and cells") {
    for (const int substeps : {8, 32}) {
      for (const int cells : {1, 5}) {
        WorldDesc desc = empty_space();
        desc.substeps = substeps;
        World world = make_world(desc);
        const Real hz = Real(2);
        const SolidId solid = take(world.add_solid(matched({cells, cells, cells}, {1, 1, 1}, hz, 0)));
        const PointView points = world.positions(solid);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
          const DVec3 x = points[i];
          const DVec3 v = {0.1 * x.x, -0.2 * x.y, 0.15 * x.x * x.z};
          REQUIRE(world.set_velocity(point(solid, i), vector_cast<Real>(v)).has_value());
        }
        const double start = points[0].x;
        int crossings = 0;
        double last = 0, before = 0;
        for (int i = 0; i < 600; ++i) {
          run(world, 1);
          const double now = world.positions(solid)[0].x - start;
          if (before != 0 && (now > 0) != (before > 0)) {
            ++crossings;
            last = world.time() - now / (now - before) / 60;
          }
          before = now;
        }
        const double measured = 0.5 * crossings / last;
        INFO(substeps << " substeps, " << cells << " cells: " << measured << " Hz");
        CHECK(std::abs(measured - d(hz)) < 0.005 * d(hz));
      }
    }
  }

  TEST_CASE("a solid on the ground sinks in by what its lowest points carry") {
    WorldDesc world_desc = without_air();
    world_desc.particle_substeps = 4;  // (h w)^2 is what one substep leaves too soft, 0.3 %
    World world = make_world(world_desc);
    (void)take(world.add_body({}));
    SolidDesc desc = matched({4, 4, 4}, {Real(0.4), Real(0.4), Real(0.4)}, Real(16), Real(1));
    desc.position = {0, 0.25, 0};
    const SolidId solid = take(world.add_solid(desc));
    run(world, 300);
    double mass = 0, carried = 0;
    DVec3 center;
    const PointView points = world.positions(solid);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      // Of a box of cells a quarter of each tetrahedron: read back as momentum per speed.
      World probe = make_world(empty_space());
      const SolidId copy = take(probe.add_solid(desc));
      REQUIRE(probe.set_velocity(point(copy, i), {1, 0, 0}).has_value());
      const double m = probe.measure().momentum.x;
      mass += m;
      center += m * points[i];
      if (points[i].y < 0.0021) carried += m;
    }
    center = (1 / mass) * center;
    const double k = std::pow(2 * std::numbers::pi * 16, 2);
    const double expected = 0.2 + 0.002 - kGravity / k * (mass - carried) / carried;
    INFO("center at " << center.y << " m, by statics " << expected << " m, of 0.202 m");
    CHECK(std::abs(center.y - expected) < 0.01 * (0.202 - expected));
    CHECK(d(world.velocities(solid).offset(3).y) == doctest::Approx(0).epsilon(1e-4));
  }

  TEST_CASE("a matched solid collides and hooks as other solids do, and a rigid one is a pendulum") {
    World world = make_world(without_air());
    SolidDesc desc = matched({2, 2, 2}, {Real(0.2), Real(0.2), Real(0.2)}, kRigid);
    desc.position = {1, 0, 0};
    const SolidId solid = take(world.add_solid(desc));
    const BodyId arm = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::box({Real(0.45), Real(0.02), Real(0.02)}),
                                            .position = {0.45, 0, 0},
                                            .mass = Real(1)}));
    HookDesc hook;
    hook.kind = HookKind::kHinge;
    hook.a = {.body = arm, .connection_point = "left"};
    hook.axis = {0, 0, 1};
    std::swap(hook.a, hook.b);
    (void)take(world.add_hook(hook));
    HookDesc tie;
    tie.a = {.body = arm, .connection_point = "right"};
    tie.b = {.point = point(solid, 0), .connection_point = "left"};
    const HookId knot = take(world.add_hook(tie));
    run(world, 1200);
    CHECK(d(world.hook_gap(knot)) < 1e-4);
    const Result<DVec3> center = world.find_place({.point = point(solid, 0), .connection_point = "center"});
    CHECK(length(take(center)) < 1.02);

    const SolidId ball = take(world.add_solid([&] {
      SolidDesc mesh = matched({}, {});
      mesh.mesh = take(world.add_mesh(octahedron(Real(0.3))));
      mesh.position = {5, 3, 0};
      return mesh;
    }()));
    CHECK(world.positions(ball).size() == 6);
    CHECK(world.volume(ball) == doctest::Approx(4.0 / 3 * 0.027).epsilon(1e-5));
    CHECK(world.triangles(ball).size() == 8);
    CHECK(world.surface(ball).size() == 6);
    const HookId on_face =
        take(world.add_hook({.b = {.point = point(ball, PointRef::kNearest)}, .anchor = {5.2, 3.2, 0.2}}));
    CHECK(length(world.hook_anchors(on_face)[1] - DVec3{5.1, 3.1, 0.1}) < 1e-6);
  }

  TEST_CASE("a matched solid comes back from inside out, from a plane and from a point") {
    for (const int how : {0, 1, 2, 3}) {
      World world = make_world(empty_space());
      const SolidId solid =
          take(world.add_solid(matched({2, 2, 2}, {Real(0.4), Real(0.3), Real(0.2)}, Real(6), Real(0.5))));
      const std::vector<DVec3> before = places(world, solid);
      for (std::uint32_t i = 0; i < before.size(); ++i) {
        DVec3 p = before[i];
        if (how == 0) p.x = -p.x;
        if (how == 1) p = -p;
        if (how == 2) p.y = 0;
        if (how == 3) p = {};
        REQUIRE(world.set_position(point(solid, i), p).has_value());
      }
      run(world, 300);
      CHECK(deformation(places(world, solid), before) < 1e-4);
      CHECK(length(world.measure().momentum) < 1e-4);
      CHECK(length(world.measure().angular_momentum) < 1e-4);
    }
  }

  TEST_CASE("the energy of a matched solid falls by its damping only") {
    World world = make_world(empty_space());
    const SolidId solid =
        take(world.add_solid(matched({2, 2, 2}, {Real(0.4), Real(0.4), Real(0.4)}, Real(3), Real(0.02))));
    REQUIRE(world.apply_impulse(point(solid, 0), {2, 1, 0}).has_value());
    run(world, 1);
    double least = world.measure().energy.total();
    const double first = least;
    for (int i = 0; i < 600; ++i) {
      run(world, 1);
      const double now = world.measure().energy.total();
      CHECK(now < least + 1e-3 * first);
      least = std::min(least, now);
    }
    CHECK(least < first);
  }

  TEST_CASE("matched solids have the same bits with any number of workers, and after a restore") {
    test::check_same_bits(without_air(), [](World& world) {
      (void)take(world.add_body({}));
      for (int i = 0; i < 5; ++i) {
        SolidDesc desc =
            matched({2, 3, 2}, {Real(0.3), Real(0.4), Real(0.2)}, i == 0 ? kRigid : static_cast<Real>(5 * i));
        desc.position = {0.5 * i, 0.5, 0};
        desc.rotation = normalize(Quat{Real(0.1), Real(0.2), Real(0.3), Real(1)});
        (void)take(world.add_solid(desc));
      }
    });
  }

  TEST_CASE("an impossible matched solid is an error that says why") {
    World world = make_world();
    SolidDesc desc = matched({1, 1, 1}, {1, 1, 1}, Real(0));
    CHECK(complaint(world, desc) == "solid.match_hz: 0 is out of range, must be positive, or rigid");
    desc = matched({1, 1, 1}, {1, 1, 1}, Real(5), Real(-1));
    CHECK(complaint(world, desc) == "solid.match_damping_ratio: -1 is out of range, must be 0 to 100");
    desc = matched({1, 1, 1}, {1, 1, 1});
    desc.yield_stress = Real(100);
    CHECK(complaint(world, desc) == "solid.yield_stress: needs tetrahedra");
    desc = matched({1, 1, 1}, {1, 1, 1});
    desc.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    CHECK(complaint(world, desc) == "solid.total_mass: is needed for points without tetrahedra");
    desc.total_mass = Real(1);
    CHECK(complaint(world, desc) == "solid.points: must not lie in one plane");
    desc.points[3].z = Real(1);
    CHECK(complaint(world, desc) == "");
    MeshDesc open = octahedron(1);
    open.triangles.pop_back();
    desc.mesh = take(world.add_mesh(open));
    CHECK(complaint(world, desc) == "solid.mesh: must be closed and face outward");
  }
}

}  // namespace hooke
