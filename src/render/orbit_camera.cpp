#include "render/orbit_camera.h"

#include <algorithm>
#include <numbers>

namespace hooke::render {

namespace {

constexpr float kRadiansPerDegree = std::numbers::pi_v<float> / 180;
// At the pole the picture would flip.
constexpr float kMaxPitch = 89 * kRadiansPerDegree;

/// Returns the unit vector from the target to the eye.
Vec3 back_of(const OrbitCamera& orbit) {
  return {std::cos(orbit.pitch) * std::sin(orbit.yaw), std::sin(orbit.pitch),
          std::cos(orbit.pitch) * std::cos(orbit.yaw)};
}

}  // namespace

OrbitCamera make_orbit_camera(const Camera& camera) {
  OrbitCamera orbit;
  orbit.target = camera.target;
  orbit.vertical_fov_deg = camera.vertical_fov_deg;
  const Vec3 back = camera.eye - camera.target;
  orbit.distance = length(back);
  if (!(orbit.distance > 1e-3F)) {
    orbit.distance = 1;
    return orbit;
  }
  orbit.yaw = std::atan2(back.x, back.z);
  orbit.pitch =
      std::clamp(std::asin(std::clamp(back.y / orbit.distance, -1.0F, 1.0F)), -kMaxPitch, kMaxPitch);
  return orbit;
}

Camera camera_of(const OrbitCamera& orbit) {
  return {orbit.target + orbit.distance * back_of(orbit), orbit.target, {0, 1, 0}, orbit.vertical_fov_deg};
}

void turn(OrbitCamera& orbit, float right, float up) {
  orbit.yaw = std::remainder(orbit.yaw + right, 2 * std::numbers::pi_v<float>);
  orbit.pitch = std::clamp(orbit.pitch + up, -kMaxPitch, kMaxPitch);
}

void pan(OrbitCamera& orbit, float x, float y) {
  const float height = 2 * orbit.distance * std::tan(0.5F * orbit.vertical_fov_deg * kRadiansPerDegree);
  const Vec3 back = back_of(orbit);
  const Vec3 right = normalize(cross(Vec3{0, 1, 0}, back));
  const Vec3 up = cross(back, right);
  orbit.target -= height * (x * right + y * up);
}

void zoom(OrbitCamera& orbit, float factor) {
  orbit.distance = std::clamp(orbit.distance * factor, 1e-3F, 1e5F);
}

}  // namespace hooke::render
