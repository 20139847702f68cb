#include "geometry/bsp/bsp_slivers.h"

#include "base/sort_unique.h"
#include "geometry/closest.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace hooke::geometry {

namespace {

constexpr int kRounds = 16;
constexpr double kLift = 1.5;   // height of a lifted sliver, times the distance
constexpr double kFlat = 1e-3;  // height below which a triangle has no plane, times the distance

/// A manifold whose edges can be collapsed and flipped.
class Remesher {
 public:
  Remesher(const SolidMesh& mesh, double distance)
      : mesh_(mesh), around_(mesh.positions.size()), distance_(distance) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t vertex : mesh.triangles[t]) around_[vertex].push_back(t);
    }
  }

  /// Returns whether anything was changed.
  bool improve() {
    bool has_changed = false;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_alive(t)) continue;
      const std::array<double, 3> sides = {side(t, 0), side(t, 1), side(t, 2)};
      const auto shortest = std::min_element(sides.begin(), sides.end()) - sides.begin();
      const auto longest = std::max_element(sides.begin(), sides.end()) - sides.begin();
      if (sides[static_cast<std::size_t>(shortest)] <= distance_) {
        has_changed = collapse(t, static_cast<std::size_t>(shortest)) || has_changed;
      } else if (twice_area(t) <= distance_ * sides[static_cast<std::size_t>(longest)]) {
        has_changed = flip(t, static_cast<std::size_t>(longest)) || has_changed;
      }
    }
    return has_changed;
  }

  /// Lifts triangles where neither can be done: the corner over the longest edge is moved away from it, in
  /// the triangle's plane or in that of its neighbor, until it is high enough. Returns whether anything was
  /// changed.
  bool lift_rest() {
    bool has_changed = false;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_alive(t)) continue;
      const std::array<double, 3> sides = {side(t, 0), side(t, 1), side(t, 2)};
      const auto longest =
          static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
      if (twice_area(t) > distance_ * sides[longest]) continue;
      lift(t, longest);
      has_changed = true;
    }
    return has_changed;
  }

  /// The mesh without the triangles and vertices that were removed.
  [[nodiscard]] SolidMesh result() const {
    SolidMesh result;
    std::vector<std::uint32_t> number(mesh_.positions.size(), kNone);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_alive(t)) continue;
      Triangle& triangle = result.triangles.emplace_back(mesh_.triangles[t]);
      for (std::uint32_t& vertex : triangle) {
        if (number[vertex] == kNone) {
          number[vertex] = static_cast<std::uint32_t>(result.positions.size());
          result.positions.push_back(mesh_.positions[vertex]);
        }
        vertex = number[vertex];
      }
    }
    return result;
  }

 private:
  [[nodiscard]] bool is_alive(std::uint32_t t) const { return mesh_.triangles[t][0] != kNone; }
  [[nodiscard]] std::uint32_t corner(std::uint32_t t, std::size_t k) const {
    return mesh_.triangles[t][k % 3];
  }
  [[nodiscard]] DVec3 place(std::uint32_t t, std::size_t k) const { return mesh_.positions[corner(t, k)]; }
  [[nodiscard]] double side(std::uint32_t t, std::size_t k) const {
    return length(place(t, k + 1) - place(t, k));
  }
  [[nodiscard]] double twice_area(std::uint32_t t) const {
    return length(cross(place(t, 1) - place(t, 0), place(t, 2) - place(t, 0)));
  }

  /// The vertices joined to `vertex` by an edge, ascending.
  [[nodiscard]] std::vector<std::uint32_t> neighbors(std::uint32_t vertex) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : around_[vertex]) {
      for (const std::uint32_t other : mesh_.triangles[t]) {
        if (other != vertex) found.push_back(other);
      }
    }
    base::sort_unique(found);
    return found;
  }

  /// The triangle whose edge runs from `a` to `b`, and the number of its third corner.
  [[nodiscard]] std::pair<std::uint32_t, std::size_t> beside(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t t : around_[a]) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (corner(t, k) == a && corner(t, k + 1) == b) return {t, k + 2};
      }
    }
    return {kNone, 0};
  }

  void leave(std::uint32_t vertex, std::uint32_t t) { std::erase(around_[vertex], t); }

  void remove(std::uint32_t t) {
    for (const std::uint32_t vertex : mesh_.triangles[t]) leave(vertex, t);
    mesh_.triangles[t] = {kNone, kNone, kNone};
  }

  void put(std::uint32_t t, const Triangle& corners) {
    for (const std::uint32_t vertex : mesh_.triangles[t]) leave(vertex, t);
    mesh_.triangles[t] = corners;
    for (const std::uint32_t vertex : corners) around_[vertex].push_back(t);
  }

  /// Moves one end of the edge to the other. This is done only if the ends have no other neighbors in common
  /// than the two third corners (the link condition), and no vertex is left with two triangles.
  bool collapse(std::uint32_t t, std::size_t k) {
    const std::uint32_t kept = std::min(corner(t, k), corner(t, k + 1));
    const std::uint32_t gone = std::max(corner(t, k), corner(t, k + 1));
    const std::vector<std::uint32_t> of_kept = neighbors(kept);
    const std::vector<std::uint32_t> of_gone = neighbors(gone);
    std::vector<std::uint32_t> common;
    std::set_intersection(of_kept.begin(), of_kept.end(), of_gone.begin(), of_gone.end(),
                          std::back_inserter(common));
    if (common.size() != 2) return false;
    for (const std::uint32_t vertex : common) {
      if (around_[vertex].size() <= 3) return false;
    }
    const std::vector<std::uint32_t> triangles = around_[gone];
    for (const std::uint32_t other : triangles) {
      Triangle corners = mesh_.triangles[other];
      if (std::count(corners.begin(), corners.end(), kept) > 0) {
        remove(other);
        continue;
      }
      std::replace(corners.begin(), corners.end(), gone, kept);
      put(other, corners);
    }
    return true;
  }

  /// Gives the edge's two triangles the other diagonal, unless that is an edge already.
  bool flip(std::uint32_t t, std::size_t k) {
    const std::uint32_t a = corner(t, k);
    const std::uint32_t b = corner(t, k + 1);
    const std::uint32_t c = corner(t, k + 2);
    const auto [other, number] = beside(b, a);
    if (other == kNone) return false;
    const std::uint32_t d = corner(other, number);
    if (d == c || beside(c, d).first != kNone || beside(d, c).first != kNone) return false;
    put(t, {a, d, c});
    put(other, {d, b, c});
    return true;
  }

  void lift(std::uint32_t t, std::size_t k) {
    const DVec3 edge = direction_or(place(t, k + 1) - place(t, k), DVec3{1, 0, 0});
    const auto across = [&](DVec3 p) { return (p - place(t, k)) - dot(p - place(t, k), edge) * edge; };
    const auto [other, number] = beside(corner(t, k + 1), corner(t, k));
    const DVec3 height = across(place(t, k + 2));
    const DVec3 away = other == kNone ? DVec3{} : -across(place(other, number));
    const bool has_plane = length(height) > kFlat * distance_;
    const DVec3 direction =
        direction_or(has_plane ? height : away, direction_or(cross(edge, DVec3{1, 0, 0}), DVec3{0, 1, 0}));
    mesh_.positions[corner(t, k + 2)] += kLift * distance_ * direction - height;
  }

  SolidMesh mesh_;
  std::vector<std::vector<std::uint32_t>> around_;  // the triangles at each vertex
  double distance_;
};

}  // namespace

SolidMesh without_slivers(const SolidMesh& mesh, double distance) {
  Remesher remesher(mesh, distance);
  for (int round = 0; round < kRounds && remesher.improve(); ++round) {
  }
  for (int round = 0; round < kRounds && remesher.lift_rest(); ++round) {
  }
  return remesher.result();
}

}  // namespace hooke::geometry
