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
      {"V2", "Fall with linear drag", linear_drag},
      {"V3", "Fall with quadratic drag", quadratic_drag},
      {"V4", "Mass on a spring", simple_oscillator},
      {"V5", "Damped oscillator", damped_oscillator},
      {"V6", "Hanging spring with its own weight", hanging_weight},
      {"V7", "Springs in series and in parallel", series_and_parallel},
      {"V8", "Normal modes of a chain", chain_modes},
      {"V9", "Wave speeds of a string", wave_speeds},
      {"V11", "Catenary", catenary},
      {"V12", "Elastic catenary", elastic_catenary},
      {"V17", "Pendulum of any amplitude", pendulum_amplitude},
      {"V20", "Inverted pendulum on a shaken pivot", inverted_pendulum},
      {"V23", "Kepler orbit", kepler_orbit},
      {"V24", "Charge in a magnetic field", charge_in_magnetic_field},
      {"V86", "Any display rate", display_rate},
      {"I1", "Rope extension at any resolution", resolution_of_rope},
      {"I2", "Any stiffness at 60 Hz", any_stiffness},
      {"I3", "Pendulum from the horizontal", pendulum_right_angle},
      {"I4", "Spinning dumbbell", dumbbell},
      {"I5", "Gusts at any frame rate", gusts},
      {"I6", "Heavy load on a light rope", heavy_load},
      {"I7", "Crane", crane},
      {"I8", "Folded rope, 10000 : 1", folded_rope},
      {"I9", "Rope over a drum: capstan", capstan},
      {"I10", "Sliding block", sliding_block},
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
