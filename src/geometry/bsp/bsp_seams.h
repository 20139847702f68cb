#pragma once

#include "hooke/result.h"

#include "geometry/bsp/bsp_space.h"
#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Turns exact pieces into a closed mesh.

namespace hooke::geometry {

/// A vertex of a piece's outline.
struct SeamCorner {
  std::uint32_t vertex = 0;
  bool is_straight = false;  ///< The vertex is not a corner of this piece, but one of another piece on this
                             ///< one's edge.
};

/// Pieces whose edges meet whole: an edge on which corners of other pieces lie is divided at them.
struct SeamedPieces {
  std::vector<std::uint32_t> vertices = {};            ///< Points, by x, y, z; no two at the same position.
  std::vector<std::vector<SeamCorner>> outlines = {};  ///< One for each piece, in its order.
};

/// Welds corners at the same position, and divides edges at the corners that lie on them (T-junctions). The
/// surface is closed if each edge is passed as often in one direction as in the other; otherwise an error
/// names the triangles.
Result<SeamedPieces> seam_pieces(const BspSpace& space, std::span<const BspPiece> pieces);

/// The triangles of a closed surface.
struct SeamedTriangles {
  std::vector<std::uint32_t> points = {};  ///< Point of each vertex; several vertices may share a point.
  std::vector<Triangle> triangles = {};
  std::vector<std::uint32_t> pieces = {};  ///< The piece that each triangle belongs to.
};

/// Triangulates the outlines. Every edge of the result has exactly two triangles and the triangles at every
/// vertex form one fan. Where the solid touches itself along an edge or in a vertex, the vertices are
/// doubled, so that the solid separates there.
SeamedTriangles triangulate(const BspSpace& space, std::span<const BspPiece> pieces,
                            const SeamedPieces& seamed);

}  // namespace hooke::geometry
