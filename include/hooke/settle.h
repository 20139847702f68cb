#pragma once

#include "hooke/id.h"
#include "hooke/math.h"

#include <cstdint>
#include <vector>

/// \file
/// How a World is brought to rest: World::settle does it, and World::unrest, World::stop and RestWatch are
/// its parts, for programs that have more to do on the way.

namespace hooke {

/// What still moves after a step.
struct Unrest {
  /// Largest sqrt(2 m E) / dt of any body or point, m being its mass, E its kinetic energy and dt the length
  /// of the last step: the force that would stop it within a step [N]. A step from rest makes it the force
  /// that is not balanced.
  double residual = 0;
  double sum = 0;       ///< Sum of these forces over all bodies and points [N].
  double speed = 0;     ///< Largest sqrt(2 E / m) [m/s].
  double kinetic = 0;   ///< Kinetic energy of all [J].
  BodyId body = {};     ///< The body that has that speed; null if it is a point.
  PointRef point = {};  ///< The point that has that speed; empty if it is a body.
};

/// What does not count on the way to rest, as what fell off.
struct LeftOut {
  std::vector<BodyId> bodies = {};     ///< Bodies.
  std::vector<PointRef> objects = {};  ///< A point of each deformable object, whatever its index.
};

/// Decides during dynamic relaxation with kinetic damping (Cundall 1976; Papadrakakis 1981; Barnes 1999) when
/// speed is taken away, and when there is rest. A world runs freely, and is stopped when its kinetic energy
/// has passed a peak. No damping force is left in the equilibrium, and one way past a peak is all that it
/// overshoots.
class RestWatch {
 public:
  /// What counts as rest.
  struct Limits {
    double residual = 0;      ///< Largest Unrest::sum that counts as rest [N].
    double speed = 0;         ///< [m/s]
    double drift = 0;         ///< What moves less in a second is at rest, too, whatever its jitter [m].
    std::uint64_t steps = 0;  ///< Steps that it is given in all.
  };
  /// What follows from a step.
  enum class Verdict {
    kMoves,   ///< It goes on.
    kPeak,    ///< The kinetic energy has passed a peak: take all speed away.
    kAtRest,  ///< It is at rest.
  };

  /// Makes a watch that has seen no step.
  explicit RestWatch(const Limits& limits) : limits_(limits) {}

  /// Takes what moved in a step. A step in which something broke is `disturbed`, and no rest. It is rest
  /// after three calm steps on end.
  Verdict observe(const Unrest& unrest, bool disturbed = false);
  /// Whether what moved `farthest` [m] within the last second is at rest, although it jitters or creeps as
  /// large cloths do: at most Limits::drift; 100 times that from a third of Limits::steps on, and 1000 times
  /// from nine tenths on.
  [[nodiscard]] bool is_still(double farthest) const;
  /// Steps observed.
  [[nodiscard]] std::uint64_t steps() const { return steps_; }

 private:
  Limits limits_;
  std::uint64_t steps_ = 0;
  int calm_ = 0;             ///< Calm steps on end.
  double last_kinetic_ = 0;  ///< [J]
  bool rising_ = false;
};

/// How World::settle goes about it.
struct SettleDesc {
  Real dt = Real(1) / Real(60);  ///< Length of a step [s]. [1e-6, 1]
  double residual = 1e-5;        ///< Rest: SettleReport::sum, over `force`, is at most this. [1e-9, 1]
  double force = 0;     ///< What it is compared with [N], not negative; with 0 the weight of all that moves.
  double drift = 1e-6;  ///< What moves less in a second is at rest, too [m], not negative.
  double seconds = 60;  ///< Time for it. (0, 1e5]
};

/// How settling ended.
enum class SettleEnd : std::uint8_t {
  kBalanced,  ///< Forces balance within the residual.
  kStill,     ///< Nothing moves as far as the drift in a second; forces balance less well than asked.
  kBroke,  ///< Something broke or tore in the last step, as World::events() tells; nothing was stopped then.
  kOutOfTime,  ///< There was no rest.
  kDiverged,   ///< Something was no longer finite in the last step, which StepReport counts as quarantined.
};

/// What settling came to.
struct SettleReport {
  SettleEnd end = SettleEnd::kOutOfTime;  ///< How it ended.
  double residual =
      0;           ///< Largest unbalanced force on a body or point, over the weight or SettleDesc::force.
  double sum = 0;  ///< Sum of all, likewise.
  std::uint64_t steps = 0;  ///< Steps that it took.
  Unrest unrest = {};       ///< After the last of them.

  /// Whether there is rest.
  [[nodiscard]] bool converged() const { return end == SettleEnd::kBalanced || end == SettleEnd::kStill; }
};

}  // namespace hooke
