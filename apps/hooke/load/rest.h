#pragma once

#include "hooke/load/movers.h"
#include "hooke/load/push.h"
#include "hooke/load/raise.h"

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

/// Lists what broke in the last step, with names.
[[nodiscard]] std::vector<LoadBreak> breaks_of(const Simulation& simulation);

/// Brings simulations to rest by RestWatch, under a load, until something breaks or runs away.
class Relaxation {
 public:
  Relaxation(Simulation& simulation, Movers& movers, const Push& push);

  /// Steps under `load` [N] until an end. The Error says that the world could not step.
  [[nodiscard]] Result<RestOutcome> run(double load, const RestRules& rules);

 private:
  /// What is known while it runs.
  struct Attempt {
    RestOutcome outcome;
    RestWatch watch;
    Movers second;       ///< Marked once a second, to see drift.
    bool broke = false;  ///< Whether something broke in the last step.
  };

  [[nodiscard]] Result<void> step(double load);
  /// Looks at the state after a step, and damps it. Returns whether it is rest.
  [[nodiscard]] bool settles(Attempt& attempt, const RestRules& rules);

  Simulation* simulation_;
  Movers* movers_;
  const Push* push_;
};

}  // namespace hooke::app
