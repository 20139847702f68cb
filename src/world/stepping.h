#pragma once

#include "hooke/limits.h"

#include "world/world_data.h"

namespace hooke::world {

/// Whether a step may have this length [s].
[[nodiscard]] inline bool is_step(Real dt) {
  return dt >= static_cast<Real>(limits::kShortestStep) && dt <= static_cast<Real>(limits::kLongestStep);
}

/// Notes the state to which a step that throws goes back, as that is now.
void note_start(WorldData& world);

/// A step that runs. If an exception of a force law or a lack of memory ends it, the destructor takes it
/// back: positions, velocities, pending forces and sleep are as before the step. What contacts, ropes and
/// hooks remember of earlier steps is lost, or is that of the broken step.
class Stepping {
 public:
  /// May throw if there is no memory; the world is then unchanged.
  explicit Stepping(WorldData& world);
  ~Stepping();
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

  /// Confirms that the step was completed, so that it is not taken back.
  void end();

 private:
  WorldData& world_;
  bool ended_ = false;
};

}  // namespace hooke::world
