#pragma once

#include "hooke/command_line.h"
#include "hooke/scene_io.h"

#include <string>

namespace hooke::app {

/// What `hooke run --stepper` was told.
struct LaboratoryRun {
  std::string scene;    ///< As the user named it.
  std::string stepper;  ///< A name of lab::steppers(), "auto", or kDeclaredName for the scene's accuracy.
  double seconds = 0;   ///< [s]
  bool force = false;
  std::string csv;   ///< Written if not empty: one line per step.
  std::string json;  ///< Written instead of the summary if not empty.
};

/// Runs a scene in the laboratory instead of the solver, and reports what was chosen and reached. The
/// timeline is left out. Expectations hold for the method that the scene's `laboratory` declares, but for
/// figures that only the solver has (contacts, forces of hooks, sleep); any other method's run is an
/// experiment.
ExitCode run_laboratory(Scene scene, const LaboratoryRun& options);

}  // namespace hooke::app
