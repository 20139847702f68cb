#pragma once

#include "hooke/bsp.h"
#include "hooke/result.h"

#include "geometry/bsp/bsp_space.h"

#include <cstdint>
#include <vector>

/// \file
/// Trees over exact pieces of triangles, as they are built and merged. BspTree is the tree for queries.

namespace hooke::geometry {

struct BspSplitNode {
  std::uint32_t plane = 0;
  std::uint32_t above = kBspEmpty;  ///< Node or leaf.
  std::uint32_t below = kBspEmpty;
  std::uint32_t first_face = 0;  ///< Index in BspPieces::faces.
  std::uint32_t face_count = 0;  ///< Pieces that lie in the plane; 0 for a cut along an axis.
};

/// A tree whose leaves are all empty or all solid. A node comes before the nodes below it.
struct BspPieces {
  std::vector<BspSplitNode> nodes = {};
  std::vector<BspPiece> faces = {};
};

/// Builds the tree over pieces that bound a solid. At each node it takes the plane with the least
///   |above - below| + 4 cut
/// (numbers of pieces, counted on a sample): among the planes of sampled pieces, and while these are many
/// also among planes across the axes at the median piece. A plane across an axis is taken only where both
/// sides have pieces and no side has nearly all, so that every leaf touches a face, which says whether it is
/// solid. So at most log_{6/5} n + n nodes lie on the path to a leaf. The same pieces give the same tree on
/// every machine. Returns an error if cutting makes more than 64 pieces of each, and 10^6.
Result<BspPieces> build_pieces(BspSpace& space, const std::vector<BspPiece>& pieces);

/// The position of a piece relative to a solid.
enum class BspClass : std::uint8_t {
  kOutside,
  kInside,
  kSame,      ///< On its surface, facing the same side.
  kOpposite,  ///< On its surface, facing the other side.
};

struct ClassifiedPiece {
  BspPiece piece = {};
  BspClass where = BspClass::kOutside;
};

/// Appends the piece, cut as little as its class needs: parts of one class are not cut from each other.
void classify_pieces(BspSpace& space, const BspPieces& tree, const BspPiece& piece,
                     std::vector<ClassifiedPiece>& classified);

}  // namespace hooke::geometry
