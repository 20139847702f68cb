#pragma once

#include "hooke/hooke.h"
#include "hooke/lab.h"

#include "validation/check.h"
#include "validation/placed_world.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What the cases share: a world with a clock, and reading times off a sampled curve.

namespace hooke::check {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]
inline constexpr double kTau = 6.283185307179586;

/// An Error on its way to run_case.
struct Failure : std::runtime_error {
  explicit Failure(const Error& error)
      : runtime_error(error.where + ": " + error.message), code(error.code) {}
  ErrorCode code;
};

/// The value, or an exception that run_case turns into a failed row.
template <class T>
T must(Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(result).value();
}
inline void must(const Result<void>& result) {
  if (!result) throw Failure(result.error());
}

constexpr Real real(double value) {
  return static_cast<Real>(value);
}

constexpr Vec3 real(DVec3 value) {
  return vector_cast<Real>(value);
}

/// Of what does not stretch: kRigid for the solver. The laboratory, which has forces only, takes `finite`
/// [N/m], or [N] of an axial stiffness.
inline Real stiff(const CheckSetting& setting, double finite) {
  return setting.laboratory() ? real(finite) : kRigid;
}

/// Half the step: twice the substeps of the solver, half the dt of the laboratory.
CheckSetting finer(CheckSetting setting);

/// A world moved as the setting says: by its own steps, or by a method of the laboratory, which takes over
/// the world as it stands at the first step and is never turned. Gravity is scaled by the setting, and
/// friction with bodies that forces do not move.
class Rig {
 public:
  explicit Rig(const CheckSetting& setting, const WorldDesc& desc = {});

  [[nodiscard]] PlacedWorld& world() { return world_; }
  [[nodiscard]] const PlacedWorld& world() const { return world_; }

  RopeId add(const RopeDesc& desc) { return must(world_.add_rope(desc)); }
  ClothId add(const ClothDesc& desc) { return must(world_.add_cloth(desc)); }
  SolidId add(const SolidDesc& desc) { return must(world_.add_solid(desc)); }
  ParticlesId add(const ParticlesDesc& desc) { return must(world_.add_particles(desc)); }
  BodyId add(BodyDesc desc);

  /// One frame. False once a particle was not finite. Throws when the laboratory's method diverges.
  bool step();
  /// Whole frames until `seconds` have passed; `after_each` sees the world after each of them.
  bool run(double seconds, const std::function<void()>& after_each = {});

  /// Of a rope, a cloth or particles, in the order their maker gave them.
  template <class IdType>
  [[nodiscard]] std::vector<DVec3> positions(IdType id) const {
    return run_ ? run_->positions(id) : world_.positions(id);
  }
  [[nodiscard]] std::vector<DVec3> positions(SolidId id) const { return world_.positions(id); }
  template <class IdType>
  [[nodiscard]] std::vector<DVec3> velocities(IdType id) const {
    return run_ ? run_->velocities(id) : world_.velocities(id);
  }
  [[nodiscard]] DVec3 center(BodyId id) const;
  [[nodiscard]] DVec3 velocity(BodyId id) const;
  [[nodiscard]] DVec3 spin(BodyId id) const;
  /// A direction of the body's frame, in the world.
  [[nodiscard]] DVec3 direction(BodyId id, DVec3 own) const;
  /// `spin` in the body's frame.
  [[nodiscard]] DVec3 own_spin(BodyId id) const;
  [[nodiscard]] Energy energy() const { return run_ ? run_->energy() : world_.measure().energy; }
  /// Equal numbers mean the same bits of every position and velocity.
  [[nodiscard]] std::uint64_t state_hash() const;

  [[nodiscard]] double time() const { return run_ ? run_->time() : world_.in_its_frame().time(); }
  [[nodiscard]] bool healthy() const { return healthy_; }

 private:
  PlacedWorld world_;
  std::optional<lab::Run> run_;  ///< From the first step on, if the setting names a stepper.
  CheckSetting setting_;
  bool healthy_ = true;
};

/// No gravity.
WorldDesc weightless();

/// Bodies that have come to rest are watched on.
WorldDesc sleepless();
WorldDesc without_air();  ///< And sleepless.

/// A body that forces move; 1000 kg/m^3.
BodyDesc moving(const Shape& shape, DVec3 position);
/// The half-space below y = 0.
BodyDesc level_ground(double friction, double restitution = 0);
Shape box_of(DVec3 half_extents);

/// A row of the real-time solver, which is asked for 0.5 % where a case asks for less.
CheckRow relative_row(std::string title, std::string unit, double expected, double achieved,
                      double tolerance = 0.005);
/// One whose tolerance is in `unit`.
CheckRow absolute_row(std::string title, std::string unit, double expected, double achieved,
                      double tolerance);
CheckRow known_miss(CheckRow row, std::string reason);
/// The same where the worlds of the setting are turned; the row as it is where they are not.
CheckRow known_miss_turned(const CheckSetting& setting, CheckRow row, std::string reason);

/// A curve sampled once a frame.
class Curve {
 public:
  void add(double time, double value) { samples_.push_back({time, value}); }

  /// Times where the value passes zero, by the cubic through the two samples on each side.
  [[nodiscard]] std::vector<double> zero_crossings() const;
  /// The value at a time between the samples, by the cubic through the two on each side.
  [[nodiscard]] double at(double time) const;
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
