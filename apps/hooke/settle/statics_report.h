#pragma once

#include "hooke/statics.h"

#include <string>
#include <vector>

namespace hooke::app {

/// Where the frame of a model comes to rest.
struct RestPlace {
  DVec3 position = {};
  Quaternion<double> rotation = {};
};

/// What statics says of a model, as texts.
struct StaticsReport {
  std::string table = {};              ///< For people.
  std::string csv = {};                ///< A line for each pose.
  std::string json = {};               ///< All of it.
  std::vector<RestPlace> places = {};  ///< The poses in the order of the table.
};

/// Tells how a solid hangs from its cables. Errors: those of find_hanging_poses.
[[nodiscard]] Result<StaticsReport> report_hanging(const std::string& model, const HangingSolid& solid);

/// Tells where a solid on an axle rests. Errors: those of find_axle_rest.
[[nodiscard]] Result<StaticsReport> report_axle(const std::string& model, const AxleSolid& solid);

/// A slope that a solid lies on.
struct SlopeWords {
  double degrees = 0;
  double friction = 0.5;
};

/// Tells how a solid lies on a slope. Errors: those of find_slope_poses.
[[nodiscard]] Result<StaticsReport> report_slope(const std::string& model, const MeshDesc& mesh, DVec3 center,
                                                 const SlopeWords& slope);

}  // namespace hooke::app
