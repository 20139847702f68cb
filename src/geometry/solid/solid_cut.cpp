#include "geometry/solid/solid_cut.h"

#include "geometry/solid/ray_winding.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace hooke::geometry {

namespace {

/// Up to four corners of a convex piece of a triangle.
struct Piece {
  std::array<Vec3, 4> corner;
  std::size_t count = 0;

  void add(Vec3 p) { corner[count++] = p; }
  void append_to(std::vector<Corners>& surface) const {
    for (std::size_t k = 1; k + 1 < count; ++k) surface.push_back({corner[0], corner[k], corner[k + 1]});
  }
};

/// The point where the edge crosses height zero; the same for both directions, so that neighbors share it.
Vec3 crossing(Vec3 a, Vec3 b, double height_a, double height_b) {
  if (height_a > height_b) return crossing(b, a, height_b, height_a);
  const auto from = vector_cast<double>(a);
  return vector_cast<Real>(from + height_a / (height_a - height_b) * (vector_cast<double>(b) - from));
}

/// Appends the pieces of a triangle with these heights over the plane, not all of them zero.
void cut_triangle(const Corners& t, const std::array<double, 3>& height, SolidHalves& halves) {
  Piece below;
  Piece above;
  Piece section;
  bool is_cut = false;
  const auto add_to_all = [&](Vec3 p) {
    for (Piece* piece : {&below, &above, &section}) piece->add(p);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (height[k] < 0) below.add(t[k]);
    if (height[k] > 0) above.add(t[k]);
    if (!(height[k] < 0) && !(height[k] > 0)) add_to_all(t[k]);
    if (!(height[k] * height[next] < 0)) continue;
    add_to_all(crossing(t[k], t[next], height[k], height[next]));
    is_cut = true;
  }
  below.append_to(halves.below.surface);
  above.append_to(halves.above.surface);
  if (section.count != 2) return;
  // An edge in the plane is found again in the triangle on its other side.
  const auto section_length = static_cast<double>(length(section.corner[1] - section.corner[0]));
  halves.cut_length += is_cut ? section_length : 0.5 * section_length;
}

/// The point where three planes meet; nothing if two of them are almost parallel.
std::optional<DVec3> intersection_point(const Plane& a, const Plane& b, const Plane& c) {
  const DVec3 bc = cross(b.normal, c.normal);
  const double volume = dot(a.normal, bc);
  if (!(std::abs(volume) > 1e-4)) return std::nullopt;
  const DVec3 sum =
      a.offset * bc + b.offset * cross(c.normal, a.normal) + c.offset * cross(a.normal, b.normal);
  return 1 / volume * sum;
}

/// Divides the corners between both sides, and adds those that the plane makes with two of the piece's
/// planes.
void cut_corners(const SolidPiece& piece, std::span<const Corners> solid, const Plane& plane, double on_plane,
                 SolidHalves& halves) {
  for (const Vec3& p : piece.corners) {
    const double height = signed_distance(plane, vector_cast<double>(p));
    if (height <= on_plane) halves.below.corners.push_back(p);
    if (height >= -on_plane) halves.above.corners.push_back(p);
  }
  const auto is_in_piece = [&](DVec3 p) {
    return std::ranges::all_of(piece.planes,
                               [&](const Plane& c) { return signed_distance(c, p) <= on_plane; });
  };
  for (std::size_t i = 0; i < piece.planes.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const std::optional<DVec3> p = intersection_point(plane, piece.planes[i], piece.planes[k]);
      if (!p || !is_in_piece(*p) || !contains(solid, *p)) continue;
      halves.below.corners.push_back(vector_cast<Real>(*p));
      halves.above.corners.push_back(vector_cast<Real>(*p));
    }
  }
}

}  // namespace

DVec3 normal_of(const Corners& triangle) {
  const auto a = vector_cast<double>(triangle[0]);
  return normalize(cross(vector_cast<double>(triangle[1]) - a, vector_cast<double>(triangle[2]) - a));
}

bool contains(std::span<const Corners> surface, DVec3 p) {
  int winding = 0;
  for (const Corners& corners : surface) {
    const Box3<Real> box = box_of(corners[0], corners[1], corners[2]);
    const bool is_beside = static_cast<double>(box.lower.z) > p.z || static_cast<double>(box.upper.z) < p.z ||
                           static_cast<double>(box.upper.y) < p.y || static_cast<double>(box.lower.y) > p.y ||
                           static_cast<double>(box.upper.x) < p.x;
    if (is_beside) continue;
    const std::array<DVec3, 3> t = {vector_cast<double>(corners[0]), vector_cast<double>(corners[1]),
                                    vector_cast<double>(corners[2])};
    const int sign = winding_about(t, p.y, p.z);
    if (sign != 0 && crossing_of(t, p.y, p.z) > p.x) winding += sign;
  }
  return winding > 0;
}

SolidHalves cut(const SolidPiece& piece, std::span<const Corners> solid, const Plane& plane,
                double on_plane) {
  SolidHalves halves;
  for (const Corners& t : piece.surface) {
    std::array<double, 3> height = {};
    std::transform(t.begin(), t.end(), height.begin(), [&](Vec3 p) {
      const double h = signed_distance(plane, vector_cast<double>(p));
      return std::abs(h) <= on_plane ? 0 : h;
    });
    if (height != std::array<double, 3>{}) {
      cut_triangle(t, height, halves);
    } else {
      (dot(normal_of(t), plane.normal) < 0 ? halves.above : halves.below).surface.push_back(t);
    }
  }
  cut_corners(piece, solid, plane, on_plane, halves);
  halves.below.planes = piece.planes;
  halves.below.planes.push_back(plane);
  halves.above.planes = piece.planes;
  halves.above.planes.push_back({-plane.normal, -plane.offset});
  return halves;
}

}  // namespace hooke::geometry
