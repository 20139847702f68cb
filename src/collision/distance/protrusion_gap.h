#pragma once

#include "hooke/math.h"

#include "state/mesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

/// \file
/// The distance of a segment or a triangle from a ridge or a peak of a mesh (geometry/mesh/protrusions.h), in
/// the mesh's frame.

namespace hooke::collision {

/// A point between the points of an element and a point on a protrusion, each of which is the nearest to the
/// other.
struct ProtrusionGap {
  Real distance = Real(0);          ///< Negative behind the mesh's front [m].
  Vec3 normal = {};                 ///< Unit vector out of the mesh.
  Vec3 place = {};                  ///< Point on the element.
  std::array<Real, 3> weight = {};  ///< Weights of the element's points there.
};

struct ProtrusionSearch {
  std::optional<ProtrusionGap> gap;  ///< Nothing if points of the element or other parts of the mesh touch.
  Real clearance = Real(0);          ///< Lower bound of the distance between the two [m].
};

/// Finds the gap between a ridge or a peak and a point (one corner) or a segment (two), or between a peak and
/// the inside of a triangle.
[[nodiscard]] ProtrusionSearch find_protrusion_gap(const state::Mesh& mesh, std::uint32_t protrusion,
                                                   std::span<const Vec3> corners);

}  // namespace hooke::collision
