#include "solver/joint/ball_joints.h"

#include "constants.h"
#include "solver/joint_rig.h"
#include "solver/soft/particle_kernels.h"

#include <cmath>
#include <doctest/doctest.h>
#include <string>
#include <vector>

namespace hooke::solver {
using test::kGravity;

namespace {

constexpr Real kRound = Real(0.1);  // moment of inertia about any axis [kg m^2]

BodyId add_ball(JointRig& rig, DVec3 center, Real mass = Real(1)) {
  return rig.add({.center = center, .mass = mass, .inertia = {kRound, kRound, kRound}});
}

void make_kinematic(JointRig& rig, BodyId id, Vec3 angular_velocity) {
  const std::uint32_t row = rig.t.body_slots.find(id);
  rig.t.bodies.traits[row].kind = BodyKind::kKinematic;
  rig.t.bodies.angular_velocity[row] = angular_velocity;
  rig.t.bodies.motion[row].omega_scaled = angular_velocity;
}

/// Balls in a tangle of hooks: between balls that move, to one that stands and to one that turns; in blocks
/// that are full and in some that are not.
struct Tangle {
  JointRig rig;

  Tangle() {
    rig.budget = 0;
    std::vector<BodyId> ball;
    for (int i = 0; i < 60; ++i) {
      const Real mass = Real(i < 2 ? 0 : 0.5 + 0.1 * (i % 7));
      ball.push_back(add_ball(rig, {1.0 * (i % 8), 0.7 * (i / 8), 0.3 * (i % 3)}, mass));
    }
    make_kinematic(rig, ball[1], {Real(1), Real(2), Real(-3)});
    for (int i = 2; i < 60; ++i) {
      for (const int other : {(i * 7) % i, i - 1}) {
        const DVec3 anchor = 0.5 * (rig.center(ball[i]) + rig.center(ball[other]));
        rig.hook({.a = {ball[i]}, .b = {ball[other]}, .anchor = anchor});
      }
    }
  }
};

TEST_SUITE("solver/ball_joints") {
  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    std::vector<DVec3> expected;
    for (const std::string& target : wide::targets()) {
      REQUIRE(wide::use_target(target));
      Tangle tangle;
      tangle.rig.run(0.5);
      REQUIRE(tangle.rig.joints.balls.hooks.size() == tangle.rig.t.hooks.size());
      if (expected.empty()) expected = tangle.rig.t.bodies.center;
      CHECK_MESSAGE(tangle.rig.t.bodies.center == expected, target);
    }
    wide::use_target("");
  }

  TEST_CASE("a ball on a turning arm is held on its circle by m omega^2 r") {
    JointRig rig;
    rig.budget = 0;
    rig.gravity = {};
    const Real omega = Real(6);
    const BodyId arm = add_ball(rig, {0, 0, 0}, Real(0));
    make_kinematic(rig, arm, {Real(0), omega, Real(0)});
    const BodyId ball = add_ball(rig, {2, 0, 0}, Real(3));
    const std::uint32_t row = rig.t.body_slots.find(ball);
    rig.t.bodies.motion[row].v = {Real(0), Real(0), Real(-2) * omega};
    // Hooked to the arm at the ball's center.
    const std::size_t hook = rig.hook({.a = {ball}, .b = {arm}, .anchor = {2, 0, 0}});
    rig.run(1);
    REQUIRE(rig.joints.balls.hooks.size() == 1);
    CHECK(length(rig.center(ball)) == doctest::Approx(2).epsilon(2e-3));
    CHECK(rig.center(ball).x == doctest::Approx(2 * std::cos(6)).epsilon(2e-2));
    CHECK(rig.center(ball).z == doctest::Approx(-2 * std::sin(6)).epsilon(2e-2));
    CHECK(d(length(rig.t.hooks[hook].force)) == doctest::Approx(3 * 36 * 2).epsilon(2e-2));
  }

  TEST_CASE("the force of a hook is the same from either end, and breaks it") {
    for (const bool swapped : {false, true}) {
      JointRig rig;
      rig.budget = 0;
      const BodyId stand = add_ball(rig, {0, 1, 0}, Real(0));
      const BodyId ball = add_ball(rig, {0, 0, 0}, Real(2));
      HookDesc desc = {.a = {stand}, .b = {ball}, .anchor = {0, 1, 0}};
      if (swapped) std::swap(desc.a, desc.b);
      const std::size_t held = rig.hook(desc);
      rig.run(2);
      const double upward = swapped ? -1 : 1;
      CHECK(d(rig.t.hooks[held].force.y) == doctest::Approx(upward * 2 * kGravity).epsilon(1e-4));
      const state::Hook& hook = rig.t.hooks[held];
      const Vec3 rows = {hook.row_impulse[0], hook.row_impulse[1], hook.row_impulse[2]};
      CHECK(d(length(rows)) * 8 * 60 == doctest::Approx(2 * kGravity).epsilon(1e-3));
      CHECK_FALSE(rig.t.hooks[held].broken);
      rig.t.hooks[held].break_force = Real(19.6);
      rig.run(0.1);
      CHECK(rig.t.hooks[held].broken);
    }
  }
}

}  // namespace
}  // namespace hooke::solver
