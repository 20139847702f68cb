#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Bumps of inner edges: a body that slides over a floor of several pieces must not feel where they meet.

namespace hooke::collision {

/// Where a shape meets one piece of the surfaces around it.
struct SurfaceContact {
  Convex piece = {};
  std::uint32_t index = 0;  ///< Of two contacts alike the lower one counts.
  Vec3 normal = {};         ///< Out of the piece, unit.
  Vec3 place = {};          ///< Of the deepest point, on the piece.
  /// Of the whole shape along the normal [m], also where it is lowest beside the piece: so a piece that is
  /// covered can be no deeper in the shape than what covers it.
  Real separation = Real(0);
};

/// How far a piece may stand out over a plane and still count as behind it: what lies flush is one floor [m].
inline constexpr Real kFlush = Real(5e-4);

/// Normals that differ by less than 1e-4 hold in the same direction.
[[nodiscard]] bool is_same_direction(Vec3 a, Vec3 b);

/// Where pieces of a surface are from: those of several bodies may lie flush but for a small step.
enum class Pieces : std::uint8_t { kOfOneMesh, kOfMany };

/// What find_ghosts finds, and its memory.
struct Ghosts {
  std::vector<std::uint8_t> is_ghost = {};  // of each contact
  std::vector<std::uint32_t> coverer = {};  // of each contact, one that covers it; itself if none does
  std::vector<std::uint32_t> held = {};     // contacts that stay, or that something covers which does
  std::vector<std::uint32_t> loose = {};    // the others
};

/// Finds the contacts that others cover: the whole piece is behind the plane of another contact, so that what
/// touches the front of the plane can feel no more of the piece than its rim, which is no obstacle. Of two
/// that cover each other (both sides of an edge), the one that holds the shape farther off stays. Needs no
/// neighborhood: pieces may be triangles with or without common vertices, T-junctions, or whole bodies.
///
/// Of two triangles of a mesh that cover each other only because they are flush, the one that covers better
/// stays. The normal at the rim of a triangle leans towards the shape; in a hollow of narrow strips each rim
/// is farther from the shape than the one before, so that all would be covered by the last, which is not
/// near.
///
/// What covers a ghost may be a ghost itself, but at the end of each such chain one stays: where contacts
/// cover each other all around, as on a summit below something flat, the one that holds the shape farthest
/// off.
void find_ghosts(std::span<const SurfaceContact> all, Pieces pieces, Ghosts& found);

}  // namespace hooke::collision
