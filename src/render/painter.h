#pragma once

#include "hooke/result.h"

#include "render/draw_list.h"

/// \file
/// Hides surfaces by the order of a BSP tree instead of by depth (the paper's 5.2.2), as was usual before
/// depth buffers.

namespace hooke::render {

/// Replaces the opaque meshes of the list by one whose triangles run from far to near as the camera sees
/// them, so that each covers what it hides. This is painter's order (Fuchs, Kedem and Naylor 1980). Triangles
/// that hide each other, or go through each other, are cut. Holed and see-through meshes, ropes, spheres,
/// lines and the ground are drawn afterwards, by depth. The tree is built for this list alone: half a second
/// for 100,000 triangles. Errors tell of triangles that cut each other into too many pieces, and of a list
/// without opaque triangles.
Result<void> paint_in_order(DrawList& list);

}  // namespace hooke::render
