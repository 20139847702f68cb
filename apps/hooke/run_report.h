#pragma once

#include "hooke/run_watch.h"
#include "hooke/scene_io.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hooke::app {

/// What a run of a simulation leaves behind, apart from its last state.
struct RunRecord {
  std::string scene;                 ///< As the user named it.
  std::vector<double> step_ms = {};  ///< Wall time of each step.
  Energy start = {};
  StepReport last = {};                    ///< Of the last step.
  StepReport worst = {};                   ///< The most of everything refused or left undone in any step.
  std::vector<std::string> warnings = {};  ///< One line each, of the file and of the run.
  std::vector<RunWarning> problems = {};   ///< Of the run.
};

struct StepTimes {
  double min = 0;
  double median = 0;
  double p99 = 0;
};

/// Zeros without steps.
StepTimes step_times(const std::vector<double>& step_ms);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

/// Raises `worst` to what `step` refused or left undone.
void note_refused(const StepReport& step, StepReport& worst);

/// No expectation that was due failed, and no event.
bool passed(const Simulation& simulation);

/// One JSON object, with a line break at its end.
std::string run_json(const Simulation& simulation, const RunRecord& record);

/// A few lines to read.
std::string run_summary(const Simulation& simulation, const RunRecord& record);

/// The names of the columns of step_csv.
std::string csv_header();

/// The present state as one line.
std::string csv_line(const World& world, std::uint32_t contacts);

}  // namespace hooke::app
