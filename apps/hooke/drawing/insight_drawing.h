#pragma once

#include "hooke/session/insight.h"
#include "hooke/view/eye.h"

#include "render/draw_list.h"

#include <array>
#include <vector>

namespace hooke::app {

/// Adds a debug picture to a list whose camera is set: lines and points lie on top of everything, triangles a
/// little in front of the surfaces that they color. `origin` is the list's [m], `pixel` the size that one
/// pixel covers at a distance of one meter [m].
void add_insight(const Insight& insight, DVec3 origin, float pixel, render::DrawList& list);

/// A number of a debug picture, and the pixel of what it is of.
struct SeenNumber {
  const Insight::Text* text = nullptr;
  std::array<double, 2> pixel = {};
};

/// Returns the numbers that are in sight and would not lie over one before them; `line_px` is the height of a
/// line. `left_out` is how many others are in sight.
std::vector<SeenNumber> numbers_with_room(const Insight& insight, const Eye& eye, double line_px,
                                          std::size_t& left_out);

}  // namespace hooke::app
