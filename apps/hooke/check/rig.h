#pragma once

#include "hooke/hooke.h"

#include "check.h"

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What the cases share: a world with a clock, and reading times off a sampled curve.

namespace hooke::check {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]
inline constexpr double kTau = 6.283185307179586;

/// The value, or an exception that run_case turns into a failed row.
template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().where + ": " + result.error().message);
  return std::move(result).value();
}
inline void must(const Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().where + ": " + result.error().message);
}

constexpr Real real(double value) {
  return static_cast<Real>(value);
}

/// A world stepped as the setting says. Friction of bodies and gravity are scaled by the setting.
class Rig {
 public:
  explicit Rig(const CheckSetting& setting, const WorldDesc& desc = {});

  [[nodiscard]] World& world() { return world_; }
  [[nodiscard]] const World& world() const { return world_; }

  RopeId add(const RopeDesc& desc) { return must(world_.add_rope(desc)); }
  ClothId add(const ClothDesc& desc) { return must(world_.add_cloth(desc)); }
  ParticlesId add(const ParticlesDesc& desc) { return must(world_.add_particles(desc)); }
  BodyId add(BodyDesc desc);

  /// One frame. False once a particle was not finite.
  bool step();
  /// Whole frames until `seconds` have passed; `after_each` sees the world after each of them.
  bool run(double seconds, const std::function<void()>& after_each = {});

  [[nodiscard]] double time() const { return world_.time(); }
  [[nodiscard]] bool healthy() const { return healthy_; }

 private:
  World world_;
  double dt_;
  double friction_scale_;
  bool healthy_ = true;
};

/// No gravity.
WorldDesc weightless();

/// A curve sampled once a frame.
class Curve {
 public:
  void add(double time, double value) { samples_.push_back({time, value}); }

  /// Times where the value passes zero, by the cubic through the two samples on each side.
  [[nodiscard]] std::vector<double> zero_crossings() const;
  /// Local maxima of |value|, by the parabola through three samples.
  [[nodiscard]] std::vector<double> peaks() const;
  [[nodiscard]] double last() const { return samples_.empty() ? 0.0 : samples_.back().value; }
  /// Mean period of an oscillation about zero: first to last crossing. NaN with fewer than three.
  [[nodiscard]] double period() const;

 private:
  struct Sample {
    double time = 0;
    double value = 0;
  };
  [[nodiscard]] double cubic(std::size_t left, double time) const;

  std::vector<Sample> samples_;
};

/// Runs frames and samples `value` at the start and after each.
Curve record(Rig& rig, double seconds, const std::function<double()>& value);

/// The threshold between `holds` (where `stands` is true) and `fails`, after `halvings` bisections.
double bisect(double holds, double fails, int halvings, const std::function<bool(double)>& stands);

}  // namespace hooke::check
