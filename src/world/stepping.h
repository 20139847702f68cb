#pragma once

#include "hooke/limits.h"

#include "world/world_data.h"

namespace hooke::world {

/// Whether it is a length that a step may have [s].
[[nodiscard]] inline bool is_step(Real dt) {
  return dt >= static_cast<Real>(limits::kShortestStep) && dt <= static_cast<Real>(limits::kLongestStep);
}

/// A step that runs. One that ends by an exception, of a force law or for want of memory, is taken back:
/// places, velocities, pending forces and who sleeps are as before it. What contacts, ropes and hooks
/// remember of steps before, to begin the next one with, is lost or of the step that broke off.
class Stepping {
 public:
  /// May itself throw for want of memory; the world is then untouched.
  explicit Stepping(WorldData& world);
  ~Stepping();
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

  /// The step was made.
  void end();

 private:
  WorldData& world_;
  bool ended_ = false;
};

}  // namespace hooke::world
