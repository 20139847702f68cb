#pragma once

#include "hooke/hooke.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace hooke::test {

/// Number of pieces in which points hang together by elements.
template <std::size_t N>
std::size_t count_pieces(std::size_t points, std::span<const std::array<std::uint32_t, N>> elements) {
  std::vector<std::uint32_t> root(points);
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i];
    return i;
  };
  for (const auto& element : elements) {
    for (const std::uint32_t p : element) root[find(p)] = find(element[0]);
  }
  std::set<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < root.size(); ++i) roots.insert(find(i));
  return roots.size();
}

inline std::size_t count_pieces(const World& world, ClothId cloth) {
  const auto triangles = world.triangles(cloth);
  return count_pieces<3>(world.positions(cloth).size(), triangles);
}

/// Pieces of a solid, by its surface.
inline std::size_t count_pieces(const World& world, SolidId solid) {
  const auto triangles = world.triangles(solid);
  return count_pieces<3>(world.surface(solid).size(), triangles);
}

}  // namespace hooke::test
