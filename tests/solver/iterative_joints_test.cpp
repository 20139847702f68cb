#include "solver/joint/iterative_joints.h"

#include "constants.h"
#include "solver/joint_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <vector>

namespace hooke::solver {
using test::kGravity;
using test::kPi;

namespace {

/// A hanging net of balls, 1 m apart; the top row is held.
struct HangingNet {
  JointRig rig;
  int size;
  std::vector<BodyId> ball;

  HangingNet(int count, double budget, int workers = 1) : rig(workers), size(count) {
    rig.budget = budget;
    const Real turn = Real(0.064);
    for (int row = 0; row < count; ++row) {
      for (int column = 0; column < count; ++column) {
        ball.push_back(rig.add({.center = {1.0 * column, -1.0 * row, 0},
                                .mass = Real(row == 0 ? 0 : 1),
                                .inertia = {turn, turn, turn}}));
        if (row > 0) join(at(row - 1, column), at(row, column), {1.0 * column, 0.5 - row, 0});
        if (row > 0 && column > 0) join(at(row, column - 1), at(row, column), {column - 0.5, -1.0 * row, 0});
      }
    }
  }

  [[nodiscard]] BodyId at(int row, int column) const { return ball[row * size + column]; }
  void join(BodyId a, BodyId b, DVec3 anchor) { rig.hook({.a = {a}, .b = {b}, .anchor = anchor}); }

  [[nodiscard]] double worst_gap() const {
    double worst = 0;
    for (const state::Hook& hook : rig.t.hooks)
      worst = std::max(worst, length(DVec3{hook.value[0], hook.value[1], hook.value[2]}));
    return worst;
  }
};

TEST_SUITE("solver/iterative_joints") {
  TEST_CASE("a net hangs still and its upper joints carry its weight") {
    HangingNet net(8, 0);
    net.rig.run(5);
    REQUIRE(net.rig.joints.order.empty());
    CHECK(net.worst_gap() < 0.01);
    double sum = 0;
    for (const state::Hook& hook : net.rig.t.hooks) {
      if (hook.a.body < 8) sum += d(hook.force.y);
    }
    CHECK(sum == doctest::Approx(56 * kGravity).epsilon(1e-3));
    for (const BodyId ball : net.ball) CHECK(d(length(net.rig.velocity(ball))) < 1e-2);
  }

  TEST_CASE("a pendulum swings as one that is solved directly") {
    std::vector<DVec3> ends;
    for (const double budget : {0.0, kArticulationBudget}) {
      JointRig rig;
      rig.budget = budget;
      const BodyId body = rig.add({.center = {1, 0, 0}, .inertia = {Real(0.1), Real(0.2), Real(0.3)}});
      rig.hook({.kind = HookKind::kHinge, .b = {body}, .axis = {Real(0), Real(0), Real(1)}});
      rig.run(2, 16);
      ends.push_back(rig.center(body));
      CHECK(length(ends.back()) == doctest::Approx(1).epsilon(1e-3));
    }
    CHECK(length(ends[0] - ends[1]) < 0.02);
  }

  TEST_CASE("limits, motors and springs work in a net") {
    JointRig rig;
    rig.budget = 0;
    const BodyId weight = rig.add({.center = {0, 0, 0}, .mass = Real(2)});
    rig.hook(
        {.kind = HookKind::kSlider, .b = {weight}, .spring = {.stiffness = Real(200), .damping = Real(40)}});
    const BodyId stopped = rig.add({.center = {3, 0, 0}});
    rig.hook(
        {.kind = HookKind::kSlider, .b = {stopped}, .anchor = {3, 0, 0}, .limits = {.lower = Real(-0.5)}});
    const BodyId driven = rig.add({.center = {6, 0, 0}});
    rig.hook({.kind = HookKind::kSlider,
              .b = {driven},
              .anchor = {6, 0, 0},
              .motor = {.speed = Real(0.3), .max_force = Real(100)}});
    rig.run(3);
    REQUIRE(rig.joints.iterative.hooks.size() == 3);
    CHECK(rig.center(weight).y == doctest::Approx(-2 * kGravity / 200).epsilon(1e-3));
    CHECK(rig.center(stopped).y == doctest::Approx(-0.5).epsilon(1e-2));
    CHECK(rig.center(driven).y == doctest::Approx(0.9).epsilon(1e-2));
  }

  TEST_CASE("a net in free flight keeps its momentum and its angular momentum") {
    HangingNet net(5, 0);
    for (int i = 0; i < 5; ++i) {  // let the top row go
      net.rig.t.bodies.motion[i].inverse_mass = Real(1);
      net.rig.t.bodies.mass[i] = net.rig.t.bodies.mass[10];
      net.rig.t.bodies.traits[i].kind = BodyKind::kDynamic;
    }
    net.rig.gravity = {};
    net.rig.t.bodies.motion[7].v = {Real(1), Real(2), Real(3)};
    const DVec3 momentum = net.rig.momentum();
    const DVec3 angular_momentum = net.rig.angular_momentum();
    net.rig.run(2);
    CHECK(length(net.rig.momentum() - momentum) < 1e-5 * length(momentum));
    CHECK(length(net.rig.angular_momentum() - angular_momentum) < 1e-4 * length(angular_momentum));
  }

  TEST_CASE("the bits do not depend on the number of workers") {
    HangingNet one(12, 0, 1);
    HangingNet three(12, 0, 3);
    one.rig.run(1);
    three.rig.run(1);
    CHECK(one.rig.t.bodies.center == three.rig.t.bodies.center);
  }

  TEST_CASE("what sleeps is left alone, and its hooks keep their force") {
    HangingNet net(5, 0);
    net.rig.run(2);
    const Vec3 force = net.rig.t.hooks[0].force;
    REQUIRE(length(force) > Real(9));
    net.rig.rows.resize(5);  // those awake: the row that is held
    for (std::size_t i = 5; i < net.ball.size(); ++i) {
      net.rig.t.bodies.asleep[i] = 1;
      net.rig.t.bodies.motion[i].v = {};
    }
    const std::vector<DVec3> centers = net.rig.t.bodies.center;
    net.rig.run(0.5);
    for (std::size_t i = 5; i < net.ball.size(); ++i) CHECK(net.rig.velocity(net.ball[i]) == Vec3{});
    CHECK(net.rig.t.bodies.center == centers);
    CHECK(length(net.rig.t.hooks[0].force - force) < Real(1e-2) * length(force));
  }

  TEST_CASE("a light hub does not throw about the arms that hang on it") {
    // Whole, then as a net that is far from solved in a step: it sinks, by no more than a tenth of a free
    // fall.
    for (const double budget : {kArticulationBudget, 0.0}) {
      for (const int arms : {20, 130}) {
        CAPTURE(budget);
        CAPTURE(arms);
        JointRig rig;
        rig.budget = budget;
        const BodyId hub = rig.add({.mass = Real(1), .inertia = {Real(0.01), Real(0.01), Real(0.01)}});
        rig.hook({.b = {hub}});
        std::vector<BodyId> leaves;
        for (int i = 0; i < arms; ++i) {
          const double angle = 2 * kPi * i / arms;
          const DVec3 place = {0.3 * std::cos(angle), 0, 0.3 * std::sin(angle)};
          leaves.push_back(rig.add({.center = place - DVec3{0, 0.25, 0},
                                    .mass = Real(1),
                                    .inertia = {Real(0.02), Real(0.005), Real(0.02)}}));
          rig.hook({.a = {hub}, .b = {leaves.back()}, .anchor = place});
        }
        rig.run(5);
        REQUIRE(rig.joints.order.size() == (budget > 0 ? 1 : 0));
        if (budget > 0) {
          CHECK(d(rig.t.hooks[0].force.y) == doctest::Approx((1 + arms) * kGravity).epsilon(1e-4));
          for (const state::Hook& hook : rig.t.hooks)
            CHECK(length(DVec3{hook.value[0], hook.value[1], hook.value[2]}) < 1e-5);
        }
        for (const BodyId leaf : leaves) CHECK(d(length(rig.velocity(leaf))) < (budget > 0 ? 1e-3 : 2.5));
      }
    }
  }

  TEST_CASE("a body with a hundred hooks is solved") {
    JointRig rig;
    rig.budget = 0;
    const BodyId hub = rig.add({.mass = Real(100), .inertia = {Real(10), Real(10), Real(10)}});
    rig.hook({.b = {hub}});
    for (int i = 0; i < 100; ++i) {
      const double angle = 0.02 * i * kPi;
      const DVec3 place = {std::cos(angle), 0, std::sin(angle)};
      const BodyId leaf = rig.add({.center = place, .mass = Real(0.1)});
      rig.hook({.a = {hub}, .b = {leaf}, .anchor = place});
    }
    rig.run(0.5);
    for (const state::Hook& hook : rig.t.hooks)
      CHECK(length(DVec3{hook.value[0], hook.value[1], hook.value[2]}) < 0.05);
  }
}

}  // namespace
}  // namespace hooke::solver
