#pragma once

#include "hooke/scene_io.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hooke::app {

/// What a user should know of a run that went on all the same.
struct RunWarning {
  std::string object = {};  ///< Its name; empty for the scene.
  std::string what = {};    ///< With the number: "stretched by 12 %, its extension_max is 5 %".
  double worst = 0;         ///< The number.
  double limit = 0;         ///< What it is measured against; 0 where nothing is to happen at all.
  std::string unit = {};    ///< Of both; empty for a ratio or a count.
  double time = 0;          ///< When it was worst [s].
  std::string cure = {};    ///< "more particle_substeps".

  /// "'rope' stretched by 12 %, its extension_max is 5 %, at 0.85 s: more particle_substeps".
  [[nodiscard]] std::string line() const;
};

/// A number of StepReport that is zero while all is well.
struct RefusedCount {
  std::uint32_t StepReport::*number;
  const char* name;  ///< In reports.
  const char* what;  ///< After the number, for a reader.
  const char* cure;
  bool of_rope = false;  ///< The worst rope is named.
};

/// All that a step can refuse or leave undone.
[[nodiscard]] std::span<const RefusedCount> refused_counts();

/// Looks at a simulation while it runs, and remembers of each object and each kind of trouble the worst.
class RunWatch {
 public:
  /// Looks at what can be told before the first step: materials that the substeps cannot carry, cells that do
  /// not fit, hooks whose ends are apart.
  explicit RunWatch(const Simulation& simulation);

  /// Looks at the state after a step and at the step's report.
  void look(const Simulation& simulation, const StepReport& report);

  /// In order of the objects' creation, what is nobody's own last. Copies of one object ("flag[3]") that have
  /// the same trouble are told of once, by the worst of them.
  [[nodiscard]] std::vector<RunWarning> warnings() const;

 private:
  /// Two points and how far they are from each other at rest [m].
  struct Edge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double length = 0;
  };
  struct Watched {
    SceneObject object = {};
    std::uint64_t order = 0;       ///< Of creation.
    double extension_max = 0;      ///< 0 for none.
    bool is_rigid = false;         ///< A rope that is to keep its length.
    double stiffness = 0;          ///< Of cloth: declared, of a spring along an edge [N/m].
    double carried = 0;            ///< Of it what a substep carries [N/m]; 0 where that is all.
    std::vector<Edge> edges = {};  ///< Of what has a limit, is rigid, or softer than declared.
    bool was_closed = false;       ///< A hook, whose ends have been at one place.
  };
  struct Worst {
    std::uint64_t order = 0;
    int kind = 0;
    double ratio = 0;  ///< Worst over limit.
    RunWarning warning = {};
  };

  /// Whether nothing came or went; then it also notes what broke.
  bool knows_all(std::span<const SceneObject> objects);
  void take_new_objects(const Simulation& simulation);
  void look_at_start(const Simulation& simulation, Watched& watched);
  static void take_cloth(const Scene& scene, const World& world, const SceneCloth& cloth, Watched& watched);
  static void take_rope(const World& world, const SceneRope& rope, Watched& watched);
  static double stretch_of(const World& world, const Watched& watched);
  void look_at_stretch(const World& world, const Watched& watched);
  void look_at_softness(const Simulation& simulation, const Watched& watched);
  void look_at_gap(const World& world, Watched& watched);
  void look_at_overlaps(const World& world);
  void look_at_report(const World& world, const StepReport& report);
  /// The rigid rope that is farthest off its length; null if there is none.
  [[nodiscard]] const Watched* least_rigid_rope(const World& world) const;
  void note(std::uint64_t order, int kind, double ratio, RunWarning warning);

  std::vector<Watched> watched_;
  std::vector<Worst> worst_;
  std::uint64_t created_ = 0;
  double next_overlaps_ = 0;  ///< When contacts are looked at again [s].
};

}  // namespace hooke::app
