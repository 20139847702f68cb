#pragma once

#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Where a surface of triangles can touch something flat or straight: along its ridges and at its peaks.

namespace hooke::geometry {

/// A ridge is an edge where the surface bends away from its front, or where it ends. A peak is a vertex at
/// the end of a ridge. Vertices at the same position are one here. Each ridge or peak belongs to one triangle
/// that has it, and they stand in the order of those triangles.
struct Protrusions {
  std::vector<Edge> ends = {};  ///< Ends of a ridge; for a peak twice its vertex.
  /// Vertices around number i: neighbors[neighbor_begin[i] .. neighbor_begin[i + 1]). For a ridge they are
  /// the corners opposite to it, for a peak those that an edge joins to it.
  std::vector<std::uint32_t> neighbor_begin = {};
  std::vector<std::uint32_t> neighbors = {};
  /// Protrusions of triangle t: triangle_begin[t] .. triangle_begin[t + 1].
  std::vector<std::uint32_t> triangle_begin = {};

  [[nodiscard]] bool is_peak(std::uint32_t i) const { return ends[i][0] == ends[i][1]; }
  [[nodiscard]] std::span<const std::uint32_t> neighbors_of(std::uint32_t i) const {
    return {neighbors.data() + neighbor_begin[i], neighbor_begin[i + 1] - neighbor_begin[i]};
  }
};

/// Finds the ridges and peaks. Edges that bend by less than half a degree are flat. Precondition: a mesh that
/// validate_mesh accepts.
[[nodiscard]] Protrusions find_protrusions(const MeshDesc& mesh);

}  // namespace hooke::geometry
