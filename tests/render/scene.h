#pragma once

#include "render/draw_list.h"

namespace hooke::render_test {

/// A waving cloth with a texture, ropes, boxes, a sphere, a jelly, a fence with holes: one of each thing that
/// the renderer draws. `time` [s] moves the cloth.
render::DrawList make_scene(float time);

/// Squares of two colors, `squares` a side, 64 pixels each.
std::shared_ptr<const render::Image> make_checkers(int squares, render::Color a, render::Color b);

}  // namespace hooke::render_test
