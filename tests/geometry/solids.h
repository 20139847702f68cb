#pragma once

#include "geometry/bsp/bsp_solid.h"
#include "geometry/meshes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace hooke::test {

using geometry::SolidMesh;

inline SolidMesh make_box(DVec3 lower, DVec3 upper) {
  SolidMesh box = geometry::solid_mesh_of(make_cube(1));
  for (DVec3& p : box.positions) {
    p = {p.x < 0 ? lower.x : upper.x, p.y < 0 ? lower.y : upper.y, p.z < 0 ? lower.z : upper.z};
  }
  return box;
}

/// A sphere with bumps and dents: each vertex between `low` and 1 from the origin.
inline SolidMesh make_star(int levels, double low, std::mt19937& random) {
  SolidMesh star = geometry::solid_mesh_of(make_sphere(levels));
  std::uniform_real_distribution<double> radius(low, 1.0);
  for (DVec3& p : star.positions) p = radius(random) * p;
  return star;
}

/// A ring of square section about the z axis.
inline SolidMesh make_ring(std::uint32_t count, double inner, double outer, double half_height) {
  SolidMesh ring;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * i / count;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    ring.positions.insert(ring.positions.end(), {{inner * c, inner * s, -half_height},
                                                 {outer * c, outer * s, -half_height},
                                                 {outer * c, outer * s, half_height},
                                                 {inner * c, inner * s, half_height}});
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t a = 4 * i + k;
      const std::uint32_t b = 4 * i + (k + 1) % 4;
      const std::uint32_t c2 = 4 * ((i + 1) % count) + (k + 1) % 4;
      const std::uint32_t d = 4 * ((i + 1) % count) + k;
      ring.triangles.insert(ring.triangles.end(), {{a, c2, b}, {a, d, c2}});
    }
  }
  return ring;
}

/// An L: the box [0, 2] x [0, 2] x [0, 1] without [1, 2] x [1, 2] x [0, 1].
inline SolidMesh make_corner() {
  SolidMesh solid;
  const std::array<std::array<double, 2>, 6> outline = {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  for (const double z : {0.0, 1.0}) {
    for (const auto& p : outline) solid.positions.push_back({p[0], p[1], z});
  }
  for (std::uint32_t k = 0; k < 6; ++k) {
    const std::uint32_t next = (k + 1) % 6;
    solid.triangles.insert(solid.triangles.end(), {{k, next, next + 6}, {k, next + 6, k + 6}});
  }
  const std::array<geometry::Triangle, 4> top = {{{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}}};
  for (const auto& [a, b, c] : top) {
    solid.triangles.insert(solid.triangles.end(), {{a + 6, b + 6, c + 6}, {a, c, b}});
  }
  return solid;
}

inline SolidMesh joined(SolidMesh a, const SolidMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

inline SolidMesh inside_out(SolidMesh solid) {
  for (auto& t : solid.triangles) std::swap(t[1], t[2]);
  return solid;
}

inline SolidMesh moved(SolidMesh solid, Quaternion<double> turn, double scale, DVec3 shift) {
  for (DVec3& p : solid.positions) p = rotate(turn, scale * p) + shift;
  return solid;
}

/// [m^3], from its first corner, so that far away no digits are lost.
inline double volume_of(const SolidMesh& solid) {
  double sum = 0;
  for (const auto& t : solid.triangles) {
    const DVec3 apex = solid.positions[solid.triangles[0][0]];
    sum +=
        dot(solid.positions[t[0]] - apex, cross(solid.positions[t[1]] - apex, solid.positions[t[2]] - apex));
  }
  return sum / 6;
}

/// Every edge has one triangle each way, and the triangles at each vertex form one fan.
inline bool is_manifold(const SolidMesh& solid) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> next;  // from an edge to the third corner
  std::vector<std::uint32_t> corner_count(solid.positions.size(), 0);
  std::vector<std::uint32_t> after(solid.positions.size(), geometry::kNone);
  for (const auto& t : solid.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!next.try_emplace({t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]).second) return false;
      ++corner_count[t[k]];
      after[t[k]] = t[(k + 1) % 3];
    }
  }
  for (const auto& [edge, third] : next) {
    if (next.count({edge.second, edge.first}) == 0) return false;
  }
  for (std::uint32_t v = 0; v < solid.positions.size(); ++v) {
    if (corner_count[v] == 0) return false;
    std::uint32_t turns = 0;
    std::uint32_t at = after[v];
    do {
      at = next.at({v, at});
      ++turns;
    } while (at != after[v] && turns <= corner_count[v]);
    if (turns != corner_count[v]) return false;
  }
  return true;
}

}  // namespace hooke::test
