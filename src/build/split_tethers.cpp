#include "build/split_tethers.h"

#include "base/sort_unique.h"
#include "geometry/orientation.h"

#include <cmath>
#include <limits>

namespace hooke::build {

namespace {

using geometry::Point2;
using state::Deformable;
using state::SpringClass;
using Triangles = std::span<const std::array<std::uint32_t, 3>>;

/// How far into its triangles the end of a tether is moved, so that its way leads beside points and edges and
/// never along them; as a share of the way to their middle. Any small one does.
constexpr double kInward = 1e-3;

/// An edge whose triangles part.
using CrackEdge = std::array<std::uint32_t, 2>;

/// Appends the edge between two triangles if they have other corners there after the splits.
void append_crack(const ElementMesh<3>& mesh, Triangles after, std::uint32_t e, std::uint32_t f,
                  std::vector<CrackEdge>& cracks) {
  CrackEdge edge = {};
  std::size_t count = 0;
  bool parts = false;
  for (const std::uint32_t p : mesh.corners[e]) {
    if (!mesh.has(f, p) || count == 2) continue;
    edge[count++] = p;
    parts = parts || corner_after(mesh, after, e, p) != corner_after(mesh, after, f, p);
  }
  if (parts) cracks.push_back({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
}

std::vector<CrackEdge> list_cracks(const ElementMesh<3>& mesh, Triangles after,
                                   std::span<const PointSplit> splits) {
  std::vector<CrackEdge> cracks;
  for (const PointSplit& split : splits) {
    for (const std::uint32_t e : split.moved) {
      for (const std::uint32_t f : mesh.incidence.of(split.particle)) {
        if (mesh.are_neighbors(e, f)) append_crack(mesh, after, e, f, cracks);
      }
    }
  }
  base::sort_unique(cracks);
  return cracks;
}

/// Edges that belong to one triangle only after the splits: all cracks, and the rim, which no straight way
/// within a grid crosses.
std::vector<CrackEdge> list_open_edges(const ElementMesh<3>& mesh, Triangles after) {
  std::vector<CrackEdge> edges;
  for (std::uint32_t e = 0; e < after.size(); ++e) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = after[e][k];
      const std::uint32_t b = after[e][(k + 1) % 3];
      const auto has_both = [&](std::uint32_t f) {
        const auto& c = after[f];
        return f != e && std::find(c.begin(), c.end(), a) != c.end() &&
               std::find(c.begin(), c.end(), b) != c.end();
      };
      const auto around = mesh.incidence.of(mesh.corners[e][k]);
      if (std::none_of(around.begin(), around.end(), has_both))
        edges.push_back({mesh.corners[e][k], mesh.corners[e][(k + 1) % 3]});
    }
  }
  return edges;
}

/// The form at rest of a cloth on a grid, as a plane.
class RestPlane {
 public:
  RestPlane(const state::Tables& t, const Deformable& cloth)
      : rest_(*cloth.surface.rest_points), first_(cloth.particles.first) {
    const auto at = [&](std::uint32_t index) {
      return vector_cast<double>(rest_[t.particles.row_of[first_ + index]]);
    };
    corner_ = at(0);
    right_ = normalize(at(1) - corner_);
    const DVec3 down = at(cloth.columns) - corner_;
    down_ = normalize(down - dot(down, right_) * right_);
  }

  [[nodiscard]] Point2 at(std::uint32_t particle) const {
    const DVec3 offset = vector_cast<double>(rest_[particle - first_]) - corner_;
    return {dot(offset, right_), dot(offset, down_)};
  }

  /// A place just inside the triangles that have `particle` before the splits and `copy` after them.
  [[nodiscard]] Point2 inside(const ElementMesh<3>& mesh, Triangles after, std::uint32_t particle,
                              std::uint32_t copy) const {
    Point2 sum;
    double count = 0;
    for (const std::uint32_t e : mesh.incidence.of(particle)) {
      if (corner_after(mesh, after, e, particle) != copy) continue;
      for (const std::uint32_t p : mesh.corners[e]) {
        const Point2 x = at(p);
        sum = {sum.x + x.x, sum.y + x.y};
        ++count;
      }
    }
    const Point2 x = at(particle);
    if (!(count > 0)) return x;
    return {x.x + kInward * (sum.x / count - x.x), x.y + kInward * (sum.y / count - x.y)};
  }

 private:
  const std::vector<Vec3>& rest_;
  std::uint32_t first_;
  DVec3 corner_, right_, down_;
};

bool are_apart(Point2 a, Point2 b, Point2 p, Point2 q) {
  return std::max(a.x, b.x) < std::min(p.x, q.x) || std::max(p.x, q.x) < std::min(a.x, b.x) ||
         std::max(a.y, b.y) < std::min(p.y, q.y) || std::max(p.y, q.y) < std::min(a.y, b.y);
}

bool cross(Point2 a, Point2 b, Point2 p, Point2 q) {
  if (are_apart(a, b, p, q)) return false;
  const auto is_left = [](Point2 from, Point2 to, Point2 x) {
    return geometry::orientation(from, to, x) >= 0;
  };
  return is_left(a, b, p) != is_left(a, b, q) && is_left(p, q, a) != is_left(p, q, b);
}

/// Tethers of a cloth, and what becomes of them.
struct TetherChanges {
  std::vector<std::uint32_t> copied;
  std::vector<std::uint32_t> ends;  ///< The free ends of the copies.
  std::vector<std::uint32_t> gone;
};

class GridTethers {
 public:
  GridTethers(const ElementMesh<3>& mesh, Triangles after, std::span<const PointSplit> splits,
              const Deformable& cloth, const state::Tables& t)
      : mesh_(mesh), after_(after), splits_(splits), plane_(t, cloth), added_(cloth.particles.end()) {
    for (const CrackEdge& edge : list_cracks(mesh, after, splits)) {
      lines_.push_back({plane_.at(edge[0]), plane_.at(edge[1])});
      for (const Point2& p : lines_.back()) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
      }
    }
  }

  /// Finds what becomes of the tether from `a` to the pin `b` in a row. Where an end splits, cracks from
  /// before may come to lie between it and the other.
  void change(std::uint32_t row, std::uint32_t a, std::uint32_t b, TetherChanges& changes) {
    if (lines_.empty() || are_apart(plane_.at(a), plane_.at(b), low_, high_)) return;
    if (is_cut(a, a, b, splits(a) || splits(b) ? open_lines() : lines_)) changes.gone.push_back(row);
    for (std::uint32_t i = 0; i < splits_.size(); ++i) {
      if (splits_[i].particle != a || is_cut(a, added_ + i, b, open_lines())) continue;
      changes.copied.push_back(row);
      changes.ends.push_back(added_ + i);
    }
  }

 private:
  using Line = std::array<Point2, 2>;

  [[nodiscard]] bool splits(std::uint32_t particle) const {
    return std::any_of(splits_.begin(), splits_.end(),
                       [=](const PointSplit& s) { return s.particle == particle; });
  }

  const std::vector<Line>& open_lines() {
    if (!open_lines_.empty()) return open_lines_;
    for (const CrackEdge& edge : list_open_edges(mesh_, after_))
      open_lines_.push_back({plane_.at(edge[0]), plane_.at(edge[1])});
    return open_lines_;
  }

  [[nodiscard]] bool is_cut(std::uint32_t a, std::uint32_t copy, std::uint32_t b,
                            const std::vector<Line>& lines) const {
    const Point2 from = plane_.inside(mesh_, after_, a, copy);
    const Point2 to = plane_.inside(mesh_, after_, b, b);
    return std::any_of(lines.begin(), lines.end(),
                       [&](const auto& line) { return cross(from, to, line[0], line[1]); });
  }

  const ElementMesh<3>& mesh_;
  Triangles after_;
  std::span<const PointSplit> splits_;
  RestPlane plane_;
  std::uint32_t added_;
  std::vector<Line> lines_;       ///< Edges that part now.
  std::vector<Line> open_lines_;  ///< All open ones; made when they are needed.
  Point2 low_ = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 high_ = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

/// Whether the shortest way of a tether along a curved surface may lead over a crack. It passes some edge of
/// the crack, and the end of that edge that is nearer lies within half of the edge: over that end the way is
/// longer by at most the edge, and chords are no longer than ways.
bool may_cross(const std::vector<Vec3>& rest, std::uint32_t first, const std::vector<CrackEdge>& cracks,
               const std::array<std::uint32_t, 2>& ends, Real reach) {
  const auto distance = [&](std::uint32_t p, std::uint32_t q) {
    return length(rest[p - first] - rest[q - first]);
  };
  return std::any_of(cracks.begin(), cracks.end(), [&](const CrackEdge& edge) {
    const Real longest = reach + distance(edge[0], edge[1]);
    return std::any_of(edge.begin(), edge.end(), [&](std::uint32_t p) {
      return distance(ends[0], p) + distance(p, ends[1]) <= longest;
    });
  });
}

TetherChanges list_changes(const ElementMesh<3>& mesh, Triangles after, std::span<const PointSplit> splits,
                           const Deformable& cloth, const state::Tables& t) {
  TetherChanges changes;
  const state::Springs& springs = t.springs;
  const auto for_each_tether = [&](auto visit) {
    for (std::uint32_t i = cloth.springs.first; i < cloth.springs.end(); ++i) {
      if (springs.kind[i] == SpringClass::kTether) visit(i, springs.particle_a[i], springs.particle_b[i]);
    }
  };
  const auto begin = springs.kind.begin() + cloth.springs.first;
  if (std::find(begin, begin + cloth.springs.count, SpringClass::kTether) == begin + cloth.springs.count)
    return changes;
  if (cloth.columns > 0) {
    GridTethers tethers(mesh, after, splits, cloth, t);
    for_each_tether([&](auto row, auto a, auto b) { tethers.change(row, a, b, changes); });
  } else {
    const std::vector<CrackEdge> cracks = list_cracks(mesh, after, splits);
    for_each_tether([&](auto row, auto a, auto b) {
      if (may_cross(*cloth.surface.rest_points, cloth.particles.first, cracks, {a, b},
                    springs.rest_length[row]))
        changes.gone.push_back(row);
    });
  }
  return changes;
}

}  // namespace

void split_tethers(std::uint32_t object, const ElementMesh<3>& mesh, Triangles after,
                   std::span<const PointSplit> splits, state::Tables& t) {
  const TetherChanges changes = list_changes(mesh, after, splits, t.objects[object], t);
  const std::uint32_t first_copy = t.objects[object].springs.end();
  change_rows(object, &Deformable::springs, t.springs, changes.copied, {}, t);
  for (std::size_t i = 0; i < changes.ends.size(); ++i)
    t.springs.particle_a[first_copy + i] = changes.ends[i];
  change_rows(object, &Deformable::springs, t.springs, {}, changes.gone, t);
}

}  // namespace hooke::build
