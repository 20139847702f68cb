#pragma once

#include "render/draw_list.h"

namespace hooke::render {

/// A camera on a sphere about its target, with the y axis up.
struct OrbitCamera {
  Vec3 target;
  float distance = 5;  ///< [m]
  float yaw = 0;       ///< About y; 0 looks along -z [rad].
  float pitch = 0;     ///< Above the horizontal, -89 to 89 degrees [rad].
  float vertical_fov_deg = 45;
};

/// The orbit camera that sees what `camera` sees, up to its roll. An eye on its target moves back by 1 m.
OrbitCamera make_orbit_camera(const Camera& camera);

Camera camera_of(const OrbitCamera& orbit);

/// Turns by the angles [rad]; positive `right` moves the eye to the right, positive `up` upward.
void turn(OrbitCamera& orbit, float right, float up);

/// Moves eye and target so that the picture follows the mouse: by parts of the picture's height, at the
/// target's depth, positive x to the right and y upward.
void pan(OrbitCamera& orbit, float x, float y);

/// Multiplies the distance, within 1 mm and 100 km.
void zoom(OrbitCamera& orbit, float factor);

}  // namespace hooke::render
