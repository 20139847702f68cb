/// Tests particles and springs without gravity: periods, decay, momentum.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hooke::check {

namespace {

constexpr const char* kSpringSolver = "springs";

struct Oscillator {
  double mass = 1;       ///< [kg]
  double stiffness = 1;  ///< [N/m]
  double damping = 0;    ///< [N s/m]
};

/// Returns the deviation from rest of a mass on a spring, released at 0.2 m.
Curve released(const CheckSetting& setting, const Oscillator& o, double seconds) {
  Rig rig(setting, weightless());
  const ParticlesId id = rig.add({.particles = {{}, {.position = {1.2, 0, 0}, .mass = real(o.mass)}},
                                  .springs = {{.a = 0,
                                               .b = 1,
                                               .stiffness = real(o.stiffness),
                                               .damping = real(o.damping),
                                               .rest_length = real(1)}},
                                  .pins = {{}}});
  return record(rig, seconds, [&] { return rig.positions(id)[1].x - 1.0; });
}

/// Returns the damping ratio from the ratio of the first two peaks on one side.
double damping_ratio(const Curve& curve) {
  const std::vector<double> peaks = curve.peaks();
  if (peaks.size() < 4) return std::numeric_limits<double>::quiet_NaN();
  const double decrement = std::log(peaks[1] / peaks[3]);
  return decrement / std::hypot(kTau, decrement);
}

/// Returns the period of one mode of `count` equal masses between two walls, each pair joined by a spring.
double mode_period(const CheckSetting& setting, int count, int mode, double stiffness) {
  const double spacing = 0.1;
  const auto shape = [&](int i) { return std::sin(0.5 * kTau * mode * i / (count + 1)); };
  ParticlesDesc desc;
  for (int i = 0; i <= count + 1; ++i) {
    desc.particles.push_back({.position = {spacing * i + 0.005 * shape(i), 0, 0}});
  }
  for (int i = 0; i <= count; ++i) {
    const auto a = static_cast<std::uint32_t>(i);
    desc.springs.push_back({.a = a, .b = a + 1, .stiffness = real(stiffness), .rest_length = real(spacing)});
  }
  desc.pins = {{.point = 0}, {.point = static_cast<std::uint32_t>(count + 1)}};
  Rig rig(setting, weightless());
  const ParticlesId id = rig.add(desc);
  const Curve curve = record(rig, 6, [&] {
    double sum = 0;
    const std::vector<DVec3> x = rig.positions(id);
    for (int i = 1; i <= count; ++i) sum += shape(i) * (x[static_cast<std::size_t>(i)].x - spacing * i);
    return sum;
  });
  return curve.period();
}

ParticlesDesc spinning_pair(double damping, ParticlesDesc::Damping kind) {
  const auto speed = real(1.5);
  return {.particles = {{.position = {-0.5, 0, 0}, .velocity = {real(0), -speed, real(0)}},
                        {.position = {0.5, 0, 0}, .velocity = {real(0), speed, real(0)}}},
          .springs = {{.a = 0, .b = 1, .stiffness = real(400), .damping = real(damping)}},
          .damping = kind};
}

double spin_left(const CheckSetting& setting, const ParticlesDesc& desc, double seconds) {
  Rig rig(setting, weightless());
  rig.add(desc);
  const double start = rig.world().measure().angular_momentum.z;
  rig.run(seconds);
  return rig.world().measure().angular_momentum.z / start;
}

}  // namespace

/// T = 2 pi sqrt(m / k) (textbook): 0.19869 s for 1 kg and compliance 1e-3 m/N, the case of Macklin et al.
/// 2016, "XPBD", section 6.1.
Rows simple_oscillator(const CheckSetting& setting) {
  Rows rows;
  const auto add = [&](std::string title, const CheckSetting& stepping, double tolerance) {
    rows.push_back({.title = std::move(title),
                    .unit = "s",
                    .expected = kTau / std::sqrt(1000.0),
                    .achieved = released(stepping, {.stiffness = 1000}, 1.5).period(),
                    .tolerance = tolerance,
                    .solver = kSpringSolver,
                    .dt = stepping.dt});
  };
  CheckSetting fine = setting;
  fine.dt = 1.0 / 600;
  if (!setting.laboratory()) add("period", setting, 0.005);
  add("period at 600 Hz", fine, 0.001);
  return rows;
}

/// The logarithmic decrement is 2 pi zeta / sqrt(1 - zeta^2), zeta = c / (2 sqrt(k m)). With zeta = 1 the
/// deviation is (1 + w t) e^(-w t) of its start after t; with zeta = 2 the slow part remains (textbook).
/// Implicit steps add w h / 2 to zeta: 0.0005 here.
Rows damped_oscillator(const CheckSetting& setting) {
  const double w = 0.5;
  const double mass = 4;
  const auto with = [&](double zeta) {
    return Oscillator{.mass = mass, .stiffness = mass * w * w, .damping = 2 * zeta * mass * w};
  };
  const double t = 6;
  const auto at_end = [&](double zeta) { return released(setting, with(zeta), t).last() / 0.2; };
  const double root = std::sqrt(3.0);  // This is sqrt(zeta^2 - 1) for zeta = 2.
  const double fast = (2 + root) * w;
  const double slow = (2 - root) * w;
  return {{.title = "damping ratio 0.2 from the decrement",
           .expected = 0.2,
           .achieved = damping_ratio(released(setting, with(0.2), 40)),
           .tolerance = 0.005,
           .solver = kSpringSolver},
          {.title = "critical damping: share left after 6 s",
           .expected = (1 + w * t) * std::exp(-w * t),
           .achieved = at_end(1),
           .tolerance = 0.005,
           .solver = kSpringSolver},
          {.title = "overdamped, zeta = 2: share left after 6 s",
           .expected = (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) / (fast - slow),
           .achieved = at_end(2),
           .tolerance = 0.005,
           .solver = kSpringSolver}};
}

/// w_j = 2 sqrt(k / m) sin(j pi / (2 (N + 1))) for N masses between fixed ends (textbook).
Rows chain_modes(const CheckSetting& setting) {
  const int count = 8;
  const double stiffness = 100;
  Rows rows;
  for (int mode = 1; mode <= 5; ++mode) {
    const double w = 2 * std::sqrt(stiffness) * std::sin(0.25 * kTau * mode / (count + 1));
    rows.push_back({.title = "8 masses, period of mode " + std::to_string(mode),
                    .unit = "s",
                    .expected = kTau / w,
                    .achieved = mode_period(setting, count, mode, stiffness),
                    .tolerance = 0.005,
                    .goal = 0.002,
                    .solver = kSpringSolver});
  }
  return rows;
}

/// Inner forces along the line of two masses keep angular momentum. Damping of the whole relative velocity,
/// the paper's form, is a torque -(c / mu) L with mu = m_a m_b / (m_a + m_b): L = L0 e^(-c t / mu), after 1 s
/// e^-1 for 1 kg + 1 kg and c = 0.5 N s/m.
Rows dumbbell(const CheckSetting& setting) {
  using Damping = ParticlesDesc::Damping;
  return {{.title = "central damping: angular momentum left after 60 s",
           .expected = 1,
           .achieved = spin_left(setting, spinning_pair(2, Damping::kCentral), 60),
           .tolerance = 1e-5,
           .solver = kSpringSolver},
          {.title = "isotropic damping: angular momentum left after 1 s",
           .expected = std::exp(-1.0),
           .achieved = spin_left(setting, spinning_pair(0.5, Damping::kIsotropic), 1),
           .tolerance = 0.005,
           .solver = kSpringSolver}};
}

}  // namespace hooke::check
