#pragma once

#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/direct_islands.h"
#include "solver/joint/joints.h"
#include "solver/rope/rope_systems.h"
#include "state/tables.h"

#include <cstdint>
#include <span>

/// \file
/// How much was solved as a whole in a step, and what budgets left out. StepReport shows these counts.

namespace hooke::solver {

/// Rows are equations: a point of a contact is one, and friction and twist are three for each manifold. A
/// hook has one for each freedom that it takes, a segment or bend of a rope three.
struct ClusterCounts {
  std::uint32_t clusters = 0;      ///< Direct islands, articulations, ropes and coupled groups.
  std::uint32_t rows_direct = 0;   ///< Rows of all of them.
  std::uint32_t rows_refused = 0;  ///< Rows that ask to be solved as a whole, and are left out by a budget.
  double worst_error = 0;  ///< Deepest overlap or largest gap in the rows refused, after the step [m].
};

/// What the budgets of a step left out.
struct RefusedInputs {
  const Joints& joints;                      ///< Hooks beyond kArticulationBudget are iterated.
  const CoupledGroups& groups;               ///< They leave out contacts of ropes.
  std::span<const std::uint32_t> manifolds;  ///< Those over kMostLoadBearingManifolds.
};

/// Counts the groups that were solved as a whole. Call it after the substeps, before bodies are finished.
[[nodiscard]] ClusterCounts count_clusters(const state::Tables& tables,
                                           std::span<const RopeSystem> rope_systems,
                                           const DirectIslands& direct, const RefusedInputs& inputs);

}  // namespace hooke::solver
