#include "solver/contact/body_contacts.h"

#include "solver/body_scene.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <cstring>
#include <doctest/doctest.h>
#include <numbers>

namespace hooke::solver {
namespace {

using testing::BodyScene;
using testing::Manifold;
using testing::place_box;
using testing::place_sphere;
using testing::solid_box;
using testing::solid_sphere;
using testing::Surface;

constexpr Vec3 kUp = {Real(0), Real(1), Real(0)};
constexpr Real kG = Real(9.81);

/// Boxes of edge 1 m and 1000 kg in a column on the plane y = 0, touching.
void add_column(BodyScene& scene, int count) {
  std::uint32_t below = scene.add({Real(0)}, {});
  const Vec3 half = {Real(0.5), Real(0.5), Real(0.5)};
  for (int i = 0; i < count; ++i) {
    const std::uint32_t box = scene.add(solid_box(Real(1000), half), {0, 0.5 + i, 0});
    const Vec3 on_a = i == 0 ? Vec3{} : Vec3{Real(0), half.y, Real(0)};
    scene.add_contact(below, box, {.friction = Real(0.6)},
                      [on_a, half](BodyScene& s, Manifold& m) { place_box(s, m, on_a, kUp, half); });
    below = box;
  }
}

/// A sphere of radius r above the plane y = 0, its lowest point at `height`.
std::uint32_t add_sphere(BodyScene& scene, Real radius, double height, const Surface& surface) {
  const std::uint32_t plane = scene.add({Real(0)}, {});
  const std::uint32_t ball =
      scene.add(solid_sphere(Real(2), radius), {0, height + static_cast<double>(radius), 0});
  scene.add_contact(plane, ball, surface,
                    [radius](BodyScene& s, Manifold& m) { place_sphere(s, m, kUp, Real(0), radius); });
  return ball;
}

/// A box of edge 0.2 m on a plane whose slope is `tangent`, at rest, after `steps`: how far it went [m].
double slide(Real tangent, Real friction, bool in_bias, int steps) {
  BodyScene scene;
  scene.settings.friction_in_bias = in_bias;
  const double angle = std::atan(static_cast<double>(tangent));
  const Quat tilt = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, static_cast<Real>(angle));
  const Vec3 half = {Real(0.1), Real(0.1), Real(0.1)};
  const std::uint32_t plane = scene.add({Real(0)}, {}, tilt);
  const DVec3 start = vector_cast<double>(rotate(tilt, Vec3{Real(0), half.y, Real(0)}));
  const std::uint32_t box = scene.add(solid_box(Real(8), half), start, tilt);
  scene.add_contact(plane, box, {.friction = friction},
                    [half](BodyScene& s, Manifold& m) { place_box(s, m, {}, kUp, half); });
  scene.run(steps);
  return length(scene.bodies.center[box] - start);
}

}  // namespace

TEST_SUITE("solver/body_contacts") {
  TEST_CASE("a box on a plane settles, and its contact carries its weight") {
    BodyScene scene;
    add_column(scene, 1);
    scene.run(300);
    const double weight = 1000.0 * static_cast<double>(kG * scene.settings.h);
    CHECK(normal_impulse(scene.manifolds[0]) == doctest::Approx(weight).epsilon(1e-4));
    // At rest a row is a spring of stiffness m omega^2, here of twice 60 Hz with all the mass on four rows.
    CHECK(scene.bodies.center[1].y - 0.5 < 0.0);
    CHECK(scene.bodies.center[1].y - 0.5 > -1e-4);
    CHECK(length(scene.velocity(1)) < Real(1e-5));
    CHECK(scene.manifolds[0].touching);
  }

  TEST_CASE("each contact of a column carries all that lies above it") {
    BodyScene scene;
    add_column(scene, 3);
    scene.run(600);
    const double weight = 1000.0 * static_cast<double>(kG * scene.settings.h);
    for (int i = 0; i < 3; ++i)
      CHECK(normal_impulse(scene.manifolds[i]) == doctest::Approx((3 - i) * weight).epsilon(1e-3));
    CHECK(scene.bodies.center[3].y > 2.499);
    CHECK(length(scene.velocity(3)) < Real(1e-4));
  }

  TEST_CASE("a box slides down a slope with g (sin - mu cos)") {
    const double cosine = 1 / std::sqrt(1 + 0.364 * 0.364);
    const double a = static_cast<double>(kG) * (0.364 - 0.2) * cosine;
    for (const bool in_bias : {false, true}) {
      CAPTURE(in_bias);
      CHECK(slide(Real(0.364), Real(0.2), in_bias, 120) == doctest::Approx(0.5 * a * 4).epsilon(2e-3));
    }
  }

  TEST_CASE("a box with friction just over the slope stays where it is") {
    CHECK(slide(Real(0.364), Real(0.368), false, 600) < 2e-3);
    const double creep =
        slide(Real(0.364), Real(0.45), false, 1200) - slide(Real(0.364), Real(0.45), false, 600);
    CHECK(std::abs(creep) < 1e-5);  // 1 um/s over ten seconds
  }

  TEST_CASE("static friction holds what dynamic friction would let go") {
    for (const Real push : {Real(0.35), Real(0.45)}) {  // in units of the weight; 0.3 dynamic, 0.4 static
      BodyScene scene;
      add_column(scene, 1);
      scene.manifolds[0].friction = Real(0.3);
      scene.manifolds[0].static_friction = Real(0.4);
      scene.run(120);
      const auto push_for = [&](int steps, bool slowly) {
        for (int i = 1; i <= steps; ++i) {
          const Real part = slowly ? static_cast<Real>(i) / static_cast<Real>(steps) : Real(1);
          scene.bodies.force[1] = {part * push * Real(1000) * kG, Real(0), Real(0)};
          scene.step();
        }
        return static_cast<double>(scene.velocity(1).x);
      };
      const double v = push_for(120, true);
      const double gained = push_for(60, false) - v;
      if (push < Real(0.4)) CHECK(std::abs(v) + std::abs(gained) < 1e-4);
      if (push > Real(0.4)) CHECK(gained == doctest::Approx((0.45 - 0.3) * 9.81).epsilon(1e-3));
    }
  }

  TEST_CASE("a conveyor brings a box to its speed") {
    BodyScene scene;
    add_column(scene, 1);
    scene.manifolds[0].surface_velocity = {Real(-1), Real(0), Real(0)};  // of B relative to A: the belt is A
    scene.run(240);
    CHECK(scene.velocity(1).x == doctest::Approx(1.0).epsilon(1e-4));
  }

  TEST_CASE("what does not bounce is stopped at the surface beside what bounces, too") {
    // What reaches the surface is a rounding above or below it: from one of many heights it is above.
    for (int k = 0; k < 50; ++k) {
      BodyScene scene;
      const Real radius = Real(0.1);
      const std::uint32_t ball = add_sphere(scene, radius, 0.05 + 0.0007 * k, {});
      add_sphere(scene, radius, 0.015, {.restitution = Real(0.8)});
      scene.bodies.motion[ball].v = {Real(0), Real(-2), Real(0)};
      for (int i = 0; i < 30; ++i) {
        scene.step();
        const double gap = scene.bodies.center[ball].y - static_cast<double>(radius);
        const double way = -static_cast<double>(scene.velocity(ball).y * scene.settings.h);
        CHECK(way <= std::max(gap, 0.0) + 1e-5);
      }
    }
  }

  TEST_CASE("two free bodies that touch and push each other keep momentum and angular momentum") {
    BodyScene scene;
    scene.settings.gravity = {};
    const std::uint32_t a = scene.add(solid_sphere(Real(1), Real(0.5)), {0, 0, 0});
    const std::uint32_t b = scene.add(solid_sphere(Real(3), Real(0.5)), {0.8, 0.6, 0});
    scene.bodies.motion[a].v = {Real(4), Real(0.5), Real(0)};
    scene.spin(a, {Real(0), Real(3), Real(20)});
    scene.add_contact(a, b, {.friction = Real(0.5)},
                      [](BodyScene& s, Manifold& m) { place_sphere(s, m, {}, Real(0.5), Real(0.5)); });
    struct Sums {
      DVec3 p, l;
    };
    // Rows are those of the start of a step, and so is the place at which they keep angular momentum.
    const std::vector<DVec3> places = scene.bodies.center;
    const auto sums = [&] {
      Sums s;
      for (const std::uint32_t i : {a, b}) {
        const DVec3 p =
            static_cast<double>(scene.bodies.mass[i].mass) * vector_cast<double>(scene.velocity(i));
        s.p += p;
        s.l += cross(places[i], p) + vector_cast<double>(scene.bodies.angular_momentum[i]);
      }
      return s;
    };
    const Sums before = sums();
    scene.step();
    const Sums after = sums();
    CHECK(scene.velocity(b).x > Real(0.2));
    CHECK(length(after.p - before.p) < 1e-6 * length(before.p));
    CHECK(length(after.l - before.l) < 1e-6 * length(before.l));
  }

  TEST_CASE("a sliding ball rolls at 5/7 of its speed after 2 v / (7 mu g)") {
    // Coriolis, Theorie mathematique des effets du jeu de billard, 1835.
    constexpr Real kMu = Real(0.2);
    constexpr Real kSpeed = Real(7);
    BodyScene scene;
    scene.dt = Real(1) / Real(240);
    const std::uint32_t ball = add_sphere(scene, Real(0.1), 0.0, {.friction = kMu});
    scene.run(60);
    const double start = scene.bodies.center[ball].x;
    scene.bodies.motion[ball].v.x = kSpeed;
    double rolls_at = 0;
    double way = 0;
    for (int i = 1; i <= 480 && rolls_at == 0; ++i) {
      scene.step();
      const Real slip = scene.velocity(ball).x + Real(0.1) * scene.bodies.angular_velocity[ball].z;
      if (slip > Real(1e-3) * kSpeed) continue;
      rolls_at = i / 240.0;
      way = scene.bodies.center[ball].x - start;
    }
    const double mu_g = static_cast<double>(kMu * kG);
    CHECK(rolls_at == doctest::Approx(2 * 7 / (7 * mu_g)).epsilon(5e-3));
    CHECK(way == doctest::Approx(12 * 49 / (49 * mu_g)).epsilon(5e-3));
    scene.run(60);
    CHECK(scene.velocity(ball).x == doctest::Approx(5.0).epsilon(5e-3));
  }

  TEST_CASE("rolling friction slows a rolling ball by its lever, and holds it at rest") {
    // Rolling: (7/5) m r a = -lever m g.
    constexpr Real kLever = Real(0.005);
    BodyScene scene;
    const std::uint32_t ball = add_sphere(scene, Real(0.1), 0.0, {.friction = Real(1)});
    scene.manifolds[0].rolling_friction = kLever;
    scene.run(60);
    scene.bodies.motion[ball].v.x = Real(2);
    scene.spin(ball, {Real(0), Real(0), Real(-20)});
    scene.run(120);
    const double a = static_cast<double>(kLever * kG) / (1.4 * 0.1);
    CHECK(scene.velocity(ball).x == doctest::Approx(2 - 2 * a).epsilon(2e-3));
    scene.run(600);
    CHECK(length(scene.velocity(ball)) < Real(1e-4));
  }

  TEST_CASE("spinning friction stops a ball that spins on its spot") {
    // I dw/dt = -lever m g.
    constexpr Real kLever = Real(0.002);
    BodyScene scene;
    const std::uint32_t ball = add_sphere(scene, Real(0.1), 0.0, {.friction = Real(0.5)});
    scene.manifolds[0].spinning_friction = kLever;
    scene.run(60);
    scene.spin(ball, {Real(0), Real(20), Real(0)});
    scene.run(60);
    const double rate = static_cast<double>(kLever * kG) / (0.4 * 0.01);
    CHECK(scene.bodies.angular_velocity[ball].y == doctest::Approx(20 - rate).epsilon(2e-3));
  }
}

}  // namespace hooke::solver
