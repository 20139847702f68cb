#pragma once

#include "hooke/compare/trial.h"

#include <string>
#include <vector>

namespace hooke::app {

/// A stepper that was asked for and does not run.
struct Skipped {
  std::string name;
  std::string reason;
};

/// Everything a comparison found.
struct Comparison {
  std::string scene;  ///< As the user named it.
  std::string title;
  std::string description;
  std::string point;                     ///< "rope:15"
  double seconds = 0;                    ///< [s]
  double dt = 0;                         ///< [s]
  std::optional<double> max_error = {};  ///< Declared by the scene [m].
  Reference reference;
  std::optional<ExactMotion> rigid;  ///< Drawn beside, see rigid_pendulum.
  std::vector<Trial> trials;
  std::vector<Skipped> skipped = {};
};

/// A table of words: the first row names the columns.
using Table = std::vector<std::vector<std::string>>;

/// One row for each stepper: orders, errors, energy, cost, limits, each beside theory.
Table summary_table(const Comparison& comparison);
/// The same in plain numbers.
std::string summary_csv(const Comparison& comparison);
/// Columns lined up, the first to the left.
std::string text_of_table(const Table& table);

/// One line for each sample.
std::string series_csv(const std::vector<Sample>& samples);
/// One line for each stepper and step: error and cost.
std::string order_csv(const Comparison& comparison);

/// Evaluations of the forces per simulated second at a step of `dt`.
double evaluations_at(const Trial& trial, double comparison_dt, double dt);

/// The measured order: slope between the two smallest steps whose errors are more than rounding. Nothing if
/// the errors do not fall there, or if the run diverged.
std::optional<double> order_of(const Trial& trial, const Comparison& comparison);

/// One sentence: did it diverge, and how far it was off.
std::string verdict_of(const Trial& trial, const Comparison& comparison);

}  // namespace hooke::app
