#include "hooke/statics.h"

#include "base/float_environment.h"
#include "geometry/statics/facets.h"
#include "math/rotation.h"
#include "math/trig.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace hooke {

namespace {

using geometry::Facet;
using geometry::FacetedSolid;

constexpr double kWholeTurn = 2 * std::numbers::pi;

/// A range of headings [rad].
struct HeadingRange {
  double from = 0;
  double to = 0;
};

/// Directions along a facet: `ahead` and `left` of it, as seen from outside.
struct FacetAxes {
  DVec3 ahead = {};
  DVec3 left = {};

  [[nodiscard]] DVec3 direction(double angle) const {
    const auto [sine, cosine] = math::sin_cos(angle);
    return cosine * ahead + sine * left;
  }
};

FacetAxes axes_of(const Facet& facet) {
  const DVec3 ahead = normalize(facet.corners[1] - facet.corners[0]);
  return {ahead, cross(facet.normal, ahead)};
}

/// Lists the headings that tip a solid whose weight meets the facet's plane `shift` downhill of the center's
/// foot, in ranges that start in [0, 2 pi). Across a side at the distance m, along its outward direction,
/// these are the headings within acos(m / shift) of that direction.
std::vector<HeadingRange> tipping_headings(const Facet& facet, DVec3 center, double shift) {
  const FacetAxes axes = axes_of(facet);
  std::vector<HeadingRange> ranges;
  const std::size_t count = facet.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const DVec3 corner = facet.corners[i];
    const DVec3 outward = normalize(cross(facet.corners[(i + 1) % count] - corner, facet.normal));
    const double inside = dot(outward, corner - center);
    if (inside >= shift) continue;
    if (inside <= -shift) return {{0, kWholeTurn}};
    const double middle = math::atan2(dot(outward, axes.left), dot(outward, axes.ahead));
    const double half = math::atan2(std::sqrt(shift * shift - inside * inside), inside);
    const double from = middle - half;
    const double start = from < 0 ? from + kWholeTurn : from;
    ranges.push_back({start, start + 2 * half});
  }
  std::sort(ranges.begin(), ranges.end(),
            [](const HeadingRange& a, const HeadingRange& b) { return a.from < b.from; });
  return ranges;
}

/// Lists what the ranges, in order of their starts, leave free of a turn from the first start on.
std::vector<HeadingRange> free_headings(const std::vector<HeadingRange>& taken) {
  std::vector<HeadingRange> gaps;
  double end = taken.front().to;
  for (const HeadingRange& range : taken) end = std::max(end, range.to - kWholeTurn);
  for (const HeadingRange& range : taken) {
    if (range.from > end) gaps.push_back({end, range.from});
    end = std::max(end, range.to);
  }
  const double turned = taken.front().from + kWholeTurn;
  if (turned > end) gaps.push_back({end, turned});
  return gaps;
}

/// The heading that takes the weight away from the side it would tip over first.
DVec3 away_from_nearest_side(const Facet& facet, DVec3 center) {
  DVec3 nearest = {};
  double least = std::numeric_limits<double>::infinity();
  const std::size_t count = facet.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const DVec3 corner = facet.corners[i];
    const DVec3 outward = normalize(cross(facet.corners[(i + 1) % count] - corner, facet.normal));
    if (dot(outward, corner - center) >= least) continue;
    least = dot(outward, corner - center);
    nearest = outward;
  }
  return -nearest;
}

/// Says in which headings the solid stays upright: their share, and the middle of the widest range.
void note_headings(SlopePose& pose, const Facet& facet, DVec3 center, double shift) {
  const FacetAxes axes = axes_of(facet);
  const std::vector<HeadingRange> taken = tipping_headings(facet, center, shift);
  if (taken.empty()) {
    pose.upright_share = 1;
    pose.heading = away_from_nearest_side(facet, center);
    return;
  }
  HeadingRange widest;
  double sum = 0;
  for (const HeadingRange& gap : free_headings(taken)) {
    sum += gap.to - gap.from;
    if (gap.to - gap.from > widest.to - widest.from) widest = gap;
  }
  pose.upright_share = std::min(sum / kWholeTurn, 1.0);
  pose.heading = axes.direction(0.5 * (widest.from + widest.to));
}

SlopePose slope_pose(const Facet& facet, DVec3 center, double slope, double tip_slope) {
  SlopePose pose = {.normal = facet.normal, .support = facet.corners, .height = facet.height};
  const auto [tip_sine, tip_cosine] = math::sin_cos(tip_slope);
  note_headings(pose, facet, center, facet.height * tip_sine / tip_cosine);
  const DVec3 foot = center + facet.height * facet.normal;
  double farthest = 0;
  for (const DVec3& corner : facet.corners) farthest = std::max(farthest, length(corner - foot));
  pose.tip_angle = math::atan2(std::max(facet.margin, 0.0), facet.height);
  pose.tip_angle_best = math::atan2(farthest, facet.height);
  // The facet is turned down, its heading to +x, and both with the slope.
  const Quaternion<double> down = geometry::turn_down(facet.normal);
  const DVec3 ahead = rotate(down, pose.heading);
  const Quaternion<double> turn = math::quaternion_of(DVec3{0, math::atan2(ahead.z, ahead.x), 0});
  const Quaternion<double> lean = math::quaternion_of(DVec3{0, 0, -slope});
  pose.rotation = normalize(lean * (turn * down));
  const DVec3 up = rotate(lean, DVec3{0, 1, 0});
  pose.position = facet.height * up - rotate(pose.rotation, center);
  return pose;
}

Result<void> check_slope(double slope, double friction) {
  if (!(slope >= 0) || !(slope < 0.5 * std::numbers::pi)) {
    return Error{ErrorCode::kOutOfRange, "slope", "must be from 0 to below a right angle"};
  }
  if (!(friction >= 0) || !std::isfinite(friction)) {
    return Error{ErrorCode::kOutOfRange, "friction", "must be 0 or more, and finite"};
  }
  return {};
}

}  // namespace

Result<SlopePoses> find_slope_poses(const MeshDesc& mesh, double slope, double friction,
                                    std::optional<DVec3> center) {
  const base::FloatEnvironment environment;
  if (auto checked = check_slope(slope, friction); !checked) return checked.error();
  auto made = geometry::make_faceted_solid(mesh, center);
  if (!made) return made.error();
  const FacetedSolid& solid = made.value();
  SlopePoses result = {.poses = {},
                       .slide_angle = math::atan2(friction, 1.0),
                       .center = solid.center,
                       .hull_error = solid.hull_error};
  // A slope of exactly the angle of friction holds, whatever the last digit of both.
  result.slides = slope > result.slide_angle * (1 + 1e-12);
  if (result.slides) {
    const auto [sine, cosine] = math::sin_cos(slope);
    result.acceleration_share = sine - friction * cosine;
  }
  const double tip_slope = std::min(slope, result.slide_angle);
  for (const Facet& facet : solid.facets) {
    SlopePose pose = slope_pose(facet, solid.center, slope, tip_slope);
    if (pose.upright_share > 0) result.poses.push_back(std::move(pose));
  }
  std::stable_sort(result.poses.begin(), result.poses.end(), [](const SlopePose& a, const SlopePose& b) {
    return a.upright_share != b.upright_share ? a.upright_share > b.upright_share : a.tip_angle > b.tip_angle;
  });
  return result;
}

}  // namespace hooke
