#include "geometry/bsp/bsp_seams.h"

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "base/sort_unique.h"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>

namespace hooke::geometry {

namespace {

/// An edge of a piece, or a part of one.
struct Side {
  std::uint32_t low = 0;  // vertices, low < high
  std::uint32_t high = 0;
  std::uint32_t piece = 0;
  std::uint32_t corner = 0;  // number of the piece's corner where its whole edge begins
  bool is_forward = false;   // from low to high

  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.piece, a.corner) < std::tie(b.low, b.high, b.piece, b.corner);
  }
};

Side make_side(std::uint32_t from, std::uint32_t to, std::uint32_t piece, std::uint32_t corner) {
  return {std::min(from, to), std::max(from, to), piece, corner, from < to};
}

/// Calls `visit` for the sides of each edge; `sides` are sorted.
template <class Visit>
void visit_edges(std::span<const Side> sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) {
      ++end;
    }
    visit(sides.subspan(begin, end - begin));
  }
}

/// By how much the edge is passed more often forward than backward.
std::ptrdiff_t excess(std::span<const Side> sides) {
  const auto forward = std::count_if(sides.begin(), sides.end(), [](const Side& s) { return s.is_forward; });
  return 2 * forward - static_cast<std::ptrdiff_t>(sides.size());
}

/// Numbers the positions by x, y, z.
void weld_corners(const BspSpace& space, std::span<const BspPiece> pieces, SeamedPieces& seamed) {
  std::vector<std::uint32_t> points;
  for (const BspPiece& piece : pieces) {
    for (const BspCorner& corner : piece.corners) points.push_back(corner.point);
  }
  base::sort_unique(points);
  std::sort(points.begin(), points.end(), [&](std::uint32_t p, std::uint32_t q) {
    const int order = space.compare(p, q);
    return order != 0 ? order < 0 : p < q;
  });
  std::vector<std::uint32_t> vertex_of(space.point_count(), kNone);
  for (const std::uint32_t point : points) {
    if (seamed.vertices.empty() || space.compare(seamed.vertices.back(), point) != 0) {
      seamed.vertices.push_back(point);
    }
    vertex_of[point] = static_cast<std::uint32_t>(seamed.vertices.size() - 1);
  }
  for (const BspPiece& piece : pieces) {
    std::vector<SeamCorner>& outline = seamed.outlines.emplace_back();
    for (const BspCorner& corner : piece.corners) outline.push_back({vertex_of[corner.point], false});
  }
}

std::vector<Side> list_sides(std::span<const std::vector<SeamCorner>> outlines) {
  std::vector<Side> sides;
  for (std::uint32_t piece = 0; piece < outlines.size(); ++piece) {
    const std::vector<SeamCorner>& outline = outlines[piece];
    std::uint32_t corner = kNone;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      if (!outline[k].is_straight) ++corner;
      sides.push_back(make_side(outline[k].vertex, outline[(k + 1) % outline.size()].vertex, piece, corner));
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Vertices that may lie on edges of others, sorted along each axis.
class SeamVertices {
 public:
  SeamVertices(const BspSpace& space, const SeamedPieces& seamed,
               const std::vector<std::uint32_t>& candidates)
      : space_(space), seamed_(seamed) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sorted_[axis] = candidates;
      std::sort(sorted_[axis].begin(), sorted_[axis].end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(at(a, axis), a) < std::pair(at(b, axis), b);
      });
    }
  }

  /// The vertices strictly between the ends of the side, from low to high.
  [[nodiscard]] std::vector<std::uint32_t> between(const Side& side, const BspPiece& piece) const {
    std::span<const std::uint32_t> fewest = near(side, 0);
    for (std::size_t axis = 1; axis < 3; ++axis) {
      const auto some = near(side, axis);
      if (some.size() < fewest.size()) fewest = some;
    }
    std::vector<std::uint32_t> found;
    for (const std::uint32_t v : fewest) {
      // Vertices are numbered by position, so those between have numbers between.
      if (v <= side.low || v >= side.high) continue;
      if (space_.side_of(piece.corners[side.corner].edge_plane, seamed_.vertices[v]) != 0) continue;
      if (space_.side_of(piece.plane, seamed_.vertices[v]) != 0) continue;
      found.push_back(v);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  static constexpr double kSlack = 0x1p-14;  // positions are right to 2^-18 steps

  [[nodiscard]] double at(std::uint32_t vertex, std::size_t axis) const {
    return component(space_.point(seamed_.vertices[vertex]).place, static_cast<int>(axis));
  }

  [[nodiscard]] std::span<const std::uint32_t> near(const Side& side, std::size_t axis) const {
    const double a = at(side.low, axis);
    const double b = at(side.high, axis);
    const std::vector<std::uint32_t>& all = sorted_[axis];
    const auto begin = std::partition_point(
        all.begin(), all.end(), [&](std::uint32_t v) { return at(v, axis) < std::min(a, b) - kSlack; });
    const auto end = std::partition_point(
        begin, all.end(), [&](std::uint32_t v) { return at(v, axis) <= std::max(a, b) + kSlack; });
    return {begin, end};
  }

  const BspSpace& space_;
  const SeamedPieces& seamed_;
  std::array<std::vector<std::uint32_t>, 3> sorted_;
};

/// Divides the edges without a partner at the vertices that lie on them.
void divide_edges(const BspSpace& space, std::span<const BspPiece> pieces, SeamedPieces& seamed) {
  std::vector<Side> open;
  std::vector<std::uint32_t> candidates;
  const std::vector<Side> sides = list_sides(seamed.outlines);
  visit_edges(sides, [&](std::span<const Side> edge) {
    if (excess(edge) == 0) return;
    open.insert(open.end(), edge.begin(), edge.end());
    candidates.push_back(edge[0].low);
    candidates.push_back(edge[0].high);
  });
  base::sort_unique(candidates);
  const SeamVertices vertices(space, seamed, candidates);
  // The order is backward, so that the corners before keep their positions in the outline.
  std::sort(open.begin(), open.end(), [](const Side& a, const Side& b) {
    return std::tie(a.piece, b.corner) < std::tie(b.piece, a.corner);
  });
  for (const Side& side : open) {
    std::vector<std::uint32_t> found = vertices.between(side, pieces[side.piece]);
    if (!side.is_forward) std::reverse(found.begin(), found.end());
    std::vector<SeamCorner>& outline = seamed.outlines[side.piece];
    std::vector<SeamCorner> inserted(found.size());
    std::transform(found.begin(), found.end(), inserted.begin(), [](std::uint32_t v) {
      return SeamCorner{v, true};
    });
    outline.insert(outline.begin() + side.corner + 1, inserted.begin(), inserted.end());
  }
}

std::string triangle_name(std::uint32_t triangle) {
  return std::string("triangles[").append(std::to_string(triangle)).append("]");
}

Result<void> check_closed(std::span<const BspPiece> pieces, std::span<const Side> sides) {
  std::vector<Side> first;
  std::size_t count = 0;
  visit_edges(sides, [&](std::span<const Side> edge) {
    if (excess(edge) == 0) return;
    if (count++ == 0) first.assign(edge.begin(), edge.end());
  });
  if (count == 0) return {};
  const std::string where = "mesh." + triangle_name(pieces[first[0].piece].triangle);
  const std::string among = ", one of " + std::to_string(count) + " such edges; a solid's surface is closed";
  if (first.size() == 1)
    return Error{ErrorCode::kOutOfRange, where, "has an edge without a neighbor" + among};
  const std::string other = triangle_name(pieces[first[1].piece].triangle);
  if (first.size() == 2)
    return Error{ErrorCode::kOutOfRange, where, "and " + other + " face opposite sides" + among};
  return Error{ErrorCode::kOutOfRange, where,
               "and " + other + " share an edge with " + std::to_string(first.size()) + " triangles" + among};
}

}  // namespace

Result<SeamedPieces> seam_pieces(const BspSpace& space, std::span<const BspPiece> pieces) {
  SeamedPieces seamed;
  weld_corners(space, pieces, seamed);
  divide_edges(space, pieces, seamed);
  if (Result<void> closed = check_closed(pieces, list_sides(seamed.outlines)); !closed) return closed.error();
  return seamed;
}

namespace {

/// Cuts corners off a convex outline until it is a triangle. None of the triangles is flat. As long as there
/// are straight vertices, one that follows a corner is joined with the vertex before that corner, and both
/// become corners. What is left is never flat, because the corner's edges have different directions.
void cut_ears(std::vector<SeamCorner> outline, std::uint32_t piece, SeamedTriangles& result) {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    result.triangles.push_back({a, b, c});
    result.pieces.push_back(piece);
  };
  // The outline begins with a corner. Everything before `done` except the first vertex is cut off.
  while (outline.size() > 3) {
    const std::size_t count = outline.size();
    std::size_t straight = 0;
    while (straight < count && !outline[straight].is_straight) ++straight;
    if (straight == count) break;
    const std::size_t corner = (straight + count - 1) % count;
    const std::size_t before = (straight + count - 2) % count;
    add(outline[before].vertex, outline[corner].vertex, outline[straight].vertex);
    outline[before].is_straight = false;
    outline[straight].is_straight = false;
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(corner));
  }
  for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
    add(outline[0].vertex, outline[k].vertex, outline[k + 1].vertex);
  }
}

/// A triangle at an edge, for the order around it.
struct EdgeFace {
  std::uint32_t triangle = 0;
  std::uint32_t number = 0;  // number of the triangle's corner where the edge begins
  bool is_forward = false;
};

/// Joins the corners of triangles that remain neighbors.
class Fans {
 public:
  Fans(const BspSpace& space, std::span<const BspPiece> pieces, SeamedTriangles& mesh)
      : space_(space), pieces_(pieces), mesh_(mesh), sets_(3 * mesh.triangles.size()) {}

  void join(std::span<const Side> sides) {
    std::vector<EdgeFace> faces;
    for (const Side& side : sides) faces.push_back({side.piece, side.corner, side.is_forward});
    if (faces.size() > 2) sort_around(faces);
    // After a forward triangle the outside follows, after a backward one the solid.
    const std::size_t count = faces.size();
    for (std::size_t k = 0; k < count; ++k) {
      if (faces[k].is_forward) continue;
      std::size_t next = (k + 1) % count;
      if (!faces[next].is_forward) next = partner(faces, k);
      join(faces[k], faces[next]);
    }
  }

  /// Gives each fan its own vertex.
  void split_vertices() {
    std::vector<std::uint32_t> vertex_of(3 * mesh_.triangles.size(), kNone);
    const std::vector<std::uint32_t> points = std::move(mesh_.points);
    mesh_.points.clear();
    for (std::uint32_t corner = 0; corner < vertex_of.size(); ++corner) {
      std::uint32_t& vertex = mesh_.triangles[corner / 3][corner % 3];
      std::uint32_t& fan = vertex_of[sets_.root(corner)];
      if (fan == kNone) {
        fan = static_cast<std::uint32_t>(mesh_.points.size());
        mesh_.points.push_back(points[vertex]);
      }
      vertex = fan;
    }
  }

 private:
  using Normal = Vector3<math::WideInt>;

  /// Direction of the piece's outside, seen along its edge from low to high.
  [[nodiscard]] Normal outward(const EdgeFace& face) const {
    const BspPiece& piece = pieces_[mesh_.pieces[face.triangle]];
    const LatticeNormal& a = space_.plane(piece.plane).a;
    return piece.is_flipped == face.is_forward ? Normal{-a.x, -a.y, -a.z} : Normal{a.x, a.y, a.z};
  }

  /// Sorts counter-clockwise about the edge, seen against the direction from low to high.
  void sort_around(std::vector<EdgeFace>& faces) const {
    const Normal start = outward(faces[0]);
    // Any two planes that are not parallel give the edge's direction. From low to high x, y, z grow.
    Normal along;
    for (std::size_t k = 1; k < faces.size() && along == Normal{}; ++k) {
      along = cross(start, outward(faces[k]));
    }
    const int sign = along.x.sign() != 0   ? along.x.sign()
                     : along.y.sign() != 0 ? along.y.sign()
                                           : along.z.sign();
    if (sign < 0) along = -along;
    const auto rotation_sign = [&](const Normal& u, const Normal& v) {
      return dot(cross(u, v), along).sign();
    };
    // The quarter is 0: along the start, 1: less than half a turn, 2: half, 3: more.
    const auto quarter = [&](const Normal& v) {
      const int side = rotation_sign(start, v);
      if (side != 0) return side > 0 ? 1 : 3;
      return dot(start, v).sign() > 0 ? 0 : 2;
    };
    std::sort(faces.begin(), faces.end(), [&](const EdgeFace& a, const EdgeFace& b) {
      const auto u = outward(a);
      const auto v = outward(b);
      const int quarter_a = quarter(u);
      const int quarter_b = quarter(v);
      if (quarter_a != quarter_b) return quarter_a < quarter_b;
      const int side = rotation_sign(u, v);
      return side != 0 ? side > 0 : a.triangle < b.triangle;
    });
  }

  /// For surfaces that lie on each other, the partner is the forward one of the same rank among the forward
  /// ones.
  static std::size_t partner(std::span<const EdgeFace> faces, std::size_t backward) {
    std::size_t rank = 0;
    for (std::size_t k = 0; k < backward; ++k) rank += faces[k].is_forward ? 0 : 1;
    for (std::size_t k = 0; k < faces.size(); ++k) {
      if (faces[k].is_forward && rank-- == 0) return k;
    }
    return backward;
  }

  void join(const EdgeFace& a, const EdgeFace& b) {
    // The two pass the edge in opposite directions: the start of one is the end of the other.
    sets_.merge(3 * a.triangle + a.number, 3 * b.triangle + (b.number + 1) % 3);
    sets_.merge(3 * a.triangle + (a.number + 1) % 3, 3 * b.triangle + b.number);
  }

  const BspSpace& space_;
  std::span<const BspPiece> pieces_;
  SeamedTriangles& mesh_;
  base::DisjointSets sets_;
};

}  // namespace

SeamedTriangles triangulate(const BspSpace& space, std::span<const BspPiece> pieces,
                            const SeamedPieces& seamed) {
  SeamedTriangles mesh;
  mesh.points = seamed.vertices;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    cut_ears(seamed.outlines[piece], piece, mesh);
  }
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      sides.push_back(make_side(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3], t, k));
    }
  }
  std::sort(sides.begin(), sides.end());
  Fans fans(space, pieces, mesh);
  visit_edges(sides, [&](std::span<const Side> edge) { fans.join(edge); });
  fans.split_vertices();
  return mesh;
}

}  // namespace hooke::geometry
