#include "solver/body/body_motion.h"
#include "solver/body/free_turn_kernels.h"
#include "solver/soft/particle_kernels.h"

#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <string>

namespace hooke::solver {
namespace {

constexpr Real kStep = Real(0.01);

/// A body of inertia 1, 1 + i / 8 and 1 + i / 5 kg m^2 that turns at up to 2 rad/s about an axis of its own.
struct Turning {
  state::BodyMass mass;
  Quat rotation;
  Vec3 momentum;

  explicit Turning(int i) {
    const Real x = Real(i);
    mass.inertia = {Real(1), Real(1) + x / Real(8), Real(1) + x / Real(5)};
    mass.principal = normalize(Quat{Real(0.1) * x, Real(0.3), Real(-0.2), Real(1)});
    rotation = normalize(Quat{Real(0.5), Real(0.1) * x, Real(0.7), Real(0.2) * x - Real(1)});
    momentum = {Real(1.5) - Real(0.2) * x, Real(0.7), Real(0.1) * x};
  }
};

wide::TurnLanes all_lanes() {
  wide::TurnLanes lanes = {};
  for (int i = 0; i < kLanes; ++i) {
    const Turning body(i);
    const Quat axes = body.rotation * body.mass.principal;
    const std::array<Real, 4> of_axes = {axes.x, axes.y, axes.z, axes.w};
    for (int k = 0; k < 4; ++k) lanes.axes[k][i] = of_axes[k];
    const Vec3 inertia = body.mass.inertia;
    const std::array<Vec3, 2> vectors = {Vec3{Real(1) / inertia.x, Real(1) / inertia.y, Real(1) / inertia.z},
                                         body.momentum};
    for (int k = 0; k < 3; ++k) {
      const auto part = std::array{&Vec3::x, &Vec3::y, &Vec3::z}[k];
      lanes.inverse[k][i] = vectors[0].*part;
      lanes.momentum[k][i] = vectors[1].*part;
    }
  }
  return lanes;
}

Vec3 omega_of(const wide::TurnLanes& lanes, int i) {
  return {lanes.omega[0][i], lanes.omega[1][i], lanes.omega[2][i]};
}

TEST_SUITE("solver/free_turns") {
  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    wide::TurnLanes expected = all_lanes();
    wide::turn_freely_scalar(kStep, kLanes, expected);
    for (const std::string& target : wide::targets()) {
      REQUIRE(wide::use_target(target));
      wide::TurnLanes lanes = all_lanes();
      wide::turn_freely(kStep, kLanes, lanes);
      for (int i = 0; i < kLanes; ++i) CHECK_MESSAGE(omega_of(lanes, i) == omega_of(expected, i), target);
    }
    wide::use_target("");
  }

  TEST_CASE("the velocity is that halfway through the turn, alone and beside others") {
    wide::TurnLanes lanes = all_lanes();
    wide::turn_freely(kStep, kLanes, lanes);
    for (int i = 0; i < kLanes; ++i) {
      const Turning body(i);
      const Vec3 omega = omega_of(lanes, i);
      CHECK(omega == mean_velocity(body.mass, body.rotation, body.momentum, kStep));
      const Vec3 half = Real(0.5) * kStep * omega;
      const Quat halfway = normalize(
          Quat{Real(0.5) * half.x, Real(0.5) * half.y, Real(0.5) * half.z, Real(1)} * body.rotation);
      const math::Symmetric3<Real> scale = inertia_scale(body.mass, halfway);
      CHECK(length(scale * (scale * body.momentum) - omega) < Real(2e-6) * length(omega));
    }
  }
}

}  // namespace
}  // namespace hooke::solver
