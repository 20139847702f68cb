#pragma once

#include "hooke/session/insight.h"

#include "render/draw_list.h"

namespace hooke::app {

/// Adds a debug picture to a list whose camera is set: lines and points lie on top of everything, triangles a
/// little in front of the surfaces that they color. `origin` is the list's [m], `pixel` the size that one
/// pixel covers at a distance of one meter [m].
void add_insight(const Insight& insight, DVec3 origin, float pixel, render::DrawList& list);

}  // namespace hooke::app
