#pragma once

#include "hooke/result.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// \file
/// `hooke check`: scenes whose answer is known, and how near the engine comes to it.
///
/// A case builds its worlds through the public API only and returns one row for each figure it measures. The
/// sources know no precision: the same cases are built against the engine in float and in double. Nor do they
/// know what moves a world: its own solver, or a method of the laboratory (hooke/lab.h).

namespace hooke::check {

/// How the worlds of a case are stepped, and what a test may spoil in them to see a case fail.
struct CheckSetting {
  double dt = 1.0 / 60.0;       ///< [s]
  int substeps = 8;             ///< WorldDesc::substeps.
  double gravity_scale = 1.0;   ///< Times the gravity of every world; 1 is right.
  double friction_scale = 1.0;  ///< Times the friction of every contact; 1 is right.
  std::string stepper = {};     ///< A name of lab::steppers(); empty for the World's own solver.
  std::uint32_t turned = 0;     ///< Not 0: the solver's worlds lie as random_placement of this seed says.

  [[nodiscard]] bool laboratory() const { return !stepper.empty(); }
};

/// One figure beside its known answer.
struct CheckRow {
  enum class Measure {
    kRelative,  ///< Error is |achieved / expected - 1|.
    kAbsolute,  ///< Error is |achieved - expected|, in `unit`.
  };

  std::string title = {};
  std::string unit = {};  ///< Of `expected` and `achieved`; empty for a pure number.
  double expected = 0;
  double achieved = 0;
  double tolerance = 0;  ///< Largest error that passes.
  double goal = 0;       ///< The same for the laboratory; 0 stands for `tolerance`.
  Measure measure = Measure::kRelative;
  std::string solver = {};                ///< Which part of the engine, or which stepper, did it.
  double dt = 0;                          ///< [s]; 0 stands for the setting's.
  int substeps = 0;                       ///< 0 stands for the setting's.
  std::optional<ErrorCode> failure = {};  ///< Why there is nothing achieved.
  /// Why the engine does not get there yet; empty for a row that has to pass. Such a row is shown and counted
  /// as a miss, and is no failure.
  std::string known_miss = {};

  [[nodiscard]] double error() const;
  /// False also for an error that is not a number.
  [[nodiscard]] bool pass() const { return error() <= tolerance; }
  [[nodiscard]] bool missed_as_known() const { return !pass() && !known_miss.empty(); }
};

struct CheckCase {
  std::string id;
  std::string title;
  std::function<std::vector<CheckRow>(const CheckSetting&)> run;
  double laboratory_dt = 0;  ///< Step of the laboratory's methods [s]; 0: not a case for them.
  /// The same for methods without a limit of stability, where stability asks for smaller steps than the
  /// answer does; 0 stands for laboratory_dt.
  double implicit_dt = 0;
  const char* not_turned = nullptr;  ///< Why the answer holds only as the case lies; null where it does not.
};

/// All cases, in the order of the report.
const std::vector<CheckCase>& check_cases();

/// Runs one case; in the laboratory with its own step. The rows come back complete: dt, substeps and in the
/// laboratory tolerance and solver are filled in. A case that cannot build its world, or whose motion
/// diverges, gives one failed row that says why.
std::vector<CheckRow> run_case(const CheckCase& check, const CheckSetting& setting);

/// "float" or "double": the engine these cases are linked to.
const char* precision_name();

struct CheckOptions {
  std::vector<std::string> cases = {};  ///< Ids, in any case of letters; none for all.
  std::string json_file = {};           ///< Also write the rows here; "-" for standard output.
  std::string markdown_file = {};       ///< Also write a table here; "-" for standard output.
  bool list = false;                    ///< Only print ids and titles.
  int substeps = 8;
  /// Also run the cases that have a laboratory_dt by this method; kAllSteppers: by all there are, and print
  /// which reaches which goal.
  std::string stepper = {};
  std::uint32_t turned = 0;   ///< CheckSetting::turned.
  bool ground_truth = false;  ///< Instead: print, or write to markdown_file, the table of ground_truth.h.
};

inline constexpr const char* kAllSteppers = "all";

/// The command: prints one line per row as it comes. Returns 0 if every row passed or is a known miss, 1 if
/// one failed, 2 for an unknown case or stepper or a file that cannot be written. With all steppers those
/// that miss a goal are what was asked for, and no failure.
int check_command(const CheckOptions& options);

}  // namespace hooke::check
