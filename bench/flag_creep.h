#pragma once

#include "hooke/hooke.h"

#include <string>
#include <vector>

/// \file
/// The paper's open question (3.5.1): its flag "extends for ever", and its author does not know whether the
/// missing limit or the wind is to blame. A flag in wind for two minutes, measured by the mean extension of
/// its threads along the wind.

namespace hooke::bench {

/// What is varied.
struct FlagSetting {
  bool gusts = false;
  bool limited = false;  ///< extension_max.
};

inline constexpr int kFlagColumns = 13;
inline constexpr int kFlagRows = 9;
inline constexpr double kFlagWidth = 1.5;  ///< [m]
inline constexpr double kFlagSeconds = 120;
inline constexpr double kFlagWindow = 20;  ///< [s] over which a mean is taken.

struct Flag {
  World world;
  ClothId cloth;
};

/// A flag of soft springs on a pole, pulled by 8 m/s of wind and its own weight.
Result<Flag> make_flag(const FlagSetting& setting);

/// Mean length of the flag's rows over their length at rest, minus 1.
double extension_of(const std::vector<DVec3>& points);

/// Mean extension in the first and the last window, collected from samples.
class CreepMeter {
 public:
  void add(double time, double extension);
  [[nodiscard]] double first() const { return first_count_ > 0 ? first_ / first_count_ : 0; }
  [[nodiscard]] double last() const { return last_count_ > 0 ? last_ / last_count_ : 0; }

 private:
  double first_ = 0;
  double last_ = 0;
  int first_count_ = 0;
  int last_count_ = 0;
};

/// One row of the table; `end` instead of the figures if it is not empty: why the run is over.
void print_row(const char* stepper, double dt, const FlagSetting& setting, const CreepMeter& meter,
               const std::string& end);

/// The rows of the real-time solver in this build's precision.
int print_solver_rows(const char* name);

}  // namespace hooke::bench
