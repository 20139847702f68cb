#pragma once

#include "geometry/bsp/bsp_solid.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace hooke::test {

/// The surface of the cells of a grid that are solid; `lines` are the places of its planes, three axes. Cells
/// without a neighbor end at it.
inline geometry::SolidMesh make_cells(const std::array<std::vector<double>, 3>& lines,
                                      const std::function<bool(std::array<std::size_t, 3>)>& is_solid) {
  geometry::SolidMesh mesh;
  std::map<std::array<std::size_t, 3>, std::uint32_t> vertex_of;
  const auto vertex = [&](const std::array<std::size_t, 3>& at) {
    const auto [entry, is_new] = vertex_of.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back({lines[0][at[0]], lines[1][at[1]], lines[2][at[2]]});
    return entry->second;
  };
  const auto cells = [&](std::size_t axis) { return lines[axis].size() - 1; };
  const auto is_solid_at = [&](const std::array<std::size_t, 3>& cell) {
    // One below zero is far beyond the end.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell[axis] >= cells(axis)) return false;
    }
    return is_solid(cell);
  };
  std::array<std::size_t, 3> cell = {};
  for (cell[0] = 0; cell[0] < cells(0); ++cell[0]) {
    for (cell[1] = 0; cell[1] < cells(1); ++cell[1]) {
      for (cell[2] = 0; cell[2] < cells(2); ++cell[2]) {
        if (!is_solid_at(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const bool is_upper : {false, true}) {
            std::array<std::size_t, 3> neighbor = cell;
            neighbor[axis] += is_upper ? 1 : std::size_t(-1);
            if (is_solid_at(neighbor)) continue;
            const std::size_t u = (axis + 1) % 3;
            const std::size_t v = (axis + 2) % 3;
            std::array<std::size_t, 3> corner = cell;
            corner[axis] += is_upper ? 1 : 0;
            std::array<std::uint32_t, 4> quad = {};
            for (std::size_t k = 0; k < 4; ++k) {
              std::array<std::size_t, 3> at = corner;
              at[u] += k == 1 || k == 2 ? 1 : 0;
              at[v] += k >= 2 ? 1 : 0;
              quad[k] = vertex(at);
            }
            if (!is_upper) std::swap(quad[1], quad[3]);
            mesh.triangles.push_back({quad[0], quad[1], quad[2]});
            mesh.triangles.push_back({quad[0], quad[2], quad[3]});
          }
        }
      }
    }
  }
  return mesh;
}

/// A building of rooms, 4 m by 4 m and 2.5 m high, with walls and floors of 0.2 m; every two rooms of a
/// storey that are next to each other are joined by a door, 1 m wide and 2 m high. Its lower corner is the
/// origin.
inline geometry::SolidMesh make_building(std::size_t rooms_x, std::size_t storeys, std::size_t rooms_z) {
  std::array<std::vector<double>, 3> lines;
  const std::array<std::size_t, 3> rooms = {rooms_x, storeys, rooms_z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t room = 0; room < rooms[axis]; ++room) {
      // Wall, then up to the door, the door, up to the wall; storeys: floor, door, above it.
      const double start = static_cast<double>(room) * (axis == 1 ? 2.7 : 4.2);
      lines[axis].insert(lines[axis].end(), {start, start + 0.2});
      if (axis == 1) {
        lines[axis].push_back(start + 2.2);
      } else {
        lines[axis].insert(lines[axis].end(), {start + 1.7, start + 2.7});
      }
    }
    const double end = static_cast<double>(rooms[axis]) * (axis == 1 ? 2.7 : 4.2);
    lines[axis].insert(lines[axis].end(), {end, end + 0.2});
  }
  return make_cells(lines, [&](std::array<std::size_t, 3> cell) {
    const std::size_t x = cell[0] % 4;
    const std::size_t y = cell[1] % 3;
    const std::size_t z = cell[2] % 4;
    if (y == 0) return true;
    const bool is_outer_x = cell[0] == 0 || cell[0] == 4 * rooms_x;
    const bool is_outer_z = cell[2] == 0 || cell[2] == 4 * rooms_z;
    if (x == 0) return is_outer_x || y != 1 || z != 2;
    if (z == 0) return is_outer_z || y != 1 || x != 2;
    return false;
  });
}

}  // namespace hooke::test
