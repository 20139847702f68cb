#include "hooke/view/eye.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::app {

Eye eye_of(const render::OrbitCamera& camera, DVec3 origin, double width, double height) {
  const render::Camera seen = render::camera_of(camera);
  Eye eye;
  eye.place = origin + vector_cast<double>(seen.eye);
  eye.forward = normalize(vector_cast<double>(seen.target - seen.eye));
  eye.right = normalize(cross(eye.forward, vector_cast<double>(seen.up)));
  eye.up = cross(eye.right, eye.forward);
  eye.half_height = std::tan(0.5 * static_cast<double>(seen.vertical_fov_deg) * std::numbers::pi / 180);
  eye.size = {std::max(width, 1.0), std::max(height, 1.0)};
  eye.sight = std::max(1000.0, 100 * static_cast<double>(camera.distance));
  return eye;
}

DVec3 place_at(const Eye& eye, std::array<double, 2> pixel, double depth) {
  const auto& [width, height] = eye.size;
  const double x = (2 * pixel[0] - width) / height * eye.half_height;
  const double y = (height - 2 * pixel[1]) / height * eye.half_height;
  return eye.place + depth * (eye.forward + x * eye.right + y * eye.up);
}

Ray ray_through(const Eye& eye, std::array<double, 2> pixel) {
  return {eye.place, eye.sight * normalize(place_at(eye, pixel, 1) - eye.place)};
}

double depth_of(const Eye& eye, DVec3 place) {
  return dot(place - eye.place, eye.forward);
}

std::optional<std::array<double, 2>> pixel_of(const Eye& eye, DVec3 place) {
  const double depth = depth_of(eye, place);
  if (!(depth > 0)) return {};
  const DVec3 offset = 1 / depth * (place - eye.place);
  const double scale = eye.size[1] / (2 * eye.half_height);
  return std::array<double, 2>{eye.size[0] / 2 + scale * dot(offset, eye.right),
                               eye.size[1] / 2 - scale * dot(offset, eye.up)};
}

}  // namespace hooke::app
