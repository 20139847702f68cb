#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hooke::geometry {

/// An order of the vertices in which neighbors are near each other, so that data that are read together lie
/// together. It is breadth-first from a vertex at the rim, neighbors with few neighbors first (Cuthill and
/// McKee, 1969). Element i is the old index of the new vertex i. Parts that are not connected follow each
/// other by their smallest vertex; ties go to the smaller index. Indices of `edges` are below `vertex_count`;
/// repeated edges and loops do no harm.
std::vector<std::uint32_t> compute_cuthill_mckee_order(std::size_t vertex_count,
                                                       std::span<const std::array<std::uint32_t, 2>> edges);

/// The permutation that undoes `order`: element i is the new index of the old vertex i.
std::vector<std::uint32_t> invert_order(std::span<const std::uint32_t> order);

}  // namespace hooke::geometry
