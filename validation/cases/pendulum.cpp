/// Tests pendulums: a mass on a rigid rope of two points, or on a rigid spring.

#include "validation/cases.h"
#include "validation/rig.h"

#include <array>
#include <cmath>
#include <limits>

namespace hooke::check {

namespace {

/// Stiffness of rods in the laboratory [N/m]. A mass of 1 kg that passes the lowest point at its fastest
/// stretches them by 5e-5.
constexpr double kStiff = 1e6;

enum class Rod { kRope, kSpring };

/// Returns the angle from straight down; `arm` leads from the pivot to the mass.
double angle_of(DVec3 arm) {
  return std::atan2(arm.x, -arm.y);
}

/// Returns the time from the first to the third passage through the vertical, over 2 pi sqrt(L/g).
double relative_period(const CheckSetting& setting, Rod rod, double angle_deg) {
  const double angle = angle_deg * kTau / 360;
  const DVec3 end = {std::sin(angle), -std::cos(angle), 0};
  Rig rig(setting);
  const double small_swing = kTau / std::sqrt(kGravity);
  std::vector<double> times;
  if (rod == Rod::kRope) {
    const RopeId id = rig.add(RopeDesc{.total_mass = real(2),
                                       .stiffness = stiff(setting, kStiff),
                                       .points = {{}, end},
                                       .drag_coefficient = real(0)});
    times =
        record(rig, 2.5 * 2.5 * small_swing, [&] { return angle_of(rig.positions(id)[1]); }).zero_crossings();
  } else {
    const ParticlesId id = rig.add({.particles = {{}, {.position = end}},
                                    .springs = {{.a = 0, .b = 1, .stiffness = stiff(setting, kStiff)}},
                                    .pins = {{}}});
    times =
        record(rig, 2.5 * 2.5 * small_swing, [&] { return angle_of(rig.positions(id)[1]); }).zero_crossings();
  }
  if (times.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  return (times[2] - times[0]) / small_swing;
}

struct Amplitude {
  double angle_deg;
  double ratio;
};

/// These are T / T0 = 1 / agm(1, cos(theta0 / 2)), computed to six places.
constexpr std::array<Amplitude, 7> kAmplitudes = {{{30, 1.017409},
                                                   {60, 1.073182},
                                                   {90, 1.180341},
                                                   {120, 1.372881},
                                                   {150, 1.762204},
                                                   {170, 2.439363},
                                                   {179, 3.901065}}};

/// Tells whether a pendulum of length `length` stays upside down over a pivot that shakes by `amplitude` at
/// `rate` [rad/s]. It starts half a degree off and may not fall over in 60 s.
bool stands_inverted(const CheckSetting& setting, double length, double amplitude, double rate) {
  Rig rig(setting);
  const double lean = 0.5 * kTau / 360;
  const MotionDesc shake{.kind = MotionDesc::Kind::kSine,
                         .amplitude = {real(0), real(amplitude), real(0)},
                         .frequency_hz = real(rate / kTau),
                         .phase = real(0.25 * kTau)};
  const ParticlesId id =
      rig.add({.particles = {{}, {.position = {length * std::sin(lean), length * std::cos(lean), 0}}},
               .springs = {{.a = 0, .b = 1, .stiffness = stiff(setting, kStiff)}},
               .pins = {{.point = 0, .motion = shake}}});
  bool stood = true;
  rig.run(60, [&] {
    const std::vector<DVec3> x = rig.positions(id);
    stood = stood && x[1].y > x[0].y;
  });
  return stood;
}

}  // namespace

/// T / T0 = 1 / agm(1, cos(theta0 / 2)), T0 = 2 pi sqrt(L / g) (Gauss; complete elliptic integral).
Rows pendulum_amplitude(const CheckSetting& setting) {
  Rows rows;
  for (const Rod rod : {Rod::kRope, Rod::kSpring}) {
    const std::string name = rod == Rod::kRope ? "rope" : "springs";
    for (const Amplitude& amplitude : kAmplitudes) {
      rows.push_back({.title = "T/T0 from " + std::to_string(static_cast<int>(amplitude.angle_deg)) +
                               " deg, rigid " + (rod == Rod::kRope ? "rope" : "spring"),
                      .expected = amplitude.ratio,
                      .achieved = relative_period(setting, rod, amplitude.angle_deg),
                      .tolerance = amplitude.angle_deg > 90 ? 0.005 : 0.001,
                      .goal = 1e-4,
                      .solver = name});
      if (amplitude.angle_deg > 178) {
        rows.back() =
            known_miss_turned(setting, rows.back(), "so near the top a rounding is a start at another angle");
      }
    }
  }
  return rows;
}

/// T / T0 = 1.180341 from 90 deg. In double precision, too, the step alone decides the error.
Rows pendulum_right_angle(const CheckSetting& setting) {
  Rows rows;
  for (const Rod rod : {Rod::kRope, Rod::kSpring}) {
    rows.push_back({.title = std::string("T/T0, first to third passage, rigid ") +
                             (rod == Rod::kRope ? "rope" : "spring"),
                    .expected = 1.180341,
                    .achieved = relative_period(setting, rod, 90),
                    .tolerance = 0.001,
                    .solver = rod == Rod::kRope ? "rope" : "springs"});
  }
  return rows;
}

/// An inverted pendulum stays up over a pivot shaken by a cos(w t) if a w > sqrt(2 g L) (Kapitza 1951), for
/// small a / L. The next term of Mathieu's boundary, -delta = e^2 / 2 - 7 e^4 / 32 with e = a / L and delta =
/// -g / (L w^2), raises w by 7 e^2 / 32: 0.2 % here.
Rows inverted_pendulum(const CheckSetting& setting) {
  const double length = 10;
  const double amplitude = 1;
  const double e = amplitude / length;
  const double rate = std::sqrt(kGravity / length / (0.5 * e * e - 7.0 / 32.0 * e * e * e * e));
  const double found = bisect(1.1 * rate, 0.9 * rate, 7, [&](double trial) {
    return stands_inverted(setting, length, amplitude, trial);
  });
  return {{.title = "least a w that holds it up, a / L = 0.1",
           .unit = "m/s",
           .expected = amplitude * rate,
           .achieved = amplitude * found,
           .tolerance = 0.02,
           .solver = "springs"}};
}

}  // namespace hooke::check
