#pragma once

#include "hooke/hooke.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

/// \file
/// How far the real-time solver is from the solution of the equations, in scenes without a closed form:
/// beside SUNDIALS at a tolerance of 1e-10, in double.

namespace hooke::check {

/// A world with one object, and where its points are.
struct TruthStage {
  World world;
  std::function<std::vector<DVec3>(const World&)> positions;
  PointRef last;  ///< Its last point.
};

struct TruthScene {
  std::string name;
  std::string reason;  ///< What the difference comes from: a sentence.
  std::function<TruthStage(int substeps)> make;
};

inline constexpr std::array<int, 2> kTruthSubsteps = {8, 16};
inline constexpr std::array<int, 4> kTruthFrames = {6, 18, 60, 180};  ///< Of 1/60 s.

struct Truth {
  const TruthScene* scene = nullptr;
  /// Largest distance of a point from where SUNDIALS has it, for each of kTruthSubsteps and kTruthFrames [m].
  std::array<std::array<double, kTruthFrames.size()>, kTruthSubsteps.size()> difference = {};
  /// By how much the exact solution enlarges a displacement of the last point by 1e-5 m at the start, until
  /// the end. Far above one, and growing, is chaos: then no method stays near for long.
  double sensitivity = 0;
};

const std::vector<TruthScene>& ground_truth_scenes();

/// Throws std::runtime_error where a world cannot be built or SUNDIALS is missing.
Truth ground_truth(const TruthScene& scene);

/// All scenes as a table, with their reasons below.
std::string ground_truth_markdown();

}  // namespace hooke::check
