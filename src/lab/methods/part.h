#pragma once

#include "lab/methods/method.h"
#include "lab/methods/particle_push_out.h"
#include "lab/system/system.h"

#include <optional>

namespace hooke::lab {

/// A Part is one object of a run, with its system, its method and its state.
struct Part {
  System system;
  Bodies bodies = {};
  const Method* method = nullptr;
  double start_time = 0;  ///< [s]
  double h = 0;           ///< Step of the method [s].
  int steps_per_output = 1;
  std::uint64_t outputs = 0;
  State y = {};
  Workspace work = {};
  std::uint64_t steps = 0;
  std::optional<double> error_estimate = {};

  [[nodiscard]] double time() const {
    return start_time + static_cast<double>(outputs) * (steps_per_output * h);
  }
};

/// Makes one output step. After an Error (see Run::advance) state and time are those before.
Result<void> advance(Part& part);

/// Moves `y`, which is the state of the part at `t`, by `seconds` of either sign, in steps no longer than
/// part.h. If the steps have another length, the history of the method is reset first. Errors: those of the
/// method, or a state that is not finite.
Result<void> take_steps(Part& part, double t, double seconds, State& y);

/// Checks that the method suits the system and the step. Errors: see Run::create.
Result<void> check(const Part& part, const Options& options);

/// Returns the method that `auto` stands for; see Options::stepper.
[[nodiscard]] const Method* automatic_method(const System& system, double start_time, double h);

/// Sets the method and the steps of `part` so that the declared accuracy is kept, or returns an Error if it
/// cannot be.
Result<void> reach(const Accuracy& accuracy, const Options& options, Part& part);

}  // namespace hooke::lab
