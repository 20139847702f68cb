#include "hooke/math.h"

#include "cases.h"
#include "check.h"

#include <cmath>
#include <exception>
#include <limits>

namespace hooke::check {

double CheckRow::error() const {
  const double difference = std::abs(achieved - expected);
  return measure == Measure::kAbsolute ? difference : difference / std::abs(expected);
}

const std::vector<CheckCase>& check_cases() {
  static const std::vector<CheckCase> cases = {
      {"V1", "Free fall", free_fall},
      {"V7", "Springs in series and in parallel", series_and_parallel},
      {"V17", "Pendulum of any amplitude", pendulum_amplitude},
  };
  return cases;
}

std::vector<CheckRow> run_case(const CheckCase& check, const CheckSetting& setting) {
  std::vector<CheckRow> rows;
  try {
    rows = check.run(setting);
  } catch (const std::exception& failure) {
    rows = {{.title = std::string("could not run: ") + failure.what(),
             .achieved = std::numeric_limits<double>::quiet_NaN()}};
  }
  for (CheckRow& row : rows) {
    if (!(row.dt > 0)) row.dt = setting.dt;
    if (row.substeps == 0) row.substeps = setting.substeps;
  }
  return rows;
}

const char* precision_name() {
  return sizeof(Real) == sizeof(double) ? "double" : "float";
}

}  // namespace hooke::check
