#include "constants.h"
#include "solver/joint/joints.h"
#include "solver/joint_rig.h"
#include "validation/planar_mechanism.h"

#include <cmath>
#include <doctest/doctest.h>
#include <vector>

namespace hooke::solver {
using check::PlanarMechanism;
using check::PlanarPose;
using test::kGravity;
using test::kPi;

namespace {

constexpr Vec3 kZ = {Real(0), Real(0), Real(1)};

constexpr double kDt = 1.0 / 240;
constexpr int kSubsteps = 16;

/// Adds body `i` of the mechanism at q, moving at q'. The stored velocity is that of half a substep before:
/// v += h a comes first.
BodyId add_body(JointRig& rig, const PlanarMechanism& m, const PlanarMechanism::Body& body, double q,
                std::size_t i) {
  const double speed = -0.5 * kDt / kSubsteps * m.acceleration(q, 0);
  const PlanarPose p = m.poses(q)[i];
  const PlanarPose s = m.slopes(q)[i];
  const auto mass = static_cast<Real>(body.mass);
  return rig.add({.center = {p.x, p.y, 0},
                  .mass = mass,
                  .inertia = {static_cast<Real>(body.inertia), static_cast<Real>(body.inertia),
                              static_cast<Real>(body.inertia)},
                  .velocity = {static_cast<Real>(speed * s.x), static_cast<Real>(speed * s.y), Real(0)},
                  .angular_velocity = {Real(0), Real(0), static_cast<Real>(speed * s.angle)},
                  .rotation = quaternion_about(kZ, static_cast<Real>(p.angle))});
}

void add_hinge(JointRig& rig, BodyId a, BodyId b, double x, double y) {
  rig.hook({.kind = HookKind::kHinge, .a = {a}, .b = {b}, .anchor = {x, y, 0}, .axis = kZ});
}

struct Ragdoll {
  std::vector<BodyId> bodies;

  /// Pelvis, spine in two, head, and limbs of two or three: 14 bodies, 13 joints.
  explicit Ragdoll(JointRig& rig) {
    const BodyId pelvis = add(rig, {0, 1, 0}, {0.15, 0.08, 0.1}, 12);
    const BodyId belly = join(rig, pelvis, {0, 1.2, 0}, {0.14, 0.1, 0.1}, 10, {0, 1.09, 0});
    const BodyId chest = join(rig, belly, {0, 1.45, 0}, {0.18, 0.13, 0.12}, 16, {0, 1.31, 0});
    join(rig, chest, {0, 1.75, 0}, {0.1, 0.12, 0.1}, 5, {0, 1.6, 0});
    for (const double side : {-1.0, 1.0}) {
      const BodyId thigh =
          join(rig, pelvis, {0.1 * side, 0.7, 0}, {0.07, 0.2, 0.07}, 8, {0.1 * side, 0.91, 0});
      const BodyId shin =
          hinge(rig, thigh, {0.1 * side, 0.28, 0}, {0.05, 0.2, 0.05}, 4, {0.1 * side, 0.49, 0});
      hinge(rig, shin, {0.1 * side, 0.04, 0.06}, {0.04, 0.03, 0.12}, 1, {0.1 * side, 0.07, 0});
      const BodyId arm = join(rig, chest, {0.35 * side, 1.5, 0}, {0.14, 0.05, 0.05}, 3, {0.2 * side, 1.5, 0});
      hinge(rig, arm, {0.63 * side, 1.5, 0}, {0.13, 0.04, 0.04}, 2, {0.5 * side, 1.5, 0});
    }
  }

 private:
  BodyId add(JointRig& rig, DVec3 center, DVec3 half_extents, double mass) {
    const Vec3 h = vector_cast<Real>(half_extents);
    const BodyId body = rig.add({.center = center,
                                 .mass = static_cast<Real>(mass),
                                 .inertia = box_inertia(static_cast<Real>(mass), h),
                                 .velocity = {Real(0.3), Real(2), Real(-0.1)}});
    bodies.push_back(body);
    return body;
  }
  BodyId join(JointRig& rig, BodyId to, DVec3 center, DVec3 half_extents, double mass, DVec3 anchor) {
    const BodyId body = add(rig, center, half_extents, mass);
    rig.hook({.a = {to},
              .b = {body},
              .anchor = anchor,
              .limits = {.lower = Real(-0.5), .upper = Real(0.5)},
              .cone = Real(0.8),
              .motor = {.max_force = Real(0.5)}});
    return body;
  }
  BodyId hinge(JointRig& rig, BodyId to, DVec3 center, DVec3 half_extents, double mass, DVec3 anchor) {
    const BodyId body = add(rig, center, half_extents, mass);
    rig.hook({.kind = HookKind::kHinge,
              .a = {to},
              .b = {body},
              .anchor = anchor,
              .axis = {Real(1), Real(0), Real(0)},
              .limits = {.lower = Real(0), .upper = Real(2.2)}});
    return body;
  }
};

/// 16 links of 1 kg and 0.4 m from the origin along `direction`, and `load` at the end.
struct Chain {
  static constexpr int kLinks = 16;
  static constexpr double kLength = 0.4;
  JointRig rig;
  BodyId load;

  Chain(bool level, double mass, double push) {
    const DVec3 along = level ? DVec3{1, 0, 0} : DVec3{0, -1, 0};
    const Quat turn = level ? quaternion_about(kZ, static_cast<Real>(0.5 * kPi)) : Quat{};
    const Vec3 half = {Real(0.05), Real(0.5 * kLength), Real(0.05)};
    BodyId last = {};
    for (int i = 0; i < kLinks; ++i) {
      const BodyId link = rig.add(
          {.center = (kLength * (i + 0.5)) * along, .inertia = box_inertia(Real(1), half), .rotation = turn});
      rig.hook({.a = {last}, .b = {link}, .anchor = (kLength * i) * along});
      last = link;
    }
    const auto m = static_cast<Real>(mass);
    load = rig.add({.center = (kLength * kLinks + 0.5) * along,
                    .mass = m,
                    .inertia = box_inertia(m, {Real(0.5), Real(0.5), Real(0.5)}),
                    .velocity = {static_cast<Real>(push), Real(0), Real(0)}});
    rig.hook({.a = {last}, .b = {load}, .anchor = (kLength * kLinks) * along});
  }

  /// Sum of the gaps in its joints over its length, at its worst while running.
  double worst_stretch(double seconds) {
    double worst = 0;
    for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
      rig.step(Real(1) / Real(60), 8);
      double sum = 0;
      for (const state::Hook& hook : rig.t.hooks)
        sum += length(DVec3{hook.value[0], hook.value[1], hook.value[2]});
      worst = std::max(worst, sum / (kLength * kLinks));
    }
    return worst;
  }

  [[nodiscard]] double energy() const {
    const state::Bodies& b = rig.t.bodies;
    double sum = 0;
    for (const std::uint32_t i : rig.rows) {
      const double m = d(b.mass[i].mass);
      const DVec3 v = vector_cast<double>(b.motion[i].v);
      sum += 0.5 * m * dot(v, v) + m * kGravity * b.center[i].y +
             0.5 * d(dot(b.angular_momentum[i], b.angular_velocity[i]));
    }
    return sum;
  }
};

TEST_SUITE("solver/mechanisms") {
  TEST_CASE("a four-bar linkage moves as its equation of motion says") {
    const check::FourBar shape;
    const std::vector<PlanarMechanism::Body> bodies = {{1, 0.03}, {2, 0.25}, {1.5, 0.1}};
    const PlanarMechanism mechanism(bodies, [&](double q) { return shape.poses(q); });
    const double start = 1.0;
    JointRig rig;
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < 3; ++i) ids.push_back(add_body(rig, mechanism, bodies[i], start, i));
    const DVec3 pin = shape.pin(start);
    add_hinge(rig, {}, ids[0], 0, 0);
    add_hinge(rig, ids[0], ids[1], shape.crank * std::cos(start), shape.crank * std::sin(start));
    add_hinge(rig, ids[1], ids[2], pin.x, pin.y);
    add_hinge(rig, {}, ids[2], shape.ground, 0);
    for (int i = 0; i < 240; ++i) {
      rig.step(static_cast<Real>(kDt), kSubsteps);
      if (i % 48 != 47) continue;
      const double q = mechanism.run(start, (i + 1) * kDt);
      const std::vector<PlanarPose> poses = mechanism.poses(q);
      for (std::size_t k = 0; k < 3; ++k) {
        const PlanarPose& p = poses[k];
        CHECK(length(rig.center(ids[k]) - DVec3{p.x, p.y, 0}) < 1e-4);
      }
    }
  }

  TEST_CASE("a slider-crank moves as its equation of motion says") {
    const check::SliderCrank shape;
    const std::vector<PlanarMechanism::Body> bodies = {{1, 0.02}, {1, 0.08}, {3, 0.1}};
    const PlanarMechanism mechanism(bodies, [&](double q) { return shape.poses(q); });
    const double start = 1.3;
    JointRig rig;
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < 3; ++i) ids.push_back(add_body(rig, mechanism, bodies[i], start, i));
    const double end = mechanism.poses(start)[2].x;
    add_hinge(rig, {}, ids[0], 0, 0);
    add_hinge(rig, ids[0], ids[1], shape.crank * std::cos(start), shape.crank * std::sin(start));
    add_hinge(rig, ids[1], ids[2], end, 0);
    rig.hook({.kind = HookKind::kSlider,
              .b = {ids[2]},
              .anchor = {end, 0, 0},
              .axis = {Real(1), Real(0), Real(0)}});
    for (int i = 0; i < 240; ++i) {
      rig.step(static_cast<Real>(kDt), kSubsteps);
      if (i % 48 != 47) continue;
      const double q = mechanism.run(start, (i + 1) * kDt);
      const std::vector<PlanarPose> poses = mechanism.poses(q);
      for (std::size_t k = 0; k < 3; ++k) {
        const PlanarPose& p = poses[k];
        CHECK(length(rig.center(ids[k]) - DVec3{p.x, p.y, 0}) < 1e-4);
      }
    }
  }

  TEST_CASE("a gyroscope on a ball precesses at m g l / (I omega)") {
    // A level axis: the steady precession is exact, Omega = m g l / (I_3 omega_3).
    const double mass = 0.5;
    const double lever = 0.1;
    const double spin = 200;
    const double axial = 0.001;
    const double precession = mass * kGravity * lever / (axial * spin);
    JointRig rig;
    const BodyId top =
        rig.add({.center = {lever, 0, 0},
                 .mass = static_cast<Real>(mass),
                 .inertia = {static_cast<Real>(axial), Real(0.0006), Real(0.0006)},
                 .velocity = {Real(0), Real(0), static_cast<Real>(-precession * lever)},
                 .angular_velocity = {static_cast<Real>(spin), static_cast<Real>(precession), Real(0)}});
    rig.hook({.b = {top}});
    const double seconds = 0.5;
    rig.run(seconds, 1, Real(1) / Real(9600));
    const DVec3 c = rig.center(top);
    CHECK(std::atan2(-c.z, c.x) == doctest::Approx(precession * seconds).epsilon(2e-3));
    CHECK(std::abs(c.y) < 0.01 * lever);
    CHECK(length(c) == doctest::Approx(lever).epsilon(1e-3));
  }

  TEST_CASE("a ragdoll in free flight keeps its momentum and its angular momentum") {
    JointRig rig;
    const Ragdoll doll(rig);
    rig.gravity = {};
    rig.t.bodies.angular_momentum[2] = {Real(3), Real(-2), Real(4)};
    rig.t.bodies.motion[6].v = {Real(1), Real(0), Real(5)};
    const DVec3 momentum = rig.momentum();
    const DVec3 angular_momentum = rig.angular_momentum();
    REQUIRE(doll.bodies.size() == 14);
    rig.run(3);
    CHECK(length(rig.momentum() - momentum) < 1e-5 * length(momentum));
    CHECK(length(rig.angular_momentum() - angular_momentum) < 1e-5 * length(angular_momentum));
    for (const state::Hook& hook : rig.t.hooks)
      CHECK(length(DVec3{hook.value[0], hook.value[1], hook.value[2]}) < 1e-3);
  }

  TEST_CASE("a chain of 16 kg carries a ton: at rest, swung and dropped") {
    Chain still(false, 1000, 0);
    CHECK(still.worst_stretch(60) < 1e-6);
    CHECK(d(still.rig.t.hooks[0].force.y) == doctest::Approx(1016 * kGravity).epsilon(1e-4));
    CHECK(d(length(still.rig.velocity(still.load))) < 1e-4);

    Chain swung(false, 1000, 2);
    const double swing = 0.5 * 1000 * 2 * 2;
    const double before = swung.energy();
    CHECK(swung.worst_stretch(20) < 1e-4);
    CHECK(std::abs(swung.energy() - before) < 0.03 * swing);

    Chain dropped(true, 1000, 0);
    const double top = dropped.energy();
    CHECK(dropped.worst_stretch(20) < 1e-3);
    CHECK(dropped.energy() < top + 1);
  }
}

}  // namespace
}  // namespace hooke::solver
