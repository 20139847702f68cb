#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace hooke::geometry {

/// A facet of the hull, as the center of mass sees it.
struct Facet {
  DVec3 normal = {};
  std::vector<DVec3> corners = {};
  double height = 0;  ///< Distance of the center of mass from the facet's plane [m].
  /// Least distance of the center, seen along the normal, from a side [m]; negative beyond it.
  double margin = std::numeric_limits<double>::infinity();
  std::uint32_t neighbor = 0;  ///< The facet across that side.
  double share = 0;            ///< Solid angle over 4 pi, and what other facets passed on.
};

/// The convex hull of a solid, which is all that touches a plane.
struct FacetedSolid {
  std::vector<Facet> facets = {};
  DVec3 center = {};      ///< Center of mass in the mesh's frame [m].
  double margin_min = 0;  ///< Margins up to this count as none [m].
  double hull_error = 0;  ///< How far points of the mesh stand out of the hull [m].
};

/// Makes the hull of a mesh and looks at its facets. Errors: those of find_stable_poses.
[[nodiscard]] Result<FacetedSolid> make_faceted_solid(const MeshDesc& mesh, std::optional<DVec3> center);

/// Returns the shortest rotation that turns a unit vector straight down.
[[nodiscard]] Quaternion<double> turn_down(DVec3 normal);

}  // namespace hooke::geometry
