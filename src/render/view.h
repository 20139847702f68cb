#pragma once

#include "render/draw_list.h"

#include <array>
#include <span>

/// \file
/// Computes camera and shadow matrices by pure functions. Clip space is that of OpenGL (-1 to 1 in all
/// three).

namespace hooke::render {

/// Bounds are a box along the axes. They are empty while `low` exceeds `high`.
struct Bounds {
  Vec3 low = {1e30F, 1e30F, 1e30F};
  Vec3 high = {-1e30F, -1e30F, -1e30F};
};

bool is_empty(const Bounds& bounds);
/// Extends the box to a point; points that are not finite are left out.
void extend(Bounds& bounds, Vec3 point);
void extend(Bounds& bounds, const Bounds& other);
Vec3 center_of(const Bounds& bounds);
/// Returns the box around the eight transformed corners; an empty box stays empty.
Bounds transformed(const Bounds& bounds, const Mat4& affine_matrix);
/// Returns the distance to the box, which is zero inside.
float distance_to(const Bounds& bounds, Vec3 point);

/// A View is what the camera sees and how.
struct View {
  Mat4 view_projection;
  Vec3 eye;
  Vec3 right;    ///< Half the picture's width at distance 1.
  Vec3 up;       ///< Half the picture's height at distance 1.
  Vec3 forward;  ///< Unit length.
  float near_distance = 0.1F;
  float reach = 10;  ///< Distance of the farthest thing in the scene [m].
};

/// Makes the view of `objects` (one box each) and of a ground plane, if any. The far plane is at infinity.
/// Degenerate cameras are repaired: an eye on its target looks along -z, and an `up` along the view becomes
/// another axis.
View make_view(const Camera& camera, float aspect, std::span<const Bounds> objects, const Ground* ground);

/// This is an orthographic view from the sun around everything that may shadow what the camera sees.
struct ShadowView {
  Mat4 matrix;           ///< Matrix to texture space: 0 to 1 in x, y and depth.
  Mat4 clip_matrix;      ///< Matrix to clip space, for drawing the map.
  float texel_size = 0;  ///< [m]
  float depth = 0;       ///< Length of the view along the sun's rays [m].
};

/// Makes the shadow view; `direction` points to the sun. The box moves and grows in steps, so that shadow
/// edges do not crawl when the scene moves a little.
ShadowView make_shadow_view(const View& view, const Bounds& casters, Vec3 direction, int map_size);

}  // namespace hooke::render
