/// Tests pendulums with more than one angle: a double one, and one that moves around the vertical.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::check {

namespace {

constexpr const char* kPlaneSolver = "springs";
constexpr double kRodStiffness = 1e6;  ///< Stiffness of rods in the laboratory [N/m].

/// These are the angles from straight down of two rods of 1 m with 1 kg each at their ends, and their rates
/// [rad/s].
using DoubleAngles = std::array<double, 4>;

/// These are the equations of motion of the double pendulum from its Lagrangian (textbook), d = a - b:
/// a'' = (-3 g sin a - g sin(a - 2 b) - 2 sin d (b'^2 + a'^2 cos d)) / (3 - cos 2d)
/// b'' = 2 sin d (2 a'^2 + 2 g cos a + b'^2 cos d) / (3 - cos 2d)
DoubleAngles rates(const DoubleAngles& y) {
  const auto [a, b, va, vb] = y;
  const double d = a - b;
  const double below = 3 - std::cos(2 * d);
  return {va, vb,
          (-3 * kGravity * std::sin(a) - kGravity * std::sin(a - 2 * b) -
           2 * std::sin(d) * (vb * vb + va * va * std::cos(d))) /
              below,
          2 * std::sin(d) * (2 * va * va + 2 * kGravity * std::cos(a) + vb * vb * std::cos(d)) / below};
}

/// Returns where the end is after `seconds` from rest at these angles, by Runge-Kutta 4 in steps of 0.1 ms,
/// exact to 1e-10 m.
DVec3 end_of_double_pendulum(double a, double b, double seconds) {
  constexpr double kFineStep = 1e-4;
  DoubleAngles y = {a, b, 0, 0};
  const auto moved = [&y](const DoubleAngles& k, double h) {
    DoubleAngles next = y;
    for (std::size_t i = 0; i < next.size(); ++i) next[i] += h * k[i];
    return next;
  };
  const auto steps = std::lround(seconds / kFineStep);
  for (long n = 0; n < steps; ++n) {
    const DoubleAngles k1 = rates(y);
    const DoubleAngles k2 = rates(moved(k1, kFineStep / 2));
    const DoubleAngles k3 = rates(moved(k2, kFineStep / 2));
    const DoubleAngles k4 = rates(moved(k3, kFineStep));
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] += kFineStep / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return {std::sin(y[0]) + std::sin(y[1]), -std::cos(y[0]) - std::cos(y[1]), 0};
}

void add_double_pendulum(const CheckSetting& setting, double degrees, double tolerance, Rows& rows) {
  const double seconds = 3;
  const double a = degrees * kTau / 360;
  const DVec3 rod = {std::sin(a), -std::cos(a), 0};
  Rig rig(setting);
  const Real k = stiff(setting, kRodStiffness);
  const ParticlesId id =
      rig.add({.particles = {{}, {.position = rod}, {.position = 2 * rod}},
               .springs = {{.a = 0, .b = 1, .stiffness = k}, {.a = 1, .b = 2, .stiffness = k}},
               .pins = {{}}});
  const double start = rig.energy().total();
  rig.run(seconds);
  const std::string from = "from " + std::to_string(static_cast<int>(degrees)) + " deg";
  rows.push_back({.title = from + ": distance of the end from where it should be after 3 s",
                  .unit = "m",
                  .expected = 0,
                  .achieved = length(rig.positions(id)[2] - end_of_double_pendulum(a, a, seconds)),
                  .tolerance = tolerance,
                  .goal = 1e-3,
                  .measure = CheckRow::Measure::kAbsolute,
                  .solver = kPlaneSolver});
  rows.push_back({.title = from + ": change of energy in 3 s / energy of the swing",
                  .expected = 0,
                  .achieved = (rig.energy().total() - start) / (3 * kGravity * (1 - std::cos(a))),
                  .tolerance = 0.005,
                  .goal = 1e-3,
                  .measure = CheckRow::Measure::kAbsolute,
                  .solver = kPlaneSolver});
}

/// A pendulum of 1 m at `angle` from straight down starts across with `speed`. Its rod is stretched from the
/// start by its tension, g cos(angle) + speed^2, so that it does not oscillate along its length.
struct Spherical {
  Rig rig;
  ParticlesId id;

  Spherical(const CheckSetting& setting, double angle, double speed) : rig(setting) {
    const Real k = stiff(setting, kRodStiffness);
    const Real pull = real(kGravity * setting.gravity_scale * std::cos(angle) + speed * speed);
    id = rig.add({.particles = {{},
                                {.position = {std::sin(angle), -std::cos(angle), 0},
                                 .velocity = {real(0), real(0), real(speed)}}},
                  .springs = {{.a = 0, .b = 1, .stiffness = k, .rest_length = Real(1) - pull / k}},
                  .pins = {{}}});
  }
};

/// Returns the angle about the vertical from one highest point to the next, of a pendulum of 1 m that starts
/// across at `angle` with `speed`. With u the depth below the pivot, E = v^2 / 2 - g u and J the angular
/// momentum about the vertical,
/// u'^2 = 2 (E + g u) (1 - u^2) - J^2 = 2 g (u - u1) (u2 - u) (u + r) (textbook), so that
/// phi = 2 Int_u1^u2 J / ((1 - u^2) u') du.
/// The quadrature is that of Gauss and Chebyshev, whose weight 1 / sqrt((u - u1) (u2 - u)) is a factor
/// of 1 / u'.
double apsidal_angle(double angle, double speed) {
  const double u1 = std::cos(angle);
  const double spin = speed * std::sin(angle);
  const double energy = 0.5 * speed * speed - kGravity * u1;
  // The roots of the cubic are u1, and two with the sum -E/g - u1 and the product -1 - (sum) u1.
  const double sum = -energy / kGravity - u1;
  const double product = -1 - sum * u1;
  const double root = std::sqrt(0.25 * sum * sum - product);
  const double u2 = 0.5 * sum + root;
  const double r = root - 0.5 * sum;
  constexpr int kNodes = 200;
  double integral = 0;
  for (int i = 0; i < kNodes; ++i) {
    const double u = 0.5 * (u1 + u2) + 0.5 * (u2 - u1) * std::cos(0.25 * kTau * (2 * i + 1) / kNodes);
    integral += spin / ((1 - u * u) * std::sqrt(2 * kGravity * (u + r)));
  }
  return kTau / kNodes * integral;
}

/// Returns the angle of the moving pendulum, as a mean of ten.
double achieved_apsidal_angle(const CheckSetting& setting, double angle, double speed) {
  Spherical pendulum(setting, angle, speed);
  Rig& rig = pendulum.rig;
  Curve climb;
  Curve azimuth;
  double turned = 0;
  double last = 0;
  rig.run(12, [&] {
    const DVec3 x = rig.positions(pendulum.id)[1];
    const double now = std::atan2(x.z, x.x);
    turned += std::remainder(now - last, kTau);
    last = now;
    climb.add(rig.time(), rig.velocities(pendulum.id)[1].y);
    azimuth.add(rig.time(), turned);
  });
  // The vertical speed is zero at each lowest and each highest point; the first crossing is a lowest one.
  const std::vector<double> times = climb.zero_crossings();
  const std::size_t whole = (times.size() - 1) / 2;
  return (azimuth.at(times[2 * whole]) - azimuth.at(times[0])) / static_cast<double>(whole);
}

}  // namespace

/// Position and energy of a double pendulum after 3 s are compared with its equations of motion in two
/// angles.
Rows double_pendulum(const CheckSetting& setting) {
  Rows rows;
  add_double_pendulum(setting, 10, 0.01, rows);
  add_double_pendulum(setting, 90, 0.01, rows);
  return rows;
}

/// A conical pendulum rotates with w^2 = g / (L cos theta); one that also swings goes from one highest point
/// to the next by apsidal_angle (textbook).
Rows conical_pendulum(const CheckSetting& setting) {
  Rows rows;
  for (const double degrees : {20.0, 60.0}) {
    const double angle = degrees * kTau / 360;
    const double w = std::sqrt(kGravity / std::cos(angle));
    Spherical pendulum(setting, angle, w * std::sin(angle));
    Rig& rig = pendulum.rig;
    const Curve side = record(rig, 10.5, [&] { return rig.positions(pendulum.id)[1].z; });
    rows.push_back({.title = "period of the cone at " + std::to_string(static_cast<int>(degrees)) + " deg",
                    .unit = "s",
                    .expected = kTau / w,
                    .achieved = side.period(),
                    .tolerance = 0.005,
                    .goal = 1e-3,
                    .solver = kPlaneSolver});
  }
  const double angle = 40 * kTau / 360;
  rows.push_back({.title = "angle from one highest place to the next, from 40 deg at 1 m/s",
                  .unit = "rad",
                  .expected = apsidal_angle(angle, 1),
                  .achieved = achieved_apsidal_angle(setting, angle, 1),
                  .tolerance = 0.005,
                  .goal = 1e-3,
                  .solver = kPlaneSolver});
  return rows;
}

}  // namespace hooke::check
