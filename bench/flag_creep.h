#pragma once

#include "hooke/hooke.h"

#include <string>
#include <vector>

/// \file
/// Tests the paper's open question (3.5.1): its flag "extends for ever", and its author does not know whether
/// the missing limit or the wind is the cause. A flag is in wind for two minutes, and the mean extension of
/// its threads along the wind is measured.

namespace hooke::bench {

/// These are the settings that are varied.
struct FlagSetting {
  bool gusts = false;
  bool limited = false;  ///< Whether extension_max is set.
};

inline constexpr int kFlagColumns = 13;
inline constexpr int kFlagRows = 9;
inline constexpr double kFlagWidth = 1.5;  ///< [m]
inline constexpr double kFlagSeconds = 120;
inline constexpr double kFlagWindow = 20;  ///< Time over which a mean is taken [s].

struct Flag {
  World world;
  ClothId cloth;
};

/// Makes a flag of soft springs on a pole, pulled by 8 m/s of wind and its own weight.
Result<Flag> make_flag(const FlagSetting& setting);

/// Returns the mean length of the flag's rows over their length at rest, minus 1.
double extension_of(const std::vector<DVec3>& points);

/// Collects samples and gives the mean extension in the first and the last window.
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

/// Prints one row of the table. If `end` is not empty, it says why the run ended and replaces the figures.
void print_row(const char* stepper, double dt, const FlagSetting& setting, const CreepMeter& meter,
               const std::string& end);

/// Prints the rows of the real-time solver in this build's precision.
int print_solver_rows(const char* name);

}  // namespace hooke::bench
