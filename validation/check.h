#pragma once

#include "hooke/result.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Runs `hooke check`: scenes with a known answer, and how near the engine comes to it.
///
/// A case builds its worlds through the public API only and returns one row for each figure it measures.
/// Cases do not depend on precision: the same sources are built against the engine in float and in double.
/// Nor do they depend on what moves a world: its own solver, or a method of the laboratory (hooke/lab.h).

namespace hooke::check {

/// This says how the worlds of a case are stepped, and what a test may change in them to see a case fail.
struct CheckSetting {
  double dt = 1.0 / 60.0;       ///< [s]
  int substeps = 8;             ///< WorldDesc::substeps.
  double gravity_scale = 1.0;   ///< Factor of the gravity of every world; 1 is right.
  double friction_scale = 1.0;  ///< Factor of the friction of every contact; 1 is right.
  std::string stepper = {};     ///< A name of lab::steppers(); empty for the World's own solver.
  /// Seed of random_placement, by which the solver's worlds are placed; 0 for none.
  std::uint32_t turned = 0;

  [[nodiscard]] bool laboratory() const { return !stepper.empty(); }
};

/// A CheckRow is one figure beside its known answer.
struct CheckRow {
  enum class Measure {
    kRelative,  ///< The error is |achieved / expected - 1|.
    kAbsolute,  ///< The error is |achieved - expected|, in `unit`.
  };

  std::string title = {};
  std::string unit = {};  ///< Unit of `expected` and `achieved`; empty for a pure number.
  double expected = 0;
  double achieved = 0;
  double tolerance = 0;  ///< Largest error that passes.
  double goal = 0;       ///< Largest error that passes in the laboratory; 0 stands for `tolerance`.
  Measure measure = Measure::kRelative;
  std::string solver = {};                ///< Part of the engine, or stepper, that was tested.
  double dt = 0;                          ///< Step [s]; 0 stands for the setting's.
  int substeps = 0;                       ///< 0 stands for the setting's.
  std::optional<ErrorCode> failure = {};  ///< Why there is no achieved value.
  /// Reason why the engine does not pass yet; empty for a row that has to pass. Such a row is shown and
  /// counted as a miss, and is no failure.
  std::string known_miss = {};

  [[nodiscard]] double error() const;
  /// Returns false also for an error that is not a number.
  [[nodiscard]] bool pass() const { return error() <= tolerance; }
  [[nodiscard]] bool missed_as_known() const { return !pass() && !known_miss.empty(); }
};

struct CheckCase {
  std::string id;
  std::string title;
  std::function<std::vector<CheckRow>(const CheckSetting&)> run;
  double laboratory_dt = 0;  ///< Step of the laboratory's methods [s]; 0: the case does not suit them.
  /// Step for methods without a limit of stability, in cases where stability asks for smaller steps than the
  /// answer does; 0 stands for laboratory_dt.
  double implicit_dt = 0;
  /// Why the answer depends on the placement of the case; null if it does not.
  const char* not_turned = nullptr;
};

/// Returns all cases, in the order of the report.
const std::vector<CheckCase>& check_cases();

/// Runs one case; in the laboratory with its own step. The rows come back complete: dt, substeps and in the
/// laboratory tolerance and solver are filled in. A case that cannot build its world, or whose motion
/// diverges, gives one failed row with the reason.
std::vector<CheckRow> run_case(const CheckCase& check, const CheckSetting& setting);

/// Returns "float" or "double", the precision of the engine that these cases are linked to.
const char* precision_name();

struct CheckOptions {
  std::vector<std::string> cases = {};  ///< Ids, without regard to case; none stands for all.
  std::string json_file = {};           ///< File that also gets the rows; "-" for standard output.
  std::string markdown_file = {};       ///< File that also gets a table; "-" for standard output.
  bool list = false;                    ///< Whether only ids and titles are printed.
  int substeps = 8;
  /// Method by which the cases that have a laboratory_dt run, too. kAllSteppers stands for all methods, and
  /// prints which reaches which goal.
  std::string stepper = {};
  std::uint32_t turned = 0;  ///< CheckSetting::turned.
  /// Whether instead the table of ground_truth.h is printed, or written to markdown_file.
  bool ground_truth = false;
};

inline constexpr const char* kAllSteppers = "all";

/// Runs the command and prints each row as it comes. Returns 0 if every row passed or is a known miss, 1 if
/// one failed, 2 for an unknown case or stepper or a file that cannot be written. With all steppers, those
/// that miss a goal are no failure, because the table is what was asked for.
int check_command(const CheckOptions& options);

}  // namespace hooke::check
