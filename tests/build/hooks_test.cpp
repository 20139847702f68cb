#include "build/build.h"
#include "solver/joint_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <string>

namespace hooke::build {
namespace {

constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();

/// Two bodies that move, one that stands, and one that was removed.
struct Ends {
  solver::JointRig rig;
  BodyId a = rig.add({});
  BodyId b = rig.add({.center = {1, 0, 0}});
  BodyId fixed = rig.add({.mass = Real(0)});
  BodyId gone = rig.add({});

  Ends() { rig.t.body_slots.move(gone.slot, rig.t.body_slots.kNone); }

  /// What is wrong with a hook: "where: message".
  std::string complaint(const HookDesc& desc) {
    const Result<void> added = add_hook(desc, rig.t);
    return added ? "" : added.error().where + ": " + added.error().message;
  }
};

TEST_SUITE("build/hooks") {
  TEST_CASE("a hook needs two different ends that are there, and one that forces move") {
    Ends e;
    CHECK(e.complaint({.a = {e.a}, .b = {e.gone}}) == "hook.b: refers to nothing that is in the world");
    CHECK(e.complaint({.a = {e.gone}, .b = {e.b}}) == "hook.a: refers to nothing that is in the world");
    CHECK(e.complaint({.a = {e.a}, .b = {e.a}}) == "hook.b: must be another body than `a`, or the world");
    CHECK(e.complaint({}) == "hook.b: must be another body than `a`, or the world");
    CHECK(e.complaint({.b = {e.fixed}}) == "hook: needs a dynamic body at one end at least");
    CHECK(e.rig.t.hooks.empty());
    CHECK(e.complaint({.a = {e.a}, .b = {e.b}}) == "");
    CHECK(e.complaint({.a = {e.a}}) == "");
    CHECK(e.complaint({.a = {e.fixed}, .b = {e.b}}) == "");
    CHECK(e.rig.t.hooks.size() == 3);
  }

  TEST_CASE("what is out of range is named") {
    Ends e;
    const auto of = [&](HookDesc desc) {
      desc.a = {e.a};
      desc.b = {e.b};
      const std::string text = e.complaint(desc);
      return text.substr(0, text.find(':'));
    };
    CHECK(of({.axis = {}}) == "hook.axis");
    CHECK(of({.axis = {Real(0), kNaN, Real(0)}}) == "hook.axis");
    CHECK(of({.anchor = {0, std::nan(""), 0}}) == "hook.anchor");
    CHECK(of({.second_axis = Vec3{Real(0), Real(2), Real(0)}}) == "hook.second_axis");
    CHECK(of({.limits = {.lower = Real(1), .upper = Real(0)}}) == "hook.limits");
    CHECK(of({.limits = {.lower = kNaN}}) == "hook.limits");
    CHECK(of({.limits = {.lower = kRigid}}) == "hook.limits");
    CHECK(of({.cone = Real(-1)}) == "hook.cone");
    CHECK(of({.spring = {.stiffness = Real(-1)}}) == "hook.spring.stiffness");
    CHECK(of({.motor = {.max_force = kRigid}}) == "hook.motor.max_force");
    CHECK(of({.steering = {.spring = {.target = kNaN}}}) == "hook.steering.spring.target");
    HookDesc six = {.kind = HookKind::kSixDegrees};
    six.freedoms[4].motor.speed = kNaN;
    CHECK(of(six) == "hook.freedoms[4].motor.speed");
    CHECK(of({.kind = HookKind::kDistance, .limits = {.upper = Real(0)}}) == "hook.limits");
    CHECK(of({.break_force = Real(0)}) == "hook.break_force");
    CHECK(of({.break_torque = kNaN}) == "hook.break_torque");
    CHECK(of({.kind = static_cast<HookKind>(99)}) == "hook.kind");
    CHECK(e.rig.t.hooks.empty());
  }

  TEST_CASE("anchors and axes are found again in the frames of both bodies") {
    Ends e;
    const Quat turned = quaternion_about(Vec3{Real(1), Real(2), Real(3)}, Real(2.5));
    e.rig.t.bodies.rotation[1] = turned;
    for (const Vec3 axis : {Vec3{Real(1), Real(0), Real(0)}, Vec3{Real(-3), Real(0.1), Real(-0.2)},
                            Vec3{Real(0), Real(-1), Real(0)}, Vec3{Real(0), Real(0), Real(-2)}}) {
      REQUIRE(e.complaint({.a = {e.a}, .b = {e.b}, .anchor = {3, 4, 5}, .axis = axis}) == "");
      const state::Hook& hook = e.rig.t.hooks.back();
      CHECK(length(rotate(hook.a.axes, Vec3{Real(1), Real(0), Real(0)}) - normalize(axis)) < Real(1e-6));
      CHECK(length(rotate(turned * hook.b.axes, Vec3{Real(1), Real(0), Real(0)}) - normalize(axis)) <
            Real(1e-6));
      CHECK(length(e.rig.place_of(e.b, hook.b.anchor) - DVec3{3, 4, 5}) < 1e-5);
    }
  }
}

}  // namespace
}  // namespace hooke::build
