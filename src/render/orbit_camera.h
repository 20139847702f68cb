#pragma once

#include "render/draw_list.h"

namespace hooke::render {

/// This camera is on a sphere about its target, with the y axis up.
struct OrbitCamera {
  Vec3 target;
  float distance = 5;  ///< [m]
  float yaw = 0;       ///< Angle about y [rad]; 0 looks along -z.
  float pitch = 0;     ///< Angle above the horizontal [rad], -89 to 89 degrees.
  float vertical_fov_deg = 45;
};

/// Makes the orbit camera that sees what `camera` sees, except its roll. An eye on its target moves back by 1
/// m.
OrbitCamera make_orbit_camera(const Camera& camera);

Camera camera_of(const OrbitCamera& orbit);

/// Rotates by the angles [rad]; positive `right` moves the eye to the right, positive `up` upward.
void turn(OrbitCamera& orbit, float right, float up);

/// Moves eye and target so that the picture follows the mouse. `x` (to the right) and `y` (upward) are shares
/// of the picture's height, at the target's depth.
void pan(OrbitCamera& orbit, float x, float y);

/// Multiplies the distance and keeps it between 1 mm and 100 km.
void zoom(OrbitCamera& orbit, float factor);

}  // namespace hooke::render
