#pragma once

#include "geometry/mesh/preselection.h"
#include "render/draw_list.h"

#include <optional>
#include <string_view>
#include <vector>

/// \file
/// Draws bounding volumes as lines, as in the paper's figure 7.

namespace hooke::render {

/// Returns the volume of that name, or nothing for other names and for "all_pairs", which has no volume.
std::optional<Preselection> bounding_volume_named(std::string_view name);

/// Adds the volume around the triangles as lines. Of a tree it draws the eight nodes three levels below its
/// root, or the leaves above them. `in_body` takes the geometry to its body's frame, where the volume is made
/// once; `body`, a rotation and a shift, takes it to the list's frame. A box along the axes is made in the
/// list's frame.
void add_bounding_lines(const MeshGeometry& mesh, const Mat4& in_body, const Mat4& body, Preselection kind,
                        std::vector<DrawLine>& lines);

}  // namespace hooke::render
