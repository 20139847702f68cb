#pragma once

#include "lab/methods/method.h"
#include "lab/methods/particle_push_out.h"
#include "lab/system/system.h"

#include <optional>

namespace hooke::lab {

/// One object on its way: its system, its method, its state.
struct Part {
  System system;
  Bodies bodies = {};
  const Method* method = nullptr;
  double start_time = 0;  ///< [s]
  double h = 0;           ///< Of the method [s].
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

/// One output step. Errors: see Run::advance; state and time are then those before.
Result<void> advance(Part& part);

/// Moves `y`, which is the part's at `t`, by `seconds` of either sign, in as many steps as `h` asks for; what
/// the method keeps from step to step goes where they are shorter. Errors: the method's; not finite.
Result<void> take_steps(Part& part, double t, double seconds, State& y);

/// Does the method suit the system and the step? Errors: see Run::create.
Result<void> check(const Part& part, const Options& options);

/// What `auto` takes, see Options::stepper.
[[nodiscard]] const Method* automatic_method(const System& system, double start_time, double h);

/// Sets method and steps of `part` so that the declared accuracy is kept. Errors: it cannot be.
Result<void> reach(const Accuracy& accuracy, const Options& options, Part& part);

}  // namespace hooke::lab
