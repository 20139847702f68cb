#include "hooke/statics.h"

#include "base/float_environment.h"
#include "geometry/statics/facets.h"
#include "math/trig.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hooke {

namespace {

using geometry::Facet;

/// Passes the shares of facets that cannot bear the center on, from the highest center down, and returns the
/// facets that keep theirs. A solid that rolls over a side which its center has passed lowers the center, so
/// that nothing goes in a circle. Where rounding says otherwise, the facet keeps its share.
std::vector<std::uint32_t> roll(std::vector<Facet>& facets, double margin_min) {
  std::vector<std::uint32_t> order(facets.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&facets](std::uint32_t a, std::uint32_t b) {
    return facets[a].height > facets[b].height;
  });
  std::vector<std::uint32_t> rest;
  for (const std::uint32_t i : order) {
    Facet& facet = facets[i];
    Facet& next = facets[facet.neighbor];
    if (facet.margin > margin_min || !(next.height < facet.height)) {
      rest.push_back(i);
      continue;
    }
    next.share += facet.share;
    facet.share = 0;
  }
  return rest;
}

StablePose pose_of(Facet& facet, DVec3 center) {
  StablePose pose;
  pose.normal = facet.normal;
  pose.support = std::move(facet.corners);
  pose.rotation = geometry::turn_down(facet.normal);
  pose.position = DVec3{0, facet.height, 0} - rotate(pose.rotation, center);
  pose.height = facet.height;
  pose.margin = std::max(facet.margin, 0.0);
  pose.tip_angle = math::atan2(pose.margin, pose.height);
  // This is sqrt(height^2 + margin^2) - height, without the difference of two near numbers.
  const double reach = std::sqrt(pose.height * pose.height + pose.margin * pose.margin);
  pose.tip_height = pose.margin * pose.margin / (reach + pose.height);
  pose.probability = facet.share;
  return pose;
}

}  // namespace

Result<StablePoses> find_stable_poses(const MeshDesc& mesh, std::optional<DVec3> center) {
  const base::FloatEnvironment environment;
  auto made = geometry::make_faceted_solid(mesh, center);
  if (!made) return made.error();
  geometry::FacetedSolid& solid = made.value();
  StablePoses result = {.center = solid.center, .hull_error = solid.hull_error};
  double sum = 0;
  for (const std::uint32_t i : roll(solid.facets, solid.margin_min)) {
    result.poses.push_back(pose_of(solid.facets[i], solid.center));
    sum += result.poses.back().probability;
  }
  // The solid angles of a closed hull make 4 pi up to rounding.
  for (StablePose& pose : result.poses) pose.probability /= sum;
  std::stable_sort(result.poses.begin(), result.poses.end(),
                   [](const StablePose& a, const StablePose& b) { return a.probability > b.probability; });
  return result;
}

}  // namespace hooke
