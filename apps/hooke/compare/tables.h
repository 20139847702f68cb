#pragma once

#include "hooke/compare/outline.h"
#include "hooke/compare/stability.h"
#include "hooke/compare/trial.h"

#include <string>
#include <vector>

namespace hooke::app {

/// This is a stepper that was asked for and does not run.
struct Skipped {
  std::string name;
  std::string reason;
};

/// A Comparison is everything that the command found.
struct Comparison {
  std::string scene;  ///< Name as the user gave it.
  std::string title;
  std::string description;
  std::string point;                     ///< Such as "rope:15".
  double seconds = 0;                    ///< [s]
  double dt = 0;                         ///< [s]
  std::optional<double> max_error = {};  ///< Error that the scene declares [m].
  Reference reference;
  std::optional<ExactMotion> rigid;  ///< Drawn for comparison; see rigid_pendulum.
  std::vector<Trial> trials;
  std::vector<Skipped> skipped = {};
  Schedule schedule = {};
  Stability stability = {};
  Outline outline = {};
};

/// A Table holds words; the first row names the columns.
using Table = std::vector<std::vector<std::string>>;

/// Has one row for each stepper: orders, errors, energy, cost, limits, each beside theory.
Table summary_table(const Comparison& comparison);
/// Has the same figures in plain numbers.
std::string summary_csv(const Comparison& comparison);
/// Returns aligned columns, the first to the left.
std::string text_of_table(const Table& table);

/// Has one line for each sample.
std::string series_csv(const std::vector<Sample>& samples);
/// Has one line for each stepper and step: error and cost.
std::string order_csv(const Comparison& comparison);

/// Returns evaluations of the forces per simulated second at a step of `dt`.
double evaluations_at(const Trial& trial, double comparison_dt, double dt);

/// Returns the measured order: the slope between the two smallest steps whose errors are more than rounding.
/// Returns nothing if the errors do not fall there, or if the run diverged.
std::optional<double> order_of(const Trial& trial, const Comparison& comparison);

/// Returns one sentence on whether it diverged, when and why, and how far it was off.
std::string verdict_of(const Trial& trial, const Comparison& comparison);

}  // namespace hooke::app
