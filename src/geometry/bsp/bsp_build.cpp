#include "geometry/bsp/bsp_build.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr std::size_t kFewPieces = 12;       // fewer are cut by their own planes only
constexpr std::size_t kCandidates = 8;       // planes of pieces that are tried at a node
constexpr std::size_t kSample = 128;         // pieces that a plane is tried on
constexpr std::size_t kCutWeight = 4;        // a cut piece costs as much as so many on the fuller side
constexpr std::size_t kPiecesPerPiece = 64;  // beyond this, and kManyPieces, a mesh is refused
constexpr std::size_t kManyPieces = 1'000'000;

using Pieces = std::vector<BspPiece>;

struct Counts {
  std::size_t above = 0;
  std::size_t below = 0;
  std::size_t cut = 0;
  std::size_t on = 0;

  [[nodiscard]] std::size_t cost() const {
    return (above > below ? above - below : below - above) + kCutWeight * cut;
  }
};

/// A node that waits for its pieces to be divided.
struct BuildTask {
  Pieces pieces = {};
  std::uint32_t parent = 0;
  bool is_above = false;
};

Counts count_sides(const BspSpace& space, const Pieces& pieces, std::uint32_t plane, std::size_t sample) {
  Counts counts;
  const std::size_t step = std::max<std::size_t>(1, pieces.size() / sample);
  for (std::size_t i = 0; i < pieces.size(); i += step) {
    switch (classify(space, pieces[i], plane)) {
      case BspSplit::kAbove:
        ++counts.above;
        break;
      case BspSplit::kBelow:
        ++counts.below;
        break;
      case BspSplit::kCut:
        ++counts.cut;
        break;
      case BspSplit::kOn:
        ++counts.on;
        break;
    }
  }
  return counts;
}

/// Both sides get pieces, and neither more than five sixths of them.
bool divides(const Counts& c) {
  const std::size_t all = c.above + c.below + c.cut + c.on;
  const auto is_less = [all](std::size_t side) { return side > 0 && 6 * side <= 5 * all; };
  return is_less(c.above + c.cut) && is_less(c.below + c.cut);
}

/// The plane across the axis at the median of the pieces' first corners.
std::uint32_t median_plane(BspSpace& space, const Pieces& pieces, std::size_t axis) {
  std::vector<double> places;
  const std::size_t step = std::max<std::size_t>(1, pieces.size() / kSample);
  for (std::size_t i = 0; i < pieces.size(); i += step) {
    places.push_back(component(space.point(pieces[i].corners[0].point).place, static_cast<int>(axis)));
  }
  const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
  std::nth_element(places.begin(), middle, places.end());
  const auto at = static_cast<std::int64_t>(std::floor(*middle));
  const LatticePoint p = {axis == 0 ? at : 0, axis == 1 ? at : 0, axis == 2 ? at : 0};
  return space.add_plane(p, {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0}).plane;
}

/// The best of the planes of some of the pieces; the first of equal ones.
std::pair<std::uint32_t, std::size_t> best_own_plane(const BspSpace& space, const Pieces& pieces) {
  std::pair<std::uint32_t, std::size_t> best = {pieces[0].plane, SIZE_MAX};
  const std::size_t tries = std::min(kCandidates, pieces.size());
  for (std::size_t i = 0; i < tries; ++i) {
    const std::uint32_t plane = pieces[i * pieces.size() / tries].plane;
    const std::size_t cost = count_sides(space, pieces, plane, kSample).cost();
    if (cost < best.second) best = {plane, cost};
  }
  return best;
}

std::uint32_t choose_plane(BspSpace& space, const Pieces& pieces) {
  auto [plane, cost] = best_own_plane(space, pieces);
  if (pieces.size() < kFewPieces) return plane;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t across = median_plane(space, pieces, axis);
    const std::size_t across_cost = count_sides(space, pieces, across, kSample).cost();
    if (across_cost >= cost) continue;
    // A sample is not enough here: all pieces are counted.
    if (!divides(count_sides(space, pieces, across, pieces.size()))) continue;
    plane = across;
    cost = across_cost;
  }
  return plane;
}

/// Moves the pieces to their sides; those in the plane become faces of the node.
void divide(BspSpace& space, Pieces& pieces, std::uint32_t plane, Pieces& above, Pieces& below,
            Pieces& faces) {
  for (BspPiece& piece : pieces) {
    BspPiece part_above;
    BspPiece part_below;
    switch (split(space, piece, plane, part_above, part_below)) {
      case BspSplit::kAbove:
        above.push_back(std::move(piece));
        break;
      case BspSplit::kBelow:
        below.push_back(std::move(piece));
        break;
      case BspSplit::kOn:
        faces.push_back(std::move(piece));
        break;
      case BspSplit::kCut:
        above.push_back(std::move(part_above));
        below.push_back(std::move(part_below));
        break;
    }
  }
}

}  // namespace

Result<BspPieces> build_pieces(BspSpace& space, const std::vector<BspPiece>& pieces) {
  BspPieces tree;
  const std::size_t limit = std::max(kManyPieces, kPiecesPerPiece * pieces.size());
  std::size_t waiting = pieces.size();
  std::vector<BuildTask> tasks;
  if (!pieces.empty()) tasks.push_back({.pieces = pieces});
  while (!tasks.empty()) {
    BuildTask task = std::move(tasks.back());
    tasks.pop_back();
    waiting -= task.pieces.size();
    const auto index = static_cast<std::uint32_t>(tree.nodes.size());
    if (index > 0) (task.is_above ? tree.nodes[task.parent].above : tree.nodes[task.parent].below) = index;
    BspSplitNode node = {.plane = choose_plane(space, task.pieces),
                         .first_face = static_cast<std::uint32_t>(tree.faces.size())};
    Pieces above;
    Pieces below;
    divide(space, task.pieces, node.plane, above, below, tree.faces);
    node.face_count = static_cast<std::uint32_t>(tree.faces.size()) - node.first_face;
    if (node.face_count > 0) {
      // A side without pieces is all empty or all solid; the face at its border says which.
      const bool is_empty_above = !tree.faces[node.first_face].is_flipped;
      node.above = is_empty_above ? kBspEmpty : kBspSolid;
      node.below = is_empty_above ? kBspSolid : kBspEmpty;
    }
    tree.nodes.push_back(node);
    waiting += above.size() + below.size();
    if (tree.faces.size() + waiting > limit) {
      return Error{
          ErrorCode::kLimitExceeded, "mesh.triangles",
          "the planes of the triangles cut each other into more than " + std::to_string(limit) + " pieces"};
    }
    if (!below.empty()) tasks.push_back({std::move(below), index, false});
    if (!above.empty()) tasks.push_back({std::move(above), index, true});
  }
  return tree;
}

namespace {

/// A piece that descends the tree. At a node in whose plane it lies, it descends above first, then below.
struct Descent {
  BspPiece piece = {};
  std::uint32_t node = 0;
  std::uint32_t lies_on = kBspEmpty;   // the node in whose plane it lies; kBspEmpty: none
  bool is_past_above = false;          // the descent above that node is done
  bool is_solid_above = false;         // result of that descent
  std::uint32_t first_part = 0;        // the first of its two parts, if it was cut; 0: not cut
  std::optional<BspClass> where = {};  // nothing if parts differ
};

BspClass class_of(const Descent& d, bool is_solid) {
  if (is_bsp_leaf(d.lies_on)) return is_solid ? BspClass::kInside : BspClass::kOutside;
  if (d.is_solid_above == is_solid) return is_solid ? BspClass::kInside : BspClass::kOutside;
  return d.is_solid_above == d.piece.is_flipped ? BspClass::kSame : BspClass::kOpposite;
}

/// Descends until the piece is cut or its class is known.
void descend(BspSpace& space, const BspPieces& tree, std::vector<Descent>& descents, std::size_t index) {
  Descent d = std::move(descents[index]);
  while (!d.where && d.first_part == 0) {
    if (is_bsp_leaf(d.node)) {
      const bool is_solid = d.node == kBspSolid;
      if (is_bsp_leaf(d.lies_on) || d.is_past_above) {
        d.where = class_of(d, is_solid);
      } else {
        d.is_solid_above = is_solid;
        d.is_past_above = true;
        d.node = tree.nodes[d.lies_on].below;
      }
      continue;
    }
    const BspSplitNode& node = tree.nodes[d.node];
    Descent above = {
        .lies_on = d.lies_on, .is_past_above = d.is_past_above, .is_solid_above = d.is_solid_above};
    Descent below = above;
    switch (split(space, d.piece, node.plane, above.piece, below.piece)) {
      case BspSplit::kAbove:
        d.node = node.above;
        break;
      case BspSplit::kBelow:
        d.node = node.below;
        break;
      case BspSplit::kOn:
        d.lies_on = d.node;
        d.node = node.above;
        break;
      case BspSplit::kCut:
        above.node = node.above;
        below.node = node.below;
        d.first_part = static_cast<std::uint32_t>(descents.size());
        descents.push_back(std::move(above));
        descents.push_back(std::move(below));
        break;
    }
  }
  descents[index] = std::move(d);
}

}  // namespace

void classify_pieces(BspSpace& space, const BspPieces& tree, const BspPiece& piece,
                     std::vector<ClassifiedPiece>& classified) {
  std::vector<Descent> descents;
  descents.push_back({.piece = piece, .node = tree.nodes.empty() ? kBspEmpty : 0});
  for (std::size_t i = 0; i < descents.size(); ++i) descend(space, tree, descents, i);
  // Parts come after the whole.
  for (std::size_t i = descents.size(); i-- > 0;) {
    const std::uint32_t part = descents[i].first_part;
    if (part > 0 && descents[part].where == descents[part + 1].where)
      descents[i].where = descents[part].where;
  }
  std::vector<std::size_t> waiting = {0};
  while (!waiting.empty()) {
    Descent& d = descents[waiting.back()];
    waiting.pop_back();
    if (d.where) {
      classified.push_back({std::move(d.piece), *d.where});
    } else {
      waiting.push_back(d.first_part + 1);
      waiting.push_back(d.first_part);
    }
  }
}

}  // namespace hooke::geometry
