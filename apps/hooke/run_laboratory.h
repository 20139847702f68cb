#pragma once

#include "hooke/command_line.h"
#include "hooke/scene_io.h"

#include <string>

namespace hooke::app {

/// These are the options of `hooke run --stepper`.
struct LaboratoryRun {
  std::string scene;    ///< Name as the user gave it.
  std::string stepper;  ///< A name of lab::steppers(), "auto", or kDeclaredName for the scene's accuracy.
  double seconds = 0;   ///< [s]
  bool force = false;
  /// File with one line per step; empty for none.
  std::string csv;
  /// File that gets a report instead of the summary; empty for none.
  std::string json;
};

/// Runs a scene in the laboratory instead of the solver, and reports what was chosen and reached. The
/// timeline is left out. Expectations hold for the method that the scene's `laboratory` declares, except
/// figures that only the solver has (contacts, forces of hooks, sleep). A run by any other method is an
/// experiment.
ExitCode run_laboratory(Scene scene, const LaboratoryRun& options);

}  // namespace hooke::app
