#include "geometry/mesh/simplify.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

namespace hooke::geometry {

namespace {

// Share of the squared length of an edge in the quadric of its ends. It keeps points apart in a plane, where
// every place is as good as another.
constexpr double kLengthShare = 1e-6;
// Least cosine between the normals of a triangle before and after a collapse.
constexpr double kTurnCosine = 0.2;

/// The sum of squared distances from planes, weighed by area: x^T A x + 2 b^T x + c.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  DVec3 b = {};
  double c = 0;

  void add(const Quadric& q) {
    xx += q.xx;
    xy += q.xy;
    xz += q.xz;
    yy += q.yy;
    yz += q.yz;
    zz += q.zz;
    b += q.b;
    c += q.c;
  }

  [[nodiscard]] DVec3 times(DVec3 p) const {
    return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
  }

  [[nodiscard]] double at(DVec3 p) const { return dot(p, times(p)) + 2 * dot(b, p) + c; }

  /// The point of least value by Cramer's rule; `otherwise` where the planes leave a direction open.
  [[nodiscard]] DVec3 lowest(DVec3 otherwise) const {
    const DVec3 r0 = {xx, xy, xz};
    const DVec3 r1 = {xy, yy, yz};
    const DVec3 r2 = {xz, yz, zz};
    const DVec3 c12 = cross(r1, r2);
    const double determinant = dot(r0, c12);
    const double trace = xx + yy + zz;
    if (!(determinant > 1e-6 * trace * trace * trace)) return otherwise;
    return -1 / determinant * (b.x * c12 + b.y * cross(r2, r0) + b.z * cross(r0, r1));
  }
};

Quadric quadric_of(DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 across = cross(b - a, c - a);
  const double twice_area = length(across);
  if (!(twice_area > 0)) return {};
  const DVec3 n = 1 / twice_area * across;
  const double offset = -dot(n, a);
  const double w = 0.5 * twice_area;
  return {w * n.x * n.x, w * n.x * n.y, w * n.x * n.z,    w * n.y * n.y,
          w * n.y * n.z, w * n.z * n.z, (w * offset) * n, w * offset * offset};
}

/// The mesh while edges collapse.
class Simplifier {
 public:
  explicit Simplifier(const MeshDesc& mesh)
      : origin_(vector_cast<double>(mesh.positions[mesh.triangles[0][0]])),
        triangles_(mesh.triangles),
        alive_(mesh.triangles.size(), 1) {
    for (const Vec3 p : mesh.positions) points_.push_back(vector_cast<double>(p) - origin_);
    around_.resize(points_.size());
    quadrics_.resize(points_.size());
    revision_.resize(points_.size(), 0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t];
      const Quadric q = quadric_of(points_[a], points_[b], points_[c]);
      for (const std::uint32_t v : triangles_[t]) {
        around_[v].push_back(t);
        quadrics_[v].add(q);
      }
    }
  }

  MeshDesc run(std::size_t triangles_max) {
    std::size_t left = triangles_.size();
    for (const Edge& edge : compute_topology(points_.size(), triangles_).edges) offer(edge[0], edge[1]);
    while (left > triangles_max && !waiting_.empty()) {
      const Collapse next = waiting_.top();
      waiting_.pop();
      if (revision_[next.a] != next.revision_a || revision_[next.b] != next.revision_b) continue;
      if (!may_collapse(next)) continue;
      left -= collapse(next);
    }
    return remaining();
  }

 private:
  /// A possible collapse of the edge from a to b, a < b, to a point.
  struct Collapse {
    double cost = 0;
    std::uint32_t a = 0, b = 0;
    std::uint32_t revision_a = 0, revision_b = 0;
    DVec3 point = {};

    bool operator<(const Collapse& other) const {  // The queue gives the largest first.
      return std::tie(other.cost, other.a, other.b) < std::tie(cost, a, b);
    }
  };

  void offer(std::uint32_t a, std::uint32_t b) {
    if (b < a) std::swap(a, b);
    Quadric q = quadrics_[a];
    q.add(quadrics_[b]);
    const DVec3 middle = 0.5 * (points_[a] + points_[b]);
    const DVec3 along = points_[b] - points_[a];
    DVec3 point = q.lowest(middle);
    // A far point of least value comes from planes that are nearly parallel.
    if (!(length_squared(point - middle) <= length_squared(along))) point = middle;
    const double spread = kLengthShare * (q.xx + q.yy + q.zz) * dot(along, along);
    waiting_.push({std::max(q.at(point), 0.0) + spread, a, b, revision_[a], revision_[b], point});
  }

  /// The vertices that share a triangle with `v`, ascending.
  void neighbors_of(std::uint32_t v, std::vector<std::uint32_t>& found) const {
    found.clear();
    for (const std::uint32_t t : around_[v]) {
      for (const std::uint32_t w : triangles_[t]) {
        if (w != v) found.push_back(w);
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

  [[nodiscard]] bool has(std::uint32_t triangle, std::uint32_t v) const {
    const Triangle& t = triangles_[triangle];
    return t[0] == v || t[1] == v || t[2] == v;
  }

  /// Whether the surface stays closed, with two triangles an edge, and no triangle turns over. The ends may
  /// have no more neighbors in common than the two triangles at the edge give them.
  bool may_collapse(const Collapse& c) {
    neighbors_of(c.a, near_a_);
    neighbors_of(c.b, near_b_);
    std::size_t common = 0;
    for (const std::uint32_t v : near_a_) common += std::binary_search(near_b_.begin(), near_b_.end(), v);
    if (common != 2 || near_a_.size() + near_b_.size() < 8) return false;
    return !flips(c.a, c.b, c.point) && !flips(c.b, c.a, c.point);
  }

  [[nodiscard]] bool flips(std::uint32_t moved, std::uint32_t other, DVec3 to) const {
    return std::any_of(around_[moved].begin(), around_[moved].end(), [&](std::uint32_t t) {
      if (has(t, other)) return false;
      DVec3 now[3];
      DVec3 then[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = triangles_[t][k];
        now[k] = points_[v];
        then[k] = v == moved ? to : now[k];
      }
      const DVec3 before = cross(now[1] - now[0], now[2] - now[0]);
      const DVec3 after = cross(then[1] - then[0], then[2] - then[0]);
      return !(dot(before, after) > kTurnCosine * length(before) * length(after));
    });
  }

  /// Moves a to the point and gives it the triangles of b. Returns the number of triangles that went.
  std::size_t collapse(const Collapse& c) {
    std::size_t gone = 0;
    points_[c.a] = c.point;
    quadrics_[c.a].add(quadrics_[c.b]);
    for (const std::uint32_t t : around_[c.b]) {
      if (has(t, c.a)) {
        alive_[t] = 0;
        ++gone;
        for (const std::uint32_t v : triangles_[t]) {
          if (v != c.b) std::erase(around_[v], t);
        }
        continue;
      }
      for (std::uint32_t& v : triangles_[t]) v = v == c.b ? c.a : v;
      around_[c.a].push_back(t);
    }
    around_[c.b].clear();
    ++revision_[c.a];
    ++revision_[c.b];
    neighbors_of(c.a, near_a_);
    for (const std::uint32_t v : near_a_) offer(c.a, v);
    return gone;
  }

  [[nodiscard]] MeshDesc remaining() const {
    MeshDesc mesh;
    std::vector<std::uint32_t> place(points_.size(), kNone);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (alive_[t] == 0) continue;
      Triangle made = triangles_[t];
      for (std::uint32_t& v : made) {
        if (place[v] == kNone) {
          place[v] = static_cast<std::uint32_t>(mesh.positions.size());
          mesh.positions.push_back(vector_cast<Real>(origin_ + points_[v]));
        }
        v = place[v];
      }
      mesh.triangles.push_back(made);
    }
    return mesh;
  }

  DVec3 origin_;  // Near the mesh, so that quadrics lose nothing far from zero.
  std::vector<DVec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> alive_;
  std::vector<std::vector<std::uint32_t>> around_;  // Living triangles at each vertex.
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> revision_;  // Counts how often a vertex changed, so that old offers are known.
  std::priority_queue<Collapse> waiting_;
  std::vector<std::uint32_t> near_a_, near_b_;
};

}  // namespace

MeshDesc simplify(const MeshDesc& mesh, std::size_t triangles_max) {
  if (mesh.triangles.size() <= triangles_max) return mesh;
  return Simplifier(mesh).run(triangles_max);
}

}  // namespace hooke::geometry
