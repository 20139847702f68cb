#include "collision/narrow_phase_ghosts.h"

#include <algorithm>

namespace hooke::collision {

namespace {

bool is_behind(const Convex& piece, Vec3 place, Vec3 normal) {
  if (piece.shape.kind == ShapeKind::kHalfSpace) return false;
  return dot(normal, support_of(piece, normal) - place) + skin_of(piece) <= kFlush;
}

}  // namespace

bool is_same_direction(Vec3 a, Vec3 b) {
  return dot(a, b) > Real(0) && length_squared(cross(a, b)) <= Real(1e-8);
}

bool is_ghost(const SurfaceContact& contact, std::span<const SurfaceContact> all) {
  return std::any_of(all.begin(), all.end(), [&](const SurfaceContact& other) {
    if (is_same_direction(contact.normal, other.normal)) return false;
    if (!is_behind(contact.piece, other.place, other.normal)) return false;
    if (!is_behind(other.piece, contact.place, contact.normal)) return true;
    if (other.separation != contact.separation) return other.separation > contact.separation;
    return other.index < contact.index;
  });
}

}  // namespace hooke::collision
