#pragma once

#include "hooke/load/movers.h"
#include "hooke/load/push.h"
#include "hooke/load/raise.h"

#include <map>
#include <string>
#include <vector>

namespace hooke::app {

/// When an attempt to come to rest ends.
struct RestRules {
  double residual = 0;      ///< Sum of unbalanced forces that counts as rest [N].
  double speed = 0;         ///< Speed that counts as rest [m/s].
  double drift = 0;         ///< What moves less in a second is at rest, too, whatever its jitter [m].
  double way = 0;           ///< A loaded place that moves farther has collapsed [m]; 0 for any way.
  std::uint64_t steps = 0;  ///< Most steps.
  bool ends_at_break = true;
};

/// How an attempt ended.
struct RestOutcome {
  enum class End { kRest, kBroke, kMoved, kNever };
  End end = End::kNever;
  double residual = 0;      ///< In the last step [N].
  std::uint64_t steps = 0;  ///< Steps made.
  std::vector<LoadBreak> breaks = {};
  std::vector<std::string> fell_off = {};
};

/// Watches the kinetic energy for its peaks.
class Peaks {
 public:
  /// Takes the energy after a step [J]. Returns whether it fell after it had risen.
  bool passed(double kinetic) {
    const bool fell = kinetic < last_;
    const bool is_peak = fell && rising_;
    rising_ = !fell;
    last_ = is_peak ? 0 : kinetic;
    return is_peak;
  }

 private:
  double last_ = 0;
  bool rising_ = false;
};

/// Brings simulations to rest by dynamic relaxation with kinetic damping (Cundall 1976; Papadrakakis 1981;
/// Barnes 1999): it runs freely, and takes all speed away when the kinetic energy has passed a peak. No
/// damping force is left in the equilibrium, and one way past a peak is all it overshoots.
class Relaxation {
 public:
  Relaxation(Simulation& simulation, Movers& movers, const Push& push);

  /// Steps under `load` [N] until an end. The Error says that the world could not step.
  [[nodiscard]] Result<RestOutcome> run(double load, const RestRules& rules);

 private:
  /// What is known while it runs.
  struct Attempt {
    RestOutcome outcome;
    Peaks peaks;
    Movers second;       ///< Marked once a second, to see drift.
    int calm = 0;        ///< Calm steps on end.
    bool broke = false;  ///< Whether something broke in the last step.
  };

  [[nodiscard]] Result<void> step(double load);
  [[nodiscard]] std::vector<LoadBreak> take_breaks();
  /// Looks at the state after a step, and damps it. Returns whether it is rest.
  [[nodiscard]] bool settles(Attempt& attempt, const RestRules& rules);

  Simulation* simulation_;
  Movers* movers_;
  const Push* push_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> hooks_;  ///< Names by slot and generation.
};

}  // namespace hooke::app
