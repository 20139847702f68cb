/// Tests chains and springs that oscillate: a hanging chain's modes, a folded chain's fall, a swinging
/// spring.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace hooke::check {

namespace {

constexpr double kChain = 1;  ///< Length of the chains [m].

/// Returns J0(j sqrt(s / L)), with s from the free end.
double hanging_shape(double zero, int i, int segments) {
  return std::cyl_bessel_j(0.0, zero * std::sqrt(1 - i / static_cast<double>(segments)));
}

double hanging_period(const CheckSetting& setting, double zero, double expected) {
  const int segments = 64;
  RopeDesc desc{.points = {}, .drag_coefficient = real(0)};
  for (int i = 0; i <= segments; ++i)
    desc.points.push_back({2e-3 * hanging_shape(zero, i, segments), -kChain * i / segments, 0});
  Rig rig(setting, without_air());
  const RopeId id = rig.add(desc);
  const Curve curve = record(rig, 5 * expected, [&] {
    const std::vector<DVec3> x = rig.positions(id);
    double sum = 0;
    for (int i = 1; i <= segments; ++i) {
      sum +=
          hanging_shape(zero, i, segments) * x[static_cast<std::size_t>(i)].x * (i == segments ? 0.5 : 1.0);
    }
    return sum;
  });
  return curve.period();
}

/// Returns the time over sqrt(L / g) in which the free end of a folded chain falls by `way` L, without loss.
/// It uses the midpoint rule after the substitution x = L u^2, which removes the root at the start.
double folded_fall(double way) {
  const int steps = 10000;
  const double end = std::sqrt(way);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps * end;
    sum += 2 * std::sqrt((1 - u * u) / (2 - u * u)) * end / steps;
  }
  return sum;
}

/// Makes a chain that hangs by both ends, `gap` apart: two strands and a half circle.
std::vector<DVec3> folded(int segments, double gap) {
  const double radius = 0.5 * gap;
  const double strand = 0.5 * (kChain - kTau / 2 * radius);
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i) {
    const double s = kChain * i / segments;
    const double angle = (s - strand) / radius;
    if (s <= strand) {
      points.push_back({0, -s, 0});
    } else if (angle < kTau / 2) {
      points.push_back({radius * (1 - std::cos(angle)), -strand - radius * std::sin(angle), 0});
    } else {
      points.push_back({gap, -(kChain - s), 0});
    }
  }
  return points;
}

/// This is a swinging mass on a spring: x aside, y down from the hook.
struct SwingingSpring {
  static constexpr double kMass = 1, kAtRest = 1;
  double stiffness = 0;
  std::array<double, 4> state = {};  ///< x, y, and their rates.

  [[nodiscard]] std::array<double, 4> rate(const std::array<double, 4>& s) const {
    const double length = std::hypot(s[0], s[1]);
    const double pull = stiffness * (length - kAtRest) / (length * kMass);
    return {s[2], s[3], -pull * s[0], kGravity - pull * s[1]};
  }
  void advance(double time, int steps) {
    const double h = time / steps;
    const auto moved = [&](const std::array<double, 4>& by, double part) {
      std::array<double, 4> result = state;
      for (std::size_t i = 0; i < 4; ++i) result[i] += part * by[i];
      return result;
    };
    for (int n = 0; n < steps; ++n) {
      const auto k1 = rate(state);
      const auto k2 = rate(moved(k1, h / 2));
      const auto k3 = rate(moved(k2, h / 2));
      const auto k4 = rate(moved(k3, h));
      for (std::size_t i = 0; i < 4; ++i) state[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
  }
};

void add_swinging_spring(const CheckSetting& setting, double stiffness, const std::string& name, Rows& rows) {
  const double balance = SwingingSpring::kAtRest + SwingingSpring::kMass * kGravity / stiffness;
  const double aside = 0.02;
  const double below = 0.2;
  SwingingSpring exact{.stiffness = stiffness, .state = {aside, balance + below, 0, 0}};
  Rig rig(setting, without_air());
  const ParticlesId id = rig.add(
      {.particles = {{}, {.position = {aside, -balance - below, 0}, .mass = real(SwingingSpring::kMass)}},
       .springs =
           {{.a = 0, .b = 1, .stiffness = real(stiffness), .rest_length = real(SwingingSpring::kAtRest)}},
       .pins = {{}}});
  // Positions are half a substep ahead (see Energy).
  exact.advance(0.5 * setting.dt / setting.substeps, 1);
  double error = 0;
  double exact_way = 0;
  double way = 0;
  rig.run(20, [&] {
    exact.advance(setting.dt, 40);
    const DVec3 x = rig.positions(id)[1];
    error = std::max(error, std::hypot(x.x - exact.state[0], x.y + exact.state[1]));
    exact_way = std::max(exact_way, std::abs(exact.state[0]));
    way = std::max(way, std::abs(x.x));
  });
  const std::string reason =
      "springs between particles are taken implicitly: at 1/480 s a bounce decays at w^2 h / 2, which takes "
      "from the swing what the bounce would give it";
  rows.push_back(known_miss(relative_row("largest way aside in 20 s, " + name, "m", exact_way, way), reason));
  rows.push_back(
      known_miss(absolute_row("largest distance from the true path in 20 s, over the bounce, " + name, "", 0,
                              error / below, 0.02),
                 reason));
}

}  // namespace

/// w_k = j_{0,k} / 2 sqrt(g / L), j_{0,k} the zeros of J0 (Daniel Bernoulli 1733).
Rows hanging_chain_modes(const CheckSetting& setting) {
  constexpr std::array<double, 3> kZeros = {2.404825557695773, 5.520078110286311, 8.653727912911013};
  Rows rows;
  for (std::size_t k = 0; k < kZeros.size(); ++k) {
    const double expected = kTau / (0.5 * kZeros[k] * std::sqrt(kGravity / kChain));
    rows.push_back(relative_row("period of mode " + std::to_string(k + 1) + " of a hanging chain", "s",
                                expected, hanging_period(setting, kZeros[k], expected)));
    rows.back().solver = "rope";
  }
  return rows;
}

/// A chain hangs by both ends, side by side, and one end is released. Without loss v^2 = g x (2 L - x) / (L -
/// x) (Calkin and March 1989), so that the end falls faster than a stone: it takes 0.847 of the time for the
/// length.
Rows falling_folded_chain(const CheckSetting& setting) {
  const double way = 0.97;
  Rig rig(setting, without_air());
  const RopeId id = rig.add(RopeDesc{.points = folded(200, 0.02), .drag_coefficient = real(0)});
  const double energy = rig.energy().total();
  double lost = 0;
  Curve fall;
  const auto fallen = [&] { return way * kChain + rig.positions(id).back().y; };
  fall.add(0, fallen());
  rig.run(0.6, [&] {
    if (fall.last() > 0.1 * kChain) lost = energy - rig.energy().total();
    fall.add(rig.time(), fallen());
  });
  const std::vector<double> times = fall.zero_crossings();
  const double stone = std::sqrt(2 * way * kChain / kGravity);
  // The energy is that of half the chain, falling from its height at rest to a quarter of the length below.
  const double drop = kGravity * kChain / 4;
  const double found = times.empty() ? NAN : times.front() / stone;
  Rows rows = {relative_row("time of a folded chain's end to fall 0.97 L, over free fall's", "",
                            folded_fall(way) / std::sqrt(2 * way), found, 0.01),
               absolute_row("energy lost until 0.87 L, share of m g L / 4", "", 0, lost / drop, 0.05)};
  for (CheckRow& row : rows) {
    row.solver = "rope";
    row = known_miss(
        row,
        "ropes lose energy where a fold runs along one, by the step: at 1/3840 s the ratio is 0.889 "
        "and the loss 0.41, at 1/480 s 0.990 and 0.78");
  }
  return rows;
}

/// A swinging mass on a spring is compared with its equation of motion by Runge-Kutta 4. At k / m = 4 g / l,
/// with l the length in balance, the vertical oscillation has twice the rate of the swing and turns into it
/// (Vitt and Gorelik 1933).
Rows swinging_spring(const CheckSetting& setting) {
  Rows rows;
  add_swinging_spring(setting, 100, "off resonance", rows);
  // k (L + m g / k) = 4 m g gives k = 3 m g / L.
  add_swinging_spring(setting, 3 * SwingingSpring::kMass * kGravity / SwingingSpring::kAtRest, "2 : 1", rows);
  for (CheckRow& row : rows) row.solver = "springs";
  return rows;
}

}  // namespace hooke::check
