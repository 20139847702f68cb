#pragma once

#include "lab/system/system.h"

#include <memory>
#include <optional>
#include <vector>

/// \file
/// What every method of integration has: one signature, so that they can be read side by side.

namespace hooke::lab {

class ImplicitMatrix;

/// What a method keeps from step to step.
struct Workspace {
  double tolerance = 1e-8;                 ///< For adaptive methods.
  std::vector<State> history;              ///< Multistep methods: earlier slopes or states, the newest first.
  std::optional<State> carried;            ///< Verlet: the acceleration at the end of the last step.
  std::shared_ptr<ImplicitMatrix> matrix;  ///< Implicit methods: of an earlier step.
  std::shared_ptr<void> integrator;        ///< SUNDIALS' own memory.
  std::uint64_t inner_steps = 0;           ///< Of adaptive methods.
  std::optional<Error> error;              ///< Set by a step that could not be made.

  /// After y was changed from outside: what was kept describes another motion.
  void reset() {
    history.clear();
    carried.reset();
    matrix.reset();
    integrator.reset();
  }
};

/// Moves y from t to t + h.
using Step = void (*)(const System& f, double t, double h, State& y, Workspace& work);

/// The oscillation x'' = -omega^2 x - damping x', as one step of a method sees it.
struct Oscillator {
  double stiffness = 0;  ///< omega^2 h^2
  double damping = 0;    ///< damping h
};

/// Factor by which a step multiplies the oscillation: the spectral radius.
using Growth = double (*)(Oscillator oscillator);

struct Method {
  StepperInfo info;
  Step step = nullptr;      ///< Null: not built in.
  Growth growth = nullptr;  ///< Null for adaptive methods: they stay stable by small steps.
};

/// The table of all methods.
[[nodiscard]] const std::vector<Method>& methods();
/// Null for an unknown name.
[[nodiscard]] const Method* find_method(std::string_view name);
[[nodiscard]] Error unknown_method(std::string_view name);

}  // namespace hooke::lab
