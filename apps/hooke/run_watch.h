#pragma once

#include "hooke/scene_io.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hooke::app {

/// What a user should know of a run that went on all the same: of whom, what, how bad it was at worst, when
/// that was, and what helps.
struct RunWarning {
  std::string object;  ///< Its name; empty for the scene.
  std::string what;    ///< "stretched by 12 %, beyond its extension_max of 5 %"
  double worst = 0;    ///< The number in `what`.
  double limit = 0;    ///< What it is measured against.
  std::string unit;    ///< Of both; empty for a ratio or a count.
  double time = 0;     ///< When it was worst [s].
  std::string cure;    ///< "more particle_substeps"

  /// "'rope' stretched by 12 % (at 0.85 s), beyond its extension_max of 5 %: more particle_substeps"
  [[nodiscard]] std::string line() const;
};

/// Looks at a simulation while it runs, and remembers of each object and each kind of trouble the worst.
class RunWatch {
 public:
  /// Looks at what can be told before the first step: materials that the substeps cannot carry, cells that do
  /// not fit, hooks whose ends are apart.
  explicit RunWatch(const Simulation& simulation);

  /// Looks at the state after a step and at its report.
  void look(const Simulation& simulation, const StepReport& report);

  /// In order of the objects' creation, the scene's own last.
  [[nodiscard]] std::vector<RunWarning> warnings() const;

 private:
  /// Two points that are not to be farther apart than `length` times 1 + limit.
  struct Edge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double length = 0;  ///< At rest [m].
  };
  /// What is looked at of one object.
  struct Watched {
    SceneObject object = {};
    double extension_max = 0;  ///< Declared; 0 for none.
    std::vector<Edge> edges = {};
    double first_gap = 0;  ///< Of a hook, when it was seen first [m].
    bool was_closed = false;
  };
  /// The worst of one kind of trouble of one object.
  struct Worst {
    std::uint64_t order = 0;  ///< Of the object's creation.
    int kind = 0;
    double ratio = 0;  ///< Worst over limit, to tell which is worse.
    RunWarning warning = {};
  };

  void take_new_objects(const Simulation& simulation);
  void look_at_start(const Simulation& simulation, const Watched& watched, std::uint64_t order);
  void look_at_stretch(const World& world, const Watched& watched, std::uint64_t order);
  void look_at_gap(const World& world, Watched& watched, std::uint64_t order);
  void look_at_overlaps(const World& world);
  void look_at_report(const Simulation& simulation, const StepReport& report);
  void note(std::uint64_t order, int kind, double ratio, RunWarning warning);

  std::vector<Watched> watched_;
  std::vector<Worst> worst_;
  double next_overlaps_ = 0;  ///< When contacts are looked at again [s].
};

}  // namespace hooke::app
