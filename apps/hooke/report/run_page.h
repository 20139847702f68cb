#pragma once

#include "hooke/run_report.h"
#include "hooke/scene_io.h"

#include <string>
#include <vector>

namespace hooke::app {

/// Figures of the whole world after a step.
struct RunSample {
  double time = 0;  ///< [s]
  Energy energy = {};
  double momentum = 0;          ///< Size of the momentum [kg m/s].
  double angular_momentum = 0;  ///< Size of that about the origin [kg m^2/s].
  double contacts = 0;
};

/// What a hook that joins something to the world, or to a body that does not move, has borne.
struct SupportLoad {
  std::string name = {};
  HookId hook = {};
  Vec3 last = {};           ///< Force on what it holds, after the last step [N]; zero once it broke.
  double largest = 0;       ///< Largest size of it [N].
  double largest_time = 0;  ///< When [s].
};

/// Watches a run for its page.
class RunSeries {
 public:
  /// Keeps about 600 samples of so many steps.
  RunSeries(const Simulation& simulation, std::uint64_t steps);

  /// Looks at the state after a step.
  void look(const Simulation& simulation, std::uint32_t contacts);

  [[nodiscard]] const std::vector<RunSample>& samples() const { return samples_; }
  [[nodiscard]] const std::vector<SupportLoad>& supports() const { return supports_; }

 private:
  std::uint64_t interval_ = 1;  ///< Steps from sample to sample.
  std::uint64_t steps_ = 0;
  std::vector<RunSample> samples_;
  std::vector<SupportLoad> supports_;
};

/// Returns a page of HTML that needs no other file: what the scene promised, what broke, forces on supports,
/// plots of energy and momentum, warnings with what helps.
[[nodiscard]] std::string run_page(const Simulation& simulation, const RunRecord& record,
                                   const RunSeries& series);

}  // namespace hooke::app
