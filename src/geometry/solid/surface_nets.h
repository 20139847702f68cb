#pragma once

#include "hooke/shape.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::geometry {

/// Nodes of a grid of cubes, x fastest, and on which side of a surface each of them lies.
struct NodeGrid {
  std::array<int, 3> counts = {};  ///< Nodes along x, y and z.
  DVec3 corner = {};               ///< The first node [m].
  double spacing = 1;              ///< Distance of neighbors [m].
  std::vector<double> value = {};  ///< One for each node: negative inside; its size says how far inside.

  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * counts[1] + y) * counts[0] + x;
  }
  [[nodiscard]] DVec3 place(int x, int y, int z) const {
    return corner + spacing * DVec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }
};

/// Moves nodes to the inside until the inner nodes are joined by faces of cubes alone: no square and no cube
/// has only opposite corners on one side (Latecki, Eckhardt and Rosenfeld 1995, Well-composed sets). Values
/// of such nodes become `value_inside`, which must be negative. The outermost nodes must be outside.
void make_well_composed(NodeGrid& grid, double value_inside);

/// Makes the surface between inside and outside (Gibson 1998, Constrained elastic surface nets): one vertex
/// in each cube that the surface crosses, in the middle of the crossings of its edges, and four vertices
/// around each crossed edge. For a well-composed grid each edge has two triangles, so that the surface is
/// closed.
[[nodiscard]] MeshDesc make_surface_net(const NodeGrid& grid);

}  // namespace hooke::geometry
