#pragma once

#include "hooke/math.h"

#include "solver/surface/surface_mesh.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Where surfaces go through each other, as they may where a scene begins, and which part of them is to go
/// back. What is apart stays apart by the guarantee, so that only objects which are new, were placed by hand
/// or crossed something a step ago are looked at (state::Surface::may_cross).

namespace hooke::solver {

/// An edge that goes through a triangle.
struct SurfaceCrossing {
  std::array<std::uint32_t, 2> end = {};     ///< Vertices of the edge.
  std::array<std::uint32_t, 3> corner = {};  ///< Vertices of the triangle.
  std::array<double, 3> weight = {};         ///< Weights of the corners where they meet, with the sum 1.
  DVec3 place = {};                          ///< That place, from the origin of the positions [m].
  DVec3 normal = {};           ///< Normal of the triangle, of unit length; outward if it is a solid's.
  double along = 0;            ///< Share of the edge, from its first end, at which they meet.
  std::uint8_t front_end = 0;  ///< Which end of the edge lies in front of the triangle: 0 or 1.
  bool edge_is_first = false;  ///< Whether the edge belongs to the first one of the two surfaces.
};

/// Finds all crossings of two surfaces, or of one with itself if both are the same, in an order that depends
/// on the tables only. Signs are exact. Edges and triangles that share a vertex, or vertices that hooks hold
/// together, do not cross; nor does what only touches, with an end within `reserve` [m] of the plane of the
/// triangle. `position` is that of each vertex.
void find_crossings(const SurfaceMeshes& surfaces, std::uint32_t first, std::uint32_t second,
                    std::span<const DVec3> position, double reserve, std::vector<SurfaceCrossing>& found);

/// Lists the vertices that have come through the other surface and are to go back, in ascending order: what
/// is inside a solid, else all but the largest of the parts into which the crossings cut a surface. Of the
/// two surfaces the one with fewer such vertices goes back. The list is empty if the crossings cut neither,
/// as two sheets that are slotted into each other.
void list_passed(const state::Tables& tables, const SurfaceMeshes& surfaces, std::uint32_t first,
                 std::uint32_t second, std::span<const SurfaceCrossing> crossings,
                 std::vector<std::uint32_t>& passed);

}  // namespace hooke::solver
