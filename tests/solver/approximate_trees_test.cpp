#include "solver/joint/approximate_trees.h"

#include "solver/joint_rig.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <vector>

namespace hooke::solver {
namespace {

constexpr Real kFriction = Real(0.5);  // [N m]
constexpr Real kInertia = Real(0.1);   // of each part about any axis [kg m^2]

/// Two bodies on a hinge with friction, without gravity; the second turns.
struct Pair {
  JointRig rig;
  BodyId a, b;

  explicit Pair(Real spin, const HookSpring& spring = {}, Real mass_of_a = Real(1)) {
    rig.gravity = {};
    a = rig.add({.mass = mass_of_a,
                 .inertia = {kInertia, kInertia, kInertia},
                 .angular_velocity = {Real(0), Real(0), -spin}});
    b = rig.add({.inertia = {kInertia, kInertia, kInertia}, .angular_velocity = {Real(0), Real(0), spin}});
    rig.hook({.kind = HookKind::kHinge,
              .a = {a},
              .b = {b},
              .axis = {Real(0), Real(0), Real(1)},
              .spring = spring,
              .motor = {.max_force = kFriction}});
  }
  [[nodiscard]] Real parting() const { return rig.omega(b).z - rig.omega(a).z; }
};

bool is_approximate(const JointRig& rig) {
  REQUIRE(rig.joints.order.size() == 1);
  const Articulation& tree = rig.joints.articulations[0];
  return is_ragdoll(tree, rig.t.hooks, rig.t.bodies) && is_approximate(tree, rig.t.hooks);
}

/// A row of parts on balls that rub, thrown.
struct Row {
  JointRig rig;
  std::vector<BodyId> part;

  explicit Row(Real last_mass = Real(1), Real speed = Real(0)) {
    for (int i = 0; i < 5; ++i) {
      part.push_back(rig.add({.center = {0.4 * i, 0, 0},
                              .mass = i == 4 ? last_mass : Real(1),
                              .inertia = {Real(0.002), Real(0.01), Real(0.01)},
                              .velocity = {Real(0), Real(i), Real(2 - i)},
                              .angular_velocity = {Real(i), Real(2), Real(-3 * i)}}));
      if (i > 0) {
        rig.hook({.a = {part[i - 1]},
                  .b = {part[i]},
                  .anchor = {0.4 * i - 0.2, 0, 0},
                  .axis = {Real(1), Real(0), Real(0)},
                  .limits = {Real(-0.3), Real(0.3)},
                  .cone = Real(0.6),
                  .motor = {.speed = speed, .max_force = Real(0.1)}});
      }
    }
  }
  [[nodiscard]] double energy() const {
    double sum = 0;
    for (const std::uint32_t i : rig.rows) {
      const state::Bodies& bodies = rig.t.bodies;
      sum += static_cast<double>(Real(0.5) * bodies.mass[i].mass * length_squared(bodies.motion[i].v) +
                                 Real(0.5) * dot(bodies.angular_velocity[i], bodies.angular_momentum[i]));
    }
    return sum;
  }
  [[nodiscard]] double largest_gap() const {
    double largest = 0;
    for (const state::Hook& hook : rig.t.hooks) {
      const JointBody a = joint_body(rig.t.bodies, hook.a.body);
      const JointBody b = joint_body(rig.t.bodies, hook.b.body);
      largest = std::max(largest, joint_gap(hook, a, b));
    }
    return largest;
  }
};

TEST_SUITE("solver/approximate_trees") {
  TEST_CASE("what hangs, carries a weight, is driven or slides without friction is exact") {
    Row loose;
    loose.rig.step(Real(0.01), 4);
    CHECK(is_approximate(loose.rig));

    Row hanging;
    hanging.rig.hook({.a = {hanging.part[0]}, .anchor = {-0.2, 0, 0}, .motor = {.max_force = Real(1)}});
    hanging.rig.step(Real(0.01), 4);
    CHECK_FALSE(is_approximate(hanging.rig));

    Row heavy(Real(2 * kApproximateMasses));
    heavy.rig.step(Real(0.01), 4);
    CHECK_FALSE(is_approximate(heavy.rig));

    Row driven(Real(1), Real(0.1));
    driven.rig.step(Real(0.01), 4);
    CHECK_FALSE(is_approximate(driven.rig));

    Row smooth;
    smooth.part.push_back(smooth.rig.add({.center = {2, 0, 0}}));
    smooth.rig.hook({.a = {smooth.part[4]}, .b = {smooth.part[5]}, .anchor = {1.8, 0, 0}});
    smooth.rig.step(Real(0.01), 4);
    CHECK_FALSE(is_approximate(smooth.rig));
  }

  TEST_CASE("a tree is exact until its joints are closed") {
    Row row;
    row.rig.gravity = {};
    row.rig.step(Real(0.01), 4);
    REQUIRE(is_approximate(row.rig));
    row.rig.t.bodies.center[4].y += 5 * kApproximateError;
    row.rig.step(Real(0.01), 1);
    CHECK_FALSE(is_approximate(row.rig));
    row.rig.run(0.5, 4);
    CHECK(is_approximate(row.rig));
    CHECK(row.largest_gap() < kApproximateError);
  }

  TEST_CASE("friction stops a joint at the time of its torque") {
    constexpr Real kSpin = Real(2);
    Pair pair(kSpin);
    const double time = static_cast<double>(kSpin * kInertia / kFriction);
    pair.rig.run(time / 2, 4);
    REQUIRE(is_approximate(pair.rig));
    CHECK(pair.parting() == doctest::Approx(static_cast<double>(kSpin)).epsilon(0.05));
    pair.rig.run(time / 2 + 0.05, 4);
    CHECK(std::abs(pair.parting()) < Real(0.01) * kSpin);
  }

  TEST_CASE("friction holds against a spring up to its torque, and lets go beyond") {
    for (const Real pull : {Real(0.8), Real(1.5)}) {
      const HookSpring spring = {.stiffness = Real(1), .damping = Real(0.1), .target = pull * kFriction};
      Pair pair(Real(0), spring);
      Pair exact(Real(0), spring, Real(2 * kApproximateMasses));
      pair.rig.run(2, 4);
      exact.rig.run(2, 4);
      REQUIRE(is_approximate(pair.rig));
      REQUIRE_FALSE(is_approximate(exact.rig));
      // It creeps by kLooseSlide at most.
      const double expected = exact.rig.t.hooks[0].value[3];
      CHECK(std::abs(pair.rig.t.hooks[0].value[3] - expected) < 0.02 * expected + 2 * kApproximateSlide);
      CHECK((expected > 0.2) == (pull > Real(1)));
    }
  }

  TEST_CASE("nothing gains energy, and joints stay closed") {
    Row row;
    row.rig.gravity = {};
    row.rig.step(Real(1) / Real(60), 4);
    const DVec3 momentum = row.rig.momentum();
    const DVec3 angular = row.rig.angular_momentum();
    double before = row.energy();
    int loose = 0;
    for (int i = 0; i < 300; ++i) {
      row.rig.step(Real(1) / Real(60), 4);
      const double now = row.energy();
      CHECK(now <= before * (1 + 1e-4) + 1e-6);
      before = now;
      CHECK(row.largest_gap() < 5e-3);
      loose += is_approximate(row.rig) ? 1 : 0;
    }
    CHECK(loose > 200);
    CHECK(length(row.rig.momentum() - momentum) < 1e-4);
    CHECK(length(row.rig.angular_momentum() - angular) < 1e-3);
  }

  TEST_CASE("a snapshot of the state is all that decides") {
    Row row;
    row.rig.run(0.2, 4);
    Row copy;
    copy.rig.t = row.rig.t;
    copy.rig.built = ~std::uint64_t{0};
    row.rig.run(0.2, 4);
    copy.rig.run(0.2, 4);
    CHECK(row.rig.t.bodies.center == copy.rig.t.bodies.center);
  }
}

}  // namespace
}  // namespace hooke::solver
