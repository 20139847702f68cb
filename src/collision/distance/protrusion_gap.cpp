#include "collision/distance/protrusion_gap.h"

#include "base/assert.h"
#include "collision/distance/distance_tuning.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

/// The gap between one protrusion and one element.
class GapSearch {
 public:
  GapSearch(const state::Mesh& mesh, std::uint32_t protrusion, std::span<const Vec3> corners)
      : mesh_(mesh), protrusion_(protrusion), corners_(corners), start_(vertex(0)) {}

  ProtrusionSearch run() {
    if (corners_.size() == 1) {
      offer_point();
    } else if (corners_.size() == 3) {
      offer_inside();
    } else if (mesh_.protrusions.is_peak(protrusion_)) {
      offer_peak();
    } else {
      offer_ridge();
    }
    return result_;
  }

 private:
  [[nodiscard]] Vec3 vertex(std::size_t end) const {
    return mesh_.desc.positions[mesh_.protrusions.ends[protrusion_][end]];
  }

  /// Whether the mesh around the protrusion lies behind the plane across n.
  [[nodiscard]] bool faces(Vec3 n) const {
    const auto around = mesh_.protrusions.neighbors_of(protrusion_);
    return std::all_of(around.begin(), around.end(), [&](std::uint32_t vertex) {
      const Vec3 beside = mesh_.desc.positions[vertex] - start_;
      const Real height = dot(n, beside);
      return height <= Real(0) ||
             height * height <= kProtrusionTilt * kProtrusionTilt * length_squared(beside);
    });
  }

  /// Offers a pair of points. `across` is a direction across both, of any sign, for points that are too near
  /// to define one.
  void offer(Vec3 on_element, Vec3 on_mesh, Vec3 across, std::array<Real, 3> weight) {
    const Vec3 apart = on_element - on_mesh;
    const Real distance = length(apart);
    result_.clearance = distance;
    const bool is_close = distance <= kProtrusionClose * length(corners_[corners_.size() - 1] - corners_[0]);
    const Vec3 n = is_close ? geometry::direction_or(across, geometry::direction_or(apart, {}))
                            : (Real(1) / distance) * apart;
    if (n == Vec3{}) return;
    if (faces(n)) {
      result_.gap = {dot(n, apart), n, on_element, weight};
    } else if (faces(-n)) {
      result_.gap = {-dot(n, apart), -n, on_element, weight};
    }
  }

  void offer_point() {
    const auto found = geometry::closest_on_segment(corners_[0], start_, vertex(1));
    const bool is_peak = mesh_.protrusions.is_peak(protrusion_);
    result_.clearance = std::sqrt(found.distance_squared);
    const bool is_between = found.fraction > Real(0) && found.fraction < Real(1);
    if (is_peak || is_between) offer(corners_[0], found.point, {}, {Real(1), Real(0), Real(0)});
  }

  void offer_inside() {
    const auto [a, b, c] = std::array{corners_[0], corners_[1], corners_[2]};
    const auto found = geometry::closest_on_triangle(start_, a, b, c);
    const auto [x, y, z] = found.weights;
    result_.clearance = std::sqrt(found.distance_squared);
    if (x > Real(0) && y > Real(0) && z > Real(0)) offer(found.point, start_, cross(b - a, c - a), {x, y, z});
  }

  void offer_peak() {
    const auto found = geometry::closest_on_segment(start_, corners_[0], corners_[1]);
    const Real share = found.fraction;
    result_.clearance = std::sqrt(found.distance_squared);
    if (share > Real(0) && share < Real(1)) offer(found.point, start_, {}, {Real(1) - share, share, Real(0)});
  }

  /// Offers the points where the two cross; elsewhere peaks and points meet.
  void offer_ridge() {
    const Vec3 along = corners_[1] - corners_[0];
    const Vec3 ridge = vertex(1) - start_;
    const Vec3 offset = corners_[0] - start_;
    const Vec3 across = cross(along, ridge);
    const Real whole = length_squared(across);
    const Real on_element = dot(cross(ridge, offset), across);
    const Real on_ridge = dot(cross(along, offset), across);
    const bool cross_each_other =
        on_element > Real(0) && on_element < whole && on_ridge > Real(0) && on_ridge < whole;
    if (!cross_each_other || !(whole > kAlongRidge * length_squared(along) * length_squared(ridge))) {
      const Vec3 between = offset + Real(0.5) * (along - ridge);
      result_.clearance = length(between) - Real(0.5) * (length(along) + length(ridge));
      return;
    }
    const Real share = on_element / whole;
    offer(corners_[0] + share * along, start_ + (on_ridge / whole) * ridge, across,
          {Real(1) - share, share, Real(0)});
  }

  const state::Mesh& mesh_;
  std::uint32_t protrusion_;
  std::span<const Vec3> corners_;
  Vec3 start_;
  ProtrusionSearch result_;
};

}  // namespace

ProtrusionSearch find_protrusion_gap(const state::Mesh& mesh, std::uint32_t protrusion,
                                     std::span<const Vec3> corners) {
  HOOKE_ASSERT(!corners.empty() && corners.size() <= 3 && protrusion < mesh.protrusions.ends.size());
  return GapSearch(mesh, protrusion, corners).run();
}

}  // namespace hooke::collision
