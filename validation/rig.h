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
/// Holds what the cases share: a world with a clock, and reading times off a sampled curve.

namespace hooke::check {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]
inline constexpr double kTau = 6.283185307179586;

/// A Failure is an Error that run_case catches.
struct Failure : std::runtime_error {
  explicit Failure(const Error& error)
      : runtime_error(error.where + ": " + error.message), code(error.code) {}
  ErrorCode code;
};

/// Returns the value, or throws an exception that run_case turns into a failed row.
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

/// Returns the stiffness of what does not stretch: kRigid for the solver. The laboratory, which has forces
/// only, takes `finite` [N/m], or [N] for an axial stiffness.
inline Real stiff(const CheckSetting& setting, double finite) {
  return setting.laboratory() ? real(finite) : kRigid;
}

/// Halves the step: twice the substeps of the solver, half the dt of the laboratory.
CheckSetting finer(CheckSetting setting);

/// A Rig is a world that moves as the setting says: by its own steps, or by a method of the laboratory. The
/// latter takes over the world as it is at the first step, and is never turned. Gravity is scaled by the
/// setting, and so is friction with bodies that forces do not move.
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

  /// Steps one frame; returns false once a particle was not finite. Throws when the laboratory's method
  /// diverges.
  bool step();
  /// Steps whole frames until `seconds` have passed; `after_each` is called after each of them.
  bool run(double seconds, const std::function<void()>& after_each = {});

  /// Returns positions of a rope, a cloth or particles, in the order of creation.
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
  /// Returns a direction of the body's frame in the world.
  [[nodiscard]] DVec3 direction(BodyId id, DVec3 own) const;
  /// Returns the spin in the body's frame.
  [[nodiscard]] DVec3 own_spin(BodyId id) const;
  [[nodiscard]] Energy energy() const { return run_ ? run_->energy() : world_.measure().energy; }
  /// Returns a hash; equal hashes mean the same bits of every position and velocity.
  [[nodiscard]] std::uint64_t state_hash() const;

  [[nodiscard]] double time() const { return run_ ? run_->time() : world_.in_its_frame().time(); }
  [[nodiscard]] bool healthy() const { return healthy_; }

 private:
  PlacedWorld world_;
  std::optional<lab::Run> run_;  ///< Set from the first step on, if the setting names a stepper.
  CheckSetting setting_;
  bool healthy_ = true;
};

/// Describes a world without gravity.
WorldDesc weightless();

/// Describes a world in which bodies at rest do not fall asleep.
WorldDesc sleepless();
WorldDesc without_air();  ///< Without sleep, too.

/// Describes a dynamic body of 1000 kg/m^3.
BodyDesc moving(const Shape& shape, DVec3 position);
/// Describes the half-space below y = 0.
BodyDesc level_ground(double friction, double restitution = 0);
Shape box_of(DVec3 half_extents);

/// Makes a row of the real-time solver. Its goal is 0.5 % where a case does not ask for more accuracy.
CheckRow relative_row(std::string title, std::string unit, double expected, double achieved,
                      double tolerance = 0.005);
/// Makes a row whose tolerance is in `unit`.
CheckRow absolute_row(std::string title, std::string unit, double expected, double achieved,
                      double tolerance);
CheckRow known_miss(CheckRow row, std::string reason);
/// Makes the row a known miss if the worlds of the setting are turned; otherwise returns the row unchanged.
CheckRow known_miss_turned(const CheckSetting& setting, CheckRow row, std::string reason);

/// A Curve is a value sampled once a frame.
class Curve {
 public:
  void add(double time, double value) { samples_.push_back({time, value}); }

  /// Returns the times where the value passes zero, by the cubic through the two samples on each side.
  [[nodiscard]] std::vector<double> zero_crossings() const;
  /// Returns the value at a time between the samples, by the cubic through the two on each side.
  [[nodiscard]] double at(double time) const;
  /// Returns the local maxima of |value|, by the parabola through three samples.
  [[nodiscard]] std::vector<double> peaks() const;
  [[nodiscard]] double last() const { return samples_.empty() ? 0.0 : samples_.back().value; }
  /// Returns the mean period of an oscillation about zero, from first to last crossing; NaN with fewer than
  /// three.
  [[nodiscard]] double period() const;

 private:
  struct Sample {
    double time = 0;
    double value = 0;
  };
  [[nodiscard]] double cubic(std::size_t left, double time) const;

  std::vector<Sample> samples_;
};

/// Steps frames and samples `value` at the start and after each.
Curve record(Rig& rig, double seconds, const std::function<double()>& value);

/// Returns the threshold between `holds` (where `stands` is true) and `fails`, after `halvings` bisections.
double bisect(double holds, double fails, int halvings, const std::function<bool(double)>& stands);

}  // namespace hooke::check
