#pragma once

#include "hooke/hooke.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

/// \file
/// Measures how far the real-time solver is from the solution of the equations, in scenes without a closed
/// form. The reference is SUNDIALS at a tolerance of 1e-10, in double.

namespace hooke::check {

/// A TruthStage is a world with one object, and its handles.
struct TruthStage {
  World world;
  std::function<std::vector<DVec3>(const World&)> positions;
  PointRef last;  ///< Last point of the object.
};

struct TruthScene {
  std::string name;
  std::string reason;  ///< A sentence on where the difference comes from.
  std::function<TruthStage(int substeps)> make;
};

inline constexpr std::array<int, 2> kTruthSubsteps = {8, 16};
/// Frames of 1/60 s after which the difference is measured.
inline constexpr std::array<int, 4> kTruthFrames = {6, 18, 60, 180};

struct Truth {
  const TruthScene* scene = nullptr;
  /// Largest distance of a point from its position by SUNDIALS, for each of kTruthSubsteps and kTruthFrames
  /// [m].
  std::array<std::array<double, kTruthFrames.size()>, kTruthSubsteps.size()> difference = {};
  /// Factor by which the exact solution enlarges a displacement of the last point by 1e-5 m at the start,
  /// until the end. Values far above one, and growing, mean chaos: then no method stays near for long.
  double sensitivity = 0;
};

const std::vector<TruthScene>& ground_truth_scenes();

/// Measures one scene. Throws std::runtime_error where a world cannot be built or SUNDIALS is missing.
Truth ground_truth(const TruthScene& scene);

/// Returns all scenes as a table, with their reasons below.
std::string ground_truth_markdown();

}  // namespace hooke::check
