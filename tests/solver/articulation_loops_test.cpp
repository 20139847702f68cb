#include "solver/joint_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

namespace hooke::solver {
namespace {

constexpr double kSpacing = 0.2;
constexpr double kGravity = 9.81;
constexpr Real kBallMass = Real(0.1);

/// A square net of balls of 0.1 kg and 5 cm, with hooks midway between them; those of the first row, and of
/// the last if `both`, are hooked to the world at their centers. It lies in a plane that goes down by `slope`
/// [rad].
struct BallNet {
  JointRig rig;
  std::vector<BodyId> balls;
  std::vector<DVec3> before;
  int side;

  BallNet(int count, double slope, bool both, Real middle_mass) : side(count) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const bool is_middle = i == side / 2 && j == side / 2;
        const Real mass = is_middle ? middle_mass : kBallMass;
        const Real inertia = Real(1e-3) * mass;
        const DVec3 at = place(i, j, slope);
        balls.push_back(rig.add({.center = at, .mass = mass, .inertia = {inertia, inertia, inertia}}));
        before.push_back(at);
        if (j == 0 || (both && j == side - 1)) rig.hook({.b = {balls.back()}, .anchor = at});
        if (i > 0) join(j * side + i - 1);
        if (j > 0) join((j - 1) * side + i);
      }
    }
  }

  [[nodiscard]] static DVec3 place(int i, int j, double slope) {
    return {kSpacing * i, -kSpacing * j * std::sin(slope), kSpacing * j * std::cos(slope)};
  }
  /// Hooks the last ball to an earlier one.
  void join(int other) {
    const auto at = static_cast<std::size_t>(other);
    rig.hook({.a = {balls[at]}, .b = {balls.back()}, .anchor = 0.5 * (before[at] + before.back())});
  }

  [[nodiscard]] double worst_gap() const {
    double worst = 0;
    for (const state::Hook& hook : rig.t.hooks) {
      const DVec3 a = hook.a.body == state::HookPlace::kWorld ? hook.a.anchor : at(hook.a);
      worst = std::max(worst, length(at(hook.b) - a));
    }
    return worst;
  }
  [[nodiscard]] DVec3 at(const state::HookPlace& place) const {
    const Quat q = rig.t.bodies.rotation[place.body];
    return rig.t.bodies.center[place.body] +
           rotate(Quaternion<double>{d(q.x), d(q.y), d(q.z), d(q.w)}, place.anchor);
  }

  /// Kinetic and potential energy, with that of the start as zero [J].
  [[nodiscard]] double energy() const {
    double sum = 0;
    for (const std::uint32_t i : rig.rows) {
      const state::BodyMass& mass = rig.t.bodies.mass[i];
      const double v = d(length(rig.t.bodies.motion[i].v));
      const double omega = d(length(rig.t.bodies.angular_velocity[i]));
      sum += 0.5 * (d(mass.mass) * v * v + d(mass.inertia.x) * omega * omega) +
             d(mass.mass) * kGravity * (rig.t.bodies.center[i].y - before[i].y);
    }
    return sum;
  }
};

TEST_SUITE("solver/articulation_loops") {
  TEST_CASE("a net of 18 x 18 balls of 0.1 kg holds 100 kg, with gaps below 0.1 % of the spacing") {
    BallNet net(18, 0, true, Real(100));
    for (int i = 0; i < 30; ++i) {
      net.rig.run(1.0 / 60);
      CHECK(net.worst_gap() < 1e-3 * kSpacing);
    }
    CHECK(net.rig.joints.balls.hooks.empty());
    CHECK(net.rig.joints.iterative.hooks.empty());
    CHECK(net.energy() < 0.01);
  }

  TEST_CASE("a net that falls about its upper edge keeps its energy and its joints") {
    constexpr int kSide = 9;
    BallNet net(kSide, 0.2, false, kBallMass);
    const double fall =
        kSide * kSide * d(kBallMass) * kGravity * kSpacing * kSide / 2;  // about what it can lose [J]
    double worst = 0;
    double most = 0;
    for (int i = 0; i < 60; ++i) {
      net.rig.run(1.0 / 60, 16);
      worst = std::max(worst, net.worst_gap());
      most = std::max(most, net.energy());
    }
    CHECK(net.rig.joints.order.size() == 1);
    CHECK(worst < 2e-3 * kSpacing);
    CHECK(most < 0.01 * fall);
    CHECK(net.energy() > -0.3 * fall);
    MESSAGE("gap " << worst << " m, energy at most " << most << " J, at the end " << net.energy() << " J of "
                   << fall);
  }
}

}  // namespace
}  // namespace hooke::solver
