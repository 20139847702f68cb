#include "collision/narrow_phase_ghosts.h"

#include <algorithm>
#include <limits>

namespace hooke::collision {

namespace {

/// Heights below this are rounding [m].
constexpr Real kRoundingOfPlace = Real(2e-6);

/// How far the piece stands out over a plane [m].
Real height_over_plane(const Convex& piece, Vec3 place, Vec3 normal) {
  if (piece.shape.kind == ShapeKind::kHalfSpace) return std::numeric_limits<Real>::infinity();
  return dot(normal, support_of(piece, normal) - place) + skin_of(piece);
}

}  // namespace

bool is_same_direction(Vec3 a, Vec3 b) {
  return dot(a, b) > Real(0) && length_squared(cross(a, b)) <= Real(1e-8);
}

bool is_ghost(const SurfaceContact& contact, std::span<const SurfaceContact> all, Pieces pieces) {
  return std::any_of(all.begin(), all.end(), [&](const SurfaceContact& other) {
    if (is_same_direction(contact.normal, other.normal)) return false;
    const Real height = height_over_plane(contact.piece, other.place, other.normal);
    if (!(height <= kFlush)) return false;
    const Real other_height = height_over_plane(other.piece, contact.place, contact.normal);
    if (!(other_height <= kFlush)) return true;
    if (pieces == Pieces::kOfOneMesh) {
      if (Real(2) * std::max(height, kRoundingOfPlace) < other_height) return true;
      if (Real(2) * std::max(other_height, kRoundingOfPlace) < height) return false;
    }
    if (other.separation != contact.separation) return other.separation > contact.separation;
    return other.index < contact.index;
  });
}

}  // namespace hooke::collision
