#pragma once

#include "geometry/triangle_mesh.h"

#include <cstddef>

namespace hooke::geometry {

/// Returns the mesh with at most `triangles_max` triangles, if it can: edges are collapsed, the one first
/// whose new point lies nearest to the planes that its ends stand for (Garland and Heckbert 1997, Surface
/// simplification using quadric error metrics). A closed surface stays closed: an edge is left alone whose
/// collapse would give an edge more than two triangles, or would turn a triangle over. Precondition: a mesh
/// that validate_solid accepts. The result is the same on every machine.
[[nodiscard]] MeshDesc simplify(const MeshDesc& mesh, std::size_t triangles_max);

}  // namespace hooke::geometry
