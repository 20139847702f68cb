#include "solver/joint/joints.h"

#include "constants.h"
#include "solver/joint_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

namespace hooke::solver {
using test::kGravity;
using test::kPi;

namespace {

/// Time between two rises of `value` through zero, by straight lines between steps [s].
template <class Value>
double period_of(JointRig& rig, int substeps, Value&& value) {
  const Real dt = Real(1) / Real(240);
  double first = -1;
  double last = value();
  for (int i = 0; i < 10000; ++i) {
    rig.step(dt, substeps);
    const double now = value();
    if (last < 0 && now >= 0) {
      const double time = (i + last / (last - now)) * d(dt);
      if (first >= 0) return time - first;
      first = time;
    }
    last = now;
  }
  return 0;
}

/// A rod of 2 kg and 1 m that hangs from its upper end, turned by `angle` about z.
BodyId add_rod(JointRig& rig, double angle) {
  return rig.add({.center = {0.5 * std::sin(angle), -0.5 * std::cos(angle), 0},
                  .mass = Real(2),
                  .inertia = box_inertia(Real(2), {Real(0.05), Real(0.5), Real(0.05)}),
                  .rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, static_cast<Real>(angle))});
}

/// A wheel of 3 kg and 0.4 m about z, free to turn on the world.
struct Wheel {
  JointRig rig;
  BodyId body;
  double inertia = 0.5 * 3 * 0.4 * 0.4;

  explicit Wheel(const HookMotor& motor) {
    rig.gravity = {};
    body = rig.add({.mass = Real(3), .inertia = {Real(0.12), Real(0.12), static_cast<Real>(inertia)}});
    rig.hook({.kind = HookKind::kHinge, .b = {body}, .axis = {Real(0), Real(0), Real(1)}, .motor = motor});
  }
};

TEST_SUITE("solver/joints") {
  TEST_CASE("a rod on a hinge and on a ball swings with its period as a physical pendulum") {
    const double amplitude = 0.1;
    const double inertia = d(box_inertia(Real(2), {Real(0.05), Real(0.5), Real(0.05)}).z) + 2 * 0.25;
    // T = 2 pi sqrt(I / (m g d)) (1 + a^2/16 + ...)
    const double exact =
        2 * kPi * std::sqrt(inertia / (2 * kGravity * 0.5)) * (1 + amplitude * amplitude / 16);
    for (const HookKind kind : {HookKind::kHinge, HookKind::kBall}) {
      JointRig rig;
      const BodyId rod = add_rod(rig, amplitude);
      rig.hook({.kind = kind, .b = {rod}, .axis = {Real(0), Real(0), Real(1)}});
      CHECK(period_of(rig, 4, [&] { return rig.center(rod).x; }) == doctest::Approx(exact).epsilon(1e-4));
    }
  }

  TEST_CASE("a hinge leaves its axis free only, and its angle goes on beyond whole turns") {
    JointRig rig;
    rig.gravity = {};
    const BodyId body = rig.add({.angular_velocity = {Real(1), Real(2), Real(5)}});
    const std::size_t hook =
        rig.hook({.kind = HookKind::kHinge, .b = {body}, .axis = {Real(0), Real(0), Real(1)}});
    rig.run(3);
    CHECK(d(rig.omega(body).x) == doctest::Approx(0).epsilon(1e-4));
    CHECK(d(rig.omega(body).y) == doctest::Approx(0).epsilon(1e-4));
    CHECK(d(rig.omega(body).z) == doctest::Approx(5).epsilon(1e-4));
    CHECK(rig.t.hooks[hook].value[3] == doctest::Approx(15).epsilon(1e-2));
  }

  TEST_CASE("a motor speeds up by its torque until it has its speed") {
    Wheel wheel({.speed = Real(10), .max_force = Real(0.6)});
    wheel.rig.run(1);
    // omega = torque t / I
    CHECK(d(wheel.rig.omega(wheel.body).z) == doctest::Approx(0.6 / wheel.inertia).epsilon(1e-4));
    wheel.rig.run(3.5);
    CHECK(d(wheel.rig.omega(wheel.body).z) == doctest::Approx(10).epsilon(1e-5));
    CHECK(d(wheel.rig.t.hooks[0].torque.z) == doctest::Approx(0).epsilon(1e-3));
  }

  TEST_CASE("a motor holds a load up to its torque and not more") {
    // A rod held level needs m g l / 2.
    const double load = 2 * kGravity * 0.5;
    for (const double share : {1.01, 0.99}) {
      JointRig rig;
      const BodyId rod = add_rod(rig, 0.5 * kPi);
      const std::size_t hook = rig.hook({.kind = HookKind::kHinge,
                                         .b = {rod},
                                         .axis = {Real(0), Real(0), Real(1)},
                                         .motor = {.max_force = static_cast<Real>(share * load)}});
      rig.run(2);
      if (share > 1) {
        CHECK(rig.center(rod).y == doctest::Approx(0).epsilon(1e-4));
        CHECK(d(rig.t.hooks[hook].torque.z) == doctest::Approx(load).epsilon(1e-4));
      } else {
        CHECK(rig.center(rod).y < -0.01);
      }
    }
  }

  TEST_CASE("friction stops a wheel at the time of its torque") {
    Wheel wheel({.max_force = Real(0.6)});
    REQUIRE(wheel.rig.t.bodies.motion.size() == 1);
    wheel.rig.t.bodies.angular_momentum[0] = {Real(0), Real(0), Real(0.9)};
    wheel.rig.run(1.4);
    CHECK(d(wheel.rig.omega(wheel.body).z) * wheel.inertia == doctest::Approx(0.9 - 1.4 * 0.6).epsilon(1e-3));
    wheel.rig.run(0.2);
    CHECK(d(wheel.rig.omega(wheel.body).z) == doctest::Approx(0).epsilon(1e-5));
  }

  TEST_CASE("a weight on a sprung slider swings with the period of its spring") {
    JointRig rig;
    rig.gravity = {};
    const BodyId body = rig.add({.center = {0.2, 0, 0}, .mass = Real(3)});
    rig.hook({.kind = HookKind::kSlider,
              .b = {body},
              .anchor = {0.2, 0, 0},
              .axis = {Real(1), Real(0), Real(0)},
              .spring = {.stiffness = Real(120), .target = Real(-0.2)}});
    const double exact = 2 * kPi * std::sqrt(3 / 120.0);
    CHECK(period_of(rig, 16, [&] { return rig.center(body).x; }) == doctest::Approx(exact).epsilon(1e-3));
    CHECK(std::abs(rig.center(body).y) < 1e-6);
  }

  TEST_CASE("a distance holds like a rod, or up to its largest like a rope") {
    JointRig rig;
    const BodyId on_rod = rig.add({.center = {1, 0, 0}});
    const BodyId on_rope = rig.add({.center = {5, 0.5, 0}});
    rig.hook({.kind = HookKind::kDistance, .b = {on_rod}, .anchor_b = DVec3{1, 0, 0}});
    rig.hook({.kind = HookKind::kDistance,
              .b = {on_rope},
              .anchor = {5, 0, 0},
              .anchor_b = DVec3{5, 0.5, 0},
              .limits = {.upper = Real(1)}});
    rig.run(0.5);
    CHECK(length(rig.center(on_rod)) == doctest::Approx(1).epsilon(1e-3));
    // Free fall as long as the rope is slack.
    CHECK(rig.center(on_rope).y == doctest::Approx(0.5 - 0.5 * kGravity * 0.25).epsilon(0.01));
    rig.run(5);
    CHECK(length(rig.center(on_rod)) == doctest::Approx(1).epsilon(1e-3));
    CHECK(rig.center(on_rope).y == doctest::Approx(-1).epsilon(1e-4));
    CHECK(d(rig.t.hooks[1].force.y) == doctest::Approx(kGravity).epsilon(1e-4));
  }

  TEST_CASE("a door stops at its limits") {
    JointRig rig;
    rig.gravity = {};
    const BodyId door = rig.add({.center = {0.5, 0, 0}, .angular_velocity = {Real(0), Real(4), Real(0)}});
    rig.t.bodies.motion[0].v = {Real(0), Real(0), Real(-2)};
    const std::size_t hook = rig.hook(
        {.kind = HookKind::kHinge, .b = {door}, .limits = {.lower = Real(-0.5), .upper = Real(1.2)}});
    double largest = 0;
    for (int i = 0; i < 120; ++i) {
      rig.step(Real(1) / Real(60), 8);
      largest = std::max(largest, rig.t.hooks[hook].value[3]);
    }
    CHECK(largest == doctest::Approx(1.2).epsilon(1e-4));
    CHECK(std::abs(d(rig.omega(door).y)) < 1e-4);
  }

  TEST_CASE("a ball keeps within its cone and its twist") {
    JointRig rig;
    const BodyId body = rig.add({.center = {0, 1, 0}, .angular_velocity = {Real(1), Real(6), Real(0)}});
    rig.hook({.b = {body}, .limits = {.lower = Real(-0.3), .upper = Real(0.3)}, .cone = Real(0.4)});
    for (int i = 0; i < 300; ++i) {
      rig.step(Real(1) / Real(60), 8);
      const Quat q = rig.t.bodies.rotation[0];
      const Vec3 axis = rotate(q, Vec3{Real(0), Real(1), Real(0)});
      CHECK(std::acos(std::min(1.0, d(axis.y))) < 0.4 + 2e-3);
      CHECK(std::abs(2 * std::atan2(d(q.y), d(q.w))) < 0.3 + 2e-3);
    }
    // It has come to rest on the cone.
    CHECK(std::acos(rig.center(body).y) == doctest::Approx(0.4).epsilon(1e-2));
  }

  TEST_CASE("a beam that is fixed at one end carries its weight and its moment") {
    JointRig rig;
    const BodyId beam = rig.add({.center = {1.5, 0, 0}, .mass = Real(4)});
    const std::size_t hook = rig.hook({.kind = HookKind::kFixed, .b = {beam}});
    rig.run(1);
    CHECK(d(rig.t.hooks[hook].force.y) == doctest::Approx(4 * kGravity).epsilon(1e-4));
    CHECK(d(rig.t.hooks[hook].torque.z) == doctest::Approx(4 * kGravity * 1.5).epsilon(1e-4));
    CHECK(length(rig.center(beam) - DVec3{1.5, 0, 0}) < 1e-6);
  }

  TEST_CASE("a hook breaks at its force and not below") {
    for (const double share : {1.01, 0.99}) {
      JointRig rig;
      const BodyId body = rig.add({.center = {0, -1, 0}, .mass = Real(5)});
      const std::size_t hook =
          rig.hook({.b = {body}, .break_force = static_cast<Real>(share * 5 * kGravity)});
      rig.run(1);
      CHECK(rig.t.hooks[hook].broken == (share < 1));
    }
  }

  TEST_CASE("a wheel sinks on its suspension, steers and is driven") {
    JointRig rig;
    const BodyId car = rig.add({.mass = Real(0)});
    const BodyId wheel = rig.add({.mass = Real(10), .inertia = {Real(0.5), Real(0.5), Real(0.9)}});
    const std::size_t hook = rig.hook({.kind = HookKind::kWheel,
                                       .a = {car},
                                       .b = {wheel},
                                       .second_axis = Vec3{Real(0), Real(0), Real(1)},
                                       .spring = {.stiffness = Real(2000), .damping = Real(200)},
                                       .motor = {.speed = Real(-7), .max_force = Real(50)},
                                       .steering = {.locked = true, .spring = {.target = Real(0.5)}}});
    rig.run(3);
    // Sag m g / k.
    CHECK(rig.center(wheel).y == doctest::Approx(-10 * kGravity / 2000).epsilon(1e-3));
    CHECK(std::abs(rig.center(wheel).x) < 1e-5);
    CHECK(rig.t.hooks[hook].value[3] == doctest::Approx(0.5).epsilon(1e-4));
    // It spins about its axle, which steering has turned about y.
    const DVec3 axle = {std::sin(0.5), 0, std::cos(0.5)};
    const DVec3 omega = vector_cast<double>(rig.omega(wheel));
    CHECK(dot(omega, axle) == doctest::Approx(-7).epsilon(1e-3));
    CHECK(length(cross(omega, axle)) < 1e-2);
  }

  TEST_CASE("six degrees: each freedom does what it says") {
    JointRig rig;
    rig.gravity = {Real(0.5), Real(0.5), Real(0.5)};
    const BodyId body = rig.add({.mass = Real(2), .angular_velocity = {Real(1), Real(1), Real(1)}});
    HookDesc desc = {.kind = HookKind::kSixDegrees,
                     .b = {body},
                     .axis = {Real(1), Real(0), Real(0)},
                     .second_axis = Vec3{Real(0), Real(1), Real(0)}};
    desc.freedoms[0] = {.limits = {.lower = Real(-1), .upper = Real(0.1)}};
    desc.freedoms[1] = {.spring = {.stiffness = Real(10), .damping = Real(10)}};
    desc.freedoms[2] = {.motor = {.speed = Real(-0.2), .max_force = Real(100)}};
    desc.freedoms[4] = desc.freedoms[5] = {.locked = true};
    rig.hook(desc);
    rig.run(5);
    CHECK(rig.center(body).x == doctest::Approx(0.1).epsilon(1e-3));
    CHECK(rig.center(body).y == doctest::Approx(2 * 0.5 / 10).epsilon(1e-2));
    CHECK(rig.center(body).z == doctest::Approx(-0.2 * 5).epsilon(1e-2));
    CHECK(d(rig.omega(body).x) == doctest::Approx(1).epsilon(1e-4));
    CHECK(std::abs(d(rig.omega(body).y)) < 1e-4);
    CHECK(std::abs(d(rig.omega(body).z)) < 1e-4);
  }

  TEST_CASE("friction holds against the spring of its freedom up to its force, and lets go beyond") {
    // 100 N/m want 0.1 m: 10 N. Against 8 N the body swings once, about 0.02 m, and stays where it turns.
    for (const auto& [friction, place] : {std::pair{12.0, 0.0}, std::pair{8.0, 0.04}}) {
      JointRig rig;
      rig.gravity = {};
      const BodyId body = rig.add({.mass = Real(2)});
      HookDesc desc = {.kind = HookKind::kSixDegrees, .b = {body}, .axis = {Real(1), Real(0), Real(0)}};
      desc.freedoms[0] = {.spring = {.stiffness = Real(100), .target = Real(0.1)},
                          .motor = {.max_force = Real(friction)}};
      for (std::size_t i = 1; i < 6; ++i) desc.freedoms[i] = {.locked = true};
      rig.hook(desc);
      rig.run(3);
      CHECK(std::abs(d(rig.center(body).x) - place) < 0.0005);
    }
  }

  TEST_CASE("a motor says nothing of a spring that is another hook's") {
    // The spring's row is the last of its hook and the motor's the first of the next, along the same axis.
    JointRig rig;
    rig.gravity = {};
    const BodyId a = rig.add({.mass = Real(2)});
    const BodyId b = rig.add({.center = {1, 0, 0}, .mass = Real(2)});
    HookDesc spring = {.kind = HookKind::kSixDegrees, .b = {a}, .axis = {Real(1), Real(0), Real(0)}};
    spring.freedoms[0] = {.spring = {.stiffness = Real(100), .damping = Real(20), .target = Real(0.1)}};
    HookDesc motor = {.kind = HookKind::kSixDegrees, .a = {a}, .b = {b}, .axis = {Real(1), Real(0), Real(0)}};
    motor.freedoms[0] = {.motor = {.speed = Real(0), .max_force = Real(1000)}};
    rig.hook(spring);
    rig.hook(motor);
    rig.run(4);
    CHECK(std::abs(d(rig.center(a).x) - 0.1) < 0.001);
    CHECK(std::abs(d(rig.center(b).x) - 1.1) < 0.001);
  }

  TEST_CASE("hooks that say the same twice share the load, those that disagree stay finite") {
    JointRig rig;
    const BodyId body = rig.add({.center = {0, -1, 0}});
    for (int i = 0; i < 10; ++i) rig.hook({.kind = HookKind::kFixed, .b = {body}});
    const BodyId torn = rig.add({.center = {5, -1, 0}});
    for (const double length : {1.0, 2.0}) {
      rig.hook({.kind = HookKind::kDistance,
                .b = {torn},
                .anchor = {5, 0, 0},
                .anchor_b = DVec3{5, -1, 0},
                .limits = {.lower = static_cast<Real>(length), .upper = static_cast<Real>(length)}});
    }
    rig.run(2);
    CHECK(length(rig.center(body) - DVec3{0, -1, 0}) < 1e-4);
    double sum = 0;
    for (int i = 0; i < 10; ++i) sum += d(rig.t.hooks[i].force.y);
    CHECK(sum == doctest::Approx(kGravity).epsilon(1e-3));
    CHECK(std::abs(length(rig.center(torn) - DVec3{5, 0, 0}) - 1.5) < 0.51);
    CHECK(d(length(rig.velocity(torn))) < 1e-2);
  }

  TEST_CASE("bodies that were put far from their hook come back and are not shot away") {
    for (const HookKind kind : {HookKind::kBall, HookKind::kHinge, HookKind::kSlider, HookKind::kFixed}) {
      JointRig rig;
      rig.gravity = {};
      const BodyId body = rig.add({.center = {1, 0, 0}});
      rig.hook({.kind = kind, .b = {body}, .axis = {Real(1), Real(0), Real(0)}});
      rig.t.bodies.center[0] = {0, 0, 4};
      rig.t.bodies.rotation[0] = {Real(0), Real(1), Real(0), Real(0)};
      rig.run(5);
      CHECK(length(rig.place_of(body, {-1, 0, 0})) < (kind == HookKind::kSlider ? 10 : 1e-3));
      CHECK(d(length(rig.velocity(body))) < 50);
      CHECK(is_finite(rig.center(body)));
    }
  }

  TEST_CASE("the bits do not depend on the number of workers") {
    std::vector<std::vector<DVec3>> ends;
    for (const int workers : {1, 2, 5}) {
      JointRig rig(workers);
      for (int k = 0; k < 7; ++k) {
        BodyId last = {};
        for (int i = 0; i < 5; ++i) {
          const BodyId link =
              rig.add({.center = {i + 0.5, 0, 3.0 * k}, .inertia = {Real(0.1), Real(0.2), Real(0.3)}});
          rig.hook({.a = {last}, .b = {link}, .anchor = {1.0 * i, 0, 3.0 * k}, .cone = Real(0.6)});
          last = link;
        }
      }
      rig.run(1);
      ends.push_back(rig.t.bodies.center);
    }
    CHECK(ends[0] == ends[1]);
    CHECK(ends[0] == ends[2]);
  }
}

}  // namespace
}  // namespace hooke::solver
