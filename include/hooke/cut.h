#pragma once

#include "hooke/id.h"
#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// \file
/// Cutting by a blade: World::cut.

namespace hooke {

/// The straight edge of a blade that moves from one place to another, and what it may cut. It sweeps two
/// triangles: from[0], from[1], to[1] and from[0], to[1], to[0]. Objects are cut where they are now: a blade
/// that moves for long is swept step by step, each time from where it was to where it is.
struct CutDesc {
  std::array<DVec3, 2> from = {};  ///< Ends of the edge before it moves [m].
  std::array<DVec3, 2> to = {};    ///< The same ends after it [m].
  /// Cut only these. If all three lists are empty, every rope, cloth and solid is cut.
  std::vector<RopeId> ropes = {};
  std::vector<ClothId> cloths = {};  ///< See `ropes`.
  std::vector<SolidId> solids = {};  ///< See `ropes`.
};

/// Segments of a rope that were cut.
struct RopeCut {
  RopeId rope = {};                          ///< The rope, which goes on as several; one object still.
  std::vector<std::uint32_t> segments = {};  ///< Segments that hold no more, in ascending order.
};

/// What a blade did to a cloth. Between which triangles it led, they part along their common edge. An edge
/// whose ends are both inside the cloth cannot open by itself: it is scored, and opens when a later cut or a
/// tear reaches it.
struct ClothCut {
  ClothId cloth = {};             ///< The cloth.
  std::uint32_t edges = 0;        ///< Edges at which triangles were parted, scored ones too.
  std::uint32_t scored = 0;       ///< Edges of the cloth that are scored after it.
  std::uint32_t first_added = 0;  ///< Index of the first point that was added.
  std::uint32_t added = 0;        ///< How many points were added; World::splits says from which.
  /// How many points split that were pinned or hooked. The larger side by area keeps pin and hook; a hook
  /// between several points goes with its triangle.
  std::uint32_t held = 0;
  bool burst = false;  ///< The cloth was closed, and lost its gas.
};

/// What a blade did to a solid. Tetrahedra part along the faces between which it led.
struct SolidCut {
  SolidId solid = {};             ///< The solid.
  std::uint32_t faces = 0;        ///< Faces at which tetrahedra were parted, scored ones too.
  std::uint32_t scored = 0;       ///< Faces that hold together by an edge or a point only, after it.
  std::uint32_t first_added = 0;  ///< Index of the first point that was added.
  std::uint32_t added = 0;        ///< How many points were added; World::splits says from which.
  std::uint32_t held = 0;         ///< How many points split that were pinned or hooked; as ClothCut::held.
};

/// An object that the blade met and did not cut.
struct CutRefusal {
  PointRef object = {};  ///< The object; its `index` says nothing.
  std::string why = {};  ///< Why it was not cut, and what helps.
};

/// What one call of World::cut did, each list in order of the objects' creation.
struct CutResult {
  std::vector<RopeCut> ropes = {};       ///< Ropes of which a segment was cut.
  std::vector<ClothCut> cloths = {};     ///< Cloths of which an edge was parted.
  std::vector<SolidCut> solids = {};     ///< Solids of which a face was parted.
  std::vector<CutRefusal> refused = {};  ///< What could not be cut.

  /// Whether nothing was cut.
  [[nodiscard]] bool empty() const { return ropes.empty() && cloths.empty() && solids.empty(); }
};

}  // namespace hooke
