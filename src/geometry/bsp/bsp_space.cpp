#include "geometry/bsp/bsp_space.h"

#include "base/assert.h"

#include <cmath>
#include <numeric>

namespace hooke::geometry {

namespace {

using math::Int128;
using math::WideInt;

// Heights computed in double are right to 2^-15 steps: positions to 2^-18 (coordinates to 2^32 + 1), normals
// and offsets to a few units in the last place.
constexpr double kSureHeight = 0x1p-12;
// Coordinates computed in double are right to 2^-18 steps.
constexpr double kSureDistance = 0x1p-14;

using WideVector = Vector3<WideInt>;

struct Homogeneous {
  WideVector x = {};
  WideInt w = {};  // positive
};

WideVector widened(const LatticeNormal& a) {
  return {a.x, a.y, a.z};
}

/// Cramer's rule: x w = -(d_a (b x c) + d_b (c x a) + d_c (a x b)), w = a . (b x c).
Homogeneous intersection(const BspPlane& a, const BspPlane& b, const BspPlane& c) {
  const WideVector u = widened(a.a);
  const WideVector v = widened(b.a);
  const WideVector w = widened(c.a);
  const WideVector vw = cross(v, w);
  const Homogeneous p = {-(WideInt(a.d) * vw + WideInt(b.d) * cross(w, u) + WideInt(c.d) * cross(u, v)),
                         dot(u, vw)};
  return p.w.sign() < 0 ? Homogeneous{-p.x, -p.w} : p;
}

Int128 size_of(Int128 v) {
  return v < 0 ? -v : v;
}

/// Greatest common divisor by Euclid's algorithm, in 64 bits as soon as they suffice. Not negative.
Int128 common_divisor(Int128 a, Int128 b) {
  a = size_of(a);
  b = size_of(b);
  while (b > Int128{INT64_MAX}) {
    const Int128 rest = a % b;
    a = b;
    b = rest;
  }
  return b == 0 ? a : std::gcd(static_cast<std::int64_t>(a % b), static_cast<std::int64_t>(b));
}

bool has_direction(const LatticeNormal& a) {
  if (a.x != 0) return a.x > 0;
  if (a.y != 0) return a.y > 0;
  return a.z > 0;
}

LatticeNormal longest_axis(const LatticeNormal& normal) {
  const Int128 x = size_of(normal.x);
  const Int128 y = size_of(normal.y);
  const Int128 z = size_of(normal.z);
  if (x >= y && x >= z) return {1, 0, 0};
  return y >= z ? LatticeNormal{0, 1, 0} : LatticeNormal{0, 0, 1};
}

LatticeNormal difference(const LatticePoint& a, const LatticePoint& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

}  // namespace

LatticeNormal normal_of(const std::array<LatticePoint, 3>& corners) {
  return cross(difference(corners[1], corners[0]), difference(corners[2], corners[0]));
}

BspSide BspSpace::add_plane(LatticePoint p, LatticeNormal normal) {
  const Int128 divisor = common_divisor(common_divisor(normal.x, normal.y), normal.z);
  HOOKE_ASSERT(divisor > 0);
  const bool is_flipped = !has_direction(normal);
  const Int128 scale = is_flipped ? -divisor : divisor;
  // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): asserted above
  BspPlane plane = {.a = {normal.x / scale, normal.y / scale, normal.z / scale}};
  plane.d = -(plane.a.x * p.x + plane.a.y * p.y + plane.a.z * p.z);
  const auto [entry, is_new] = plane_of_.try_emplace({plane.a.x, plane.a.y, plane.a.z, plane.d},
                                                     static_cast<std::uint32_t>(planes_.size()));
  if (is_new) {
    const DVec3 direction = vector_cast<double>(plane.a);
    const double size = length(direction);
    plane.normal = {direction.x / size, direction.y / size, direction.z / size};
    plane.offset = static_cast<double>(plane.d) / size;
    planes_.push_back(plane);
  }
  return {entry->second, is_flipped};
}

BspPiece BspSpace::add_triangle(const std::array<LatticePoint, 3>& corners, std::uint32_t triangle) {
  const LatticeNormal normal = normal_of(corners);
  if (normal == LatticeNormal{}) return {};
  const BspSide own = add_plane(corners[0], normal);
  BspPiece piece = {.plane = own.plane, .triangle = triangle, .is_flipped = own.is_flipped};
  // The plane goes through an edge and along an axis, so it is across the triangle and has small numbers.
  const LatticeNormal axis = longest_axis(normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const LatticeNormal across = cross(difference(corners[(k + 1) % 3], corners[k]), axis);
    piece.corners.push_back({.edge_plane = add_plane(corners[k], across).plane});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    piece.corners[k].point = static_cast<std::uint32_t>(points_.size());
    points_.push_back(
        {.place = vector_cast<double>(corners[k]),
         .planes = {own.plane, piece.corners[k].edge_plane, piece.corners[(k + 2) % 3].edge_plane},
         .is_lattice = true});
  }
  return piece;
}

std::uint32_t BspSpace::add_intersection(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Homogeneous p = intersection(planes_[a], planes_[b], planes_[c]);
  HOOKE_ASSERT(p.w.sign() > 0);
  const double w = p.w.approximate();
  points_.push_back({.place = {p.x.x.approximate() / w, p.x.y.approximate() / w, p.x.z.approximate() / w},
                     .planes = {a, b, c}});
  return static_cast<std::uint32_t>(points_.size() - 1);
}

int BspSpace::side_of(std::uint32_t plane, std::uint32_t point) const {
  const BspPlane& s = planes_[plane];
  const BspPoint& p = points_[point];
  const double height = dot(s.normal, p.place) + s.offset;
  if (height > kSureHeight) return 1;
  if (height < -kSureHeight) return -1;
  if (p.planes[0] == plane || p.planes[1] == plane || p.planes[2] == plane) return 0;
  if (p.is_lattice) {
    const auto q = vector_cast<std::int64_t>(p.place);
    const Int128 exact = s.a.x * q.x + s.a.y * q.y + s.a.z * q.z + s.d;
    return exact > 0 ? 1 : exact < 0 ? -1 : 0;
  }
  const Homogeneous h = intersection(planes_[p.planes[0]], planes_[p.planes[1]], planes_[p.planes[2]]);
  return (dot(widened(s.a), h.x) + h.w * WideInt(s.d)).sign();
}

int BspSpace::compare(std::uint32_t p, std::uint32_t q) const {
  if (p == q) return 0;
  const BspPoint& a = points_[p];
  const BspPoint& b = points_[q];
  const bool is_exact = a.is_lattice && b.is_lattice;
  const double sure = is_exact ? 0.0 : kSureDistance;
  const DVec3 gap = a.place - b.place;
  if (gap.x > sure) return 1;
  if (gap.x < -sure) return -1;
  if (is_exact) return gap.y != 0 ? (gap.y > 0 ? 1 : -1) : gap.z > 0 ? 1 : gap.z < 0 ? -1 : 0;
  const Homogeneous u = intersection(planes_[a.planes[0]], planes_[a.planes[1]], planes_[a.planes[2]]);
  const Homogeneous v = intersection(planes_[b.planes[0]], planes_[b.planes[1]], planes_[b.planes[2]]);
  const WideVector exact = v.w * u.x - u.w * v.x;
  for (const WideInt& coordinate : {exact.x, exact.y, exact.z}) {
    if (coordinate.sign() != 0) return coordinate.sign();
  }
  return 0;
}

BspSplit classify(const BspSpace& space, const BspPiece& piece, std::uint32_t plane) {
  if (piece.plane == plane) return BspSplit::kOn;
  bool has_above = false;
  bool has_below = false;
  for (const BspCorner& corner : piece.corners) {
    const int side = space.side_of(plane, corner.point);
    has_above = has_above || side > 0;
    has_below = has_below || side < 0;
    if (has_above && has_below) return BspSplit::kCut;
  }
  // If all corners were on it, the piece would lie in the plane, which has one number only.
  HOOKE_ASSERT(has_above || has_below);
  return has_above ? BspSplit::kAbove : BspSplit::kBelow;
}

BspSplit split(BspSpace& space, const BspPiece& piece, std::uint32_t plane, BspPiece& above,
               BspPiece& below) {
  const BspSplit where = classify(space, piece, plane);
  if (where != BspSplit::kCut) return where;
  const std::size_t count = piece.corners.size();
  std::vector<int> sides(count);
  for (std::size_t k = 0; k < count; ++k) sides[k] = space.side_of(plane, piece.corners[k].point);
  above = {.plane = piece.plane, .triangle = piece.triangle, .is_flipped = piece.is_flipped};
  below = above;
  for (std::size_t k = 0; k < count; ++k) {
    const BspCorner& corner = piece.corners[k];
    const int here = sides[k];
    const int next = sides[(k + 1) % count];
    // After an edge that leaves a side, the cut follows on that side.
    if (here > 0) above.corners.push_back(corner);
    if (here < 0) below.corners.push_back(corner);
    if (here == 0) {
      above.corners.push_back({corner.point, next < 0 ? plane : corner.edge_plane});
      below.corners.push_back({corner.point, next > 0 ? plane : corner.edge_plane});
    }
    if (here * next < 0) {
      const std::uint32_t cut = space.add_intersection(piece.plane, corner.edge_plane, plane);
      above.corners.push_back({cut, next < 0 ? plane : corner.edge_plane});
      below.corners.push_back({cut, next > 0 ? plane : corner.edge_plane});
    }
  }
  return BspSplit::kCut;
}

}  // namespace hooke::geometry
