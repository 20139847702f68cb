#pragma once

#include "hooke/scene_io.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hooke::app {

/// A RunWarning is what a user should know of a run that went on all the same.
struct RunWarning {
  std::string object = {};  ///< Name of the object; empty for the scene.
  std::string what = {};    ///< Text with the number: "stretched by 12 %, its extension_max is 5 %".
  double worst = 0;         ///< The number.
  double limit = 0;         ///< Limit of the number; 0 where nothing at all should happen.
  std::string unit = {};    ///< Unit of both; empty for a ratio or a count.
  double time = 0;          ///< Time of the worst value [s].
  std::string cure = {};    ///< Advice, such as "more particle_substeps".

  /// Returns a line such as "'rope' stretched by 12 %, its extension_max is 5 %, at 0.85 s: more
  /// particle_substeps".
  [[nodiscard]] std::string line() const;
};

/// This is a number of StepReport that is zero while all is well.
struct RefusedCount {
  std::uint32_t StepReport::*number;
  const char* name;  ///< Name in reports.
  const char* what;  ///< Text before the number, for a reader.
  const char* cure;
  bool of_rope = false;                 ///< Whether the warning names the worst rope.
  double StepReport::*error = nullptr;  ///< Length that tells whether it matters [m]; null if it always does.
  const char* error_name = nullptr;     ///< Its name in reports.
};

/// Returns all that a step can refuse or leave undone.
[[nodiscard]] std::span<const RefusedCount> refused_counts();

/// Observes a simulation while it runs, and stores the worst value for each object and each kind of trouble.
class RunWatch {
 public:
  /// Checks what can be told before the first step: materials that the substeps cannot carry, cells that do
  /// not fit, hooks whose ends are apart.
  explicit RunWatch(const Simulation& simulation);

  /// Checks the state after a step and the step's report.
  void look(const Simulation& simulation, const StepReport& report);

  /// Returns warnings in the order of the objects' creation; those of no object come last. Copies of one
  /// object ("flag[3]") that have the same trouble give one warning, by the worst of them, and so do more
  /// than eight objects of any name.
  [[nodiscard]] std::vector<RunWarning> warnings() const;

 private:
  /// An Edge is two points and their distance at rest [m].
  struct Edge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double length = 0;
  };
  struct Watched {
    SceneObject object = {};
    std::uint64_t order = 0;   ///< Order of creation.
    double extension_max = 0;  ///< 0 for none.
    bool is_rigid = false;     ///< Whether it is a rope that must keep its length.
    double stiffness = 0;      ///< Declared stiffness of a spring along an edge of cloth [N/m].
    double carried = 0;        ///< Part of it that a substep carries [N/m]; 0 where that is all.
    /// Edges of an object that has a limit, is rigid, or is softer than declared.
    std::vector<Edge> edges = {};
    bool was_closed = false;  ///< For a hook: whether its ends have been at one place.
  };
  struct Worst {
    std::uint64_t order = 0;
    int kind = 0;
    double ratio = 0;  ///< Worst value over its limit.
    RunWarning warning = {};
  };

  /// Tells whether no object came or went; then it also notes which hooks broke.
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
  void look_at_crossings(const World& world);
  void look_at_report(const World& world, const StepReport& report);
  /// Returns the rigid rope that is farthest off its length, or null.
  [[nodiscard]] const Watched* least_rigid_rope(const World& world) const;
  void note(std::uint64_t order, int kind, double ratio, RunWarning warning);

  std::vector<Watched> watched_;
  std::vector<Worst> worst_;
  std::uint64_t created_ = 0;
  double next_overlaps_ = 0;  ///< Time of the next check of all contacts [s].
};

}  // namespace hooke::app
