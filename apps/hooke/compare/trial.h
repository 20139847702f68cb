#pragma once

#include "hooke/compare/exact.h"
#include "hooke/compare/stage.h"
#include "hooke/lab.h"
#include "hooke/progress.h"

#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

/// A Sample is the watched point and the energy at one time.
struct Sample {
  double time = 0;      ///< [s]
  DVec3 position = {};  ///< [m]
  Energy energy = {};
  double error = 0;  ///< Distance from the reference [m]; NaN without one.
};

/// A Schedule says how long a run is and how often it is sampled.
struct Schedule {
  std::uint64_t steps = 1;         ///< Steps of the scene.
  std::uint64_t stride = 1;        ///< Steps between two samples.
  std::uint64_t frame_stride = 1;  ///< Steps between two frames.
  double dt = 0;                   ///< [s]

  [[nodiscard]] double time(std::size_t sample) const { return static_cast<double>(sample * stride) * dt; }
};

/// A Frame holds where all points of the watched object are at one time [m].
using Frame = std::vector<DVec3>;

/// A Reference is what all steppers are measured against.
struct Reference {
  std::string title;               ///< Such as "the exact ..." or "rk4 at dt/16"; empty if there is none.
  std::vector<Sample> samples;     ///< One for each sample of the schedule.
  std::vector<Frame> frames = {};  ///< One for each frame of the schedule.
  double extent = 1;               ///< Size of the motion and the object [m].
  std::string missing = {};        ///< Why there is none.
};

/// These are measurements beside theory. They are empty where they have no meaning or did not fit into the
/// time.
struct Limits {
  std::optional<lab::OrderMeasurement> order = {};
  int order_in_theory = 0;
  std::optional<double> stiffness = {};  ///< Largest stable k of 1 kg on one spring at dt [N/m].
  std::optional<double> stiffness_in_theory = {};
  std::optional<double> step = {};  ///< Largest stable omega dt, undamped.
  std::optional<double> step_in_theory = {};
};

/// A Trial is the run of one stepper on the stage.
struct Trial {
  std::string name;
  std::vector<Sample> samples;             ///< Fewer than in the schedule if it diverged.
  std::vector<Frame> frames = {};          ///< Likewise.
  std::optional<double> diverged_at = {};  ///< [s]
  double cost_ms = 0;                      ///< Measured wall time [ms] per simulated second.
  double evaluations = 0;                  ///< Evaluations of the forces per simulated second.
  double largest_error = 0;                ///< [m]; NaN without a reference.
  lab::CollisionReport collisions = {};
  std::string note = {};
  Limits limits = {};
};

/// Makes steps of `dt` up to `seconds`, with at most a few thousand samples and at most `frames` frames.
Schedule make_schedule(double seconds, double dt, std::uint64_t frames);

/// Returns the exact motion if there is one, else rk4 with the step divided until it is stable, at least by
/// 16. Errors are those of lab::Run::create and lab::Run::advance.
Result<Reference> make_reference(const Stage& stage, const Schedule& schedule);
/// Makes a reference for scenes that the laboratory refuses. It has no samples, only the object's size.
Reference no_reference(const Stage& stage, const std::string& why);

/// Runs one stepper to the end, or until it is ten times the extent away from the reference.
Result<Trial> run_trial(const Stage& stage, const std::string& name, bool force, const Schedule& schedule,
                        const Reference& reference);

/// Measures order and stability of a stepper on this stage.
Limits measure_limits(const Stage& stage, const std::string& name, const Schedule& schedule,
                      const Reference& reference);

}  // namespace hooke::app
