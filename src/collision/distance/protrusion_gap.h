#pragma once

#include "hooke/math.h"

#include "state/mesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

/// \file
/// How far a segment or a triangle is from a ridge or a peak of a mesh (geometry/mesh/protrusions.h), in the
/// mesh's frame.

namespace hooke::collision {

/// Places between the points of an element and on a protrusion, of which each is the nearest to the other.
struct ProtrusionGap {
  Real distance = Real(0);          ///< Negative behind the mesh's front [m].
  Vec3 normal = {};                 ///< Out of the mesh.
  Vec3 place = {};                  ///< On the element.
  std::array<Real, 3> weight = {};  ///< Of the element's points there.
};

struct ProtrusionSearch {
  std::optional<ProtrusionGap>
      gap;                   ///< Nothing where points of the element or other parts of the mesh touch.
  Real clearance = Real(0);  ///< The two are not nearer to each other than this [m].
};

/// Of a ridge or a peak and a point (one corner) or a segment (two), or of a peak and the inside of a
/// triangle.
[[nodiscard]] ProtrusionSearch find_protrusion_gap(const state::Mesh& mesh, std::uint32_t protrusion,
                                                   std::span<const Vec3> corners);

}  // namespace hooke::collision
