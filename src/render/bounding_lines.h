#pragma once

#include "geometry/mesh/preselection.h"
#include "render/draw_list.h"

#include <optional>
#include <string_view>
#include <vector>

/// \file
/// Bounding volumes as lines: the paper's figure 7.

namespace hooke::render {

/// The volume of that name; nothing for others, and for "all_pairs", which has none.
std::optional<Preselection> bounding_volume_named(std::string_view name);

/// Adds the volume around the triangles: of a tree the eight nodes three levels below its root, or the leaves
/// above them. `in_body` takes the geometry to its body's frame, where the volume is made once for all;
/// `body`, a turn and a shift, to the list's. A box along the axes is made in the list's frame.
void add_bounding_lines(const MeshGeometry& mesh, const Mat4& in_body, const Mat4& body, Preselection kind,
                        std::vector<DrawLine>& lines);

}  // namespace hooke::render
