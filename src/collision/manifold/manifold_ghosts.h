#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_tuning.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Removes the bumps of inner edges: a body that slides over a floor of several pieces must not feel their
/// seams.

namespace hooke::collision {

/// The contact of a shape with one piece of the surfaces around it.
struct SurfaceContact {
  Convex piece = {};
  std::uint32_t index = 0;  ///< Of two equal contacts the one with the lower index stays.
  Vec3 normal = {};         ///< Unit vector out of the piece.
  Vec3 place = {};          ///< Deepest point, on the piece.
  /// Separation of the whole shape along the normal [m], also where the shape is lowest beside the piece. So
  /// a piece that is covered can be no deeper in the shape than the contact that covers it.
  Real separation = Real(0);
};

/// Whether the normals differ by less than 1e-4, which counts as one direction.
[[nodiscard]] bool is_same_direction(Vec3 a, Vec3 b);

/// The source of the pieces. Pieces of several bodies may be flush except for a small step.
enum class Pieces : std::uint8_t { kOfOneMesh, kOfMany };

/// Result and memory of find_ghosts.
struct Ghosts {
  std::vector<std::uint8_t> is_ghost = {};  // by contact
  std::vector<std::uint32_t> coverer = {};  // by contact, one that covers it; itself if none does
  std::vector<std::uint32_t> held = {};     // contacts that stay, or are covered by one that stays
  std::vector<std::uint32_t> loose = {};    // all other contacts
};

/// Finds the contacts that others cover: the whole piece is behind the plane of another contact. A shape that
/// touches the front of that plane can feel only the rim of the piece, which is no obstacle. If two cover
/// each other (both sides of an edge), the one that holds the shape farther off stays. This needs no
/// neighborhood: pieces may be triangles with or without common vertices, T-junctions, or whole bodies.
///
/// Two triangles of a mesh may cover each other only because they are flush; then the one that covers better
/// stays. The normal at the rim of a triangle tilts towards the shape. In a hollow of narrow strips each rim
/// is farther from the shape than the one before, so that the last one, which is not near, would cover all.
///
/// What covers a ghost may be a ghost itself, but at the end of each such sequence one contact stays. Where
/// contacts cover each other all around, as on a summit below something flat, it is the one that holds the
/// shape farthest off.
void find_ghosts(std::span<const SurfaceContact> all, Pieces pieces, Ghosts& found);

}  // namespace hooke::collision
