#include "render/view.h"

#include <algorithm>
#include <numbers>

namespace hooke::render {

namespace {

std::array<Vec3, 8> corners_of(const Bounds& bounds) {
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {(i & 1U) != 0 ? bounds.high.x : bounds.low.x, (i & 2U) != 0 ? bounds.high.y : bounds.low.y,
                  (i & 4U) != 0 ? bounds.high.z : bounds.low.z};
  }
  return corners;
}

/// Returns some unit vector perpendicular to the unit vector `axis`.
Vec3 perpendicular_to(Vec3 axis) {
  const Vec3 other = std::abs(axis.y) < 0.9F ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
  return normalize(cross(axis, other));
}

/// Returns the matrix from world to camera coordinates, for the axes right, up and back.
Mat4 make_look(Vec3 right, Vec3 up, Vec3 back, Vec3 eye) {
  const Mat3 rotation = transpose(Mat3{right, up, back});
  return affine(rotation, -(rotation * eye));
}

/// Returns the matrix that scales the box to -1..1; z of the camera is negative in front of it.
Mat4 make_orthographic(const Bounds& box) {
  const Vec3 size = box.high - box.low;
  const Vec3 middle = center_of(box);
  return {{{2 / size.x, 0, 0, 0},
           {0, 2 / size.y, 0, 0},
           {0, 0, -2 / size.z, 0},
           {-2 * middle.x / size.x, -2 * middle.y / size.y, 2 * middle.z / size.z, 1}}};
}

/// Returns the next size of the series 2^(k/4), so that a scene whose size varies a little rarely changes it.
float rounded_up(float size) {
  return std::exp2(std::ceil(4 * std::log2(std::max(size, 1e-3F))) / 4);
}

float floor_to(float value, float step) {
  return std::floor(value / step) * step;
}

}  // namespace

bool is_empty(const Bounds& bounds) {
  return bounds.low.x > bounds.high.x;
}

void extend(Bounds& bounds, Vec3 point) {
  if (!is_finite(point)) return;
  bounds.low = {std::min(bounds.low.x, point.x), std::min(bounds.low.y, point.y),
                std::min(bounds.low.z, point.z)};
  bounds.high = {std::max(bounds.high.x, point.x), std::max(bounds.high.y, point.y),
                 std::max(bounds.high.z, point.z)};
}

void extend(Bounds& bounds, const Bounds& other) {
  if (is_empty(other)) return;
  extend(bounds, other.low);
  extend(bounds, other.high);
}

Vec3 center_of(const Bounds& bounds) {
  return 0.5F * (bounds.low + bounds.high);
}

Bounds transformed(const Bounds& bounds, const Mat4& affine_matrix) {
  Bounds result;
  if (is_empty(bounds)) return result;
  for (const Vec3 corner : corners_of(bounds)) extend(result, transform_point(affine_matrix, corner));
  return result;
}

float distance_to(const Bounds& bounds, Vec3 point) {
  const auto outside = [](float low, float high, float value) {
    return std::max(std::max(low - value, value - high), 0.0F);
  };
  return length(Vec3{outside(bounds.low.x, bounds.high.x, point.x),
                     outside(bounds.low.y, bounds.high.y, point.y),
                     outside(bounds.low.z, bounds.high.z, point.z)});
}

View make_view(const Camera& camera, float aspect, std::span<const Bounds> objects, const Ground* ground) {
  View view;
  view.eye = camera.eye;
  view.forward = normalize(camera.target - camera.eye);
  if (view.forward == Vec3{}) view.forward = {0, 0, -1};
  Vec3 right = normalize(cross(view.forward, camera.up));
  if (right == Vec3{}) right = perpendicular_to(view.forward);
  const Vec3 up = cross(right, view.forward);

  float nearest = std::max(length(camera.target - camera.eye), 1e-3F);
  view.reach = nearest;
  for (const Bounds& box : objects) {
    if (is_empty(box)) continue;
    nearest = std::min(nearest, distance_to(box, view.eye));
    for (const Vec3 corner : corners_of(box)) view.reach = std::max(view.reach, length(corner - view.eye));
  }
  if (ground != nullptr) nearest = std::min(nearest, std::abs(view.eye.y - ground->height));
  // With 24 bits of depth over a range of 1 : 2000, distances that differ by 1/8000 are still distinct at the
  // far end.
  view.near_distance = std::max(0.5F * nearest, view.reach / 2000);

  const float half_angle =
      0.5F * std::clamp(camera.vertical_fov_deg, 1.0F, 170.0F) * std::numbers::pi_v<float> / 180;
  const float half_height = std::tan(half_angle);
  view.up = half_height * up;
  view.right = half_height * aspect * right;
  const Mat4 projection = {{{1 / (half_height * aspect), 0, 0, 0},
                            {0, 1 / half_height, 0, 0},
                            {0, 0, -1, -1},
                            {0, 0, -2 * view.near_distance, 0}}};
  view.view_projection = projection * make_look(right, up, -view.forward, view.eye);
  return view;
}

ShadowView make_shadow_view(const View& view, const Bounds& casters, Vec3 direction, int map_size) {
  Vec3 back = normalize(direction);
  if (back == Vec3{}) back = {0, 1, 0};
  const Vec3 right = perpendicular_to(back);
  const Mat4 look = make_look(right, cross(back, right), back, Vec3{});

  // The camera sees a pyramid up to the farthest object. A shadow keeps its x and y in this frame, so only
  // casters inside the pyramid's outline matter.
  Bounds seen;
  extend(seen, transform_point(look, view.eye));
  for (int i = 0; i < 4; ++i) {
    const float side_x = (i & 1) != 0 ? 1.0F : -1.0F;
    const float side_y = (i & 2) != 0 ? 1.0F : -1.0F;
    const Vec3 ray = view.forward + side_x * view.right + side_y * view.up;
    extend(seen, transform_point(look, view.eye + view.reach * ray));
  }
  Bounds box = transformed(casters, look);
  if (is_empty(box)) box = {{-1, -1, -1}, {1, 1, 1}};
  const Vec3 low = {std::max(box.low.x, seen.low.x), std::max(box.low.y, seen.low.y), box.low.z};
  const Vec3 high = {std::min(box.high.x, seen.high.x), std::min(box.high.y, seen.high.y), box.high.z};
  if (low.x < high.x && low.y < high.y) box = {low, high};

  // There is a margin of the filter's width, and room to move by whole texels.
  const float side = rounded_up(1.02F * std::max(box.high.x - box.low.x, box.high.y - box.low.y));
  ShadowView shadow;
  shadow.texel_size = side / static_cast<float>(map_size);
  const Vec3 middle = center_of(box);
  const float x = floor_to(middle.x, shadow.texel_size);
  const float y = floor_to(middle.y, shadow.texel_size);
  const float slack = 8 * shadow.texel_size;
  box = {{x - 0.5F * side, y - 0.5F * side, box.low.z - slack},
         {x + 0.5F * side, y + 0.5F * side, box.high.z + slack}};
  shadow.depth = box.high.z - box.low.z;
  shadow.clip_matrix = make_orthographic(box) * look;
  const Mat4 to_texture = affine(Mat3{{0.5F, 0, 0}, {0, 0.5F, 0}, {0, 0, 0.5F}}, Vec3{0.5F, 0.5F, 0.5F});
  shadow.matrix = to_texture * shadow.clip_matrix;
  return shadow;
}

}  // namespace hooke::render
