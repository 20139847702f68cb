#pragma once

#include "hooke/math.h"
#include "hooke/session/action.h"

#include "render/orbit_camera.h"

#include <array>
#include <optional>

namespace hooke::app {

/// The camera of a window: which line of sight belongs to which pixel. Pixels count from the top left corner
/// of the window, in screen units.
struct Eye {
  DVec3 place = {};            ///< In the world [m].
  DVec3 forward = {0, 0, -1};  ///< Unit length, as the two that follow.
  DVec3 right = {1, 0, 0};
  DVec3 up = {0, 1, 0};
  double half_height = 1;           ///< Half the picture's height at distance 1.
  std::array<double, 2> size = {};  ///< Width and height of the window.
  double sight = 1000;              ///< How far one sees [m].
};

/// Returns the eye of a camera whose coordinates count from `origin` [m].
Eye eye_of(const render::OrbitCamera& camera, DVec3 origin, double width, double height);

/// The line of sight through a pixel.
Ray ray_through(const Eye& eye, std::array<double, 2> pixel);

/// How far a place is in front of the eye, along `forward` [m].
double depth_of(const Eye& eye, DVec3 place);

/// The place that is seen at a pixel at a depth [m].
DVec3 place_at(const Eye& eye, std::array<double, 2> pixel, double depth);

/// Where a place is seen; nothing if it is behind the eye.
std::optional<std::array<double, 2>> pixel_of(const Eye& eye, DVec3 place);

}  // namespace hooke::app
