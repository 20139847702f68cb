#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <span>
#include <vector>

/// \file
/// Makes meshes for bodies. Needs no World.

namespace hooke {

/// A landscape: point (column, row) lies at (column cell, heights[row * columns + column], row cell) in the
/// mesh's frame [m]; the upper side is outside. Each cell is cut from (column, row) to (column + 1, row + 1).
///
/// Errors: columns and rows outside [2, 4096], a cell that is not positive and finite, another number of
/// heights than columns x rows, a height that is not finite.
[[nodiscard]] Result<MeshDesc> make_height_field(int columns, int rows, Real cell,
                                                 std::span<const Real> heights);

/// Convex meshes that together are about the given solid: for bodies that move, each as the hull of a part
/// (Shape::hull_of). The solid is cut by planes, the deepest part first, until the surface lies nowhere
/// deeper than `concavity_max` [m] below its part's hull, or there are `parts_max` parts. Where the solid is
/// concave the parts are larger than it, and they may overlap a little; left out is only what is thinner than
/// 1e-4 of its extent. Takes about a second for 2,000 triangles: for loading, not between steps.
///
/// Errors: a mesh that is not closed or faces inward, a solid thinner than 1e-4 of its extent, a concavity
/// that is not positive and finite, parts outside [1, 256].
[[nodiscard]] Result<std::vector<MeshDesc>> decompose_convex(const MeshDesc& mesh, Real concavity_max,
                                                             int parts_max);

}  // namespace hooke
