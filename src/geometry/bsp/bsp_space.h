#pragma once

#include "hooke/math.h"

#include "math/wide_int.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

/// \file
/// Exact planes, points and convex pieces of triangles, for trees and for their merging.
///
/// All corners of the meshes lie on a lattice of integers, so every plane through three of them has integer
/// coefficients. A point where a piece is cut is never rounded: it is stored as the three planes that meet in
/// it, and these are always planes of the input (supporting planes of triangles, planes through their edges,
/// cuts along the axes), so numbers do not grow from cut to cut (Sugihara and Iri 1989, A solid modelling
/// system free from topological inconsistency; Bernstein and Fussell 2009, Fast, exact, linear booleans). The
/// sign of a point over a plane is that of a 4x4 determinant: by doubles where they are sure, else by
/// integers. Bits: coordinates 32, normals 67, offsets 100; a point as (x, y, z, w) 235 and 201; a sign 304;
/// the order of two points 437.

namespace hooke::geometry {

/// A corner of a mesh, in steps of the lattice; each at most kLatticeHalf in size.
using LatticePoint = Vector3<std::int64_t>;
inline constexpr std::int64_t kLatticeHalf = (std::int64_t{1} << 32) + 1;
using LatticeNormal = Vector3<math::Int128>;

/// Normal of the triangle, outward, of twice its area in length; zero if it has no area.
[[nodiscard]] LatticeNormal normal_of(const std::array<LatticePoint, 3>& corners);

/// The points p with dot(a, p) + d = 0. `a` has no common divisor, and its first number that is not zero is
/// positive: equal planes have equal numbers.
struct BspPlane {
  LatticeNormal a = {};
  math::Int128 d = 0;
  DVec3 normal = {};  ///< Unit normal, along `a`.
  double offset = 0;  ///< dot(normal, p) + offset is the height of p, in steps.
};

/// A plane and the side of it.
struct BspSide {
  std::uint32_t plane = 0;
  bool is_flipped = false;  ///< The requested direction is against the plane's normal.
};

struct BspPoint {
  DVec3 place = {};                          ///< Position in steps; exact for a corner of a mesh, else to
                                             ///< 2^-18 steps.
  std::array<std::uint32_t, 3> planes = {};  ///< The point is the only one on all three.
  bool is_lattice = false;
};

/// A corner of a piece and the edge from there to the next corner.
struct BspCorner {
  std::uint32_t point = 0;
  std::uint32_t edge_plane = 0;  ///< The edge is where this plane meets the piece's own.
};

/// A convex piece of a triangle, its corners counter-clockwise seen from outside, none of them straight.
struct BspPiece {
  std::vector<BspCorner> corners = {};
  std::uint32_t plane = 0;
  std::uint32_t triangle = 0;  ///< Number of the triangle that the piece is from.
  bool is_flipped = false;     ///< The outside is below the plane.
};

/// Stores planes, points and pieces under numbers.
class BspSpace {
 public:
  /// The plane through `p` across `normal`, which is not zero; its numbers are at most 2^67.
  BspSide add_plane(LatticePoint p, LatticeNormal normal);
  /// The triangle as a piece; without corners if it has no area.
  BspPiece add_triangle(const std::array<LatticePoint, 3>& corners, std::uint32_t triangle);
  /// The point where the three planes meet. Precondition: there is one.
  std::uint32_t add_intersection(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  [[nodiscard]] const BspPlane& plane(std::uint32_t index) const { return planes_[index]; }
  [[nodiscard]] const BspPoint& point(std::uint32_t index) const { return points_[index]; }
  [[nodiscard]] std::size_t point_count() const { return points_.size(); }

  /// Side of the point: 1 above the plane, -1 below, 0 on it. Exact.
  [[nodiscard]] int side_of(std::uint32_t plane, std::uint32_t point) const;
  /// The order of two points by x, then y, then z: -1, 0 or 1. Exact; 0 only for the same position.
  [[nodiscard]] int compare(std::uint32_t p, std::uint32_t q) const;

 private:
  using PlaneKey = std::tuple<math::Int128, math::Int128, math::Int128, math::Int128>;

  std::map<PlaneKey, std::uint32_t> plane_of_;
  std::vector<BspPlane> planes_;
  std::vector<BspPoint> points_;
};

/// The position of a piece relative to a plane.
enum class BspSplit : std::uint8_t { kAbove, kBelow, kOn, kCut };

/// Finds the position of the piece relative to the plane; if it is cut, also its two parts.
BspSplit split(BspSpace& space, const BspPiece& piece, std::uint32_t plane, BspPiece& above, BspPiece& below);
/// Does the same without cutting.
BspSplit classify(const BspSpace& space, const BspPiece& piece, std::uint32_t plane);

}  // namespace hooke::geometry
