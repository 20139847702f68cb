#include "hooke/compare/exact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hooke::app {

namespace {

constexpr double kAligned = 1e-9;  // Largest sine of an angle that counts as zero; only rounding exceeds it.

/// One free mass hangs on one spring from a held point; all values are in SI units.
struct SpringPendulum {
  DVec3 hook;
  DVec3 offset;  ///< Offset of the mass from the hook.
  DVec3 velocity;
  DVec3 gravity;
  double mass = 1;
  double stiffness = 0;
  double damping = 0;
  double rest_length = 0;
};

double real(Real x) {
  return static_cast<double>(x);
}

/// Returns nothing if anything else is in the scene, or if the scene has air.
std::optional<SpringPendulum> find_pendulum(const Stage& stage) {
  const SceneObjects& objects = stage.scene().objects;
  const bool alone = objects.bodies.empty() && objects.ropes.empty() && objects.cloths.empty() &&
                     objects.fields.empty() && objects.solids.empty() && objects.hooks.empty() &&
                     objects.particles.size() == 1;
  if (!alone) return std::nullopt;
  const SceneParticles& net = objects.particles.front();
  const ParticlesDesc& desc = net.desc;
  const bool simple = desc.particles.size() == 2 && desc.springs.size() == 1 && net.pins.size() == 1 &&
                      net.tag.array.kind == SceneArray::Kind::kSingle;
  if (!simple || real(desc.air_friction) > 0 || real(desc.drag_coefficient) > 0) return std::nullopt;
  const ScenePin& pin = net.pins.front();
  const std::uint32_t held = pin.point.last ? 1 : pin.point.index;
  const bool still = pin.pick == ScenePin::Pick::kPoint && pin.motion.kind == MotionDesc::Kind::kStill;
  const bool isotropic = desc.damping == ParticlesDesc::Damping::kIsotropic;
  if (!still || held > 1 || stage.point == held || (isotropic && real(desc.springs[0].damping) > 0)) {
    return std::nullopt;
  }
  const ParticleDesc& mass = desc.particles[1 - held];
  const SpringDesc& spring = desc.springs.front();
  const DVec3 offset = mass.position - desc.particles[held].position;
  return SpringPendulum{.hook = desc.particles[held].position,
                        .offset = offset,
                        .velocity = vector_cast<double>(mass.velocity),
                        .gravity = vector_cast<double>(stage.scene().world.gravity),
                        .mass = real(mass.mass),
                        .stiffness = real(spring.stiffness),
                        .damping = real(spring.damping),
                        .rest_length = spring.rest_length ? real(*spring.rest_length) : length(offset)};
}

bool parallel(DVec3 a, DVec3 b) {
  return length(cross(a, b)) <= kAligned * length(a) * length(b);
}

/// This is y'' = -omega^2 y - 2 a y', from y0 and v0.
struct Oscillator {
  double omega = 1;
  double a = 0;  ///< [1/s]
  double y0 = 0;
  double v0 = 0;

  /// Returns y and y' at `time`.
  [[nodiscard]] std::array<double, 2> at(double time) const {
    const double difference = a * a - omega * omega;
    const double rate = std::sqrt(std::abs(difference));
    double c = 1;
    double s = time;
    if (difference < 0) {
      c = std::cos(rate * time);
      s = std::sin(rate * time) / rate;
    } else if (difference > 0) {
      c = std::cosh(rate * time);
      s = std::sinh(rate * time) / rate;
    }
    const double fade = std::exp(-a * time);
    return {fade * (y0 * (c + a * s) + v0 * s), fade * (v0 * (c - a * s) - omega * omega * y0 * s)};
  }
};

/// Returns sn(u, k) by the descending arithmetic-geometric mean, for 0 <= k < 1.
double jacobi_sn(double u, double k) {
  constexpr int kMost = 16;
  std::array<double, kMost + 1> a = {1};
  std::array<double, kMost + 1> c = {k};
  double b = std::sqrt(1 - k * k);
  int n = 0;
  while (n < kMost && c[static_cast<std::size_t>(n)] > 1e-16) {
    const double mean = a[static_cast<std::size_t>(n)];
    ++n;
    a[static_cast<std::size_t>(n)] = (mean + b) / 2;
    c[static_cast<std::size_t>(n)] = (mean - b) / 2;
    b = std::sqrt(mean * b);
  }
  double phi = std::ldexp(a[static_cast<std::size_t>(n)] * u, n);
  for (; n > 0; --n) {
    const auto i = static_cast<std::size_t>(n);
    phi = (phi + std::asin(std::clamp(c[i] / a[i] * std::sin(phi), -1.0, 1.0))) / 2;
  }
  return std::sin(phi);
}

/// Returns K(k) = pi / (2 agm(1, sqrt(1 - k^2))).
double quarter_period(double k) {
  double a = 1;
  double b = std::sqrt(1 - k * k);
  for (int i = 0; i < 16; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / (2 * a);
}

}  // namespace

std::optional<ExactMotion> exact_motion(const Stage& stage) {
  const auto found = find_pendulum(stage);
  if (!found) return std::nullopt;
  const SpringPendulum p = *found;
  const double distance = length(p.offset);
  const bool on_a_line = parallel(p.offset, p.gravity) && parallel(p.offset, p.velocity);
  if (!on_a_line || !(distance > 0) || !(p.stiffness > 0) || !std::isfinite(p.stiffness)) return std::nullopt;
  const DVec3 along = normalize(p.offset);
  const double rest = p.rest_length + p.mass * dot(p.gravity, along) / p.stiffness;
  const Oscillator oscillator = {.omega = std::sqrt(p.stiffness / p.mass),
                                 .a = p.damping / (2 * p.mass),
                                 .y0 = distance - rest,
                                 .v0 = dot(p.velocity, along)};
  // The formula of the line does not hold beyond the time when the spring would pass through its hook.
  if (!(rest > std::hypot(oscillator.y0, oscillator.v0 / oscillator.omega))) return std::nullopt;
  return ExactMotion{
      .title = "the exact damped oscillator",
      .position = [=](double time) { return p.hook + (rest + oscillator.at(time)[0]) * along; },
      .energy = [=](double time) -> Energy {
        const auto [y, v] = oscillator.at(time);
        const double stretch = rest + y - p.rest_length;
        return {p.mass * v * v / 2, -p.mass * dot(p.gravity, p.hook + (rest + y) * along),
                p.stiffness * stretch * stretch / 2};
      }};
}

std::optional<ExactMotion> rigid_pendulum(const Stage& stage) {
  const auto found = find_pendulum(stage);
  if (!found) return std::nullopt;
  const SpringPendulum p = *found;
  const double l = length(p.offset);
  const double g = length(p.gravity);
  const bool swings = l > 0 && g > 0 && !parallel(p.offset, p.gravity) && length(p.velocity) <= 0;
  if (!swings) return std::nullopt;
  const DVec3 down = normalize(p.gravity);
  const DVec3 side = normalize(p.offset - dot(p.offset, down) * down);
  const double k = std::sin(std::atan2(dot(p.offset, side), dot(p.offset, down)) / 2);
  const double omega = std::sqrt(g / l);
  const double quarter = quarter_period(k);
  const auto angle = [=](double time) {
    return 2 * std::asin(k * jacobi_sn(std::fmod(quarter + omega * time, 4 * quarter), k));
  };
  return ExactMotion{.title = "a rigid pendulum, exact",
                     .position =
                         [=](double time) {
                           return p.hook + l * (std::cos(angle(time)) * down + std::sin(angle(time)) * side);
                         },
                     .energy = [=](double time) -> Energy {
                       const double drop = l * (std::cos(angle(time)) - dot(p.offset, down) / l);
                       return {p.mass * g * drop,
                               -p.mass * g * dot(p.hook, down) - p.mass * g * l * std::cos(angle(time)), 0};
                     }};
}

}  // namespace hooke::app
