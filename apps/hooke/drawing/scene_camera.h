#pragma once

#include "hooke/scene_io.h"

namespace hooke::app {

/// A Viewpoint is where a picture is taken from.
struct Viewpoint {
  DVec3 eye = {2, 1.5, 4};   ///< [m]
  DVec3 target = {0, 1, 0};  ///< [m]
  float vertical_fov_deg = 45;
};

/// Returns the camera of a scene at a time [s]. Between keyframes it moves along a smooth curve; before the
/// first and after the last it stands still.
Viewpoint viewpoint_at(const SceneCamera& camera, double time);

/// Returns a view of a box along the axes from the front, a little from above and from the right. A box
/// without size is seen from 1 m.
Viewpoint viewpoint_of_box(DVec3 low, DVec3 high);

}  // namespace hooke::app
