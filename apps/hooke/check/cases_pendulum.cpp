/// Pendulums: a mass on a rigid rope of two points, or on a rigid spring.

#include "cases.h"
#include "rig.h"

#include <array>
#include <cmath>
#include <limits>

namespace hooke::check {

namespace {

enum class Rod { kRope, kSpring };

/// Angle from straight down, from the place of the mass relative to its pivot.
double angle_of(DVec3 arm) {
  return std::atan2(arm.x, -arm.y);
}

/// Time from the first to the third passage through the vertical, over 2 pi sqrt(L/g).
double relative_period(const CheckSetting& setting, Rod rod, double angle_deg) {
  const double angle = angle_deg * kTau / 360;
  const DVec3 end = {std::sin(angle), -std::cos(angle), 0};
  Rig rig(setting);
  const World& world = rig.world();
  const double small_swing = kTau / std::sqrt(kGravity);
  std::vector<double> times;
  if (rod == Rod::kRope) {
    const RopeId id =
        rig.add(RopeDesc{.total_mass = real(2), .points = {{}, end}, .drag_coefficient = real(0)});
    times = record(rig, 2.5 * 2.5 * small_swing, [&] {
              return angle_of(world.positions(id)[1]);
            }).zero_crossings();
  } else {
    const ParticlesId id = rig.add({.particles = {{}, {.position = end}},
                                    .springs = {{.a = 0, .b = 1, .stiffness = kRigid}},
                                    .pins = {{}}});
    times = record(rig, 2.5 * 2.5 * small_swing, [&] {
              return angle_of(world.positions(id)[1]);
            }).zero_crossings();
  }
  if (times.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  return (times[2] - times[0]) / small_swing;
}

struct Amplitude {
  double angle_deg;
  double ratio;
};

/// T / T0 = 1 / agm(1, cos(theta0 / 2)), computed to six places.
constexpr std::array<Amplitude, 6> kAmplitudes = {
    {{30, 1.017409}, {60, 1.073182}, {90, 1.180341}, {120, 1.372881}, {150, 1.762204}, {170, 2.439363}}};

}  // namespace

/// T / T0 = 1 / agm(1, cos(theta0 / 2)), T0 = 2 pi sqrt(L / g) (Gauss; complete elliptic integral).
std::vector<CheckRow> pendulum_amplitude(const CheckSetting& setting) {
  std::vector<CheckRow> rows;
  for (const Rod rod : {Rod::kRope, Rod::kSpring}) {
    const std::string name = rod == Rod::kRope ? "rope" : "springs";
    for (const Amplitude& amplitude : kAmplitudes) {
      rows.push_back({.title = "T/T0 from " + std::to_string(static_cast<int>(amplitude.angle_deg)) +
                               " deg, rigid " + (rod == Rod::kRope ? "rope" : "spring"),
                      .expected = amplitude.ratio,
                      .achieved = relative_period(setting, rod, amplitude.angle_deg),
                      .tolerance = amplitude.angle_deg > 90 ? 0.005 : 0.001,
                      .solver = name});
    }
  }
  return rows;
}

}  // namespace hooke::check
