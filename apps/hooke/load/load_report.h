#pragma once

#include "hooke/load/raise.h"

#include <optional>
#include <string>

namespace hooke::app {

/// What the report says beside what was found.
struct LoadTitle {
  std::string scene = {};              ///< Name of the file.
  std::string on = {};                 ///< What is loaded, as the user gave it.
  DVec3 direction = {};                ///< Direction of the load, of length 1.
  std::optional<double> nominal = {};  ///< Load that the structure is made for [N].
  double most = 0;                     ///< Load at which the search would have ended [N].
  double tolerance = 0;                ///< Relative width of an interval in which something breaks.
};

/// Returns the reserve factor: the least of the loads of collapse, of first yield and of first buckling over
/// the nominal load; where there was no collapse the largest load that held; nothing without a nominal load.
[[nodiscard]] std::optional<double> reserve_of(const Raised& raised, const LoadTitle& title);

/// Returns lines for people.
[[nodiscard]] std::string load_summary(const Raised& raised, const LoadTitle& title);
/// Returns a table with a line for each equilibrium and a column for each member's force.
[[nodiscard]] std::string load_csv(const Raised& raised);
/// Returns one JSON object, with a line break at its end.
[[nodiscard]] std::string load_json(const Raised& raised, const LoadTitle& title);
/// Draws forces of the members that are used most over the load, as SVG or, if `path` ends in .png, as PNG.
/// Errors: gnuplot is missing or refuses.
[[nodiscard]] Result<std::string> load_plot(const Raised& raised, const LoadTitle& title,
                                            const std::string& path);

}  // namespace hooke::app
