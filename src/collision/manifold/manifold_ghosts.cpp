#include "collision/manifold/manifold_ghosts.h"

#include "base/assert.h"
#include "collision/manifold/manifold_tuning.h"

#include <algorithm>
#include <limits>

namespace hooke::collision {

namespace {

/// Height by which the piece stands out over a plane [m].
Real height_over_plane(const Convex& piece, Vec3 place, Vec3 normal) {
  if (piece.shape.kind == ShapeKind::kHalfSpace) return std::numeric_limits<Real>::infinity();
  return dot(normal, support_of(piece, normal) - place) + skin_of(piece);
}

/// Whether `other` covers the contact; see find_ghosts.
bool covers(const SurfaceContact& other, const SurfaceContact& contact, Pieces pieces) {
  if (is_same_direction(contact.normal, other.normal)) return false;
  const Real height = height_over_plane(contact.piece, other.place, other.normal);
  if (!(height <= kFlush)) return false;
  const Real other_height = height_over_plane(other.piece, contact.place, contact.normal);
  if (!(other_height <= kFlush)) return true;
  if (pieces == Pieces::kOfOneMesh) {
    if (Real(2) * std::max(height, kPositionRounding) < other_height) return true;
    if (Real(2) * std::max(other_height, kPositionRounding) < height) return false;
  }
  if (other.separation != contact.separation) return other.separation > contact.separation;
  return other.index < contact.index;
}

/// Where contacts cover each other all around, lets one of them stay.
void open_rings(std::span<const SurfaceContact> all, Pieces pieces, Ghosts& found) {
  const std::vector<std::uint32_t>& coverer = found.coverer;
  std::vector<std::uint32_t>& held = found.held;
  std::vector<std::uint32_t>& loose = found.loose;
  const auto count = static_cast<std::uint32_t>(all.size());
  held.clear();
  HOOKE_ASSERT(coverer.size() == all.size() && found.is_ghost.size() == all.size());
  loose.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t end = i;
    for (std::uint32_t hop = 0; hop < count && coverer[end] != end; ++hop) end = coverer[end];
    (coverer[end] == end ? held : loose).push_back(i);
  }
  for (std::size_t next = 0; !loose.empty(); ++next) {
    if (next == held.size()) {
      const auto stays = std::max_element(loose.begin(), loose.end(), [&](std::uint32_t i, std::uint32_t j) {
        return all[i].separation < all[j].separation;
      });
      found.is_ghost[*stays] = 0;
      held.push_back(*stays);
      loose.erase(stays);
    }
    const SurfaceContact& other = all[held[next]];
    std::erase_if(loose, [&](std::uint32_t i) {
      if (!covers(other, all[i], pieces)) return false;
      held.push_back(i);
      return true;
    });
  }
}

}  // namespace

bool is_same_direction(Vec3 a, Vec3 b) {
  return dot(a, b) > Real(0) && length_squared(cross(a, b)) <= Real(1e-8);
}

void find_ghosts(std::span<const SurfaceContact> all, Pieces pieces, Ghosts& found) {
  const auto count = static_cast<std::uint32_t>(all.size());
  found.is_ghost.assign(count, 0);
  found.coverer.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t j = 0;
    while (j < count && !covers(all[j], all[i], pieces)) ++j;
    found.is_ghost[i] = j < count;
    found.coverer[i] = j < count ? j : i;
  }
  open_rings(all, pieces, found);
}

}  // namespace hooke::collision
