#pragma once

#include "hooke/run_watch.h"
#include "hooke/scene_io.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hooke::app {

/// A RunRecord is what a run of a simulation gives besides its last state.
struct RunRecord {
  std::string scene;                 ///< Name as the user gave it.
  std::vector<double> step_ms = {};  ///< Wall time of each step.
  Energy start = {};
  StepReport last = {};                 ///< Report of the last step.
  StepReport worst = {};                ///< Largest number of each kind that any step refused or left undone.
  std::vector<std::string> notes = {};  ///< One line each, on what was made of the file's models.
  std::vector<std::string> warnings = {};  ///< One line each, of the file and of the run.
  std::vector<RunWarning> problems = {};   ///< Problems of the run.
};

struct StepTimes {
  double min = 0;
  double median = 0;
  double p99 = 0;
};

/// Returns zeros without steps.
StepTimes step_times(const std::vector<double>& step_ms);

/// Returns 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

/// Raises the counts in `worst` to those that `step` refused or left undone.
void note_refused(const StepReport& step, StepReport& worst);

/// Tells whether no expectation that was due failed, and no event.
bool passed(const Simulation& simulation);

/// Returns the hooks that broke, the ropes that snapped and what tore or was cut, in the order of time.
std::vector<const SceneObject*> broken_objects(const Simulation& simulation);

/// Returns one JSON object, with a line break at its end.
std::string run_json(const Simulation& simulation, const RunRecord& record);

/// Returns a few lines for people.
std::string run_summary(const Simulation& simulation, const RunRecord& record);

/// Returns the names of the columns of csv_line.
std::string csv_header();

/// Returns the present state as one line.
std::string csv_line(const World& world, std::uint32_t contacts);

}  // namespace hooke::app
