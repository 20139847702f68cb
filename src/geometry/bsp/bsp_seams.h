#pragma once

#include "hooke/result.h"

#include "geometry/bsp/bsp_space.h"
#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// From exact pieces to a closed mesh.

namespace hooke::geometry {

/// A vertex of a piece's outline.
struct SeamCorner {
  std::uint32_t vertex = 0;
  bool is_straight = false;  ///< Not a corner: a corner of another piece on this one's edge.
};

/// Pieces whose edges meet whole: where corners of others lie on an edge, it goes from one to the next.
struct SeamedPieces {
  std::vector<std::uint32_t> vertices = {};            ///< Points, by x, y, z; no two at the same place.
  std::vector<std::vector<SeamCorner>> outlines = {};  ///< One for each piece, in its order.
};

/// Welds corners at the same place, and divides edges at the corners that lie on them (T-junctions). An error
/// that names the triangles where the surface is not closed: each edge must be gone along as often one way as
/// the other.
Result<SeamedPieces> seam_pieces(const BspSpace& space, std::span<const BspPiece> pieces);

/// The triangles of a closed surface.
struct SeamedTriangles {
  std::vector<std::uint32_t> points = {};  ///< Of each vertex; several vertices may share a point.
  std::vector<Triangle> triangles = {};
  std::vector<std::uint32_t> pieces = {};  ///< The piece that each triangle belongs to.
};

/// Triangulates the outlines. Every edge of the result has exactly two triangles and the triangles at every
/// vertex form one fan: where the solid touches itself along an edge or in a vertex, the vertices there are
/// doubled, so that the solid parts part.
SeamedTriangles triangulate(const BspSpace& space, std::span<const BspPiece> pieces,
                            const SeamedPieces& seamed);

}  // namespace hooke::geometry
