#pragma once

#include "hooke/result.h"

#include "render/draw_list.h"

/// \file
/// Hidden surfaces by the order of a BSP tree instead of by depth (the paper's 5.2.2): what a picture was
/// without a depth buffer.

namespace hooke::render {

/// Replaces the opaque meshes of the list by one whose triangles run from far to near as the camera sees
/// them, so that each covers what it hides: painter's order (Fuchs, Kedem and Naylor 1980). Triangles that
/// hide each other, or go through each other, are cut. What is holed or see-through, ropes, spheres, lines
/// and the ground are drawn after them, by depth. The tree is built for the one list: half a second for
/// 100,000 triangles. Errors: triangles that cut each other into too many pieces, a list without opaque
/// triangles.
Result<void> paint_in_order(DrawList& list);

}  // namespace hooke::render
