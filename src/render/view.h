#pragma once

#include "render/draw_list.h"

#include <array>
#include <span>

/// \file
/// Camera and shadow matrices: pure functions. Clip space is OpenGL's (-1 to 1 in all three).

namespace hooke::render {

/// A box along the axes. Empty while `low` exceeds `high`.
struct Bounds {
  Vec3 low = {1e30F, 1e30F, 1e30F};
  Vec3 high = {-1e30F, -1e30F, -1e30F};
};

bool is_empty(const Bounds& bounds);
/// Points that are not finite are left out.
void extend(Bounds& bounds, Vec3 point);
void extend(Bounds& bounds, const Bounds& other);
Vec3 center_of(const Bounds& bounds);
/// The box around the eight moved corners; empty stays empty.
Bounds transformed(const Bounds& bounds, const Mat4& affine_matrix);
/// Zero inside.
float distance_to(const Bounds& bounds, Vec3 point);

/// What the camera sees and how.
struct View {
  Mat4 view_projection;
  Vec3 eye;
  Vec3 right;    ///< Half the picture's width at distance 1.
  Vec3 up;       ///< Half the picture's height at distance 1.
  Vec3 forward;  ///< Unit length.
  float near_distance = 0.1F;
  float reach = 10;  ///< Distance of the farthest thing in the scene [m].
};

/// The view of `objects` (one box each) and of a ground plane, if any. The far plane is at infinity.
/// Degenerate cameras are repaired: eye on target looks along -z, `up` along the view becomes another axis.
View make_view(const Camera& camera, float aspect, std::span<const Bounds> objects, const Ground* ground);

/// An orthographic view from the sun around everything that may shadow what the camera sees.
struct ShadowView {
  Mat4 matrix;           ///< To texture space: 0 to 1 in x, y and depth.
  Mat4 clip_matrix;      ///< The same in clip space, for drawing the map.
  float texel_size = 0;  ///< [m]
};

/// `direction` points to the sun. The box moves and grows in steps, so that shadow edges do not crawl when
/// the scene moves a little.
ShadowView make_shadow_view(const View& view, const Bounds& casters, Vec3 direction, int map_size);

}  // namespace hooke::render
