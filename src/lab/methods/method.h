#pragma once

#include "lab/system/system.h"

#include <memory>
#include <optional>
#include <vector>

/// \file
/// All methods of integration have one signature, so that they can be read side by side.

namespace hooke::lab {

class ImplicitMatrix;

/// A Workspace is what a method keeps from step to step.
struct Workspace {
  double tolerance = 1e-8;       ///< Relative tolerance of adaptive methods.
  std::vector<State> history;    ///< For multistep methods: earlier slopes or states, the newest first.
  std::optional<State> carried;  ///< For Verlet: the acceleration at the end of the last step.
  std::shared_ptr<ImplicitMatrix> matrix;  ///< For implicit methods: the matrix of an earlier step.
  std::shared_ptr<void> integrator;        ///< Memory of SUNDIALS.
  std::uint64_t inner_steps = 0;           ///< Steps that an adaptive method has made on its own.
  std::optional<Error> error;              ///< Set by a step that could not be made.

  /// Call this after y was changed from outside, because the history then describes another motion.
  void reset() {
    history.clear();
    carried.reset();
    matrix.reset();
    integrator.reset();
  }
};

/// A Step moves y from t to t + h.
using Step = void (*)(const System& f, double t, double h, State& y, Workspace& work);

/// This is the oscillation x'' = -omega^2 x - damping x', as one step of a method sees it.
struct Oscillator {
  double stiffness = 0;  ///< omega^2 h^2
  double damping = 0;    ///< damping h
};

/// A Growth is the factor by which a step multiplies the oscillation: the spectral radius.
using Growth = double (*)(Oscillator oscillator);

struct Method {
  StepperInfo info;
  Step step = nullptr;      ///< Null if the method was not built in.
  Growth growth = nullptr;  ///< Null for adaptive methods, which stay stable by small steps.
};

/// Returns the table of all methods.
[[nodiscard]] const std::vector<Method>& methods();
/// Returns null for an unknown name.
[[nodiscard]] const Method* find_method(std::string_view name);
[[nodiscard]] Error unknown_method(std::string_view name);

}  // namespace hooke::lab
