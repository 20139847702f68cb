#include "hooke/drawing/scene_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::app {

namespace {

constexpr double kFovDeg = 40;  ///< Vertical field of the automatic view.

/// Returns the slope at keyframe `i`, that of the line between its neighbors. It is zero at both ends, so
/// that films begin and end softly.
DVec3 slope(const std::vector<SceneKeyframe>& path, std::size_t i, DVec3 SceneKeyframe::*member) {
  if (i == 0 || i + 1 == path.size()) return {};
  const double span = path[i + 1].time - path[i - 1].time;
  return (1 / span) * (path[i + 1].*member - path[i - 1].*member);
}

/// Returns a point on the cubic Hermite curve from keyframe `i` to the next; `part` goes from 0 to 1.
DVec3 between(const std::vector<SceneKeyframe>& path, std::size_t i, double part,
              DVec3 SceneKeyframe::*member) {
  const double span = path[i + 1].time - path[i].time;
  const double s = part;
  const double s2 = s * s;
  const double s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * (path[i].*member) + (3 * s2 - 2 * s3) * (path[i + 1].*member) +
         (span * (s3 - 2 * s2 + s)) * slope(path, i, member) +
         (span * (s3 - s2)) * slope(path, i + 1, member);
}

}  // namespace

Viewpoint viewpoint_at(const SceneCamera& camera, double time) {
  const auto fov = static_cast<float>(camera.fov_deg);
  const std::vector<SceneKeyframe>& path = camera.path;
  if (path.empty()) return {camera.eye, camera.target, fov};
  if (time <= path.front().time) return {path.front().eye, path.front().target, fov};
  if (time >= path.back().time) return {path.back().eye, path.back().target, fov};
  const auto next = std::upper_bound(path.begin(), path.end(), time,
                                     [](double t, const SceneKeyframe& key) { return t < key.time; });
  const auto i = static_cast<std::size_t>(next - path.begin()) - 1;
  const double part = (time - path[i].time) / (path[i + 1].time - path[i].time);
  return {between(path, i, part, &SceneKeyframe::eye), between(path, i, part, &SceneKeyframe::target), fov};
}

Viewpoint viewpoint_of_box(DVec3 low, DVec3 high) {
  const DVec3 center = 0.5 * (low + high);
  const double radius = std::max(0.5 * length(high - low), 0.3);
  const double distance = 1.05 * radius / std::sin(0.5 * kFovDeg * std::numbers::pi / 180);
  const DVec3 direction = normalize(DVec3{0.45, 0.35, 1});
  return {center + distance * direction, center, static_cast<float>(kFovDeg)};
}

}  // namespace hooke::app
